// The DICOM Colon CAD SR of findings: read back, looked at by other programs, and what is refused.
#include "dicom/colon_cad_report.h"

#include "core/voxel_ellipsoid.h"
#include "dicom/import_series.h"
#include "dicom_test_files.h"
#include "end_to_end/run_program.h"

#include <dcmtk/dcmsr/dsrdoc.h>

using namespace haustra;

namespace {

namespace fs = std::filesystem;

// A ball of voxels about a place.
std::vector<VoxelRun> ball(const Grid& grid, glm::dvec3 centerMm, double radiusMm) {
    std::vector<VoxelRun> runs;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (glm::distance(grid.patientFromVoxelPoint(v), centerMm) > radiusMm) continue;
        const bool next = !runs.empty() && runs.back().first.y == v.y &&
                          runs.back().first.z == v.z &&
                          runs.back().first.x + runs.back().count == v.x;
        if (next)
            ++runs.back().count;
        else
            runs.push_back({v, 1});
    }
    return runs;
}

Finding finding(const Grid& grid, glm::dvec3 centerMm, double score) {
    Finding finding{centerMm, 6.125, score, "sessile"};
    finding.wallMm = centerMm + glm::dvec3(0.0, 3.0, 0.0);
    finding.diameterEndsMm = {centerMm - glm::dvec3(3.0625, 0, 0),
                              centerMm + glm::dvec3(3.0625, 0, 0)};
    finding.heightMm = 2.5, finding.arcMm = 412.375;
    finding.segment = ColonSegment::sigmoid;
    finding.voxels = ball(grid, centerMm, 2.0);
    return finding;
}

// Places with every digit that the JSON has; the last far outside all slices.
Findings someFindings() {
    Findings all;
    all.model = {"haustra 1.2.3", "phantoms-1", std::string(64, 'a'), "phantoms; not patients"};
    all.operatingPoint = 0.25;
    all.grid = tests::smallGrid();
    all.findings = {finding(all.grid, {-25.123, 17.457, -60.001}, 0.987654),
                    finding(all.grid, {-22.999, 16.5, -50.333}, 0.25)};
    all.findings[1].segment = {};
    all.findings.push_back({{511.111, -499.999, 1234.567}, 8.25, 0.5, ""});
    all.candidates = {finding(all.grid, {-24.5, 18.25, -55.125}, 0.125)};
    return all;
}

struct Item {
    int depth;
    std::string relation, type, name, value;
    std::vector<glm::vec3> places;
};

// The content tree, depth first.
std::vector<Item> itemsOf(const fs::path& file, DSRDocument& document) {
    DcmFileFormat format;
    EXPECT_TRUE(format.loadFile(OFFilename(file.c_str())).good());
    EXPECT_TRUE(document.read(*format.getDataset()).good());
    std::vector<Item> items;
    DSRDocumentTree& tree = document.getTree();
    for (bool on = tree.gotoRoot() > 0; on; on = tree.iterate() > 0) {
        DSRContentItem& at = tree.getCurrentContentItem();
        Item item{int(tree.getLevel()),
                  DSRTypes::relationshipTypeToDefinedTerm(at.getRelationshipType()),
                  DSRTypes::valueTypeToDefinedTerm(at.getValueType()),
                  at.getConceptName().getCodeMeaning().c_str(),
                  "",
                  {}};
        switch (at.getValueType()) {
            case DSRTypes::VT_Code:
                item.value = at.getCodeValue().getCodeMeaning().c_str();
                break;
            case DSRTypes::VT_Num:
                item.value = (at.getNumericValue().getNumericValue() + " " +
                              at.getNumericValue().getMeasurementUnit().getCodeValue())
                                 .c_str();
                break;
            case DSRTypes::VT_SCoord3D: {
                DSRSpatialCoordinates3DValue value = at.getSpatialCoordinates3D();
                item.value = DSRTypes::graphicType3DToEnumeratedValue(value.getGraphicType());
                EXPECT_EQ(document.getTree().isValid(), OFTrue);
                auto& list = value.getGraphicDataList();
                for (size_t n = 1; n <= list.getNumberOfItems(); ++n) {
                    const auto& p = list.getItem(n);
                    item.places.push_back({p.XCoord, p.YCoord, p.ZCoord});
                }
                break;
            }
            case DSRTypes::VT_Container:
                break;
            default:
                item.value = at.getStringValue().c_str();
        }
        items.push_back(item);
    }
    return items;
}

