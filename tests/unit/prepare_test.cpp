// Laws of prepare: work that is unchanged and sound is reused, anything else is done again, and
// the products do not depend on the number of threads.
#include "cleansing/tissue_mixture.h"
#include "core/tri_mesh.h"
#include "flat_meshes.h"
#include "pipeline/product_attributes.h"
#include "pipeline/source_key.h"
#include "pipeline/stage_meter.h"
#include "prepared_tube.h"

#include <algorithm>
#include <chrono>
#include <cstring>

namespace haustra::pipeline {
namespace {

TEST_F(Prepare, ASecondRunReusesEverythingAndChangesNothing) {
    EXPECT_EQ(reused(options()), all(false));
    const auto before = bytesOf(store().openCase("tube").value());
    EXPECT_EQ(before.size(), 12u);
    EXPECT_EQ(reused(options()), all(true));
    EXPECT_EQ(bytesOf(store().openCase("tube").value()), before);
}

// Every triangle of the surface is in the map, but those of the two holes at its ends.
void expectFlatMapOf(const TriMesh& surface, const Centerline& centerline,
                     const store::Case& tube) {
    const auto flat = tube.readFlatMap();
    ASSERT_TRUE(flat) << describe(flat.error());
    const auto attributes = tube.attributes("flatmap").value();
    EXPECT_EQ(attributes.at("modulus").substr(0, 6), exactText(flat->height).substr(0, 6));
    EXPECT_EQ(attributes.at("flips"), "0");
    EXPECT_EQ(attributes.at("seam-mismatch"), "0");
    EXPECT_EQ(attributes.at("triangles"), std::to_string(flat->surface.triangles.size()));
    EXPECT_LT(std::stod(attributes.at("certificate")), 0.05);
    std::vector<double> left(surface.triangles.size());
    double capsMm2 = 0.0;
    for (std::size_t t = 0; t < left.size(); ++t) {
        left[t] = tests::areaMm2({surface.vertices, {surface.triangles[t]}});
        capsMm2 += left[t];
    }
    capsMm2 -= tests::areaMm2(flat->surface);
    for (std::size_t t = 0; t < flat->surface.triangles.size(); ++t) {
        const auto source = std::size_t(flat->sourceTriangle[t]);
        ASSERT_LT(source, left.size());
        left[source] -= tests::areaMm2({flat->surface.vertices, {flat->surface.triangles[t]}});
    }
    const auto missing = std::ranges::count_if(left, [](double mm2) { return mm2 > 1e-6; });
    EXPECT_LT(missing, 200);
    EXPECT_GT(missing, 2);
    EXPECT_NEAR(capsMm2, 2.0 * 18.0, 12.0);  // of rims of 15 mm each
    EXPECT_LT(glm::distance(flat->cameras.front().positionMm, centerline.points.front().positionMm),
              1e-9);
    // The rectum, where the centerline begins, is at the bottom.
    for (std::size_t v = 0; v < flat->flat.size(); ++v) {
        if (flat->flat[v].y == 0.0) {
            EXPECT_LT(flat->camera[v], 10);
        }
        if (flat->flat[v].y == flat->height) {
            EXPECT_GT(flat->camera[v], int(flat->cameras.size()) - 10);
        }
    }
}

TEST_F(Prepare, ProductsAreTheStagesOutputs) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const auto ct = tube.readVolume<std::int16_t>("ct").value();
    const auto labels = tube.readVolume<std::uint8_t>("lumen").value();
    const auto distance = tube.readVolume<float>("distance").value();
    const auto centerline = tube.readCenterline().value();
    EXPECT_EQ(tube.attributes("ct").value().at("position"), "unknown");
    EXPECT_TRUE(sameGrid(ct.grid(), labels.grid()));
    EXPECT_EQ(labels.grid().patientFromVoxel, ct.grid().patientFromVoxel);
    for (std::size_t n = 0; n < labels.grid().voxelCount(); ++n) {
        ASSERT_EQ(labels[n] != 0, ct[n] == -1000);
        ASSERT_EQ(labels[n] != 0, distance[n] > 0.0f);
    }
    EXPECT_NEAR(centerline.lengthMm(), 90.0, 20.0);
    // Nothing is tagged, so nothing is cleansed, and the surface is the tube's.
    const auto cleansed = tube.readVolume<std::int16_t>("cleansed").value();
    EXPECT_TRUE(std::ranges::equal(cleansed.voxels(), ct.voxels()));
    EXPECT_TRUE(tube.readVolume<TissueFractions>("mixture"));
    const auto surface = tube.readMesh().value();
    const MeshTopology topology = meshTopology(surface);
    EXPECT_TRUE(topology.closed());
    EXPECT_EQ(topology.eulerCharacteristic, 2);
    EXPECT_EQ(tube.attributes("surface").value().at("triangles"),
              std::to_string(surface.triangles.size()));
    expectFlatMapOf(surface, centerline, tube);
}

TEST_F(Prepare, ChangedInputsRedoWhatComesFromThemAlone) {
    reused(options());
    ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(5.0)));
    EXPECT_EQ(reused(options()),
              redone({"segmentation", "mixture", "cleansing", "denoising", "distance", "centerline",
                      "surface", "flattening", "cad"}));
    writeScan(5.0);
    PrepareOptions coarser = options();
    coarser.replace = true;
    EXPECT_EQ(reused(coarser), all(false));
    coarser.surfaceErrorMm = 0.3;
    EXPECT_EQ(reused(coarser), redone({"surface", "flattening", "cad"}));
    coarser.threads = 1;
    EXPECT_EQ(reused(coarser), all(true));
    coarser.areaWeight = 0.5;
    EXPECT_EQ(reused(coarser), redone({"flattening", "cad"}));
}

