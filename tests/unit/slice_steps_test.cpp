// Slices that do not follow each other are told, by height; noise and anatomy are not.
#include "core/slice_steps.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

constexpr glm::ivec3 size{48, 40, 60};
constexpr double spacingMm = 2.0, lowestMm = -300.0;

/// A body that narrows upwards, with a tube of gas that wanders; `shiftMm` of each slice moves it.
Volume<std::int16_t> scan(double noiseHu, const std::function<double(int)>& shiftMm) {
    Volume<std::int16_t> hu(axisAlignedGrid(size, glm::dvec3(spacingMm), {0.0, 0.0, lowestMm}));
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 1.0);
    for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n) {
        const glm::ivec3 v = hu.grid().voxelAt(n);
        const glm::dvec2 p = spacingMm * (glm::dvec2(v) - 0.5 * glm::dvec2(size));
        const double up = v.z * spacingMm + shiftMm(v.z);
        const double body = glm::length(p) - (36.0 - 0.1 * up);
        const double tube =
            glm::length(p - 12.0 * glm::dvec2(std::cos(up / 15), std::sin(up / 15))) - 8.0;
        const double value = body > 0.0 || tube < 0.0 ? -1000.0 : 40.0;
        hu.writable()[n] = std::int16_t(std::lround(value + noiseHu * noise(random)));
    }
    return hu;
}
Volume<std::int16_t> still(double noiseHu) {
    return scan(noiseHu, [](int) { return 0.0; });
}
void swapSlices(Volume<std::int16_t>& hu, int a, int b) {
    const std::size_t per = std::size_t(size.x * size.y);
    const auto voxels = hu.writable();
    std::swap_ranges(voxels.begin() + std::ptrdiff_t(std::size_t(a) * per),
                     voxels.begin() + std::ptrdiff_t(std::size_t(a + 1) * per),
                     voxels.begin() + std::ptrdiff_t(std::size_t(b) * per));
}
bool says(const std::optional<std::string>& told, const std::string& what) {
    return told && told->find(what) != std::string::npos;
}

TEST(SliceSteps, AnEvenScanHasNoneWhateverItsNoise) {
    for (const double noiseHu : {0.0, 5.0, 20.0, 80.0})
        EXPECT_FALSE(unevenStepsOf(still(noiseHu), 2)) << *unevenStepsOf(still(noiseHu), 2);
}

// A breath between two slices: what lies above is elsewhere.
TEST(SliceSteps, ABreathIsToldWhereItWasTaken) {
    const auto told = unevenStepsOf(scan(10.0, [](int k) { return k > 30 ? 18.0 : 0.0; }), 1);
    EXPECT_TRUE(says(told, "the slices at -240.0 and -238.0 mm differ"))
        << told.value_or("nothing");
    EXPECT_FALSE(says(told, "more pair"));
}

TEST(SliceSteps, ASliceThatDoesNotBelongThereIsTold) {
    Volume<std::int16_t> swapped = still(10.0);
    swapSlices(swapped, 20, 45);
    EXPECT_TRUE(says(unevenStepsOf(swapped, 1), "and 3 more pairs"));

    Volume<std::int16_t> blank = still(10.0);
    const std::size_t per = std::size_t(size.x * size.y);
    std::fill_n(blank.writable().begin() + 25 * std::ptrdiff_t(per), per, std::int16_t(-1024));
    const auto told = unevenStepsOf(blank, 1);
    EXPECT_TRUE(says(told, "-250.0")) << told.value_or("nothing");
    EXPECT_TRUE(says(told, "and 1 more pair by"));
}

TEST(SliceSteps, ASliceThatWasStoredTwiceIsTold) {
    Volume<std::int16_t> twice = still(10.0);
    const std::size_t per = std::size_t(size.x * size.y);
    const auto voxels = twice.writable();
    std::copy_n(voxels.begin() + 40 * std::ptrdiff_t(per), per,
                voxels.begin() + 41 * std::ptrdiff_t(per));
    const auto told = unevenStepsOf(twice, 1);
    EXPECT_TRUE(says(told, "1 slice is the same as the one before, the first at -218.0 mm"))
        << told.value_or("nothing");
}

TEST(SliceSteps, IsTheSameForAnyNumberOfThreads) {
    Volume<std::int16_t> swapped = still(10.0);
    swapSlices(swapped, 20, 45);
    EXPECT_EQ(unevenStepsOf(swapped, 1), unevenStepsOf(swapped, 3));
}

TEST(SliceSteps, OfOneSliceThereAreNone) {
    EXPECT_FALSE(unevenStepsOf(Volume<std::int16_t>(axisAlignedGrid({4, 4, 1}, {1, 1, 1})), 1));
}

}  // namespace
