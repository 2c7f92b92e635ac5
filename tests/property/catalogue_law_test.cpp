// Laws of the catalogue of products: what it says of parents is what prepare truly reads, and what
// it says is all that a new product needs.
#include "pipeline/stage_case.h"
#include "prepared_tube.h"
#include "store/products.h"

#include <algorithm>
#include <set>
#include <sstream>

namespace haustra::pipeline {
namespace {

using store::Catalogue;
using store::Content;
using store::Product;
using Names = Catalogue::Names;
using NameSet = std::set<std::string>;

NameSet setOf(const Names& names) {
    return {names.begin(), names.end()};
}

TEST(Catalogue, EveryParentIsAProductThatIsMadeBefore) {
    NameSet before;
    for (const Product& product : store::catalogue().products()) {
        for (const std::string& parent : product.parents)
            EXPECT_TRUE(before.contains(parent)) << product.name << " from " << parent;
        EXPECT_TRUE(before.insert(product.name).second) << product.name << " is there twice";
        EXPECT_FALSE(product.help.empty()) << product.name;
        EXPECT_EQ(product.help.find('\n'), std::string::npos) << product.name;
        if (product.content) {
            EXPECT_NE(store::kindOf(*product.content), nullptr) << product.name;
        }
    }
}

TEST(Catalogue, AStagesProductsStandTogetherAndAfterWhatItReads) {
    const Catalogue& catalogue = store::catalogue();
    Names order;
    for (const Product& product : catalogue.products())
        if (!product.stage.empty() && (order.empty() || order.back() != product.stage))
            order.push_back(product.stage);
    EXPECT_EQ(order, catalogue.stages());
    for (const std::string& stage : catalogue.stages()) {
        for (const std::string& source : catalogue.readBy(stage))
            EXPECT_NE(catalogue.find(source)->stage, stage) << source;
        // One key stands for what they are made from.
        for (const std::string& made : catalogue.madeBy(stage))
            EXPECT_EQ(setOf(catalogue.find(made)->parents), setOf(catalogue.readBy(stage))) << made;
    }
}

// a → b → d, a → c → d, and e beside all.
Catalogue diamond() {
    return Catalogue({{.name = "a"},
                      {.name = "b", .parents = {"a"}},
                      {.name = "c", .parents = {"a"}},
                      {.name = "d", .parents = {"b", "c"}},
                      {.name = "e"}});
}

TEST(Catalogue, ClosuresFollowAllWays) {
    EXPECT_EQ(diamond().madeFrom("a"), (Names{"b", "c", "d"}));
    EXPECT_EQ(diamond().madeFrom("c"), Names{"d"});
    EXPECT_EQ(diamond().madeFrom("e"), Names{});
    EXPECT_EQ(diamond().sources("d"), (Names{"a", "b", "c"}));
    EXPECT_EQ(diamond().sources("a"), Names{});
    EXPECT_EQ(diamond().madeFrom("unknown"), Names{});
}

TEST(Catalogue, WhatIsMadeFromAProductHasItAmongItsSources) {
    const Catalogue& catalogue = store::catalogue();
    for (const Product& a : catalogue.products()) {
        const NameSet dependents = setOf(catalogue.madeFrom(a.name));
        EXPECT_FALSE(dependents.contains(a.name));
        for (const Product& b : catalogue.products())
            EXPECT_EQ(dependents.contains(b.name),
                      setOf(catalogue.sources(b.name)).contains(a.name))
                << a.name << " " << b.name;
        // And what is made from that is too.
        for (const std::string& b : dependents)
            EXPECT_TRUE(std::ranges::includes(dependents, setOf(catalogue.madeFrom(b))));
    }
}

Catalogue withToy() {
    std::vector<Product> products = store::catalogue().products();
    products.push_back({.name = "roundness",
                        .stage = "rounding",
                        .content = Content::floatVolume,
                        .parents = {"distance"},
                        .endings = {".nii.gz", ".mha"},
                        .help = "how round the lumen is (float, 0 to 1)"});
    return Catalogue(products);
}

TEST(Catalogue, AToyProductIsInHelpListAndClosures) {
    const Catalogue catalogue = withToy();
    EXPECT_EQ(catalogue.exported().back(), "roundness");
    EXPECT_EQ(catalogue.stages().back(), "rounding");
    EXPECT_NE(
        catalogue.exportHelp().find("  roundness         .nii.gz .mha\n"
                                    "                    how round the lumen is (float, 0 to 1)\n"),
        std::string::npos)
        << catalogue.exportHelp();
    EXPECT_NE(
        catalogue.stageHelp().find("  rounding\n    roundness       how round the lumen is (float"),
        std::string::npos)
        << catalogue.stageHelp();
    EXPECT_NE(catalogue.keptHelp().find("\n  roundness         how round the lumen is (float"),
              std::string::npos)
        << catalogue.keptHelp();
    for (const char* source : {"ct", "segmentation", "mixture", "lumen", "distance"})
        EXPECT_TRUE(setOf(catalogue.madeFrom(source)).contains("roundness")) << source;
    for (const char* other : {"surface", "centerline", "edits"})
        EXPECT_FALSE(setOf(catalogue.madeFrom(other)).contains("roundness")) << other;
}

TEST(Catalogue, HelpNamesEveryProductOnLinesThatFitATerminal) {
    const Catalogue& catalogue = store::catalogue();
    for (const std::string& text :
         {catalogue.exportHelp(), catalogue.stageHelp(), catalogue.keptHelp()}) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);) {
            EXPECT_LE(line.size(), 100u) << line;
            EXPECT_NE(line.back(), ' ') << line;
        }
    }
    for (const Product& product : catalogue.products()) {
        EXPECT_EQ(catalogue.exportHelp().find("\n  " + product.name + " ") != std::string::npos,
                  !product.endings.empty());
        EXPECT_EQ(catalogue.stageHelp().find("\n    " + product.name + " ") != std::string::npos,
                  !product.stage.empty());
        EXPECT_EQ(catalogue.keptHelp().find("\n  " + product.name + " ") != std::string::npos,
                  product.content.has_value());
    }
}

