// Findings as JSON.
#include "core/findings.h"

#include <gtest/gtest.h>

using namespace haustra;

namespace {

Findings twoFindings() {
    Findings all;
    all.model = {"haustra 1.2.3", "phantoms-1", std::string(64, 'a'), "phantoms; not patients"};
    all.operatingPoint = 0.25;
    all.warnings = {"the sigmoid is collapsed"};
    all.unexaminedMm2 = 1234.5;
    all.grid = axisAlignedGrid({64, 48, 32}, {0.75, 0.75, 1.0}, {-20.0, 11.5, -300.25});
    Finding finding{{1.25, -3.5, 10.0}, 8.125, 0.75, "sessile"};
    finding.wallMm = {1.0, -3.0, 9.0};
    finding.diameterEndsMm = {{0.0, 1.0, 2.0}, {3.0, 4.0, 5.0}};
    finding.heightMm = 4.5, finding.arcMm = 312.0;
    finding.segment = ColonSegment::sigmoid;
    finding.features = {{"shape_index", 0.9}, {"curvedness", 0.25}};
    finding.voxels = {{{1, 2, 3}, 4}, {{60, 47, 31}, 4}};
    all.findings = {finding};
    all.biopsy = {
        41.5, -97.25, 12.125, {{{-249.5, {0.1, 0.2, 0.95}, 0.0}, {219.5, {1, 0, 0}, 0.3}}}};
    finding.score = 0.125, finding.segment = {};
    all.candidates = {finding};
    return all;
}

TEST(Findings, JsonReadsBackAsItWas) {
    const Findings all = twoFindings();
    const auto read = findingsOfJson(findingsJson(all));
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(findingsJson(*read), findingsJson(all));
    const Finding &was = all.findings[0], &is = read->findings.at(0);
    EXPECT_EQ(is.positionMm, was.positionMm);
    EXPECT_EQ(is.diameterEndsMm, was.diameterEndsMm);
    EXPECT_EQ(is.segment, was.segment);
    EXPECT_EQ(is.voxels, was.voxels);
    EXPECT_EQ(is.features, was.features);
    EXPECT_EQ(read->candidates.at(0).segment, std::nullopt);
    EXPECT_TRUE(sameGrid(read->grid, all.grid));
    EXPECT_EQ(read->model.sha256, all.model.sha256);
    EXPECT_EQ(read->warnings, all.warnings);
    EXPECT_EQ(read->unexaminedMm2, all.unexaminedMm2);
    EXPECT_EQ(read->biopsy, all.biopsy);
}

TEST(Findings, ATruthNeedsNoMoreThanPlaceAndSize) {
    const auto read = findingsOfJson(R"({"findings":[{"position_mm":[1,2,3],"diameter_mm":6.5}]})");
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(read->findings.at(0).score, 1.0);
    EXPECT_FALSE(read->biopsy);
    EXPECT_EQ(read->findings.at(0).positionMm, glm::dvec3(1.0, 2.0, 3.0));
}

TEST(Findings, WhatIsNoneIsRefused) {
    const std::string sound = findingsJson(twoFindings());
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = sound;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    ASSERT_TRUE(findingsOfJson(sound));
    for (const std::string& text :
         {std::string(), std::string("[]"), std::string("{}"), sound.substr(0, sound.size() / 2),
          with("\"score\":0.75", "\"score\":7.5"), with("8.125", "-8.125"), with("8.125", "1e300"),
          with("\"sigmoid\"", "\"elbow\""), with("[60,", "[61,"), with("[64", "[-64"),
          with("\"noise_hu\":12", "\"noise_hu\":-12"), with("\"hu\":219.5", "\"hu\":-300"),
          with("[0.1,0.2,0.95]", "[0.1,0.2]"), with("[0.1,0.2,0.95]", "[0.1,0.2,9.5]"),
          with("\"opacity\":0.3", "\"opacity\":3")}) {
        const auto read = findingsOfJson(text, "case/findings");
        ASSERT_FALSE(read) << text;
        EXPECT_EQ(read.error().kind, ErrorKind::badInput);
        EXPECT_EQ(read.error().place, "case/findings");
    }
}

}  // namespace