// What stands below the n-th item called so, at any depth.
std::vector<Item> below(const std::vector<Item>& items, const std::string& name, int count) {
    for (std::size_t n = 0; n < items.size(); ++n) {
        if (items[n].name != name || count-- > 0) continue;
        std::size_t end = n + 1;
        while (end < items.size() && items[end].depth > items[n].depth)
            ++end;
        return {items.begin() + std::ptrdiff_t(n), items.begin() + std::ptrdiff_t(end)};
    }
    return {};
}

const Item* named(const std::vector<Item>& items, const std::string& name) {
    const auto found = std::ranges::find(items, name, &Item::name);
    return found == items.end() ? nullptr : &*found;
}

int countOf(const std::vector<Item>& items, const std::string& name) {
    return int(std::ranges::count(items, name, &Item::name));
}

// A number of the JSON back from single precision.
glm::dvec3 toThousandths(glm::vec3 p) {
    return glm::round(glm::dvec3(p) * 1e3) / 1e3;
}

class ColonCadReport : public testing::Test {
protected:
    void SetUp() override {
        tests::write(folder(), tests::patternScan(tests::smallGrid()));
        for (const fs::path& path : tests::filesIn(folder())) {
            tests::set(path, DCM_StudyDate, "20240229");
            tests::set(path, DCM_StudyTime, "081530");
            tests::set(path, DCM_PatientName, "Pol^Yp");
            tests::set(path, DCM_PatientID, "ID-7");
            tests::set(path, DCM_PatientSex, "F");
            tests::set(path, DCM_AccessionNumber, "A1");
        }
        source_ = imported(folder());
    }
    static SourceSeries imported(const fs::path& path) {
        const auto read = dicom::importSeries(path);
        EXPECT_TRUE(read) << describe(read.error());
        // As it comes out of the store.
        return read ? sourceSeriesOfJson(sourceSeriesJson(read->source)).value() : SourceSeries{};
    }
    fs::path folder() const { return temporary_.path() / "series"; }
    fs::path file() const { return temporary_.path() / "report.dcm"; }

    // As they come out of the store.
    Findings kept(const Findings& findings) const {
        return findingsOfJson(findingsJson(findings)).value();
    }
    std::vector<Item> written(const Findings& findings,
                              const dicom::ColonCadReportOptions& options = {}) {
        const auto done = dicom::writeColonCadReport(file(), kept(findings), source_, options);
        EXPECT_TRUE(done) << describe(done.error());
        return itemsOf(file(), document_);
    }
    std::string attribute(const DcmTagKey& tag) const {
        DcmFileFormat format;
        EXPECT_TRUE(format.loadFile(OFFilename(file().c_str())).good());
        OFString value;
        EXPECT_TRUE(format.getDataset()->tagExists(tag));
        format.getDataset()->findAndGetOFStringArray(tag, value);
        return value.c_str();
    }
    void expectRefused(const Findings& findings, const SourceSeries& source,
                       const std::string& word,
                       const dicom::ColonCadReportOptions& options = {}) const {
        const auto done = dicom::writeColonCadReport(file(), findings, source, options);
        ASSERT_FALSE(done) << word;
        EXPECT_NE(done.error().message.find(word), std::string::npos) << describe(done.error());
        EXPECT_EQ(describe(done.error()).find("Pol"), std::string::npos) << "no patient's name";
        EXPECT_FALSE(fs::exists(file()));
    }
    // dsrdump reads it, and the validator of dicom3tools finds no fault but one: it has never heard
    // of this class. So it is shown a copy that says to be of the class that has all the same
    // modules and kinds of content, and more: Comprehensive 3D SR.
    void expectSound() const {
        for (const char* tool : {"/usr/bin/dciodvfy", "/usr/bin/dsrdump"})
            if (!fs::exists(tool)) GTEST_SKIP() << tool << " is not installed";
        const auto errorsOf = [](const fs::path& path) {
            const std::string told =
                tests::runProgram("/usr/bin/dciodvfy", {path}, [](pid_t) {}).err;
            std::istringstream lines(told);
            std::string errors;
            for (std::string line; std::getline(lines, line);)
                if (line.find("Error") != std::string::npos) errors += line + "\n";
            return std::pair(errors, told);
        };
        const auto [own, ownTold] = errorsOf(file());
        EXPECT_TRUE(own.empty() || own == "Error - Information Object Not found\n") << ownTold;
        const fs::path copy = temporary_.path() / "copy.dcm";
        fs::copy_file(file(), copy, fs::copy_options::overwrite_existing);
        tests::set(copy, DCM_SOPClassUID, UID_Comprehensive3DSRStorage);
        const auto [errors, told] = errorsOf(copy);
        EXPECT_EQ(errors, "") << told;
        EXPECT_NE(told.find("Comprehensive3DSR"), std::string::npos) << told;
        const auto dump = tests::runProgram("/usr/bin/dsrdump", {file()}, [](pid_t) {});
        EXPECT_EQ(dump.exitCode, 0) << dump.err;
        EXPECT_EQ(dump.err.find("E:"), std::string::npos) << dump.err;
        EXPECT_EQ(dump.err.find("missing"), std::string::npos) << dump.err;
        EXPECT_NE(dump.out.find("Colon CAD SR Document"), std::string::npos) << dump.out;
    }
    SourceSeries source_;
    DSRDocument document_;
    const tests::TemporaryFolder temporary_;
};

