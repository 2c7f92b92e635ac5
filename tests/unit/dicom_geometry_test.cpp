// How slices stack: laws of series_geometry and slice_resampling on made-up slices and linear
// fields, and the real tilted scan's block.
#include "data_folder.h"
#include "dicom/import_series.h"
#include "dicom/series_geometry.h"
#include "dicom/slice_resampling.h"
#include "dicom_test_files.h"

#include <numeric>

namespace haustra {
namespace {

using dicom::Slice;
using dicom::SliceStack;
using dicom::stackSlices;

/// One slice at each of the depths, its first pixel moved by `lean` per mm of depth.
std::vector<Slice> slicesAt(const std::vector<double>& depthsMm, glm::dvec3 lean = {},
                            const glm::dmat3& turn = glm::dmat3(1.0)) {
    std::vector<Slice> slices;
    for (double depth : depthsMm) {
        Slice slice;
        slice.name = "slice" + std::to_string(slices.size());
        slice.instanceUid = "1.2." + std::to_string(slices.size());
        slice.positionMm = turn * (glm::dvec3(-10, -20, depth) + lean * depth);
        slice.rowDirection = turn[0];
        slice.columnDirection = turn[1];
        slice.pixelSpacingMm = {0.5, 0.8};
        slice.matrix = {64, 48};
        slices.push_back(slice);
    }
    return slices;
}

std::vector<double> evenly(int count, double spacing) {
    std::vector<double> depths(std::size_t(count), 0.0);
    for (int k = 0; k < count; ++k)
        depths[std::size_t(k)] = k * spacing;
    return depths;
}

void expectRefused(const std::vector<Slice>& slices, const std::string& name,
                   const std::string& reason) {
    const auto stack = stackSlices(slices);
    ASSERT_FALSE(stack);
    EXPECT_NE(describe(stack.error()).find(name), std::string::npos) << describe(stack.error());
    EXPECT_NE(describe(stack.error()).find(reason), std::string::npos) << describe(stack.error());
}

TEST(SliceStack, SortsByPositionWhateverTheOrientation) {
    for (const glm::dmat3& turn :
         {glm::dmat3(1.0), tests::rotation(0.2, 1.5), tests::rotation(2.0, -3.0)}) {
        std::vector<Slice> slices = slicesAt(evenly(30, 1.5), {}, turn);
        const std::vector<Slice> sorted = slices;
        std::shuffle(slices.begin(), slices.end(), std::mt19937(3));
        const auto stack = stackSlices(slices);
        ASSERT_TRUE(stack) << describe(stack.error());
        EXPECT_TRUE(stack->shiftPixels.empty());
        EXPECT_TRUE(stack->depthSlices.empty());
        ASSERT_EQ(stack->grid.size, glm::ivec3(64, 48, 30));
        for (int k = 0; k < 30; ++k) {
            const Slice& slice = slices[stack->order[std::size_t(k)]];
            EXPECT_EQ(slice.name, sorted[std::size_t(k)].name);
            EXPECT_LT(glm::distance(stack->grid.patientFromVoxelPoint({0, 0, k}), slice.positionMm),
                      1e-9);
        }
        EXPECT_GT(glm::determinant(glm::dmat3(stack->grid.patientFromVoxel)), 0.0);
    }
}

TEST(SliceStack, PositionsRoundedToATenthAreUniform) {
    std::vector<double> depths = evenly(200, 0.625);
    for (double& depth : depths)
        depth = std::round(depth * 10) / 10;
    const auto stack = stackSlices(slicesAt(depths));
    ASSERT_TRUE(stack) << describe(stack.error());
    EXPECT_TRUE(stack->depthSlices.empty());
    EXPECT_NEAR(stack->grid.spacingMm().z, 0.625, 1e-3);
}

TEST(SliceStack, NamesAMissingSlice) {
    for (int missing : {1, 7, 18}) {
        std::vector<double> depths = evenly(20, 1.25);
        depths.erase(depths.begin() + missing);
        const std::string where = std::to_string(missing * 1.25).substr(0, 4);
        expectRefused(slicesAt(depths), "slice" + std::to_string(missing - 1),
                      "a slice is missing at z = " + where);
        expectRefused(slicesAt(depths), "slice" + std::to_string(missing), "1.25 mm apart");
    }
    // Two that leave one between them, and three in a row.
    std::vector<double> depths = evenly(20, 1.0);
    depths.erase(depths.begin() + 9);
    depths.erase(depths.begin() + 10);
    expectRefused(slicesAt(depths), "slice8", "z = 9.00 mm");
    depths = evenly(20, 1.0);
    depths.erase(depths.begin() + 5, depths.begin() + 8);
    expectRefused(slicesAt(depths), "slice4", "3 slices are missing from z = 5.00 mm");
}

TEST(SliceStack, NamesAMissingSliceWhereTheSpacingVaries) {
    // Coarse for the most part: in the fine part a hole is no wider than the usual gap.
    std::vector<double> depths = evenly(20, 2.0);
    for (int k = 0; k < 10; ++k)
        depths.push_back(depths.back() + 1.0);
    ASSERT_TRUE(stackSlices(slicesAt(depths)));
    depths.erase(depths.begin() + 24);
    expectRefused(slicesAt(depths), "slice23", "a slice is missing at z = 43.00 mm");
    expectRefused(slicesAt({0.0, 1.0, 6.0}), "slice1", "4 slices are missing from z = 2.00 mm");
    depths = evenly(9, 5.0);
    for (int k = 0; k < 5; ++k)
        depths.push_back(depths.back() + 20.0);
    expectRefused(slicesAt(depths), "slice8", "20.00 mm away");
}

TEST(SliceStack, RefusesWhatCannotBeOneVolume) {
    std::vector<Slice> slices = slicesAt(evenly(20, 1.0));
    slices[7].positionMm.z = slices[12].positionMm.z;
    expectRefused(slices, "slice7", "same position (z = 12.00 mm) as slice12");

    slices = slicesAt(evenly(20, 1.0));
    slices[3].matrix = {64, 64};
    expectRefused(slices, "slice3", "matrix");
    slices = slicesAt(evenly(20, 1.0));
    slices[3].pixelSpacingMm.y = 0.81;
    expectRefused(slices, "slice3", "pixel spacing");
    slices = slicesAt(evenly(20, 1.0));
    slices[3].rowDirection = tests::rotation(0.02, 0)[0];
    expectRefused(slices, "slice3", "orientation");
    slices = slicesAt(evenly(20, 1.0));
    slices[3].positionMm.x += 5.0;
    expectRefused(slices, "slice3", "sideways by 5.00 mm");
    expectRefused(slicesAt(evenly(5, 12.0)), "slice0", "12.00 mm away");
    EXPECT_FALSE(stackSlices({}));
}

TEST(SliceStack, NamesAStraySlice) {
    for (const double at : {0.02, 0.3, 0.75, 1.05, 2.08}) {
        auto depths = evenly(20, 2.1);
        depths.push_back(9 * 2.1 + at);
        expectRefused(slicesAt(depths), "slice20", "another's");
    }
    // A spacing that changes, and one step of another width, are none.
    std::vector<double> depths{0, 2, 4, 6, 8, 9, 10, 11, 12, 14, 16, 18, 20, 22, 24};
    EXPECT_TRUE(stackSlices(slicesAt(depths)));
    for (const std::vector<double>& sound :
         {std::vector<double>{0, 2, 4, 6, 8, 9.2, 11.2, 13.2, 15.2, 17.2, 19.2},
          {0, 1, 2, 4, 6, 8},
          {0, 2, 4, 6, 7, 8}})
        EXPECT_TRUE(stackSlices(slicesAt(sound)));
}

TEST(SliceStack, LeavesOutCopiesOfASlice) {
    std::vector<Slice> slices = slicesAt(evenly(20, 1.0));
    slices.push_back(slices[4]);
    slices.back().name = "copy";
    const auto stack = stackSlices(slices);
    ASSERT_TRUE(stack) << describe(stack.error());
    EXPECT_EQ(stack->order.size(), 20u);
    ASSERT_EQ(stack->notes.size(), 1u);
}

TEST(SliceStack, VariableSpacingIsResampledNotRefused) {
    std::vector<double> depths = evenly(20, 1.0);
    for (int k = 0; k < 10; ++k)
        depths.push_back(depths.back() + 2.0);
    const auto stack = stackSlices(slicesAt(depths));
    ASSERT_TRUE(stack) << describe(stack.error());
    EXPECT_EQ(stack->grid.size.z, 40);
    EXPECT_DOUBLE_EQ(stack->grid.spacingMm().z, 1.0);
    EXPECT_EQ(stack->depthSlices.back(), 39.0);
    EXPECT_EQ(stack->notes.size(), 1u);
}

TEST(SliceStack, TiltMakesOrthogonalAxesThatHoldEverySlice) {
    for (double lean : {-0.33, 0.2}) {
        const std::vector<Slice> slices = slicesAt(evenly(54, 2.4), {0.05, lean, 0});
        const auto stack = stackSlices(slices);
        ASSERT_TRUE(stack) << describe(stack.error());
        const glm::dmat3 axes(stack->grid.patientFromVoxel);
        EXPECT_NEAR(glm::dot(axes[0], axes[1]), 0.0, 1e-9);
        EXPECT_NEAR(glm::dot(axes[1], axes[2]), 0.0, 1e-9);
        EXPECT_NEAR(glm::dot(axes[2], axes[0]), 0.0, 1e-9);
        ASSERT_EQ(stack->shiftPixels.size(), slices.size());
        for (std::size_t k = 0; k < slices.size(); ++k) {
            const glm::dvec2 shift = stack->shiftPixels[k];
            const glm::dvec3 first(shift, double(k));
            EXPECT_LT(glm::distance(stack->grid.patientFromVoxelPoint(first),
                                    slices[stack->order[k]].positionMm),
                      1e-6);
            EXPECT_GE(std::min(shift.x, shift.y), 0.0);
            EXPECT_LE(shift.x + 63, stack->grid.size.x - 1 + 1e-9);
            EXPECT_LE(shift.y + 47, stack->grid.size.y - 1 + 1e-9);
        }
    }
}

TEST(SliceStack, OneSliceTakesItsThickness) {
    std::vector<Slice> slices = slicesAt({4.0});
    slices[0].thicknessMm = 2.5;
    const auto stack = stackSlices(slices);
    ASSERT_TRUE(stack);
    EXPECT_EQ(stack->grid.spacingMm(), glm::dvec3(0.5, 0.8, 2.5));
}

TEST(SliceResampling, ShiftReproducesALinearField) {
    const glm::ivec2 matrix(20, 15), size(24, 19);
    std::vector<std::int16_t> slice(20 * 15), result(24 * 19);
    for (int y = 0; y < 15; ++y) {
        for (int x = 0; x < 20; ++x)
            slice[std::size_t(y * 20 + x)] = std::int16_t(40 * x - 24 * y + 100);
    }
    for (const glm::dvec2 shift : {glm::dvec2(0, 0), glm::dvec2(1.25, 3.5), glm::dvec2(4, 0.75)}) {
        dicom::placeShifted(slice, matrix, shift, result, size);
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const glm::dvec2 from = glm::dvec2(x, y) - shift;
                const bool inside = from.x >= 0 && from.y >= 0 && from.x <= 19 && from.y <= 14;
                const double expected = inside ? 40 * from.x - 24 * from.y + 100 : -1024;
                EXPECT_NEAR(result[std::size_t(y * size.x + x)], expected, 0.501) << x << ' ' << y;
            }
        }
    }
}

