// What prepare takes: masks beside a scan and alone, volumes in any order of axes; and what it
// refuses.
#include "pipeline/axial_order.h"
#include "pipeline/read_inputs.h"
#include "prepared_tube.h"

#include <algorithm>
#include <fstream>

namespace haustra::pipeline {
namespace {

using PrepareInputs = Prepare;

TEST_F(PrepareInputs, AMaskStandsAlone) {
    PrepareOptions alone = options();
    alone.series.clear();
    EXPECT_EQ(reused(alone), all(false, {"segmentation", "denoising", "distance", "centerline",
                                         "surface", "flattening"}));
    const auto tube = store().openCase("tube").value();
    for (const char* product : {"ct", "mixture", "cleansed", "cleansed-lumen"})
        EXPECT_FALSE(tube.find(product)) << product;
    EXPECT_TRUE(tube.find("centerline"));
    EXPECT_TRUE(meshTopology(tube.readMesh().value()).closed());
}

TEST_F(PrepareInputs, ANiftiFileThatLeansOrDoesNotSayHowItLies) {
    const fs::path file = folder_ / "scan.nii";
    Grid grid = axisAlignedGrid({6, 5, 4}, {1, 1, 1});
    ASSERT_TRUE(nifti::writeNifti(file, Volume<std::int16_t>(grid, 40)));
    const auto straight = readScan(file, "", 1, {});
    ASSERT_TRUE(straight) << describe(straight.error());
    EXPECT_TRUE(straight->notes.empty());
    {
        std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
        stream.seekp(252).write("\0\0\0\0", 4);  // neither qform nor sform
    }
    const auto unsaid = readScan(file, "", 1, {});
    ASSERT_TRUE(unsaid) << describe(unsaid.error());
    ASSERT_FALSE(unsaid->notes.empty());
    EXPECT_TRUE(unsaid->notes[0].starts_with("warning: the file does not say how its axes lie"));
    grid.patientFromVoxel[2] = {0.0, 0.2, 1.0, 0.0};
    ASSERT_TRUE(nifti::writeNifti(file, Volume<std::int16_t>(grid, 40)));
    const auto leaning = readScan(file, "", 1, {});
    ASSERT_FALSE(leaning);
    EXPECT_EQ(leaning.error().place, file.string());
    EXPECT_NE(leaning.error().message.find("right angles"), std::string::npos);
}

// A lumen too short for a hole at each end: one clear error, and nothing before it is lost.
TEST_F(PrepareInputs, ALumenThatCannotBeFlattenedIsPreparedUpToItsSurface) {
    Volume<std::uint8_t> stub = tubeMask(6.0);
    for (std::size_t n = 0; n < stub.grid().voxelCount(); ++n) {
        if (stub.grid().voxelAt(n).z > 10) stub.writable()[n] = 0;
    }
    ASSERT_TRUE(nifti::writeNifti(maskFile(), stub));
    for (int run = 0; run < 2; ++run) {
        const auto report = prepare(store(), "tube", options());
        ASSERT_FALSE(report);
        EXPECT_EQ(report.error().place, "case tube, flattening");
        EXPECT_NE(report.error().message.find("hole"), std::string::npos)
            << describe(report.error());
        const auto tube = store().openCase("tube").value();
        EXPECT_TRUE(tube.readMesh());
        EXPECT_TRUE(tube.readCenterline());
        EXPECT_FALSE(tube.find("flatmap"));
    }
    PrepareOptions some = options();
    some.until = "surface";
    EXPECT_EQ(reused(some), all(true, {"import", "segmentation", "mixture", "cleansing",
                                       "denoising", "distance", "centerline", "surface"}));
}

TEST_F(PrepareInputs, AMaskWithoutASeriesIsOfTheCasesScan) {
    PrepareOptions import = options();
    import.until = "import";
    reused(import);
    PrepareOptions mask = options();
    mask.series.clear();
    EXPECT_EQ(reused(mask), all(false, {"segmentation", "mixture", "cleansing", "denoising",
                                        "distance", "centerline", "surface", "flattening", "cad"}));
    EXPECT_TRUE(store().openCase("tube")->find("ct"));
    EXPECT_EQ(reused(options()), all(true));
}

TEST_F(PrepareInputs, AMaskOnAnotherGridIsRefused) {
    Volume<std::uint8_t> shifted(tubeMask(6.0));
    Grid grid = shifted.grid();
    grid.patientFromVoxel[3].x += 0.4;
    const auto moved = Volume<std::uint8_t>::view(grid, shifted.voxels().data(), nullptr);
    ASSERT_TRUE(nifti::writeNifti(maskFile(), moved));
    const auto report = prepare(store(), "tube", options());
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().place.find("mask.nii.gz"), std::string::npos);