TEST_F(Prepare, ANewScanLeavesNoProductOfTheOldOne) {
    reused(options());
    ASSERT_TRUE(nifti::writeNifti(ctFile(), Volume<std::int16_t>(tubeMask(5.0).grid(), -7)));
    PrepareOptions only = options();
    only.until = "import";
    only.replace = true;
    EXPECT_EQ(reused(only), (Stages{{"import", false}}));
    EXPECT_EQ(store().openCase("tube")->products()->size(), 1u);
}

TEST_F(Prepare, UntilStopsAndTheNextRunGoesOn) {
    PrepareOptions some = options();
    some.until = "distance";
    EXPECT_EQ(reused(some), all(false, {"import", "segmentation", "mixture", "cleansing",
                                        "denoising", "distance"}));
    EXPECT_EQ(reused(options()), redone({"centerline", "surface", "flattening", "cad"}));
}

// What a store of before this order of stages holds: the same names, made otherwise.
TEST_F(Prepare, OldProductsAreMadeAgain) {
    reused(options());
    const auto now = bytesOf(store().openCase("tube").value());
    fs::remove_all(folder_ / "store");
    PrepareOptions import = options();
    import.until = "import";
    reused(import);
    {
        auto old = store().createCase("tube").value();
        const auto key = store::makeKey("lumen", 1, "", {old.find("ct")->key});
        ASSERT_TRUE(old.publishVolume("lumen", key, tubeMask(3.0)));
        ASSERT_TRUE(old.publishVolume("distance", key, Volume<float>(tubeMask(3.0).grid(), 1.0f)));
        ASSERT_TRUE(old.publishCenterline("centerline", key, {}));
    }
    PrepareOptions found = options();
    found.until = "segmentation";
    reused(found);
    EXPECT_EQ(store().openCase("tube")->products()->size(), 3u)
        << "old products outlive their input";
    reused(options());
    EXPECT_EQ(bytesOf(store().openCase("tube").value()), now);
}

TEST_F(Prepare, TheTissueModelComesBackFromTheSegmentationBitForBit) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const CtScan scan{tube.readVolume<std::int16_t>("ct").value(), PatientPosition::unknown};
    const auto fitted = cleansing::fitTissueModel(scan).value();
    const auto stored = tissueModelOf(tube.attributes("segmentation").value()).value();
    EXPECT_EQ(stored.meanHu, fitted.meanHu);
    EXPECT_EQ(stored.sdHu, fitted.sdHu);
    EXPECT_EQ(stored.weight, fitted.weight);
    EXPECT_EQ(stored.airBelowHu, fitted.airBelowHu);
    EXPECT_EQ(stored.taggedAboveHu, fitted.taggedAboveHu);
    auto damaged = tube.attributes("segmentation").value();
    for (const char* bad : {"", "1,2,3", "1,2,3,4,5", "1,2,3,x", "1,2,3,nan"}) {
        damaged["mean-hu"] = bad;
        EXPECT_FALSE(tissueModelOf(damaged)) << bad;
    }
}

TEST_F(Prepare, DamagedProductsAreMadeAgainByteForByte) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const auto sound = bytesOf(tube);
    const auto entries = tube.products().value();
    for (const auto& entry : entries) {
        const fs::path file = tube.folder() / entry.file;
        const std::string whole = content(file);
        std::string flipped = whole;
        flipped[whole.size() - 5] = char(flipped[whole.size() - 5] ^ 16);
        for (const std::string& bad :
             {whole.substr(0, whole.size() - 1), whole.substr(0, 100), std::string(), flipped}) {
            overwrite(file, bad);
            const auto report = prepare(store(), "tube", options());
            ASSERT_TRUE(report) << describe(report.error());
            EXPECT_TRUE(std::ranges::any_of(report->notes, [&](const std::string& note) {
                return note.find(entry.file) != std::string::npos;
            })) << entry.file;
            for (const StageReport& stage : report->stages) {
                EXPECT_EQ(stage.reused, stage.stage != stageOf(entry.product));
            }
            EXPECT_EQ(bytesOf(tube), sound);
        }
        fs::remove(file);
        ASSERT_TRUE(prepare(store(), "tube", options()));
        EXPECT_EQ(bytesOf(tube), sound);
    }
}

