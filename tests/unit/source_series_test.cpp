// What a scan's import keeps of the series that it came from, and what is refused as such.
#include "core/source_series.h"

#include "dicom/import_series.h"
#include "dicom_test_files.h"

using namespace haustra;

namespace {

namespace fs = std::filesystem;

class Source : public testing::Test {
protected:
    fs::path folder() const { return temporary_.path() / "series"; }
    void writeSmall() { tests::write(folder(), tests::patternScan(tests::smallGrid())); }
    SourceSeries imported() const {
        auto read = dicom::importSeries(folder());
        EXPECT_TRUE(read) << describe(read.error());
        return read ? read->source : SourceSeries{};
    }
    static std::string uid(const fs::path& file, const DcmTagKey& tag) {
        DcmFileFormat format;
        EXPECT_TRUE(format.loadFile(OFFilename(file.c_str())).good());
        OFString value;
        format.getDataset()->findAndGetOFString(tag, value);
        return value.c_str();
    }
    const tests::TemporaryFolder temporary_;
};

TEST_F(Source, IsTheSeriesAndEachOfItsSlicesInOrder) {
    writeSmall();
    for (const fs::path& file : tests::filesIn(folder())) {
        tests::set(file, DCM_StudyDate, "20240229");
        tests::set(file, DCM_StudyTime, "081530.25");
        tests::set(file, DCM_PatientName, "Secret^Name");
        tests::set(file, DCM_PatientID, "SECRET-1");
    }
    const SourceSeries source = imported();
    const Grid grid = tests::smallGrid();
    const fs::path first = folder() / "0001.dcm";
    EXPECT_EQ(source.studyUid, uid(first, DCM_StudyInstanceUID));
    EXPECT_EQ(source.seriesUid, uid(first, DCM_SeriesInstanceUID));
    EXPECT_EQ(source.frameOfReferenceUid, uid(first, DCM_FrameOfReferenceUID));
    EXPECT_EQ(source.studyDate, "20240229");
    EXPECT_EQ(source.studyTime, "081530.25");
    EXPECT_EQ(source.position, PatientPosition::supine);
    ASSERT_EQ(source.images.size(), std::size_t(grid.size.z));
    for (int k = 0; k < grid.size.z; ++k) {
        const SourceImage& image = source.images[std::size_t(k)];
        char name[16];
        std::snprintf(name, sizeof name, "%04d.dcm", k + 1);
        EXPECT_EQ(image.sopInstanceUid, uid(folder() / name, DCM_SOPInstanceUID));
        EXPECT_EQ(image.sopClassUid, UID_CTImageStorage);
        EXPECT_EQ(image.frame, 0);
        EXPECT_EQ(image.positionMm, grid.patientFromVoxelPoint({0, 0, k}));
    }
    const std::string text = sourceSeriesJson(source);
    EXPECT_EQ(text.find("ecret"), std::string::npos) << "no name in the store";
    EXPECT_EQ(text.find("SECRET"), std::string::npos) << "no ID in the store";
    const auto back = sourceSeriesOfJson(text);
    ASSERT_TRUE(back) << describe(back.error());
    EXPECT_EQ(*back, source);
}

TEST_F(Source, OfAnEnhancedImageIsEachFrame) {
    const CtScan scan = tests::patternScan(tests::smallGrid());
    fs::create_directories(folder());
    tests::writeEnhanced(folder() / "all.dcm", scan);
    const SourceSeries source = imported();
    ASSERT_EQ(source.images.size(), 24u);
    std::set<int> frames;
    for (const SourceImage& image : source.images) {
        frames.insert(image.frame);
        EXPECT_EQ(image.sopInstanceUid, source.images[0].sopInstanceUid);
        EXPECT_EQ(image.sopClassUid, UID_EnhancedCTImageStorage);
    }
    EXPECT_EQ(frames.size(), 24u);
    EXPECT_EQ(*frames.begin(), 1);
    EXPECT_EQ(*sourceSeriesOfJson(sourceSeriesJson(source)), source);
}

// Slices that are sheared back, or resampled, stay where the scanner put them.
TEST_F(Source, OfATiltedAndUnevenScanIsWhereTheScannerPutIt) {
    writeSmall();
    const Grid grid = tests::smallGrid();
    std::vector<glm::dvec3> places;
    for (int k = 0; k < grid.size.z; ++k) {
        const double depth = k < 12 ? 1.25 * k : 1.25 * 12 + 2.5 * (k - 12);
        places.push_back(glm::dvec3(-30, 12.5 + 0.3 * depth, -71 + depth));
        char name[16];
        std::snprintf(name, sizeof name, "%04d.dcm", k + 1);
        tests::set(folder() / name, DCM_ImagePositionPatient, tests::triple(places.back()));
    }
    const auto read = dicom::importSeries(folder());
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_GT(read->scan.hu.grid().size.z, grid.size.z) << "resampled";
    EXPECT_GT(read->scan.hu.grid().size.y, grid.size.y) << "sheared back";
    ASSERT_EQ(read->source.images.size(), places.size());
    for (std::size_t k = 0; k < places.size(); ++k)
        EXPECT_LT(glm::distance(read->source.images[k].positionMm, places[k]), 1e-6);
}

TEST_F(Source, WhatFilesDoNotAgreeOnOrSayWronglyIsLeftOut) {
    writeSmall();
    tests::set(folder() / "0003.dcm", DCM_FrameOfReferenceUID, "1.2.3");
    for (const fs::path& file : tests::filesIn(folder())) {
        tests::set(file, DCM_StudyDate, "2024.2.9");
        tests::set(file, DCM_StudyTime, "25");
    }
    tests::set(folder() / "0005.dcm", DCM_SOPInstanceUID, "not a uid");
    const SourceSeries source = imported();
    EXPECT_TRUE(source.frameOfReferenceUid.empty());
    EXPECT_TRUE(source.studyDate.empty());
    EXPECT_TRUE(source.studyTime.empty());
    EXPECT_FALSE(source.studyUid.empty());
    EXPECT_EQ(source.images[4].sopInstanceUid, "");
    EXPECT_TRUE(sourceSeriesOfJson(sourceSeriesJson(source)));
}

TEST_F(Source, WhatIsNoneIsRefused) {
    writeSmall();
    const std::string sound = sourceSeriesJson(imported());
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = sound;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    ASSERT_TRUE(sourceSeriesOfJson(sound));
    for (const std::string& text :
         {std::string(), std::string("[]"), std::string("{}"), sound.substr(0, sound.size() / 2),
          with("\"2.25.", "\"02.25."), with("\"2.25.", "\"2..25."), with("\"2.25.", "\"../"),
          with("\"2.25.", "\"2.25." + std::string(64, '1')), with("\"study_date\":\"\"", "\"x\":1"),
          with("\"study_date\":\"\"", "\"study_date\":\"20241301\""),
          with("\"study_time\":\"\"", "\"study_time\":\"2460\""), with("[1.0,0.0,0.0]", "[0,0,0]"),
          with("[1.0,0.0,0.0]", "[0,1,0]"), with("[0.7,0.8]", "[0.7,-0.8]"),
          with("[0.7,0.8]", "[0.7]"), with("-71.0", "1e300"), with("-71.0", "null"),
          with("\"thickness_mm\":1.25", "\"thickness_mm\":-1"),
          with("\"images\": [", "\"images\": 7, \"x\": [")}) {
        const auto read = sourceSeriesOfJson(text, "case/source");
        ASSERT_FALSE(read) << text.substr(0, 600);
        EXPECT_EQ(read.error().kind, ErrorKind::badInput);
        EXPECT_EQ(read.error().place, "case/source");
    }
}

TEST(DicomText, UidsDatesAndTimesAreToldFromOthers) {
    for (const char* uid : {"1", "0", "1.2.840.10008.1.1", "2.25.0"})
        EXPECT_TRUE(isUid(uid)) << uid;
    for (const char* none : {"", ".", "1.", ".1", "1..2", "1.02", "1.a", "1 ", "-1"})
        EXPECT_FALSE(isUid(none)) << none;
    for (const char* time : {"00", "2359", "235960", "000000.123456"})
        EXPECT_TRUE(isDicomTime(time)) << time;
    for (const char* none : {"", "0", "24", "0060", "0000.5", "000000.", "000000.1234567", "12:30"})
        EXPECT_FALSE(isDicomTime(none)) << none;
    EXPECT_TRUE(isDicomDate("20240229"));
    for (const char* none : {"", "2024", "20241301", "20240132", "2024-1-1"})
        EXPECT_FALSE(isDicomDate(none)) << none;
}

}  // namespace