TEST_F(ColonCadReport, HasEveryFindingAtItsVeryPlace) {
    const Findings all = kept(someFindings());
    const auto items = written(all);
    EXPECT_EQ(document_.getDocumentType(), DSRTypes::DT_ColonCadSR);
    ASSERT_EQ(countOf(items, "Composite Feature"), 4);
    std::vector<Finding> wanted = all.findings;
    wanted.insert(wanted.end(), all.candidates.begin(), all.candidates.end());
    for (std::size_t n = 0; n < wanted.size(); ++n) {
        const auto feature = below(items, "Composite Feature", int(n));
        const Finding& is = wanted[n];
        EXPECT_EQ(feature[0].value, "Polyp of colon");
        EXPECT_EQ(feature[0].relation, "INFERRED FROM");
        EXPECT_EQ(named(feature, "Rendering Intent")->value,
                  n < 3 ? "Presentation Required: Rendering device is expected to present"
                        : "Presentation Optional: Rendering device may present");
        EXPECT_EQ(named(feature, "Tracking Identifier")->value,
                  n < 3 ? "finding " + std::to_string(n + 1) : "candidate 4");
        EXPECT_EQ(named(feature, "Algorithm Name")->value, "phantoms-1");
        EXPECT_EQ(named(feature, "Algorithm Version")->value,
                  "haustra 1.2.3; model's SHA-256 " + std::string(64, 'a'));
        const Item* center = named(feature, "Center");
        ASSERT_TRUE(center);
        EXPECT_EQ(center->value, "POINT");
        EXPECT_EQ(center->relation, "HAS PROPERTIES");
        EXPECT_EQ(toThousandths(center->places.at(0)), is.positionMm);
        EXPECT_EQ(std::stod(named(feature, "Certainty of Feature")->value), 100.0 * is.score);
        EXPECT_EQ(std::stod(named(feature, "Diameter")->value), is.diameterMm);
        EXPECT_EQ(named(feature, "Finding Site") != nullptr, is.segment.has_value());
        EXPECT_EQ(named(feature, "Outline") != nullptr, !is.voxels.empty());
        if (is.voxels.empty()) continue;
        const Item* path = named(feature, "Path");
        EXPECT_EQ(path->value, "POLYLINE");
        EXPECT_EQ(toThousandths(path->places.at(0)), is.diameterEndsMm.first);
        EXPECT_EQ(toThousandths(path->places.at(1)), is.diameterEndsMm.second);
        EXPECT_EQ(named(feature, "Height")->value, "2.5 mm");
        EXPECT_EQ(named(feature, "Distance from anus")->value, "412.375 mm");
        // TID 4128 says that their order is significant.
        std::vector<std::string> order{"Distance from anus", "Height", "Diameter"};
        if (is.segment) order.insert(order.begin(), "Finding Site");
        order.insert(order.begin(), "Associated Morphology");
        std::vector<std::string> written;
        for (const Item& item : feature)
            if (std::ranges::find(order, item.name) != order.end()) written.push_back(item.name);
        EXPECT_EQ(written, order);
        const Item* outline = named(feature, "Outline");
        EXPECT_EQ(outline->value, "ELLIPSOID");
        ASSERT_EQ(outline->places.size(), 6u);
        for (int axis = 0; axis < 3; ++axis) {
            const glm::vec3 from = outline->places[std::size_t(2 * axis)],
                            to = outline->places[std::size_t(2 * axis + 1)];
            EXPECT_LT(glm::distance(0.5f * (from + to), glm::vec3(is.positionMm)), 0.6f);
            EXPECT_NEAR(glm::distance(from, to), 4.0, 1.2);
        }
    }
    expectSound();
}

