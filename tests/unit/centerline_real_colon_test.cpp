// The centerline of a real lumen with 88 handles against the one that VMTK computed.
#include "centerline/path.h"
#include "data_folder.h"
#include "nifti/nifti_file.h"
#include "topology/distance_field.h"
#include "tube_phantom.h"
#include "vtp_points.h"

#include <gtest/gtest.h>

namespace haustra::centerline {
namespace {

// VMTK's line runs where the largest balls fit; ours does so too, until it moves to the middle of
// the cross-sections, which lies to the side of haustra.
TEST(CenterlinePath, LiesWithinTwoMillimetresOfVmtksInARealColon) {
    HAUSTRA_REAL_DATA(maskFile, "masks/lumen460.nii.gz");
    HAUSTRA_REAL_DATA(vmtkFile, "masks/lumen460_centerline.vtp");
    const auto read = nifti::readNifti<std::uint8_t>(maskFile);
    ASSERT_TRUE(read) << describe(read.error());
    const Volume<std::uint8_t>& mask = *read;
    const Grid& grid = mask.grid();
    const Volume<float> distanceMm = topology::distanceToBoundaryMm(mask);
    CenterlineOptions options;
    options.middle = Middle::deepest;
    const auto traced = traceCenterline(mask, distanceMm, options);
    ASSERT_TRUE(traced) << describe(traced.error());
    const Centerline& line = traced->centerline;
    // VMTK's coordinates are voxel indices times the spacing, from the cecum to the rectum.
    std::vector<glm::dvec3> vmtk = tests::AppendedVtp(vmtkFile).polyline();
    ASSERT_EQ(vmtk.size(), 1120u);
    for (glm::dvec3& p : vmtk)
        p = grid.patientFromVoxelPoint(p / grid.spacingMm());

    double sum = 0.0;
    int outside = 0, gaps = 0;
    for (const CenterlinePoint& p : line.points) {
        sum += tests::distanceToCurve(vmtk, p.positionMm);
        const glm::ivec3 voxel(glm::floor(grid.voxelFromPatientPoint(p.positionMm) + 0.5));
        outside += !grid.contains(voxel) || mask.at(voxel) == 0;
        gaps += p.gap;
    }
    const double meanMm = sum / double(line.points.size());
    RecordProperty("mean_mm", std::to_string(meanMm));
    RecordProperty("length_mm", std::to_string(line.lengthMm()));
    EXPECT_LT(meanMm, 2.0);
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(gaps, 0);
    EXPECT_NEAR(line.lengthMm(), 1424.0, 0.05 * 1424.0);
    EXPECT_LT(glm::distance(line.points.front().positionMm, vmtk.back()), 15.0);
    EXPECT_LT(glm::distance(line.points.back().positionMm, vmtk.front()), 15.0);
    // Both ways: nothing of VMTK's line is far from ours either.
    std::vector<glm::dvec3> ours;
    for (const CenterlinePoint& p : line.points)
        ours.push_back(p.positionMm);
    double back = 0.0;
    for (const glm::dvec3& p : vmtk)
        back += tests::distanceToCurve(ours, p);
    EXPECT_LT(back / double(vmtk.size()), 2.0);

    const auto middle = traceCenterline(mask, distanceMm);
    ASSERT_TRUE(middle) << describe(middle.error());
    double shares = 0.0;
    for (const CenterlinePoint& p : middle->centerline.points) {
        const glm::ivec3 voxel(glm::floor(grid.voxelFromPatientPoint(p.positionMm) + 0.5));
        ASSERT_NE(mask.at(voxel), 0);
        shares += tests::distanceToCurve(vmtk, p.positionMm) / p.radiusMm;
    }
    EXPECT_LT(shares / double(middle->centerline.points.size()), 0.4) << "of the radius";
}

}  // namespace
}  // namespace haustra::centerline