/// A linear field of HU over the patient: what any correct resampling gives back.
std::int16_t field(glm::dvec3 patientMm) {
    return std::int16_t(std::lround(glm::dot(patientMm, glm::dvec3(3.0, -2.0, 4.0))));
}

/// Writes the field as a series whose slices lie at `depthsMm`, leaning by `lean` per mm.
void writeField(const std::filesystem::path& folder, const std::vector<double>& depthsMm,
                glm::dvec3 lean) {
    const Grid grid =
        axisAlignedGrid({40, 32, int(depthsMm.size())}, {0.8, 0.8, 1.0}, {-16, -13, 0});
    CtScan scan{Volume<std::int16_t>(grid), PatientPosition::supine};
    std::vector<glm::dvec3> origins;
    for (double depth : depthsMm)
        origins.push_back(glm::dvec3(-16, -13, depth) + lean * depth);
    for (std::size_t n = 0; n < scan.hu.voxels().size(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        scan.hu.writable()[n] =
            field(origins[std::size_t(v.z)] + glm::dvec3(0.8 * v.x, 0.8 * v.y, 0));
    }
    tests::write(folder, scan);
    const auto files = tests::filesIn(folder);
    for (std::size_t k = 0; k < files.size(); ++k)
        tests::set(files[k], DCM_ImagePositionPatient, tests::triple(origins[k]));
}

void expectField(const CtScan& scan, double fewest) {
    std::size_t compared = 0;
    for (std::size_t n = 0; n < scan.hu.voxels().size(); ++n) {
        if (scan.hu[n] <= -1024) continue;  // beyond the slices' edges
        const Grid& grid = scan.hu.grid();
        const double expected = field(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(n))));
        ASSERT_NEAR(scan.hu[n], expected, 1.51) << n;
        ++compared;
    }
    EXPECT_GT(double(compared), fewest * double(scan.hu.voxels().size()));
}