TEST_F(ColonCadReport, TellsTheMorphologyThatAFindingIsOf) {
    // CID 6209.
    const std::pair<std::string, std::string> kinds[] = {{"sessile", "Sessile"},
                                                         {"pedunculated", "Pedunculated"},
                                                         {"flat", "Flat"},
                                                         {annularKind, "Circumferential"}};
    for (const auto& [kind, meaning] : kinds) {
        Findings findings = someFindings();
        findings.findings[0].kind = kind;
        const auto feature = below(written(findings), "Composite Feature", 0);
        const Item* morphology = named(feature, "Associated Morphology");
        ASSERT_TRUE(morphology) << kind;
        EXPECT_EQ(morphology->value, meaning);
        EXPECT_EQ(morphology->relation, "HAS PROPERTIES");
        expectSound();
    }
    // Of what no kind is told nothing is made up.
    const auto truth = below(written(someFindings()), "Composite Feature", 2);
    EXPECT_FALSE(named(truth, "Associated Morphology"));
}

TEST_F(ColonCadReport, OfWallThatIsThickAllAroundSaysThatARuleFoundIt) {
    Findings findings = someFindings();
    findings.findings[0].kind = annularKind;
    findings.findings[0].heightMm = 11.0;
    const auto items = written(findings);
    const auto feature = below(items, "Composite Feature", 0),
               other = below(items, "Composite Feature", 1);
    ASSERT_TRUE(named(feature, "Algorithm Parameters"));
    EXPECT_EQ(named(feature, "Algorithm Parameters")->value,
              "a rule that has not learnt: the wall is 11 mm thick all around");
    EXPECT_FALSE(named(feature, "Height")) << "nothing stands up there";
    EXPECT_FALSE(named(other, "Algorithm Parameters"));
    expectSound();
}

