// Laws that every phantom obeys, on small ones of all presets and both positions.
#include "label_topology.h"
#include "phantom/phantom.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::phantom;

namespace {

struct Case {
    std::uint64_t seed;
    Preset preset;
    PatientPosition position;
};

void PrintTo(const Case& c, std::ostream* out) {
    *out << "seed " << c.seed;
}

/// Voxels within `reach` voxels (a box) of one with the label.
std::vector<std::uint8_t> grown(const Volume<std::uint8_t>& labels, std::uint8_t label, int reach) {
    const Grid& grid = labels.grid();
    std::vector<std::uint8_t> now(grid.voxelCount());
    for (std::size_t n = 0; n < now.size(); ++n)
        now[n] = labels[n] == label;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<std::uint8_t> old = now;
        for (std::size_t n = 0; n < now.size(); ++n) {
            if (!old[n]) continue;
            glm::ivec3 v = grid.voxelAt(n);
            const int middle = v[axis];
            for (int d = -reach; d <= reach; ++d) {
                v[axis] = middle + d;
                if (grid.contains(v)) now[grid.index(v)] = 1;
            }
        }
    }
    return now;
}

struct Statistics {
    double mean = 0, sd = 0;
    std::size_t count = 0;
};
template <class Take>
Statistics statistics(const Volume<std::int16_t>& hu, const Take& take) {
    double sum = 0, squares = 0;
    Statistics s;
    for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n) {
        if (take(n)) sum += hu[n], squares += double(hu[n]) * hu[n], ++s.count;
    }
    s.mean = sum / double(s.count), s.sd = std::sqrt(squares / double(s.count) - s.mean * s.mean);
    return s;
}

class PhantomLaws : public testing::TestWithParam<Case> {
protected:
    void SetUp() override {
        PhantomOptions options;
        options.seed = GetParam().seed, options.preset = GetParam().preset;
        options.position = GetParam().position, options.size = Size::small;
        auto phantom = makePhantom(options);
        ASSERT_TRUE(phantom.has_value());
        phantom_ = std::move(*phantom);
        grid_ = phantom_.scan.hu.grid();
    }
    void everythingIsOnOneGridAndThePositionIsRecorded();
    void centerlineIsOneThatALumenCouldHave();
    void lumenIsOnePieceOrTwoWhereCollapsed();
    void fluidLiesBelowAirWithALevelSurface();
    void polypsAreTissueOnTheWall();
    void polypVoxelsAreItsTissue();
    void fluidCoversSomePolyps();
    void untaggedScanDiffersOnlyAtTheTagging();
    void huAreThoseOfAirWallAndTagging();

    Phantom phantom_;
    Grid grid_;
    std::uint8_t labelAt(glm::dvec3 p) const {
        const glm::ivec3 v(glm::round(grid_.voxelFromPatientPoint(p)));
        return grid_.contains(v) ? phantom_.lumen.at(v) : 0;
    }
};

void PhantomLaws::everythingIsOnOneGridAndThePositionIsRecorded() {
    EXPECT_TRUE(sameGrid(grid_, phantom_.untaggedHu.grid()));
    EXPECT_TRUE(sameGrid(grid_, phantom_.lumen.grid()));
    EXPECT_EQ(phantom_.scan.position, GetParam().position);
}

void PhantomLaws::centerlineIsOneThatALumenCouldHave() {
    const auto& points = phantom_.centerline.points;
    EXPECT_GE(phantom_.centerline.lengthMm(), 1200.0);
    EXPECT_LE(phantom_.centerline.lengthMm(), 1700.0);
    std::size_t gaps = 0, runs = 0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        gaps += points[n].gap;
        runs += points[n].gap && (n == 0 || !points[n - 1].gap);
        if (points[n].gap) {
            EXPECT_EQ(points[n].radiusMm, 0.0);
        } else {
            EXPECT_NE(labelAt(points[n].positionMm), 0) << "at " << points[n].arcMm << " mm";
            EXPECT_GT(points[n].radiusMm, 0.0);
        }
        if (n > 0) {
            EXPECT_NEAR(points[n].arcMm - points[n - 1].arcMm, 1.0, 0.02);
        }
    }
    if (GetParam().preset == Preset::hard) {
        EXPECT_EQ(runs, 1u);
        EXPECT_GT(gaps, 15u);
        EXPECT_LT(gaps, 80u);
    } else {
        EXPECT_EQ(gaps, 0u);
    }
}