TEST(DicomGeometry, TiltedSeriesIsShearedBack) {
    const tests::TemporaryFolder folder;
    writeField(folder.path(), evenly(30, 1.5), {0, 0.3, 0});
    const auto imported = dicom::importSeries(folder.path());
    ASSERT_TRUE(imported) << describe(imported.error());
    ASSERT_EQ(imported->notes.size(), 1u);
    EXPECT_NE(imported->notes[0].find("16.7 degrees"), std::string::npos) << imported->notes[0];
    expectField(imported->scan, 0.6);
}

TEST(DicomGeometry, VariableSpacingIsResampled) {
    std::vector<double> depths = evenly(20, 1.0);
    for (int k = 0; k < 12; ++k)
        depths.push_back(depths.back() + 1.7);
    for (const glm::dvec3 lean : {glm::dvec3(0), glm::dvec3(0, -0.25, 0)}) {
        const tests::TemporaryFolder folder;
        writeField(folder.path(), depths, lean);
        const auto imported = dicom::importSeries(folder.path());
        ASSERT_TRUE(imported) << describe(imported.error());
        EXPECT_EQ(imported->scan.hu.grid().size.z, 41);
        EXPECT_EQ(imported->notes.size(), lean.y == 0 ? 1u : 2u);
        CtScan& scan = const_cast<CtScan&>(imported->scan);
        // The last slice of the result lies beyond the last one scanned.
        const Grid& grid = scan.hu.grid();
        const std::size_t plane = std::size_t(grid.size.x) * std::size_t(grid.size.y);
        std::fill_n(scan.hu.writable().end() - std::ptrdiff_t(plane), plane, std::int16_t(-1024));
        if (lean.y == 0) expectField(scan, 0.9);
    }
}