using StageCases = Prepare;

const store::ProductKey keyOf(int n) {
    return store::makeKey("test", n, "", {});
}

TEST_F(StageCases, AStageIsRefusedWhatIsNoParentOfItsProducts) {
    const Catalogue catalogue = withToy();
    auto target = store().createCase("toy").value();
    const auto mask = tubeMask(5.0);
    ASSERT_TRUE(target.publishVolume("lumen", keyOf(1), mask));
    ASSERT_TRUE(target.publishVolume("distance", keyOf(1), Volume<float>(mask.grid(), 1.0f)));
    StageCase stage(target, "rounding", keyOf(2), {}, catalogue);
    EXPECT_TRUE(stage.readVolume<float>("distance"));
    EXPECT_TRUE(stage.attributes("distance"));
    const auto refused = [](const auto& result) {
        return !result && result.error().kind == ErrorKind::wrongState;
    };
    EXPECT_TRUE(refused(stage.readVolume<std::uint8_t>("lumen")));
    EXPECT_TRUE(refused(stage.attributes("lumen")));
    EXPECT_TRUE(refused(stage.holds("lumen")));
    EXPECT_TRUE(refused(stage.readScan()));
    EXPECT_TRUE(refused(stage.readMesh("surface")));
    EXPECT_TRUE(refused(stage.readCenterline("centerline")));
    EXPECT_TRUE(refused(stage.readText("quality")));
    EXPECT_TRUE(refused(stage.readVolume<float>("roundness")));  // its own is no parent either
    EXPECT_TRUE(refused(stage.readVolume<float>("nothing")));
    EXPECT_EQ(stage.read(), NameSet{"distance"});

    EXPECT_TRUE(refused(stage.publish("distance", Volume<float>(mask.grid(), 2.0f))));
    EXPECT_TRUE(refused(stage.publish("nothing", Volume<float>(mask.grid(), 2.0f))));
    EXPECT_TRUE(refused(stage.publish("roundness", mask))) << "of another content";
    EXPECT_TRUE(refused(stage.publish("roundness", std::string("round"))));
    EXPECT_FALSE(target.find("roundness"));
    EXPECT_TRUE(stage.publish("roundness", Volume<float>(mask.grid(), 2.0f)));
    EXPECT_TRUE(target.has("roundness", keyOf(2)));
}