void PhantomLaws::lumenIsOnePieceOrTwoWhereCollapsed() {
    const auto sizes = tests::pieceSizes(phantom_.lumen.grid(),
                                         [&](std::size_t n) { return phantom_.lumen[n] != 0; });
    const std::size_t pieces = GetParam().preset == Preset::hard ? 2 : 1;
    ASSERT_GE(sizes.size(), pieces);
    // Behind a fold or a ball of stool a few voxels may be shut off.
    EXPECT_LT(std::accumulate(sizes.begin() + std::ptrdiff_t(pieces), sizes.end(), std::size_t(0)),
              30u);
    EXPECT_GT(sizes[pieces - 1], 2000u);
}

void PhantomLaws::fluidLiesBelowAirWithALevelSurface() {
    // Along each line of voxels that runs down, within one stretch of lumen, all tagged voxels are
    // below all air; stool that hangs on the wall is the exception. Neighbouring lines' surfaces
    // are at one height.
    const int down = GetParam().position == PatientPosition::supine ? 1 : -1;
    const int none = -1;
    std::size_t runs = 0, upsideDown = 0, pairs = 0, level = 0, tagged = 0;
    for (int k = 0; k < grid_.size.z; ++k) {
        std::vector<int> before;
        for (int i = 0; i < grid_.size.x; ++i) {
            std::vector<int> surfaces;
            int previous = 0;
            bool sawTagged = false, wrong = false;
            for (int step = 0; step < grid_.size.y; ++step) {
                const int j = down > 0 ? step : grid_.size.y - 1 - step;
                const int label = phantom_.lumen.at(i, j, k);
                if (label == 2) ++tagged;
                if (previous == 1 && label == 2) surfaces.push_back(j);
                if (previous == 2 && label == 1) wrong = true;
                sawTagged = sawTagged || label == 2;
                if (label == 0 && previous != 0) {
                    runs += sawTagged, upsideDown += wrong;
                    sawTagged = wrong = false;
                }
                previous = label;
            }
            for (int s : surfaces) {
                int nearest = none;
                for (int b : before) {
                    if (nearest == none || std::abs(b - s) < std::abs(nearest - s)) nearest = b;
                }
                if (nearest == none || std::abs(nearest - s) > 4) continue;
                ++pairs, level += nearest == s;
            }
            before = surfaces;
        }
    }
    ASSERT_GT(tagged, 1000u);
    EXPECT_LT(double(upsideDown), 0.08 * double(runs) + 40);
    EXPECT_GT(double(level), 0.9 * double(pairs));
}