// ------------------------------------------------------------- the block in the real tilted scan

/// Where, from `start` along `axis` (voxels), the volume first falls through −450 HU.
glm::dvec3 edgeAlong(const Volume<std::int16_t>& volume, glm::dvec3 start, glm::dvec3 axis) {
    constexpr double level = -450.0, step = 0.05;
    double t = 0.0;
    while (t < 60.0 && trilinear(volume, start + t * axis) > level)
        t += step;
    return start + t * axis;
}

/// Normal of the least-squares plane through points that is steepest along coordinate `along`.
glm::dvec3 faceNormal(const std::vector<glm::dvec3>& points, int along) {
    const int u = (along + 1) % 3, v = (along + 2) % 3;
    glm::dmat3 a(0.0);
    glm::dvec3 b(0.0);
    for (const glm::dvec3& p : points) {
        const glm::dvec3 row(1.0, p[u], p[v]);
        a += glm::outerProduct(row, row);
        b += row * p[along];
    }
    const glm::dvec3 fit = glm::inverse(a) * b;
    glm::dvec3 normal(0.0);
    normal[along] = 1.0;
    normal[u] = -fit[1];
    normal[v] = -fit[2];
    return glm::normalize(normal);
}

struct BlockAngles {
    double sideFront, frontTop, topSide;
};