TEST_F(ColonCadReport, SaysWhatWasLookedAtAndHow) {
    const auto items = written(someFindings());
    EXPECT_EQ(items[0].name, "Colon CAD Report");
    EXPECT_EQ(named(items, "Language of Content Item and Descendants")->value, "English");
    ASSERT_EQ(countOf(items, "Image Set Properties"), 1);
    const auto images = below(items, "Image Set Properties", 0);
    EXPECT_EQ(named(images, "Frame of Reference UID")->value, source_.frameOfReferenceUid);
    EXPECT_EQ(named(images, "Study Instance UID")->value, source_.studyUid);
    EXPECT_EQ(named(images, "Study Date")->value, "20240229");
    EXPECT_EQ(named(images, "Horizontal Pixel Spacing")->value, "0.7 mm");
    EXPECT_EQ(named(images, "Vertical Pixel Spacing")->value, "0.8 mm");
    EXPECT_EQ(named(images, "Slice Thickness")->value, "1.25 mm");
    EXPECT_EQ(named(images, "Spacing between slices")->value, "1.25 mm");
    EXPECT_EQ(named(images, "Recumbent Patient Position with respect to gravity")->value, "supine");
    EXPECT_EQ(named(items, "CAD Processing and Findings Summary")->value,
              "All algorithms succeeded; with findings");
    const auto detections = below(items, "Summary of Detections", 0);
    EXPECT_EQ(detections[0].value, "Succeeded");
    EXPECT_EQ(named(detections, "Series Instance UID")->value, source_.seriesUid);
    EXPECT_EQ(named(detections, "Algorithm Parameters")->value, "operating point: 0.25");
    EXPECT_FALSE(named(detections, "Failed Detections"));
    EXPECT_EQ(named(items, "Summary of Analyses")->value, "Not Attempted");
    EXPECT_EQ(countOf(items, "Image Library"), 0);
    // The evidence is every slice.
    auto& evidence = document_.getCurrentRequestedProcedureEvidence();
    EXPECT_EQ(evidence.getNumberOfInstances(), source_.images.size());
    for (const SourceImage& image : source_.images)
        EXPECT_TRUE(
            evidence.gotoItem(image.sopClassUid.c_str(), image.sopInstanceUid.c_str()).good());
    OFString identifier, resource;
    document_.getTree().getTemplateIdentification(identifier, resource);
    EXPECT_EQ(identifier, "4120");
    EXPECT_EQ(resource, "DCMR");
    EXPECT_EQ(document_.getCompletionFlag(), DSRTypes::CF_Complete);
    EXPECT_EQ(document_.getVerificationFlag(), DSRTypes::VF_Unverified);
}

TEST_F(ColonCadReport, OfNothingFoundSaysSo) {
    Findings none = someFindings();
    none.findings.clear();
    none.candidates.clear();
    const auto items = written(none);
    EXPECT_EQ(named(items, "CAD Processing and Findings Summary")->value,
              "All algorithms succeeded; without findings");
    EXPECT_EQ(countOf(items, "Composite Feature"), 0);
    EXPECT_EQ(countOf(items, "Detection Performed"), 1);
    expectSound();
}

TEST_F(ColonCadReport, NamesWhatAReaderMustKnow) {
    Findings warned = someFindings();
    warned.findings.clear();
    warned.candidates.clear();
    warned.warnings = {"the sigmoid is collapsed", "Größe \\ 5 × 6"};
    // What a reader must know is no failure; wall that was not looked at is.
    EXPECT_EQ(named(written(warned), "CAD Processing and Findings Summary")->value,
              "All algorithms succeeded; without findings");
    warned.unexaminedMm2 = 250.0;
    const auto items = written(warned);
    EXPECT_EQ(named(items, "CAD Processing and Findings Summary")->value,
              "Not all algorithms succeeded; without findings");
    EXPECT_EQ(named(items, "Summary of Detections")->value, "Partially Succeeded");
    const auto parametersOf = [&](const char* detections) {
        std::vector<std::string> texts;
        for (const Item& item : below(items, detections, 0))
            if (item.name == "Algorithm Parameters") texts.push_back(item.value);
        return texts;
    };
    for (const std::string& warning : warned.warnings)
        EXPECT_EQ(std::ranges::count(parametersOf("Successful Detections"), "warning: " + warning),
                  1);
    EXPECT_EQ(parametersOf("Failed Detections"),
              std::vector<std::string>{"wall that was not examined: 250 mm2"});
    expectSound();
}

TEST_F(ColonCadReport, UnevenSlicesAreASetForEachSpacing) {
    for (int k = 12; k < 24; ++k) {
        char name[16];
        std::snprintf(name, sizeof name, "%04d.dcm", k + 1);
        tests::set(folder() / name, DCM_ImagePositionPatient,
                   tests::triple({-30, 12.5, -71 + 1.25 * 12 + 2.5 * (k - 12)}));
    }
    source_ = imported(folder());
    const auto items = written(someFindings());
    ASSERT_EQ(countOf(items, "Image Set Properties"), 2);
    EXPECT_EQ(named(below(items, "Image Set Properties", 0), "Spacing between slices")->value,
              "1.25 mm");
    EXPECT_EQ(named(below(items, "Image Set Properties", 1), "Spacing between slices")->value,
              "2.5 mm");
    EXPECT_EQ(toThousandths(named(items, "Center")->places.at(0)),
              someFindings().findings[0].positionMm);
    expectSound();
}