void PhantomLaws::polypsAreTissueOnTheWall() {
    EXPECT_GE(phantom_.polyps.findings.size(), 7u);
    for (const Finding& polyp : phantom_.polyps.findings) {
        SCOPED_TRACE(polyp.kind + " of " + std::to_string(polyp.diameterMm) + " mm");
        EXPECT_GE(polyp.diameterMm, 4.0);
        EXPECT_LE(polyp.diameterMm, 15.0);
        EXPECT_EQ(labelAt(polyp.positionMm), 0);
        // Lumen begins just beyond its surface, somewhere.
        const double reach = 0.5 * polyp.diameterMm + 3.5;
        const glm::ivec3 middle(glm::round(grid_.voxelFromPatientPoint(polyp.positionMm)));
        const glm::ivec3 span(glm::ceil(reach / grid_.spacingMm()));
        bool lumen = false;
        for (int k = -span.z; k <= span.z; ++k) {
            for (int j = -span.y; j <= span.y; ++j) {
                for (int i = -span.x; i <= span.x; ++i) {
                    const glm::ivec3 v = middle + glm::ivec3(i, j, k);
                    if (!grid_.contains(v) || !phantom_.lumen.at(v)) continue;
                    lumen = lumen ||
                            glm::distance(grid_.patientFromVoxelPoint(v), polyp.positionMm) < reach;
                }
            }
        }
        EXPECT_TRUE(lumen);
        if (polyp.diameterMm > 9.0 && polyp.kind != "flat") {
            double sum = 0;
            for (int n = 0; n < 27; ++n)
                sum +=
                    phantom_.scan.hu.at(middle + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
            EXPECT_NEAR(sum / 27, 55.0, 45.0) << "soft tissue inside";
        }
    }
}

void PhantomLaws::polypVoxelsAreItsTissue() {
    ASSERT_EQ(phantom_.polypVoxels.size(), phantom_.polyps.findings.size());
    for (std::size_t p = 0; p < phantom_.polypVoxels.size(); ++p) {
        const Finding& polyp = phantom_.polyps.findings[p];
        SCOPED_TRACE(polyp.kind + " of " + std::to_string(polyp.diameterMm) + " mm");
        const auto& voxels = phantom_.polypVoxels[p];
        EXPECT_TRUE(std::is_sorted(voxels.begin(), voxels.end()));
        const double ml = double(voxels.size()) * grid_.voxelVolumeMm3() * 1e-3;
        const double ballMl = std::pow(polyp.diameterMm, 3.0) * 3.14159 / 6.0 * 1e-3;
        EXPECT_GT(ml, polyp.kind == "flat" ? 0.05 * ballMl : 0.25 * ballMl);
        EXPECT_LT(ml, 1.3 * ballMl + 0.2);
        for (const std::uint32_t v : voxels) {
            EXPECT_EQ(phantom_.lumen[v], 0);
            // A stalk is at most as long as this.
            EXPECT_LT(
                glm::distance(grid_.patientFromVoxelPoint(grid_.voxelAt(v)), polyp.positionMm),
                0.6 * polyp.diameterMm + 7.0);
        }
    }
}

void PhantomLaws::fluidCoversSomePolyps() {
    std::size_t covered = 0;
    for (const auto& voxels : phantom_.polypVoxels) {
        std::size_t air = 0, tagged = 0;
        for (const std::uint32_t v : voxels) {
            const glm::ivec3 middle = grid_.voxelAt(v);
            for (int n = 0; n < 27; ++n) {
                const glm::ivec3 w = middle + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1);
                air += phantom_.lumen.at(w) == 1, tagged += phantom_.lumen.at(w) == 2;
            }
        }
        covered += tagged > 20 * air;
    }
    EXPECT_GE(covered, GetParam().preset == Preset::easy ? 1u : 3u);
}

void PhantomLaws::untaggedScanDiffersOnlyAtTheTagging() {
    const auto near = grown(phantom_.lumen, 2, 5);
    // A film of fluid thinner than a voxel tags no voxel's centre.
    std::size_t different = 0, far = 0;
    for (std::size_t n = 0; n < near.size(); ++n) {
        if (phantom_.scan.hu[n] == phantom_.untaggedHu[n]) continue;
        ++different, far += !near[n];
    }
    EXPECT_GT(different, 1000u);
    EXPECT_LT(double(far), 0.01 * double(different));
}