/// Angles between three faces of the block, from edges found along the voxel axes.
BlockAngles measureBlock(const Volume<std::int16_t>& volume, const glm::dmat4& patientFromVoxel) {
    // A point in the middle of the block, which is 20 mm square and 35 mm high, and leans.
    const glm::dvec3 middle = volume.grid().voxelFromPatientPoint({13.5, 86.8, 778.1});
    std::vector<glm::dvec3> side, front, top;
    auto place = [&](glm::dvec3 voxel) {
        return glm::dvec3(patientFromVoxel * glm::dvec4(voxel, 1.0));
    };
    for (int a = -4; a <= 4; ++a) {
        for (int b = -4; b <= 4; ++b) {
            side.push_back(
                place(edgeAlong(volume, middle + glm::dvec3(0, 2.5 * a, b), {-1, 0, 0})));
            front.push_back(place(edgeAlong(volume, middle + glm::dvec3(3 * a, 0, b), {0, -1, 0})));
            const glm::dvec3 upper = middle + glm::dvec3(3 * a, -4.0 + 2.5 * b, 3);
            top.push_back(place(edgeAlong(volume, upper, {0, 0, 1})));
        }
    }
    const glm::dvec3 x = faceNormal(side, 0), y = faceNormal(front, 1), z = faceNormal(top, 2);
    auto degrees = [](glm::dvec3 p, glm::dvec3 q) {
        return glm::degrees(std::acos(glm::dot(p, q)));
    };
    return {degrees(x, y), degrees(y, z), degrees(z, x)};
}

TEST(DicomGeometry, BlockInTheTiltedScanHasRightAngles) {
    HAUSTRA_REAL_DATA(folder, "dicom/tilt");
    const auto imported = dicom::importSeries(folder);
    ASSERT_TRUE(imported) << describe(imported.error());
    ASSERT_EQ(imported->notes.size(), 1u);
    EXPECT_NE(imported->notes[0].find("18.5 degrees"), std::string::npos);
    const Grid& grid = imported->scan.hu.grid();
    const BlockAngles angles = measureBlock(imported->scan.hu, grid.patientFromVoxel);
    RecordProperty("sideFront", std::to_string(angles.sideFront));
    RecordProperty("frontTop", std::to_string(angles.frontTop));
    RecordProperty("topSide", std::to_string(angles.topSide));
    EXPECT_NEAR(angles.sideFront, 90.0, 1.5);
    EXPECT_NEAR(angles.frontTop, 90.0, 1.5);
    EXPECT_NEAR(angles.topSide, 90.0, 1.5);

    // The same edges, placed as if the slices had not been sheared back: the angle opens.
    glm::dmat4 crooked = grid.patientFromVoxel;
    crooked[2] +=
        crooked[1] * (std::tan(glm::radians(18.5)) * grid.spacingMm().z / grid.spacingMm().y);
    EXPECT_GT(std::abs(measureBlock(imported->scan.hu, crooked).frontTop - 90.0), 10.0);
}

}  // namespace
}  // namespace haustra
