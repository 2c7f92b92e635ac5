// NIfTI files that are damaged, or mean what Haustra does not read, and places that take none.
#include "nifti_test_files.h"

#include <limits>

namespace haustra {
namespace {

using nifti::readNifti;
using nifti::writeNifti;

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
    // A type without a size, of more voxels than memory holds: told before any is asked for.
    for (const int type : {0, 1, 255}) {
        file = oneVoxel(std::int16_t(type));
        file.size(4096, 4096, 4096);
        refuse(file, "are not read");
    }
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
    EXPECT_EQ(written.error().message, "cannot create: No such file or directory");
}

}  // namespace
}  // namespace haustra
