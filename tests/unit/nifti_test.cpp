// NIfTI files: round trips, headers written by hand from the standard, and refusals.
#include "data_folder.h"
#include "nifti/gzip_stream.h"
#include "nifti/nifti_file.h"

#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra {
namespace {

namespace fs = std::filesystem;
using nifti::readNifti;
using nifti::writeNifti;

class Nifti : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "haustra-nifti-XXXXXX").string();
        ASSERT_TRUE(mkdtemp(pattern.data()));
        folder = pattern;
    }
    void TearDown() override { fs::remove_all(folder); }
    fs::path folder;
};

Grid obliqueGrid(glm::ivec3 size) {
    // Orthogonal, turned about z and x, left-handed.
    const double c = std::cos(0.4), s = std::sin(0.4), d = std::cos(-0.7), e = std::sin(-0.7);
    Grid grid;
    grid.size = size;
    grid.patientFromVoxel = glm::dmat4(0.75 * c, 0.75 * s * d, 0.75 * s * e, 0,  //
                                       -0.5 * s, 0.5 * c * d, 0.5 * c * e, 0,    //
                                       0, 1.25 * e, -1.25 * d, 0,                //
                                       -101.5, 33.25, -700.0, 1);
    return grid;
}

template <class T>
Volume<T> pattern(const Grid& grid) {
    Volume<T> volume(grid);
    std::uint32_t state = 1;
    for (T& value : volume.writable()) {
        state = state * 1664525u + 1013904223u;
        if constexpr (std::is_floating_point_v<T>)
            value = T(std::ldexp(double(std::int32_t(state)), -20));
        else
            value = T(state >> 13);
    }
    return volume;
}

std::vector<char> bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void put(const fs::path& file, const std::vector<char>& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

/// A .nii file built byte by byte from the standard's offsets, in either byte order.
class HandWritten {
public:
    explicit HandWritten(bool bigEndian = false) : big_(bigEndian), bytes_(352, 0) {
        set<std::int32_t>(0, 348);
        set<float>(108, 352);  // vox_offset
        std::memcpy(bytes_.data() + 344, "n+1", 4);
        for (int axis = 1; axis < 8; ++axis)
            set<std::int16_t>(40 + 2 * axis, 1);
    }
    template <class T>
    void set(int offset, T value) {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), &value, sizeof value);
        if (big_) std::reverse(raw.begin(), raw.end());
        std::copy(raw.begin(), raw.end(), bytes_.begin() + offset);
    }
    void size(int x, int y, int z) {
        set<std::int16_t>(40, 3);
        set<std::int16_t>(42, std::int16_t(x));
        set<std::int16_t>(44, std::int16_t(y));
        set<std::int16_t>(46, std::int16_t(z));
    }
    void spacing(float x, float y, float z) {
        set(80, x);
        set(84, y);
        set(88, z);
    }
    void datatype(int code) { set<std::int16_t>(70, std::int16_t(code)); }
    template <class T>
    void append(T value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof value);
        set(int(at), value);
    }
    const std::vector<char>& bytes() const { return bytes_; }

private:
    bool big_;
    std::vector<char> bytes_;
};

HandWritten oneVoxel(int datatype, bool bigEndian = false) {
    HandWritten file(bigEndian);
    file.size(1, 1, 1);
    file.spacing(1, 1, 1);
    file.datatype(datatype);
    return file;
}

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

TEST_F(Nifti, NotANumberIsZero) {
    HandWritten file = oneVoxel(16);
    file.append(std::numeric_limits<float>::quiet_NaN());
    put(folder / "nan.nii", file.bytes());
    const auto read = readNifti<std::int16_t>(folder / "nan.nii");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->at(0, 0, 0), 0);
}

void expectRefused(const fs::path& file, const std::string& reason) {
    const auto read = readNifti<std::int16_t>(file);
    ASSERT_FALSE(read) << file;
    EXPECT_EQ(read.error().place, file.string());
    EXPECT_NE(read.error().message.find(reason), std::string::npos) << describe(read.error());
}