TEST_F(ColonCadReport, OfAnEnhancedImageNamesItOnce) {
    const fs::path one = temporary_.path() / "enhanced";
    fs::create_directories(one);
    tests::writeEnhanced(one / "all.dcm", tests::patternScan(tests::smallGrid()));
    tests::set(one / "all.dcm", DCM_StudyInstanceUID, "1.2.3.4");
    tests::set(one / "all.dcm", DCM_FrameOfReferenceUID, "1.2.3.5");
    source_ = imported(one);
    written(someFindings());
    EXPECT_EQ(document_.getCurrentRequestedProcedureEvidence().getNumberOfInstances(), 1u);
    expectSound();
}

TEST_F(ColonCadReport, IsTheSameBytesForTheSameFindings) {
    written(someFindings());
    const std::string first = tests::fileContent(file());
    const std::string uid = attribute(DCM_SOPInstanceUID),
                      series = attribute(DCM_SeriesInstanceUID);
    written(someFindings());
    EXPECT_EQ(tests::fileContent(file()), first);
    Findings other = someFindings();
    other.findings[0].score = 0.5;
    written(other);
    EXPECT_NE(attribute(DCM_SOPInstanceUID), uid);
    EXPECT_EQ(attribute(DCM_SeriesInstanceUID), series);
    EXPECT_NE(series, source_.seriesUid);
    EXPECT_EQ(attribute(DCM_StudyInstanceUID), source_.studyUid);
}

TEST_F(ColonCadReport, IsWhoseItIsWhereTheSeriesIsAtHand) {
    written(someFindings());
    EXPECT_EQ(attribute(DCM_PatientName), "");
    EXPECT_EQ(attribute(DCM_PatientID), "");
    EXPECT_EQ(attribute(DCM_StudyDate), "20240229");
    const std::string nameless = attribute(DCM_SOPInstanceUID);
    for (const fs::path& path : tests::filesIn(folder())) {
        tests::set(path, DCM_SpecificCharacterSet, "ISO_IR 100");
        tests::set(path, DCM_PatientName, "M\xfcller^J\xf6rg");
    }
    const auto items = written(someFindings(), {.series = folder()});
    EXPECT_EQ(attribute(DCM_PatientName), "Müller^Jörg");
    EXPECT_EQ(attribute(DCM_SpecificCharacterSet), "ISO_IR 192");
    EXPECT_EQ(attribute(DCM_PatientID), "ID-7");
    EXPECT_EQ(attribute(DCM_PatientSex), "F");
    EXPECT_EQ(attribute(DCM_AccessionNumber), "A1");
    EXPECT_NE(attribute(DCM_SOPInstanceUID), nameless);
    EXPECT_EQ(countOf(items, "Composite Feature"), 4);
    expectSound();
}

// Yamada Tarou in kanji, as DICOM PS3.5 H.3.1 has it.
TEST_F(ColonCadReport, KeepsANameWhoseCharactersCannotBeConverted) {
    const std::string kanji = "Yamada^Tarou=\x1b$B;3ED\x1b(B^\x1b$BB@O:\x1b(B";
    for (const fs::path& path : tests::filesIn(folder())) {
        tests::set(path, DCM_SpecificCharacterSet, "\\ISO 2022 IR 87");
        tests::set(path, DCM_PatientName, kanji);
    }
    const auto items = written(someFindings(), {.series = folder()});
    if (attribute(DCM_SpecificCharacterSet) != "ISO_IR 192") {  // a DCMTK that knows it converts it
        EXPECT_EQ(attribute(DCM_SpecificCharacterSet), "\\ISO 2022 IR 87");
        EXPECT_EQ(attribute(DCM_PatientName), kanji);
        fs::remove(file());
        Findings warned = someFindings();
        warned.warnings = {"Größe"};
        expectRefused(warned, source_, "ISO 2022 IR 87", {.series = folder()});
    }
    EXPECT_EQ(countOf(items, "Composite Feature"), 4);
}

