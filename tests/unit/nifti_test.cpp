// NIfTI files: round trips, and headers written by hand from the standard.
#include "data_folder.h"
#include "nifti/gzip_stream.h"
#include "nifti_test_files.h"

#include <limits>

namespace haustra {
namespace {

using nifti::readNifti;
using nifti::writeNifti;

template <class T>
void expectRoundTrip(const fs::path& file, const Grid& grid) {
    const Volume<T> volume = pattern<T>(grid);
    const auto written = writeNifti(file, volume);
    ASSERT_TRUE(written) << describe(written.error());
    const auto read = readNifti<T>(file);
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_TRUE(sameGrid(read->grid(), grid));
    EXPECT_TRUE(std::ranges::equal(read->voxels(), volume.voxels()));
}

TEST_F(Nifti, ColoursComeBackWithTheirOpacityAndWithoutItAreOpaque) {
    Volume<Rgba> volume(obliqueGrid({7, 5, 3}));
    std::uint8_t next = 0;
    for (Rgba& voxel : volume.writable()) {
        voxel = {next, std::uint8_t(next + 1), std::uint8_t(2 * next), std::uint8_t(255 - next)};
        next = std::uint8_t(next + 3);
    }
    for (const char* name : {"color.nii", "color.nii.gz"}) {
        ASSERT_TRUE(nifti::writeColorNifti(folder / name, volume));
        const auto back = nifti::readColorNifti(folder / name);
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_TRUE(back->hasOpacity);
        EXPECT_TRUE(std::equal(volume.voxels().begin(), volume.voxels().end(),
                               back->voxels.voxels().begin()));
        EXPECT_FALSE(readNifti<std::uint8_t>(folder / name));
    }
    // RGB24: three bytes a voxel.
    std::vector<char> bytes = bytesOf(folder / "color.nii");
    const std::int16_t rgb24 = 128, bits = 24;
    std::memcpy(bytes.data() + 70, &rgb24, 2);
    std::memcpy(bytes.data() + 72, &bits, 2);
    std::vector<char> three(bytes.begin(), bytes.begin() + 352);
    for (const Rgba& voxel : volume.voxels())
        three.insert(three.end(), {char(voxel.r), char(voxel.g), char(voxel.b)});
    put(folder / "rgb.nii", three);
    const auto back = nifti::readColorNifti(folder / "rgb.nii");
    ASSERT_TRUE(back) << describe(back.error());
    EXPECT_FALSE(back->hasOpacity);
    for (std::size_t i = 0; i < volume.voxels().size(); ++i) {
        const Rgba is = volume[i];
        EXPECT_EQ(back->voxels[i], (Rgba{is.r, is.g, is.b, 255}));
    }
    three.pop_back();
    put(folder / "short.nii", three);
    EXPECT_FALSE(nifti::readColorNifti(folder / "short.nii"));
    ASSERT_TRUE(writeNifti(folder / "grey.nii", pattern<std::uint8_t>(obliqueGrid({2, 2, 2}))));
    const auto grey = nifti::readColorNifti(folder / "grey.nii");
    ASSERT_FALSE(grey);
    EXPECT_EQ(grey.error().kind, ErrorKind::unsupported);
}

TEST_F(Nifti, RoundTripIsExact) {
    for (const char* name : {"a.nii", "a.nii.gz"}) {
        for (const Grid& grid : {axisAlignedGrid({5, 6, 7}, {0.7, 0.8, 1.5}, {-20, 30, 40}),
                                 obliqueGrid({31, 17, 9}), obliqueGrid({1, 1, 1})}) {
            expectRoundTrip<std::uint8_t>(folder / name, grid);
            expectRoundTrip<std::int16_t>(folder / name, grid);
            expectRoundTrip<float>(folder / name, grid);
        }
    }
    // Several compressed blocks and waves of them.
    expectRoundTrip<std::int16_t>(folder / "large.nii.gz", obliqueGrid({256, 256, 301}));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 3) << "a temporary file stays";
}

TEST_F(Nifti, FractionsAreThreePlanarVolumesInOneImage) {
    const Grid grid = obliqueGrid({127, 101, 90});  // several compressed blocks
    const std::size_t count = grid.voxelCount();
    Volume<TissueFractions> fractions(grid);
    std::uint32_t state = 1;
    for (TissueFractions& voxel : fractions.writable()) {
        state = state * 1664525u + 1013904223u;
        voxel.air = std::uint8_t(state >> 24);
        voxel.tagged = std::uint8_t((state >> 8 & 0xffff) % (256u - voxel.air));
    }
    for (const char* name : {"a.nii", "a.nii.gz"}) {
        ASSERT_TRUE(nifti::writeFractions(folder / name, fractions));
        auto stream = nifti::MaybeGzipFile::open(folder / name);
        ASSERT_TRUE(stream);
        std::vector<std::byte> bytes(352 + 3 * count);
        ASSERT_TRUE(stream->read(bytes));
        ASSERT_TRUE(stream->finish());
        std::array<std::int16_t, 8> dim;
        std::memcpy(dim.data(), bytes.data() + 40, sizeof dim);
        EXPECT_EQ(dim, (std::array<std::int16_t, 8>{4, 127, 101, 90, 3, 1, 1, 1}));
        for (std::size_t n = 0; n < count; ++n) {
            const auto value = [&](std::size_t plane) {
                return int(bytes[352 + plane * count + n]);
            };
            ASSERT_EQ(value(0), fractions[n].air);
            ASSERT_EQ(value(2), fractions[n].tagged);
            ASSERT_EQ(value(0) + value(1) + value(2), 255);
        }
        const auto refused = readNifti<std::uint8_t>(folder / name);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().kind, ErrorKind::unsupported);
    }
    // The first of the three alone is the file that its own volume makes, on the same affine.
    std::vector<char> bytes = bytesOf(folder / "a.nii");
    bytes.resize(352 + count);
    bytes[40] = 3, bytes[48] = 1;
    put(folder / "air.nii", bytes);
    const auto air = readNifti<std::uint8_t>(folder / "air.nii");
    ASSERT_TRUE(air) << describe(air.error());
    EXPECT_TRUE(sameGrid(air->grid(), grid));
}

