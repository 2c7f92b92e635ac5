// Laws of the lumen's labels, held on phantoms.
#include "cleansing/tissue_mixture.h"
#include "core/connected_labels.h"
#include "phantom/phantom.h"
#include "segmentation/find_colon.h"
#include "segmentation/hu_range_lumen.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

class LumenLaw
    : public testing::TestWithParam<std::tuple<phantom::Preset, PatientPosition, std::uint64_t>> {
protected:
    void SetUp() override {
        phantom::PhantomOptions options;
        options.size = phantom::Size::small;
        std::tie(options.preset, options.position, options.seed) = GetParam();
        auto made = phantom::makePhantom(options);
        ASSERT_TRUE(made);
        scan_ = std::move(made->scan);
        collapses_ = made->structure.collapses;
        auto tissue = cleansing::fitTissueModel(scan_);
        ASSERT_TRUE(tissue);
        tissue_ = *tissue;
        auto lumen = segmentation::findColon(scan_, tissue_);
        ASSERT_TRUE(lumen) << describe(lumen.error());
        lumen_ = std::move(*lumen);
    }
    LumenLabel label(glm::ivec3 v) const { return LumenLabel(lumen_.labels.at(v)); }
    bool airWithin(glm::ivec3 v, int reach) const {
        for (int face = 0; face < 6; ++face) {
            glm::ivec3 w = v;
            for (int step = 0; step < reach; ++step) {
                w[face / 2] += face % 2 ? 1 : -1;
                if (!scan_.hu.grid().contains(w)) break;
                if (label(w) == LumenLabel::air) return true;
            }
        }
        return false;
    }

    void eachVoxelHoldsAirOrTaggedMaterialOrTheirPartialVolume() const;
    void isOnePieceBridgedAtTrueCollapsesOnly() const;
    void recordHoldsWhatTheLabelsHold() const;

    CtScan scan_;
    std::vector<phantom::Structure::Collapse> collapses_;
    TissueModel tissue_;
    segmentation::FoundColon lumen_;
};

void LumenLaw::eachVoxelHoldsAirOrTaggedMaterialOrTheirPartialVolume() const {
    const Grid& grid = scan_.hu.grid();
    const double edgeHu = 0.5 * (tissue_.meanHu[int(Tissue::soft)] + tissue_.taggedAboveHu);
    // Noise may darken a voxel of fluid, but not what lies around it too.
    const Volume<std::int16_t> smooth = segmentation::smoothHu(scan_.hu, 0.8);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const auto here = LumenLabel(lumen_.labels[n]);
        if (here == LumenLabel::air) {
            ASSERT_LT(scan_.hu[n], tissue_.airBelowHu);
        } else if (here == LumenLabel::tagged && !(scan_.hu[n] > edgeHu) && !(smooth[n] > edgeHu)) {
            ASSERT_TRUE(airWithin(grid.voxelAt(n), 4)) << "HU " << scan_.hu[n];
        }
    }
}

void LumenLaw::isOnePieceBridgedAtTrueCollapsesOnly() const {
    Volume<std::uint8_t> labels = lumen_.labels.clone();
    EXPECT_EQ(
        joinBodies(
            labels, [](std::size_t) { return false; }, [](std::size_t) { return std::uint8_t(0); }),
        0.0);
    constexpr double endsMm = 10.0;
    const Grid& grid = labels.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (LumenLabel(labels[n]) != LumenLabel::bridge) continue;
        const glm::dvec3 at = grid.patientFromVoxelPoint(grid.voxelAt(n));
        ASSERT_TRUE(std::any_of(collapses_.begin(), collapses_.end(), [&](const auto& collapse) {
            const glm::dvec3 middle = 0.5 * (collapse.beginAtMm + collapse.endAtMm);
            return glm::distance(at, middle) < 0.5 * collapse.lengthMm() + endsMm;
        }));
    }
}

void LumenLaw::recordHoldsWhatTheLabelsHold() const {
    std::size_t air = 0;
    for (std::uint8_t label : lumen_.labels.voxels())
        air += LumenLabel(label) == LumenLabel::air;
    double piecesMl = 0.0;
    for (const ColonPiece& piece : lumen_.record.pieces)
        piecesMl += piece.gasMl;
    const double airMl = double(air) * scan_.hu.grid().voxelVolumeMm3() / 1000.0;
    EXPECT_NEAR(piecesMl, airMl, 0.05 * airMl);  // sacs and crumbs are no pieces of the chain
    EXPECT_EQ(lumen_.gravity, gravityDirection(std::get<1>(GetParam())));
    for (const std::string& note : lumen_.notes)
        EXPECT_EQ(note.find("lay"), std::string::npos) << "the levels agree with the position";
}

// One test, as the phantom takes far longer than its laws.
TEST_P(LumenLaw, HoldsOnAPhantom) {
    eachVoxelHoldsAirOrTaggedMaterialOrTheirPartialVolume();
    isOnePieceBridgedAtTrueCollapsesOnly();
    recordHoldsWhatTheLabelsHold();
}

INSTANTIATE_TEST_SUITE_P(
    Phantoms, LumenLaw,
    testing::Values(std::tuple(phantom::Preset::easy, PatientPosition::prone, 2),
                    std::tuple(phantom::Preset::hard, PatientPosition::prone, 4)));

}  // namespace
