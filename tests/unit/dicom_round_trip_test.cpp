// What writeSeries writes, importSeries gives back, whatever the files' names, order and folders.
#include "dicom/import_series.h"
#include "dicom_test_series.h"

#include <fstream>

namespace haustra {
namespace {

using dicom::importSeries;
using tests::patternScan;
using tests::smallGrid;
using tests::TemporaryFolder;
namespace fs = std::filesystem;

void expectSame(const CtScan& expected, const Result<dicom::ImportedSeries>& imported) {
    ASSERT_TRUE(imported) << describe(imported.error());
    const CtScan& scan = imported->scan;
    ASSERT_EQ(scan.hu.grid().size, expected.hu.grid().size);
    EXPECT_TRUE(sameGrid(scan.hu.grid(), expected.hu.grid()));
    EXPECT_TRUE(std::ranges::equal(scan.hu.voxels(), expected.hu.voxels()));
    EXPECT_EQ(scan.position, expected.position);
    EXPECT_TRUE(imported->notes.empty()) << imported->notes.front();
}

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(DicomRoundTrip, IsExact) {
    for (PatientPosition position :
         {PatientPosition::supine, PatientPosition::prone, PatientPosition::leftDecubitus,
          PatientPosition::rightDecubitus, PatientPosition::unknown}) {
        const TemporaryFolder folder;
        const CtScan scan = patternScan(smallGrid(), position);
        tests::write(folder.path(), scan);
        expectSame(scan, importSeries(folder.path()));
    }
}

TEST(DicomRoundTrip, KeepsObliqueAndReversedAxes) {
    for (const glm::dmat3& by : {tests::rotation(0.3, -0.2), tests::rotation(3.0, 1.5),
                                 tests::rotation(0.0, std::acos(-1.0))}) {
        const TemporaryFolder folder;
        const CtScan scan = patternScan(tests::rotated(smallGrid(), by));
        tests::write(folder.path(), scan);
        expectSame(scan, importSeries(folder.path()));
    }
}

TEST(DicomRoundTrip, FeetFirstIsTheSamePatient) {
    for (PatientPosition position : {PatientPosition::supine, PatientPosition::leftDecubitus}) {
        const TemporaryFolder folder;
        const CtScan scan = patternScan(smallGrid(), position);
        dicom::WriteOptions writing;
        writing.uidSeed = "feet first", writing.feetFirst = true;
        ASSERT_TRUE(dicom::writeSeries(folder.path(), scan, writing));
        const auto imported = importSeries(folder.path());
        ASSERT_TRUE(imported) << describe(imported.error());
        EXPECT_EQ(imported->scan.position, position);
        const Grid &grid = scan.hu.grid(), &back = imported->scan.hu.grid();
        EXPECT_LT(back.patientFromVoxel[0].x, 0.0) << "rows run the other way";
        ASSERT_EQ(back.voxelCount(), grid.voxelCount());
        for (std::size_t n = 0; n < back.voxelCount(); ++n) {
            const glm::dvec3 at =
                grid.voxelFromPatientPoint(back.patientFromVoxelPoint(back.voxelAt(n)));
            const glm::ivec3 v(glm::round(at));
            ASSERT_LT(glm::distance(at, glm::dvec3(v)), 1e-6);
            ASSERT_EQ(imported->scan.hu[n], scan.hu.at(v));
        }
    }
}

TEST(DicomRoundTrip, IgnoresNamesFoldersAndOtherFiles) {
    const TemporaryFolder folder;
    const CtScan scan = patternScan(smallGrid());
    tests::write(folder / "flat", scan);
    for (int k = 0; k < 24; ++k) {
        char name[16];
        std::snprintf(name, sizeof name, "%04d.dcm", k + 1);
        const fs::path nested = folder / ("nested/" + std::to_string(k * 7 % 5));
        fs::create_directories(nested);
        fs::rename(folder / "flat" / name, nested / ("IM" + std::to_string(k * 11 % 24)));
    }
    std::ofstream(folder / "nested/notes.txt") << "not DICOM";
    std::ofstream(folder / "nested/empty");
    expectSame(scan, importSeries(folder / "nested"));
}

TEST(DicomRoundTrip, OneSliceIsAVolume) {
    const TemporaryFolder folder;
    const CtScan scan = patternScan(axisAlignedGrid({9, 7, 1}, {0.5, 0.5, 2.5}, {1, 2, 3}));
    tests::write(folder.path(), scan);
    expectSame(scan, importSeries(folder.path() / "0001.dcm"));
}

TEST(DicomRoundTrip, DoesNotDependOnThreads) {
    const TemporaryFolder folder;
    const CtScan scan = patternScan(smallGrid());
    for (int threads : {1, 3}) {
        dicom::WriteOptions write;
        write.uidSeed = "same";
        write.threads = threads;
        ASSERT_TRUE(dicom::writeSeries(folder / std::to_string(threads), scan, write));
        dicom::ImportOptions read;
        read.threads = threads;
        expectSame(scan, importSeries(folder / std::to_string(threads), read));
    }
    for (const auto& entry : fs::directory_iterator(folder / "1"))
        EXPECT_EQ(bytesOf(entry), bytesOf(folder / "3" / entry.path().filename()));
}

TEST(DicomRoundTrip, ProgressRisesToOne) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(smallGrid()));
    double last = 0.0;
    dicom::ImportOptions options;
    options.threads = 1;
    options.progress = [&](double fraction) {
        EXPECT_GE(fraction, last);
        last = fraction;
    };
    ASSERT_TRUE(importSeries(folder.path(), options));
    EXPECT_EQ(last, 1.0);
}

TEST(DicomWrite, RefusesASkewGrid) {
    const TemporaryFolder folder;
    Grid grid = smallGrid();
    grid.patientFromVoxel[2][1] = 0.2;
    const auto written = dicom::writeSeries(folder.path(), patternScan(grid), {});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, ErrorKind::unsupported);
}

TEST(DicomWrite, NamesTheFolderItCannotMake) {
    const TemporaryFolder folder;
    std::ofstream(folder / "file") << "in the way";
    const auto written = dicom::writeSeries(folder / "file/series", patternScan(smallGrid()), {});
    ASSERT_FALSE(written);
    EXPECT_NE(describe(written.error()).find("file/series"), std::string::npos);
}

}  // namespace
}  // namespace haustra
