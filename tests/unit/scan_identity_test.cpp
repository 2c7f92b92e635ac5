// Whose case it is: a case is of one scan, and is never another's by its name.
#include "pipeline/scan_identity.h"

#include "core/case_name.h"
#include "core/source_series.h"
#include "dicom/write_series.h"
#include "pipeline/source_key.h"
#include "prepared_tube.h"

namespace haustra::pipeline {
namespace {

class WhoseCase : public Prepare {
protected:
    // A series of few slices of one value.
    fs::path series(const std::string& folder, const std::string& study, const std::string& name,
                    std::int16_t hu = 0) const {
        const CtScan scan{Volume<std::int16_t>(axisAlignedGrid({8, 8, 20}, {1, 1, 1}), hu),
                          PatientPosition::supine};
        dicom::WriteOptions writing;
        writing.patientName = "SECRET^NAME";
        writing.uidSeed = study + name;
        writing.studySeed = study;
        EXPECT_TRUE(dicom::writeSeries(folder_ / folder, scan, writing));
        return folder_ / folder;
    }
    Result<PrepareReport> import(const std::string& name, const fs::path& from,
                                 bool replace = false, const std::string& scan = {}) const {
        PrepareOptions only;
        only.series = from;
        only.until = "import";
        only.replace = replace;
        only.scan = scan;
        return prepare(store(), name, only);
    }
    std::optional<store::ScanIdentity> scanOf(const std::string& name) const {
        return store().openCase(name)->scan().value();
    }
    void expectRefused(const Result<PrepareReport>& report, const std::string& words) const {
        ASSERT_FALSE(report);
        EXPECT_EQ(report.error().kind, ErrorKind::badInput);
        EXPECT_NE(describe(report.error()).find(words), std::string::npos)
            << describe(report.error());
    }
    store::ScanIdentity identityOf(const fs::path& from) const {
        return identifyScan(from, {}, sourceKey(from, 1).value(), 1).value();
    }
};

TEST_F(WhoseCase, AnotherStudyUnderTheNameIsRefusedAndTheCaseIsAsItWas) {
    ASSERT_TRUE(import("p", series("a/DICOM", "A", "1")));
    const auto before = bytesOf(*store().openCase("p"));
    const auto index = content(store().openCase("p")->folder() / "case.json");
    expectRefused(import("p", series("b/DICOM", "B", "1")), "another scan");
    EXPECT_EQ(bytesOf(*store().openCase("p")), before);
    EXPECT_EQ(content(store().openCase("p")->folder() / "case.json"), index);
}

TEST_F(WhoseCase, ANewSeriesOfTheStudyIsAScanOfItsOwn) {
    ASSERT_TRUE(import("p", series("a", "A", "supine")));
    const fs::path prone = series("b", "A", "prone");
    expectRefused(import("p", prone), "--scan prone");
    const auto report = import("p", prone, false, "prone");
    ASSERT_TRUE(report) << describe(report.error());
    EXPECT_EQ(report->caseName, "p.prone");
    EXPECT_EQ(store().cases().value(), (std::vector<std::string>{"p", "p.prone"}));
    EXPECT_EQ(scanOf("p")->studyUid, scanOf("p.prone")->studyUid);
    EXPECT_NE(scanOf("p")->key, scanOf("p.prone")->key);
    expectRefused(import("p", series("c", "C", "prone"), false, "late"), "another study");
    expectRefused(import("p", series("c", "C", "prone"), true, "prone"), "another study");
    EXPECT_EQ(store().cases()->size(), 2u);
}

TEST_F(WhoseCase, ASeriesSentAgainIsTheSameScan) {
    ASSERT_TRUE(import("p", series("a", "A", "1")));
    const auto bound = scanOf("p");
    overwrite(folder_ / "again/README", "what a disc holds beside it");
    const auto again = import("p", series("again", "A", "1", 100));
    ASSERT_TRUE(again) << describe(again.error());
    EXPECT_EQ(scanOf("p"), bound);
    EXPECT_EQ(store().openCase("p")->readVolume<std::int16_t>("ct")->voxels()[0], 100);
}

TEST_F(WhoseCase, AReplacedScanTakesAllWithItAndComesBackAsItself) {
    const fs::path a = series("a", "A", "1"), b = series("b", "B", "1");
    ASSERT_TRUE(import("p", a));
    const auto bound = scanOf("p");
    {
        auto held = store().createCase("p").value();
        ASSERT_TRUE(held.publishVolume("of-another-time", store::makeKey("x", 1, "", {}),
                                       Volume<float>(axisAlignedGrid({2, 2, 2}, {1, 1, 1}))));
    }
    ASSERT_TRUE(import("p", b, true));
    EXPECT_EQ(store().openCase("p")->products()->size(), 2u);
    EXPECT_NE(scanOf("p")->key, bound->key);
    expectRefused(import("p", a), "another scan");
    ASSERT_TRUE(import("p", a, true));
    EXPECT_EQ(scanOf("p"), bound);
}

// Of a store of before cases kept their source.
TEST_F(WhoseCase, AnOlderCaseGetsItsSourceAndKeepsAllElse) {
    const fs::path a = series("a", "A", "1");
    ASSERT_TRUE(import("new", a));
    const auto made = store().openCase("new").value();
    const auto ct = made.readVolume<std::int16_t>("ct").value();
    {
        auto old = store().createCase("old").value();
        ASSERT_TRUE(old.bind(*scanOf("new")));
        ASSERT_TRUE(old.publishVolume("ct", made.find("ct")->key, ct, *made.attributes("ct")));
        ASSERT_TRUE(old.publishVolume("segmentation", store::makeKey("x", 1, "", {}),
                                      Volume<std::uint8_t>(ct.grid())));
    }
    ASSERT_TRUE(import("old", a));
    const auto old = store().openCase("old").value();
    EXPECT_EQ(old.readText("source").value(), made.readText("source").value());
    EXPECT_TRUE(old.find("segmentation"));
    EXPECT_EQ(sourceSeriesOfJson(*old.readText("source"))->seriesUid, scanOf("old")->seriesUid);
}

TEST_F(WhoseCase, WhatFailsBeforeItsFirstProductReplacesNothing) {
    ASSERT_TRUE(import("p", series("a", "A", "1")));
    const auto before = bytesOf(*store().openCase("p"));
    const fs::path cut = series("b", "B", "1");
    const std::string slice = content(cut / "0007.dcm");
    overwrite(cut / "0007.dcm", slice.substr(0, slice.size() - 40));
    ASSERT_FALSE(import("p", cut, true));
    EXPECT_EQ(bytesOf(*store().openCase("p")), before);
    EXPECT_EQ(scanOf("p"), identityOf(folder_ / "a"));
}

TEST_F(WhoseCase, NiftiFilesAndMasksAreToldApartByTheirContent) {
    reused(options());
    fs::rename(ctFile(), folder_ / "moved.nii.gz");
    PrepareOptions moved = options();
    moved.series = folder_ / "moved.nii.gz";
    EXPECT_EQ(reused(moved), all(true));
    writeScan(5.0);
    expectRefused(prepare(store(), "tube", options()), "another scan");

    PrepareOptions alone = options();
    alone.series.clear();
    alone.until = "segmentation";
    ASSERT_TRUE(prepare(store(), "mask", alone));
    ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(4.0)));
    expectRefused(prepare(store(), "mask", alone), "another scan");
    alone.replace = true;
    EXPECT_TRUE(prepare(store(), "mask", alone));
}

