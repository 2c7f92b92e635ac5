// The real colonography, up to the centerline: what is right on it stays right.
#include "core/colon_record.h"
#include "data_folder.h"
#include "end_to_end/run_program.h"
#include "pipeline/prepare.h"
#include "store/case_store.h"
#include "topology/digital_topology.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

TEST(RealScan, TheWholeColonIsFoundAndNothingElse) {
    HAUSTRA_REAL_DATA(folder, "ctc430");
    const tests::TemporaryFolder scratch;
    const auto store = store::CaseStore::open(scratch.path() / "store", true);
    ASSERT_TRUE(store);
    pipeline::PrepareOptions options;
    options.series = folder;
    options.until = "centerline";
    const auto report = pipeline::prepare(*store, "real", options);
    ASSERT_TRUE(report) << describe(report.error());
    for (const std::string& note : report->notes)
        EXPECT_EQ(note.find("have no centerline"), std::string::npos) << note;

    const auto opened = store->openCase("real").value();
    const auto quality = opened.readText("quality");
    ASSERT_TRUE(quality);
    const auto pieces = piecesOfQuality(*quality).value();
    EXPECT_EQ(pieces.front().part, ColonPart::rectum);
    EXPECT_EQ(pieces.back().part, ColonPart::cecum);
    const ColonTrust trust = trustOfQuality(*quality).value();
    EXPECT_GT(trust.confidence, 0.85) << "one thin place in the sigmoid is doubted";
    for (const SegmentDistension& segment : trust.segments) {
        EXPECT_GT(segment.lengthMm, 40.0);
        EXPECT_GT(segment.diameterMm, 16.0) << "it is well distended";
        EXPECT_EQ(segment.collapsedMm, 0.0);
    }

    // Two other programs' figures for its gas and fluid: 2.8 and 0.33 l (the levels and what blurs
    // into the wall come on top).
    const auto labels = opened.readVolume<std::uint8_t>("segmentation").value();
    std::size_t count[4] = {};
    for (const std::uint8_t label : labels.voxels())
        ++count[std::min<std::uint8_t>(label, 3)];
    const double litre = 1e6 / labels.grid().voxelVolumeMm3();
    EXPECT_NEAR(double(count[1]) / litre, 3.0, 0.25);
    EXPECT_NEAR(double(count[2]) / litre, 0.5, 0.2);
    EXPECT_EQ(count[3], 0u) << "no part of it is collapsed";
    // Opacified ileum beside the cecum, and a loop over the sigmoid: looked at, and not colon.
    for (const glm::dvec3 p : {glm::dvec3(-73, -108, 176), glm::dvec3(25, -71, 160)}) {
        const glm::ivec3 v(glm::round(labels.grid().voxelFromPatientPoint(p)));
        EXPECT_EQ(labels.at(v), 0) << p.x;
    }

    const auto lumen = opened.readVolume<std::uint8_t>("lumen").value();
    EXPECT_TRUE(topology::isBallEitherWay(lumen));
    const Centerline path = opened.readCenterline().value();
    EXPECT_NEAR(path.lengthMm(), 2092.0, 60.0);
    EXPECT_TRUE(std::none_of(path.points.begin(), path.points.end(),
                             [](const CenterlinePoint& p) { return p.gap; }));
    EXPECT_LT(path.points.front().positionMm.z, path.points.back().positionMm.z)
        << "from the rectum to the cecum";
}

}  // namespace