TEST_F(Nifti, RefusesTruncatedAndDamagedFiles) {
    ASSERT_TRUE(writeNifti(folder / "a.nii", pattern<std::int16_t>(obliqueGrid({40, 40, 40}))));
    ASSERT_TRUE(writeNifti(folder / "a.nii.gz", pattern<std::int16_t>(obliqueGrid({40, 40, 40}))));
    for (const char* name : {"a.nii", "a.nii.gz"}) {
        std::vector<char> bytes = bytesOf(folder / name);
        const std::vector<char> whole = bytes;
        for (std::size_t length : {whole.size() - 1, whole.size() / 2}) {
            bytes.assign(whole.begin(), whole.begin() + std::ptrdiff_t(length));
            put(folder / name, bytes);
            expectRefused(folder / name, "truncated");
        }
        for (std::size_t length : {360, 300, 10, 0}) {
            bytes.assign(whole.begin(), whole.begin() + std::ptrdiff_t(length));
            put(folder / name, bytes);
            EXPECT_FALSE(readNifti<std::int16_t>(folder / name)) << length;
        }
    }
    ASSERT_TRUE(writeNifti(folder / "a.nii.gz", pattern<std::int16_t>(obliqueGrid({40, 40, 40}))));
    std::vector<char> bytes = bytesOf(folder / "a.nii.gz");
    bytes[bytes.size() - 6] ^= 1;  // in the checksum
    put(folder / "a.nii.gz", bytes);
    expectRefused(folder / "a.nii.gz", "damaged");
}

TEST_F(Nifti, RefusesWhatItCannotMean) {
    const fs::path path = folder / "odd.nii";
    auto refuse = [&](const HandWritten& file, const std::string& reason) {
        std::vector<char> bytes = file.bytes();
        bytes.resize(bytes.size() + 64);
        put(path, bytes);
        expectRefused(path, reason);
    };
    HandWritten file = oneVoxel(32);
    refuse(file, "COMPLEX64");
    file = oneVoxel(2);
    file.set<std::int16_t>(40, 4);
    file.set<std::int16_t>(48, 3);
    refuse(file, "more than three axes");
    file = oneVoxel(2);
    file.size(0, 1, 1);
    refuse(file, "0 voxels");
    file = oneVoxel(2);
    file.size(-5, 1, 1);
    refuse(file, "-5 voxels");
    file = oneVoxel(2);
    file.size(4096, 4096, 512);
    refuse(file, "truncated");
    file = oneVoxel(2);
    file.spacing(0, 1, 1);
    refuse(file, "singular");
    file = oneVoxel(2);
    file.spacing(std::numeric_limits<float>::infinity(), 1, 1);
    refuse(file, "not finite");
    for (float offset : {0.0f, -1.0f, 1e30f, std::numeric_limits<float>::quiet_NaN()}) {
        file = oneVoxel(2);
        file.set(108, offset);
        refuse(file, "data offset");
    }
    file = oneVoxel(2);
    std::vector<char> pair = file.bytes();
    std::memcpy(pair.data() + 344, "ni1", 4);
    put(path, pair);
    expectRefused(path, "pair");
    put(path, std::vector<char>(2000, 'x'));
    expectRefused(path, "not a NIfTI-1 file");
    EXPECT_EQ(readNifti<float>(folder / "absent.nii").error().kind, ErrorKind::notFound);
    EXPECT_EQ(readNifti<float>(folder).error().kind, ErrorKind::notFound);
}

TEST_F(Nifti, NoHeaderByteCrashes) {
    const Grid grid = obliqueGrid({3, 3, 3});
    ASSERT_TRUE(writeNifti(folder / "a.nii", pattern<float>(grid)));
    const std::vector<char> whole = bytesOf(folder / "a.nii");
    for (std::size_t at = 0; at < 352; ++at) {
        for (char flip : {char(0x01), char(0x80), char(0xff)}) {
            std::vector<char> bytes = whole;
            bytes[at] ^= flip;
            put(folder / "b.nii", bytes);
            const auto read = readNifti<std::int16_t>(folder / "b.nii");
            EXPECT_TRUE(read || read.error().place == (folder / "b.nii").string());
        }
    }
}

TEST_F(Nifti, UnwritablePlaceIsAnError) {
    const auto written =
        writeNifti(folder / "no/such/folder.nii", pattern<float>(obliqueGrid({2, 2, 2})));
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, ErrorKind::io);
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