TEST_F(Prepare, WithItsDamagedIndexRemovedACaseIsMadeAgain) {
    reused(options());
    const auto tube = store().openCase("tube").value();
    const auto sound = bytesOf(tube);
    overwrite(tube.folder() / "case.json", "{");
    const auto report = prepare(store(), "tube", options());
    ASSERT_FALSE(report);
    const std::string said = describe(report.error());
    EXPECT_NE(said.find("case.json"), std::string::npos) << said;
    EXPECT_NE(said.find("remove this file"), std::string::npos) << said;
    fs::remove(tube.folder() / "case.json");
    EXPECT_EQ(reused(options()), all(false));
    EXPECT_EQ(bytesOf(tube), sound);
}

TEST_F(Prepare, WhatDenoisingAndTheSurfaceCameToIsNoted) {
    for (int run = 0; run < 2; ++run) {  // made, and reused
        const auto report = prepare(store(), "tube", options());
        ASSERT_TRUE(report) << describe(report.error());
        for (const char* start : {"denoising: 0 handles cut, 0 cavities filled, ",
                                  "surface: ", "flattening: modulus "}) {
            EXPECT_TRUE(std::ranges::any_of(report->notes, [&](const std::string& note) {
                return note.rfind(start, 0) == 0;
            })) << start;
        }
    }
    EXPECT_NE(
        store().openCase("tube")->attributes("surface")->at("notes").find("Euler characteristic 2"),
        std::string::npos);
}

TEST_F(Prepare, ProductsDoNotDependOnTheNumberOfThreads) {
    std::map<std::string, std::string> first;
    for (const int threads : {1, 2, 5}) {
        PrepareOptions some = options();
        some.threads = threads;
        ASSERT_TRUE(prepare(store(), "threads-" + std::to_string(threads), some));
        const auto bytes = bytesOf(store().openCase("threads-" + std::to_string(threads)).value());
        if (first.empty()) first = bytes;
        EXPECT_EQ(bytes, first);
    }
}

TEST_F(Prepare, TheReportTellsWhatTheSurfaceTookBesideOtherStages) {
    for (const int threads : {1, 2}) {
        PrepareOptions some = options();
        some.threads = threads;
        const auto start = std::chrono::steady_clock::now();
        const auto report = prepare(store(), "beside-" + std::to_string(threads), some);
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        ASSERT_TRUE(report);
        double sum = 0.0;
        for (const StageReport& stage : report->stages) {
            const bool beside = stage.stage == "surface" && threads > 1;
            EXPECT_GE(stage.besideSeconds, 0.0) << stage.stage;
            if (!beside) {
                EXPECT_EQ(stage.besideSeconds, 0.0) << stage.stage;
            }
            EXPECT_LE(stage.besideSeconds, stage.wallSeconds) << stage.stage;
            sum += stage.wallSeconds - stage.besideSeconds;
        }
        EXPECT_LE(sum, took.count());
    }
}

TEST_F(Prepare, ProgressEndsEachStageAtOne) {
    std::map<std::string, double> last;
    PrepareOptions some = options();
    some.progress = [&](const std::string& stage, double fraction) {
        EXPECT_GE(fraction, 0.0);
        EXPECT_LE(fraction, 1.0);
        last[stage] = fraction;
    };
    ASSERT_TRUE(prepare(store(), "tube", some));
    EXPECT_EQ(last.size(), stageNames().size());
    for (const auto& [stage, fraction] : last)
        EXPECT_EQ(fraction, 1.0) << stage;
}

TEST_F(Prepare, TheSourcesKeyIsOfTheirContentNotOfTheirNames) {
    overwrite(folder_ / "a/1.dcm", "one");
    overwrite(folder_ / "a/2.dcm", "two");
    overwrite(folder_ / "b/z", "one");
    overwrite(folder_ / "b/deep/er/1.dcm", "two");
    overwrite(folder_ / "c/1.dcm", "one");
    overwrite(folder_ / "c/2.dcm", "twO");
    overwrite(folder_ / "d/1.dcm", "onetwo");
    const auto key = [&](const char* name) { return sourceKey(folder_ / name, 2).value().hex; };
    EXPECT_EQ(key("a"), key("b"));
    EXPECT_NE(key("a"), key("c"));
    EXPECT_NE(key("a"), key("d"));
    EXPECT_FALSE(sourceKey(folder_ / "none", 2));
}

TEST(StageMeter, SeesThePeakOfItsOwnStageOnly) {
    constexpr std::size_t bytes = std::size_t(200) << 20;
    const auto touch = [] {
        std::vector<char> memory(bytes);
        for (std::size_t n = 0; n < bytes; n += 4096)
            const_cast<volatile char&>(memory[n]) = 1;
    };
    const StageMeter first;
    const double before = first.peakMemoryMib();
    touch();
    EXPECT_GT(first.peakMemoryMib(), before + 190.0);
    const StageMeter second;
    EXPECT_LT(second.peakMemoryMib(), before + 100.0);
}

}  // namespace
}  // namespace haustra::pipeline
