// A scan that is coarser than CT colonography is read at says so.
#include "core/scan_coarseness.h"

#include "prepared_tube.h"

namespace haustra {
namespace {

Grid spaced(glm::dvec3 mm) {
    return axisAlignedGrid({6, 7, 8}, mm);
}

// Slices along z, at these heights.
SourceSeries seriesAt(const std::vector<double>& depthsMm, double thicknessMm) {
    SourceSeries series;
    for (const double z : depthsMm) {
        series.images.emplace_back();
        series.images.back().positionMm = {10.0, -20.0, z};
        series.images.back().thicknessMm = thicknessMm;
    }
    return series;
}

bool says(const std::optional<std::string>& warning, const std::string& words) {
    return warning && warning->find(words) != std::string::npos;
}

TEST(ScanCoarseness, AMillimetreAndAHalfIsFineAndMoreIsTold) {
    EXPECT_FALSE(coarsenessOf(spaced({0.7, 0.7, 1.5}), nullptr));
    // Along any axis, as files may be stored in any order.
    for (const glm::dvec3 mm :
         {glm::dvec3(0.7, 0.7, 2.0), glm::dvec3(0.7, 2.0, 0.7), glm::dvec3(2.0, 0.7, 0.7)}) {
        const auto told = coarsenessOf(spaced(mm), nullptr);
        EXPECT_TRUE(says(told, "samples up to 2 mm apart")) << told.value_or("nothing");
        EXPECT_TRUE(says(told, "small and flat polyps may not show")) << told.value_or("nothing");
        EXPECT_FALSE(says(told, "thick"));
    }
}

TEST(ScanCoarseness, ThickSlicesAreToldThoughTheyOverlap) {
    const Grid grid = spaced({0.7, 0.7, 1.0});
    const SourceSeries fine = seriesAt({0, 1, 2, 3}, 3.0), thick = seriesAt({0, 1, 2, 3}, 5.0);
    EXPECT_FALSE(coarsenessOf(grid, &fine));
    const auto told = coarsenessOf(grid, &thick);
    EXPECT_TRUE(says(told, "slices 5 mm thick")) << told.value_or("nothing");
    EXPECT_FALSE(says(told, "apart"));
    const auto both = coarsenessOf(spaced({0.7, 0.7, 5.0}), &thick);
    EXPECT_TRUE(says(both, "5 mm apart") && says(both, "5 mm thick")) << both.value_or("nothing");
}

TEST(ScanCoarseness, FarOverTheLimitsLargePolypsMayBeMissedToo) {
    const Grid grid = spaced({0.7, 0.7, 1.0});
    const SourceSeries thicker = seriesAt({0, 1, 2, 3}, 4.0),
                       thickest = seriesAt({0, 1, 2, 3}, 5.0);
    EXPECT_FALSE(says(coarsenessOf(grid, &thicker), "large"));
    EXPECT_TRUE(says(coarsenessOf(grid, &thickest), "large ones among them"));
    EXPECT_TRUE(says(coarsenessOf(spaced({0.7, 0.7, 2.5}), nullptr), "large ones among them"));
    EXPECT_TRUE(says(coarsenessOf(spaced({0.7, 0.7, 2.5}), &thicker), "large ones among them"));
}

TEST(ScanCoarseness, OfResampledSlicesTheWidestGapCounts) {
    const SourceSeries series = seriesAt({0, 1, 2, 3.75, 4.75}, 1.0);
    const auto told = coarsenessOf(spaced({0.7, 0.7, 1.0}), &series);
    EXPECT_TRUE(says(told, "up to 1.75 mm apart")) << told.value_or("nothing");
}

using ImportOfCoarseScan = pipeline::Prepare;

// A warning about polyps is for whoever looks for polyps.
TEST_F(ImportOfCoarseScan, IsToldOfAColonAndNotOfAVessel) {
    ASSERT_TRUE(nifti::writeNifti(
        ctFile(), Volume<std::int16_t>(axisAlignedGrid({40, 40, 40}, {0.8, 0.8, 2.5}), 40)));
    for (const char* organ : {"colon", "vessel"}) {
        pipeline::PrepareOptions import;
        import.series = ctFile();
        import.until = "import";
        import.organ = organ;
        const auto report = prepare(store(organ), "scan", import);
        ASSERT_TRUE(report) << describe(report.error());
        bool told = false;
        for (const std::string& note : report->notes)
            told |= note.starts_with("import: warning: ") &&
                    note.find("2.5 mm apart") != std::string::npos;
        EXPECT_EQ(told, std::string(organ) == "colon");
    }
}

}  // namespace
}  // namespace haustra