TEST_F(ColonCadReport, TextOfNoNamedCharacterSetIsRefused) {
    for (const fs::path& path : tests::filesIn(folder()))
        tests::set(path, DCM_PatientName, "M\xfcller");
    expectRefused(someFindings(), source_, "SpecificCharacterSet", {.series = folder()});
}

TEST_F(ColonCadReport, ImagesOfTwoPatientsAreRefused) {
    tests::set(folder() / "0024.dcm", DCM_PatientID, "ID-8");
    expectRefused(someFindings(), source_, "differ in PatientID", {.series = folder()});
}

TEST_F(ColonCadReport, ALeapSecondIsTheOneBefore) {
    source_.studyTime = "235960.5";
    const auto items = written(someFindings());
    EXPECT_EQ(attribute(DCM_StudyTime), "235959.5");
    EXPECT_EQ(attribute(DCM_ContentTime), "235959.5");
    EXPECT_EQ(named(items, "Study Time")->value, "235959.5");
}

TEST_F(ColonCadReport, AnotherSeriesThanTheCasesIsRefused) {
    const fs::path other = temporary_.path() / "other";
    tests::write(other, tests::patternScan(tests::smallGrid()), "other");
    expectRefused(someFindings(), source_, "no CT series", {.series = other});
    fs::remove(folder() / "0024.dcm");
    expectRefused(someFindings(), source_, "not the very images", {.series = folder()});
    expectRefused(someFindings(), source_, "no such file", {.series = folder() / "nothing"});
}

TEST_F(ColonCadReport, WhatCannotBeReferredToIsRefused) {
    expectRefused(someFindings(), {}, "needs the DICOM series");
    SourceSeries source = source_;
    source.frameOfReferenceUid.clear();
    expectRefused(someFindings(), source, "frame of reference");
    source = source_;
    source.studyUid.clear();
    expectRefused(someFindings(), source, "study");
    source = source_;
    source.images[3].sopInstanceUid.clear();
    expectRefused(someFindings(), source, "UID");
    Findings unsigned_ = someFindings();
    unsigned_.model = {};
    expectRefused(unsigned_, source_, "program");
    const auto nowhere =
        dicom::writeColonCadReport(temporary_.path() / "no/report.dcm", someFindings(), source_);
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().kind, ErrorKind::io);
}

// ------------------------------------------------------------------------------- the outline

TEST(VoxelEllipsoid, OfABallIsTheBall) {
    const Grid grid = axisAlignedGrid({40, 40, 40}, {0.5, 0.5, 0.5}, {0, 0, 0});
    const Ellipsoid e = ellipsoidOf(ball(grid, {10, 9, 8}, 6.0), grid);
    EXPECT_LT(glm::distance(e.centerMm, glm::dvec3(10, 9, 8)), 1e-9);
    for (const glm::dvec3& axis : e.halfAxesMm)
        EXPECT_NEAR(glm::length(axis), 6.0, 0.1);
}

TEST(VoxelEllipsoid, FollowsTheGridAndItsBoxes) {
    Grid grid = axisAlignedGrid({8, 8, 8}, {1.0, 2.0, 3.0}, {5, 6, 7});
    grid = tests::rotated(grid, tests::rotation(0.4, -0.3));
    const VoxelRun run{{1, 2, 3}, 4};
    const Ellipsoid e = ellipsoidOf(std::span(&run, 1), grid);
    EXPECT_LT(glm::distance(e.centerMm, grid.patientFromVoxelPoint({2.5, 2, 3})), 1e-9);
    const std::array<double, 3> sides{4.0, 3.0, 2.0};
    const std::array<int, 3> gridAxis{0, 2, 1};
    for (std::size_t n = 0; n < 3; ++n) {
        EXPECT_NEAR(glm::length(e.halfAxesMm[n]), std::sqrt(5.0 / 12.0) * sides[n], 1e-9);
        const glm::dvec3 along = glm::normalize(glm::dvec3(grid.patientFromVoxel[gridAxis[n]]));
        EXPECT_NEAR(std::abs(glm::dot(glm::normalize(e.halfAxesMm[n]), along)), 1.0, 1e-9);
    }
}

}  // namespace