TEST_F(Nifti, ShearedAffineSurvives) {
    Grid grid = axisAlignedGrid({4, 4, 4}, {1, 1, 2});
    grid.patientFromVoxel[2][1] = 0.6;
    expectRoundTrip<std::uint8_t>(folder / "sheared.nii", grid);
}

TEST_F(Nifti, WritesRas) {
    // The voxel (0, 0, 0) is 10 mm left, 20 mm posterior, 30 mm superior: +10, +20, +30 in LPS.
    Grid grid = axisAlignedGrid({2, 2, 2}, {0.5, 0.75, 1}, {10, 20, 30});
    ASSERT_TRUE(writeNifti(folder / "a.nii", Volume<std::uint8_t>(grid, 0)));
    const std::vector<char> bytes = bytesOf(folder / "a.nii");
    ASSERT_EQ(bytes.size(), 352u + 8u);
    auto number = [&](int offset) {
        float value;
        std::memcpy(&value, bytes.data() + offset, sizeof value);
        return value;
    };
    const float sform[12] = {-0.5f, 0, 0, -10, 0, -0.75f, 0, -20, 0, 0, 1, 30};
    for (int n = 0; n < 12; ++n)
        EXPECT_EQ(number(280 + 4 * n), sform[n]) << n;
    EXPECT_EQ(number(268), -10.0f);  // qoffset_x
    EXPECT_EQ(number(272), -20.0f);
    EXPECT_EQ(number(80), 0.5f);  // pixdim
}

TEST_F(Nifti, QformAgreesWithSform) {
    const Grid grid = obliqueGrid({3, 4, 5});
    ASSERT_TRUE(writeNifti(folder / "both.nii", pattern<float>(grid)));
    std::vector<char> bytes = bytesOf(folder / "both.nii");
    bytes[254] = bytes[255] = 0;  // sform_code
    for (int n = 280; n < 328; ++n)
        bytes[std::size_t(n)] = 0;
    put(folder / "qform.nii", bytes);
    const auto read = readNifti<float>(folder / "qform.nii");
    ASSERT_TRUE(read) << describe(read.error());
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row) {
            EXPECT_NEAR(read->grid().patientFromVoxel[column][row],
                        grid.patientFromVoxel[column][row], 1e-4);
        }
    }
}

TEST_F(Nifti, SpacingAloneIsRas) {
    HandWritten file = oneVoxel(2);
    file.spacing(2, 3, 4);
    file.append(std::uint8_t(7));
    put(folder / "plain.nii", file.bytes());
    const auto read = readNifti<std::uint8_t>(folder / "plain.nii");
    ASSERT_TRUE(read) << describe(read.error());
    const glm::dmat4 expected(-2, 0, 0, 0, 0, -3, 0, 0, 0, 0, 4, 0, 0, 0, 0, 1);
    EXPECT_EQ(read->grid().patientFromVoxel, expected);
}

