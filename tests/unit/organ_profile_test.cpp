// Organ profiles: what is built in, and what is refused, with the file and the field.
#include "organs/organ_profile.h"

#include "organs/built_in_profiles.h"
#include "temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra::organs {
namespace {

using nlohmann::json;

json builtIn(const std::string& name) {
    return json::parse(builtInProfiles().at(name));
}

TEST(OrganProfile, TheBuiltInOnesAreWhatTheirNamesSay) {
    ASSERT_EQ(builtInProfiles().size(), 3u);
    for (const auto& [name, text] : builtInProfiles()) {
        const auto profile = readProfile(std::string(name));
        ASSERT_TRUE(profile) << describe(profile.error());
        EXPECT_EQ(profile->organ, name);
    }
    const OrganProfile colon = readProfile("colon").value();
    EXPECT_EQ(colon.finder, LumenFinder::gasAndTagged);
    EXPECT_TRUE(colon.cleanse);
    EXPECT_EQ(colon.topology, ExpectedTopology::ball);
    EXPECT_EQ(colon.endPoints, EndPoints::rectumCecum);
    EXPECT_FALSE(colon.branches);
    EXPECT_TRUE(colon.flatten);
    EXPECT_EQ(colon.tissues, TissuePriors{});  // an abdomen's
    const OrganProfile vessel = readProfile("vessel").value();
    EXPECT_EQ(vessel.finder, LumenFinder::huRange);
    EXPECT_EQ(vessel.contentHu, (HuRange{180, 700}));
    EXPECT_EQ(vessel.topology, ExpectedTopology::any);
    EXPECT_EQ(vessel.endPoints, EndPoints::farthest);
    EXPECT_TRUE(vessel.branches);
    EXPECT_FALSE(vessel.cleanse);
    EXPECT_FALSE(vessel.flatten);
    EXPECT_GT(readProfile("bladder")->openingMm, 0.0);
}

// What is wrong, made of a sound profile by a JSON patch, and the words the message must hold.
struct Wrong {
    const char *base, *patch, *field, *what;
};

TEST(OrganProfile, WhatIsWrongIsRefusedWithFileAndField) {
    const Wrong wrongs[] = {
        {"colon", R"([{"op":"add","path":"/colour","value":1}])", "colour", "unknown"},
        {"colon", R"([{"op":"add","path":"/lumen/hu","value":[1,2]}])", "lumen.hu", "unknown"},
        {"colon", R"([{"op":"add","path":"/tissues/bone","value":[1,2]}])", "tissues.bone",
         "unknown"},
        {"colon", R"([{"op":"remove","path":"/tissues"}])", "tissues", "missing"},
        {"colon", R"([{"op":"remove","path":"/tissues/fat"}])", "tissues.fat", "missing"},
        {"colon", R"([{"op":"replace","path":"/tissues","value":[]}])", "tissues", "object"},
        {"colon", R"([{"op":"replace","path":"/tissues/air","value":[-1024]}])", "tissues.air",
         "[lowest, highest]"},
        {"colon", R"([{"op":"replace","path":"/tissues/air","value":[-1024.5,-900]}])",
         "tissues.air", "whole HU"},
        {"colon", R"([{"op":"replace","path":"/tissues/air","value":[-2000,-900]}])", "tissues.air",
         "-1024"},
        {"colon", R"([{"op":"replace","path":"/tissues/air","value":[-900,-950]}])", "tissues.air",
         "from low to high"},
        {"colon", R"([{"op":"replace","path":"/tissues/soft","value":[-90,110]}])", "tissues.soft",
         "overlaps fat"},
        {"colon", R"([{"op":"remove","path":"/organ"}])", "organ", "missing"},
        {"colon", R"([{"op":"replace","path":"/organ","value":""}])", "organ", "text"},
        {"colon", R"([{"op":"replace","path":"/cleanse","value":"yes"}])", "cleanse",
         "true nor false"},
        {"colon", R"([{"op":"replace","path":"/flatten","value":1}])", "flatten", "true nor false"},
        {"vessel", R"([{"op":"add","path":"/flatten","value":true}])", "flatten",
         "needs the topology ball"},
        {"colon", R"([{"op":"replace","path":"/topology","value":"torus"}])", "topology",
         "ball nor any"},
        {"colon", R"([{"op":"replace","path":"/end-points","value":3}])", "end-points", "text"},
        {"colon", R"([{"op":"replace","path":"/end-points","value":"nearest"}])", "end-points",
         "rectum-cecum nor farthest"},
        {"colon", R"([{"op":"replace","path":"/branches","value":0}])", "branches",
         "true nor false"},
        {"colon", R"([{"op":"replace","path":"/lumen/finder","value":"luck"}])", "lumen.finder",
         "gas-and-tagged nor hu-range"},
        {"vessel", R"([{"op":"remove","path":"/lumen/hu"}])", "lumen.hu", "missing"},
        {"vessel", R"([{"op":"replace","path":"/lumen/hu","value":[200,9000]}])", "lumen.hu",
         "3071"},
        {"vessel", R"([{"op":"add","path":"/lumen/opening-mm","value":-1}])", "lumen.opening-mm",
         "between 0 and 50"},
        {"vessel", R"([{"op":"add","path":"/lumen/opening-mm","value":"1"}])", "lumen.opening-mm",
         "number"},
        {"vessel", R"([{"op":"add","path":"/lumen/smoothing-mm","value":11}])",
         "lumen.smoothing-mm", "between 0 and 10"},
        {"vessel", R"([{"op":"replace","path":"/cleanse","value":true}])", "cleanse",
         "gas-and-tagged"},
        {"vessel", R"([{"op":"add","path":"/tissues","value":{}}])", "tissues", "no use"},
    };
    for (const Wrong& wrong : wrongs) {
        const json changed = builtIn(wrong.base).patch(json::parse(wrong.patch));
        const auto profile = parseProfile(changed.dump(), "mine.json");
        ASSERT_FALSE(profile) << wrong.patch;
        const std::string said = describe(profile.error());
        EXPECT_EQ(profile.error().place, "mine.json");
        EXPECT_NE(said.find("field " + std::string(wrong.field) + " "), std::string::npos) << said;
        EXPECT_NE(said.find(wrong.what), std::string::npos) << said;
    }
}

TEST(OrganProfile, WhatIsNoProfileAtAllIsRefused) {
    for (const char* text : {"", "[]", "3", "{", "null", "\xff\xfe"})
        EXPECT_FALSE(parseProfile(text, "mine.json")) << text;
    EXPECT_EQ(readProfile("no-such-organ").error().kind, ErrorKind::notFound);
    EXPECT_NE(readProfile("no-such-organ").error().message.find("colon"), std::string::npos);
    EXPECT_EQ(parseProfile("{\n\"organ\": colon}", "mine.json").error().message,
              "the organ's profile is not JSON: parse error at line 2, column 10");
    EXPECT_NE(readProfile(std::filesystem::temp_directory_path()).error().message.find("a folder"),
              std::string::npos);
    EXPECT_NE(readProfile("/dev/null").error().message.find("empty"), std::string::npos);
}

TEST(OrganProfile, AFileIsReadAsTheBuiltInTextIs) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder / "organ";
    std::ofstream(file) << builtInProfiles().at("bladder");
    const auto profile = readProfile(file);
    ASSERT_TRUE(profile) << describe(profile.error());
    EXPECT_EQ(segmentationOptions(*profile), segmentationOptions(readProfile("bladder").value()));
}

TEST(OrganProfile, TheSegmentationsOptionsTellProfilesApart) {
    std::set<std::string> options;
    const auto add = [&](const json& profile) {
        const auto parsed = parseProfile(profile.dump(), "mine.json");
        ASSERT_TRUE(parsed) << describe(parsed.error());
        EXPECT_TRUE(options.insert(segmentationOptions(*parsed)).second) << profile;
    };
    for (const char* name : {"colon", "bladder", "vessel"})
        add(builtIn(name));
    json changed = builtIn("vessel");
    changed["lumen"]["opening-mm"] = 1e-9;
    add(changed);
    changed["lumen"]["hu"] = {181, 700};
    add(changed);
    changed = builtIn("colon");
    changed["tissues"]["soft"] = {-10, 111};
    add(changed);
}

}  // namespace
}  // namespace haustra::organs