TEST_F(StageCases, WhatAStagePublishesTakesWithItWhatIsOutdated) {
    // One stage makes `one` and `two`; `three` is made from `one`, `four` from `two`.
    const Catalogue catalogue(
        {{.name = "zero", .stage = "first", .content = Content::text},
         {.name = "one", .stage = "second", .content = Content::text, .parents = {"zero"}},
         {.name = "two", .stage = "second", .content = Content::text, .parents = {"zero"}},
         {.name = "three", .stage = "third", .content = Content::text, .parents = {"one"}},
         {.name = "four", .stage = "fourth", .content = Content::text, .parents = {"two"}}});
    auto target = store().createCase("toy").value();
    const auto held = [&] {
        std::string names;
        const auto products = target.products().value();
        for (const auto& entry : products)
            names += entry.product + " ";
        return names;
    };
    const auto publish = [&](const char* stage, int key, const Names& products) {
        StageCase opened(target, stage, keyOf(key), {}, catalogue);
        for (const std::string& product : products)
            ASSERT_TRUE(opened.publish(product, std::string("text"))) << product;
    };
    publish("first", 1, {"zero"});
    publish("second", 2, {"one", "two"});
    publish("third", 3, {"three"});
    publish("fourth", 4, {"four"});
    EXPECT_EQ(held(), "four one three two zero ");
    publish("second", 2, {"one"});  // the same: made again after damage
    EXPECT_EQ(held(), "four one three two zero ");
    publish("third", 5, {"three"});
    EXPECT_EQ(held(), "four one three two zero ");
    publish("second", 6, {"one"});  // `two` has not been made with it yet
    EXPECT_EQ(held(), "one zero ");
    publish("second", 6, {"two"});
    EXPECT_EQ(held(), "one two zero ");
    publish("first", 7, {"zero"});
    EXPECT_EQ(held(), "zero ");
}

// A vessel that forks, full of contrast: an organ that is found in HU, branches, and is neither
// cleansed nor flattened.
Volume<std::int16_t> forkedVessel() {
    Volume<std::int16_t> hu(tubeMask(1.0).grid(), 45);
    const glm::dvec3 low(20, 20, 8), high(20, 20, 82), fork(20, 20, 34), tip(40, 20, 62);
    const auto near = [](glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, double radius) {
        const double t = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
        return glm::distance(p, a + t * (b - a)) < radius;
    };
    for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n) {
        const glm::dvec3 v(hu.grid().voxelAt(n));
        const bool inside = near(v, low, high, 6.0) || near(v, fork, tip, 4.5);
        hu.writable()[n] = std::int16_t((inside ? 300 : 45) + int(n % 7));
    }
    return hu;
}

// The parents of a stage's products, and the products that some preparation has it read, are the
// same: no parent is claimed that no stage reads, and StageCase refuses the others.
TEST_F(StageCases, ParentsAreWhatPrepareReads) {
    const Catalogue& catalogue = store::catalogue();
    std::map<std::string, NameSet> read;
    const auto note = [&](const std::string& name, const PrepareOptions& options) {
        const auto report = prepare(store(), name, options);
        ASSERT_TRUE(report) << describe(report.error());
        NameSet made;
        const auto products = store().openCase(name)->products().value();
        for (const auto& entry : products)
            made.insert(entry.product);
        for (const StageReport& stage : report->stages) {
            EXPECT_FALSE(stage.reused);
            read[stage.stage].insert(stage.read.begin(), stage.read.end());
            // Whatever a stage read is there still: nothing that goes into another was lost. A mask
            // has no quality, and a NIfTI file no series; both are asked for.
            for (const std::string& product : stage.read)
                EXPECT_TRUE(made.contains(product) || product == "quality" || product == "source")
                    << product;
        }
    };
    // A colon with a pool of tagged fluid, so that there is something to cleanse.
    auto mask = tubeMask(6.0);
    Volume<std::int16_t> ct(mask.grid());
    for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
        const bool pool = mask[n] != 0 && mask.grid().voxelAt(n).y > 22;
        if (pool) mask.writable()[n] = std::uint8_t(LumenLabel::tagged);
        ct.writable()[n] = std::int16_t((pool ? 600 : mask[n] != 0 ? -1000 : 40) + int(n % 7));
    }
    ASSERT_TRUE(nifti::writeNifti(maskFile(), mask));
    ASSERT_TRUE(nifti::writeNifti(ctFile(), ct));
    note("colon", options());
    PrepareOptions alone = options();
    alone.series.clear();
    note("mask", alone);
    ASSERT_TRUE(nifti::writeNifti(folder_ / "vessel.nii.gz", forkedVessel()));
    PrepareOptions vessel;
    vessel.series = folder_ / "vessel.nii.gz";
    vessel.organ = "vessel";
    note("vessel", vessel);
    EXPECT_TRUE(store().openCase("vessel")->find("branches"));

    for (const std::string& stage : catalogue.stages())
        EXPECT_EQ(read[stage], setOf(catalogue.readBy(stage))) << stage;
    EXPECT_EQ(read.size(), catalogue.stages().size());
}

}  // namespace
}  // namespace haustra::pipeline