TEST_F(Nifti, UnitsBecomeMillimetres) {
    HandWritten file = oneVoxel(2);
    file.spacing(500, 500, 750);
    file.set<char>(123, 3);  // micrometres
    file.append(std::uint8_t(0));
    put(folder / "micron.nii", file.bytes());
    const auto read = readNifti<std::uint8_t>(folder / "micron.nii");
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_NEAR(read->grid().spacingMm().z, 0.75, 1e-12);
}

template <class Stored>
void expectConverted(const fs::path& path, int datatype, Stored stored, float slope,
                     float intercept, double expected) {
    for (bool bigEndian : {false, true}) {
        HandWritten file = oneVoxel(datatype, bigEndian);
        file.set(112, slope);
        file.set(116, intercept);
        file.append(stored);
        put(path, file.bytes());
        const auto real = readNifti<float>(path);
        ASSERT_TRUE(real) << describe(real.error());
        EXPECT_EQ(real->at(0, 0, 0), float(expected)) << "type " << datatype;
        const auto whole = readNifti<std::int16_t>(path);
        ASSERT_TRUE(whole);
        EXPECT_EQ(whole->at(0, 0, 0), std::lround(std::clamp(expected, -32768.0, 32767.0)));
        const auto byte = readNifti<std::uint8_t>(path);
        ASSERT_TRUE(byte);
        EXPECT_EQ(byte->at(0, 0, 0), std::lround(std::clamp(expected, 0.0, 255.0)));
    }
}

TEST_F(Nifti, ConvertsEveryTypeInBothByteOrders) {
    const fs::path path = folder / "typed.nii";
    expectConverted<std::uint8_t>(path, 2, 200, 0, 99, 200);  // slope 0: no scaling at all
    expectConverted<std::int16_t>(path, 4, -1000, 2, 24, -1976);
    expectConverted<std::int32_t>(path, 8, 70000, 1, 0, 70000);
    expectConverted<float>(path, 16, -2.25f, 1, 0, -2.25);
    expectConverted<double>(path, 64, 1e9, 1, -1, 1e9 - 1);
    expectConverted<std::int8_t>(path, 256, -5, 1, 0, -5);
    expectConverted<std::uint16_t>(path, 512, 65535, 0.5f, 0, 32767.5);
    expectConverted<std::uint32_t>(path, 768, 4000000000u, 1, 0, 4e9);
    expectConverted<std::int64_t>(path, 1024, -3, 1, 0.5f, -2.5);
    expectConverted<std::uint64_t>(path, 1280, 12, 1, 0, 12);
}

TEST_F(Nifti, NotANumberIsZeroOrWhatIsAskedFor) {
    HandWritten file = oneVoxel(16);
    file.append(std::numeric_limits<float>::quiet_NaN());
    put(folder / "nan.nii", file.bytes());
    const auto read = readNifti<std::int16_t>(folder / "nan.nii");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->at(0, 0, 0), 0);
    const auto padded = readNifti<std::int16_t>(folder / "nan.nii", -1024);
    ASSERT_TRUE(padded);
    EXPECT_EQ(padded->at(0, 0, 0), -1024);
}

TEST_F(Nifti, TellsWhetherItSaysHowItLies) {
    const fs::path file = folder / "lies.nii";
    ASSERT_TRUE(writeNifti(file, pattern<std::int16_t>(obliqueGrid({3, 4, 5}))));
    EXPECT_TRUE(nifti::saysHowItLies(file).value_or(false));
    std::vector<char> bytes = bytesOf(file);
    std::fill_n(bytes.begin() + 252, 4, '\0');  // neither qform nor sform
    put(file, bytes);
    EXPECT_FALSE(nifti::saysHowItLies(file).value_or(true));
    EXPECT_FALSE(nifti::saysHowItLies(folder / "absent.nii"));
}

TEST_F(Nifti, ReadsARealMask) {
    HAUSTRA_REAL_DATA(file, "masks/lumen460.nii.gz");
    const auto mask = readNifti<std::uint8_t>(file);
    ASSERT_TRUE(mask) << describe(mask.error());
    EXPECT_EQ(mask->grid().size, glm::ivec3(512, 512, 460));
    EXPECT_NEAR(mask->grid().spacingMm().x, 0.8691, 1e-4);
    const auto inside = std::ranges::count_if(mask->voxels(), [](auto v) { return v != 0; });
    EXPECT_NEAR(double(inside) * mask->grid().voxelVolumeMm3() * 1e-6, 2.1, 0.05);  // litres
}

}  // namespace
}  // namespace haustra