void PhantomLaws::huAreThoseOfAirWallAndTagging() {
    // Two voxels away from any other label nothing is blurred into a voxel.
    const auto wall = grown(phantom_.lumen, 0, 2), air = grown(phantom_.lumen, 1, 2),
               tagged = grown(phantom_.lumen, 2, 2);
    const bool hard = GetParam().preset == Preset::hard;
    const auto inAir = [&](std::size_t n) {
        return phantom_.lumen[n] == 1 && !wall[n] && !tagged[n];
    };
    const auto inTagged = [&](std::size_t n) {
        return phantom_.lumen[n] == 2 && !wall[n] && !air[n];
    };
    EXPECT_NEAR(statistics(phantom_.scan.hu, inAir).mean, -989.0, 6.0);
    const Statistics fluid = statistics(phantom_.scan.hu, inTagged);
    if (fluid.count > 200) {
        EXPECT_GT(fluid.mean, hard ? 180.0 : 400.0);
        EXPECT_LT(fluid.mean, hard ? 450.0 : 900.0);
        EXPECT_NEAR(statistics(phantom_.untaggedHu, inTagged).mean, -989.0, 8.0) << "air instead";
    }
    // The muscle beside the spine is soft tissue, with the preset's noise.
    const auto inMuscle = [&](std::size_t n) {
        const glm::dvec3 p = grid_.patientFromVoxelPoint(grid_.voxelAt(n));
        return glm::distance(p, glm::dvec3(34, 86, 236)) < 8.0 && phantom_.lumen[n] == 0;
    };
    const Statistics muscle = statistics(phantom_.scan.hu, inMuscle);
    EXPECT_NEAR(muscle.mean, 55.0, 15.0);
    EXPECT_GT(muscle.sd, hard ? 24.0 : 8.0);
    EXPECT_LT(muscle.sd, hard ? 40.0 : 26.0);
    const auto [low, high] =
        std::minmax_element(phantom_.scan.hu.voxels().begin(), phantom_.scan.hu.voxels().end());
    EXPECT_GE(*low, -1024);
    EXPECT_LE(*high, 3071);
}

// One test, since each test makes its phantom anew.
TEST_P(PhantomLaws, Hold) {
    everythingIsOnOneGridAndThePositionIsRecorded();
    centerlineIsOneThatALumenCouldHave();
    lumenIsOnePieceOrTwoWhereCollapsed();
    fluidLiesBelowAirWithALevelSurface();
    polypsAreTissueOnTheWall();
    polypVoxelsAreItsTissue();
    fluidCoversSomePolyps();
    untaggedScanDiffersOnlyAtTheTagging();
    huAreThoseOfAirWallAndTagging();
}

std::string nameOf(const testing::TestParamInfo<Case>& test) {
    const char* preset = test.param.preset == Preset::easy       ? "easy"
                         : test.param.preset == Preset::standard ? "standard"
                                                                 : "hard";
    return std::string(preset) + "_" + toString(test.param.position);
}

INSTANTIATE_TEST_SUITE_P(Small, PhantomLaws,
                         testing::Values(Case{11, Preset::easy, PatientPosition::supine},
                                         Case{12, Preset::easy, PatientPosition::prone},
                                         Case{13, Preset::standard, PatientPosition::supine},
                                         Case{14, Preset::standard, PatientPosition::prone},
                                         Case{15, Preset::hard, PatientPosition::supine},
                                         Case{16, Preset::hard, PatientPosition::prone}),
                         nameOf);

TEST(Phantom, IsTheSameForAnyNumberOfThreads) {
    PhantomOptions options;
    options.seed = 4, options.preset = Preset::hard, options.size = Size::small;
    options.threads = 1;
    const auto one = makePhantom(options);
    options.threads = 3;
    const auto three = makePhantom(options);
    ASSERT_TRUE(one && three);
    EXPECT_TRUE(std::ranges::equal(one->scan.hu.voxels(), three->scan.hu.voxels()));
    EXPECT_TRUE(std::ranges::equal(one->untaggedHu.voxels(), three->untaggedHu.voxels()));
    EXPECT_TRUE(std::ranges::equal(one->lumen.voxels(), three->lumen.voxels()));
    ASSERT_EQ(one->centerline.points.size(), three->centerline.points.size());
    for (std::size_t n = 0; n < one->centerline.points.size(); ++n) {
        EXPECT_EQ(one->centerline.points[n].positionMm, three->centerline.points[n].positionMm);
        EXPECT_EQ(one->centerline.points[n].radiusMm, three->centerline.points[n].radiusMm);
    }
}

TEST(Phantom, RefusesAPositionItCannotLieIn) {
    PhantomOptions options;
    options.position = PatientPosition::unknown;
    const auto phantom = makePhantom(options);
    ASSERT_FALSE(phantom.has_value());
    EXPECT_EQ(phantom.error().kind, ErrorKind::badInput);
}

}  // namespace
