// Laws of the lumen's labels, held on phantoms.
#include "cleansing/tissue_mixture.h"
#include "phantom/phantom.h"
#include "topology/lumen.h"

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
        auto tissue = cleansing::fitTissueModel(scan_);
        ASSERT_TRUE(tissue);
        tissue_ = *tissue;
        auto lumen = topology::findLumen(scan_, tissue_);
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
    void taggedMaterialIsUnderOrBesideAir() const;
    void segmentsHoldWhatTheLabelsHold() const;

    CtScan scan_;
    TissueModel tissue_;
    topology::Lumen lumen_;
};

void LumenLaw::eachVoxelHoldsAirOrTaggedMaterialOrTheirPartialVolume() const {
    const Grid& grid = scan_.hu.grid();
    const double edgeHu = 0.5 * (tissue_.meanHu[int(Tissue::soft)] + tissue_.taggedAboveHu);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const auto here = LumenLabel(lumen_.labels[n]);
        if (here == LumenLabel::air) {
            ASSERT_LT(scan_.hu[n], tissue_.airBelowHu);
        } else if (here == LumenLabel::tagged && !(scan_.hu[n] > edgeHu)) {
            ASSERT_TRUE(airWithin(grid.voxelAt(n), 4)) << "HU " << scan_.hu[n];
        }
    }
}

void LumenLaw::taggedMaterialIsUnderOrBesideAir() const {
    const Grid& grid = scan_.hu.grid();
    std::vector<bool> seen(grid.voxelCount(), false);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (seen[n] || LumenLabel(lumen_.labels[n]) != LumenLabel::tagged) continue;
        std::vector<std::size_t> body{n};
        seen[n] = true;
        bool besideAir = false;
        for (std::size_t head = 0; head < body.size(); ++head) {
            const glm::ivec3 v = grid.voxelAt(body[head]);
            for (int step = 0; step < 27; ++step) {
                const glm::ivec3 w = v + glm::ivec3(step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
                if (!grid.contains(w)) continue;
                besideAir |= label(w) == LumenLabel::air;
                if (label(w) != LumenLabel::tagged || seen[grid.index(w)]) continue;
                seen[grid.index(w)] = true;
                body.push_back(grid.index(w));
            }
        }
        const double ml = double(body.size()) * grid.voxelVolumeMm3() / 1000.0;
        EXPECT_TRUE(besideAir || ml < 1.0) << ml << " ml of tagged material by itself";
    }
}

void LumenLaw::segmentsHoldWhatTheLabelsHold() const {
    std::size_t air = 0;
    for (std::uint8_t label : lumen_.labels.voxels())
        air += LumenLabel(label) == LumenLabel::air;
    double segmentsMl = 0.0;
    for (std::size_t n = 0; n < lumen_.segments.size(); ++n) {
        segmentsMl += lumen_.segments[n].airMl;
        if (n > 0) {
            EXPECT_GE(lumen_.segments[n - 1].airMl + lumen_.segments[n - 1].taggedMl,
                      lumen_.segments[n].airMl + lumen_.segments[n].taggedMl);
        }
    }
    EXPECT_NEAR(segmentsMl, double(air) * scan_.hu.grid().voxelVolumeMm3() / 1000.0, 0.1);
    EXPECT_EQ(lumen_.gravity, gravityDirection(std::get<1>(GetParam())));
    for (const std::string& note : lumen_.notes)
        EXPECT_EQ(note.find("lie"), std::string::npos) << "the levels agree with the position";
}

// One test, as the phantom takes far longer than its laws.
TEST_P(LumenLaw, HoldsOnAPhantom) {
    eachVoxelHoldsAirOrTaggedMaterialOrTheirPartialVolume();
    taggedMaterialIsUnderOrBesideAir();
    segmentsHoldWhatTheLabelsHold();
}

INSTANTIATE_TEST_SUITE_P(
    Phantoms, LumenLaw,
    testing::Values(std::tuple(phantom::Preset::easy, PatientPosition::prone, 2),
                    std::tuple(phantom::Preset::hard, PatientPosition::prone, 4)));

}  // namespace