    ASSERT_TRUE(nifti::writeNifti(maskFile(),
                                  Volume<std::uint8_t>(axisAlignedGrid({9, 9, 9}, {1, 1, 1}), 1)));
    EXPECT_FALSE(prepare(store(), "tube", options()));
    ASSERT_TRUE(nifti::writeNifti(maskFile(), Volume<std::uint8_t>(grid, 0)));
    EXPECT_FALSE(prepare(store(), "tube", options()));
}

TEST_F(PrepareInputs, ACoronalScanFromHeadToFeetIsPreparedAsTheAxialOne) {
    EXPECT_EQ(reused(options()), all(false));
    const AxisOrder coronal{{0, 2, 1}, {true, true, false}};
    auto ct = nifti::readNifti<std::int16_t>(ctFile()).value();
    ASSERT_TRUE(
        nifti::writeNifti(folder_ / "coronal.nii.gz", reordered(std::move(ct), coronal, 1)));
    ASSERT_TRUE(
        nifti::writeNifti(folder_ / "coronal-mask.nii.gz", reordered(tubeMask(6.0), coronal, 1)));
    PrepareOptions turned = options();
    turned.series = folder_ / "coronal.nii.gz";
    for (const fs::path& mask : {maskFile(), folder_ / "coronal-mask.nii.gz"}) {
        turned.lumenMask = mask;
        const std::string name = mask.stem().stem().string();
        const auto report = prepare(store(), name, turned);
        ASSERT_TRUE(report) << describe(report.error());
        EXPECT_EQ(std::ranges::count(report->notes,
                                     "import: the voxels' axes were put in the order left, "
                                     "posterior, superior; they were stored as RIP"),
                  1);
        for (const char* product : {"ct", "cleansed"}) {
            const auto axial = store().openCase("tube")->readVolume<std::int16_t>(product).value();
            const auto other = store().openCase(name)->readVolume<std::int16_t>(product).value();
            EXPECT_TRUE(sameGrid(other.grid(), axial.grid()));
            EXPECT_TRUE(std::ranges::equal(other.voxels(), axial.voxels())) << product;
        }
    }
    // The mask alone.
    turned.series.clear();
    ASSERT_TRUE(prepare(store(), "alone", turned));
    EXPECT_EQ(store().openCase("alone")->readVolume<std::uint8_t>("lumen")->grid().size, tubeSize);
}

TEST_F(PrepareInputs, MaskValuesFarFromZeroAreLumen) {
    ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(6.0, 255)));
    const auto report = prepare(store(), "tube", options());
    ASSERT_TRUE(report);
    EXPECT_NE(std::ranges::find_if(report->notes,
                                   [](const std::string& note) {
                                       return note.find("mask values") != std::string::npos;
                                   }),
              report->notes.end());
    const auto labels = store().openCase("tube")->readVolume<std::uint8_t>("segmentation").value();
    EXPECT_EQ(labels.at(24, 20, 6), 1);
}

TEST_F(PrepareInputs, AFailedStageNamesItsCase) {
    Volume<std::uint8_t> speck(tubeMask(6.0).grid(), 0);
    speck.writable()[speck.grid().index(20, 20, 40)] = 1;
    ASSERT_TRUE(nifti::writeNifti(maskFile(), speck));
    PrepareOptions alone = options();
    alone.series.clear();
    const auto report = prepare(store(), "speck", alone);
    ASSERT_FALSE(report);
    EXPECT_NE(describe(report.error()).find("case speck, "), std::string::npos)
        << describe(report.error());
}

TEST_F(PrepareInputs, ACaseThatIsBeingWrittenIsRefused) {
    const auto held = store().createCase("tube");
    ASSERT_TRUE(held);
    const auto report = prepare(store(), "tube", options());
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("being written"), std::string::npos);
}

TEST_F(PrepareInputs, WrongOptionsAreToldAndLeaveNoCase) {
    PrepareOptions wrong = options();
    wrong.until = "polish";
    EXPECT_FALSE(prepare(store(), "tube", wrong));
    EXPECT_FALSE(prepare(store(), "tube", {}));
    wrong = options();
    wrong.series = folder_ / "none";
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::notFound);
    wrong = options();
    wrong.surfaceErrorMm = 0.0;
    EXPECT_FALSE(prepare(store(), "tube", wrong));
    wrong = options();
    wrong.surfaceErrorMm = std::nan("");
    EXPECT_FALSE(prepare(store(), "tube", wrong));
    wrong = options();
    wrong.excludesMm = {{0.0, 0.0, 0.0}};
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::badInput);
    wrong = options();
    wrong.lumenMask = folder_;
    EXPECT_NE(describe(prepare(store(), "tube", wrong).error()).find("a folder"),
              std::string::npos);
    wrong = options();
    wrong.series.clear();
    wrong.until = "import";
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::badInput);
    wrong = options();
    wrong.organ = "spleen";
    EXPECT_EQ(prepare(store(), "tube", wrong).error().kind, ErrorKind::notFound);
    EXPECT_FALSE(prepare(store(), "../tube", options()));
    EXPECT_TRUE(fs::is_empty(folder_ / "store" / "cases"));
}

}  // namespace
}  // namespace haustra::pipeline