// A case of before cases were bound becomes its scan's by that scan alone.
TEST_F(WhoseCase, AnUnboundCaseIsAdoptedByItsOwnScanOnly) {
    const fs::path a = series("a", "A", "1");
    ASSERT_TRUE(import("p", a));
    const fs::path index = store().openCase("p")->folder() / "case.json";
    const auto ct = store().openCase("p")->find("ct").value();
    overwrite(index, R"({"format":1,"products":{"ct":{"file":")" + ct.file + R"(","key":")" +
                         ct.key.hex + R"("}}})");
    ASSERT_EQ(scanOf("p")->key, ct.key);
    expectRefused(import("p", series("b", "B", "1")), "another scan");
    const auto report = import("p", a);
    ASSERT_TRUE(report) << describe(report.error());
    EXPECT_FALSE(report->stages.at(0).reused) << "its source is to be read yet";
    EXPECT_TRUE(store().openCase("p")->has("ct", ct.key));
    EXPECT_TRUE(store().openCase("p")->has("source", ct.key));
    EXPECT_EQ(scanOf("p")->key, ct.key) << "readers' records are under it";
    EXPECT_EQ(scanOf("p")->seriesUid, identityOf(a).seriesUid);
    EXPECT_TRUE(import("p", series("again", "A", "1", 5)));
}

TEST_F(WhoseCase, ADefaultNameIsTheScansAndNoFoldersOrPatients) {
    const auto a = identityOf(series("a/SECRET", "A", "1"));
    const auto again = identityOf(series("b/DICOM", "A", "1"));
    const auto prone = identityOf(series("c/DICOM", "A", "2"));
    const auto other = identityOf(series("d/DICOM", "D", "1"));
    EXPECT_EQ(defaultCaseName(a), defaultCaseName(again));
    EXPECT_NE(defaultCaseName(a), defaultCaseName(prone));
    EXPECT_NE(defaultCaseName(a), defaultCaseName(other));
    for (const auto& scan : {a, prone, other, identityOf(ctFile())}) {
        const std::string name = defaultCaseName(scan);
        EXPECT_TRUE(isCaseName(name)) << name;
        EXPECT_EQ(name.find("SECRET"), std::string::npos);
        EXPECT_EQ(name.find("DICOM"), std::string::npos);
    }
    EXPECT_TRUE(defaultCaseName(prone).starts_with(studyCode(a.studyUid) + "."));
    EXPECT_FALSE(defaultCaseName(other).starts_with(studyCode(a.studyUid)));
}

}  // namespace
}  // namespace haustra::pipeline
