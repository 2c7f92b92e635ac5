// Presets: the built-in ones, files that are and are not presets, and a folder of them.
#include "render/optics/optics_presets.h"

#include "temporary_folder.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/stat.h>

namespace haustra::render {
namespace {

namespace fs = std::filesystem;

constexpr const char* sound = R"({"name": "test-1", "points": [
    {"hu": 0, "color": [0, 0, 0], "opacity": 0}, {"hu": 10, "color": [1, 1, 1], "opacity": 1}]})";

TEST(OpticsPresets, AllFilesAreBuiltInUnderTheirNames) {
    ASSERT_FALSE(builtInPresets().empty());
    EXPECT_EQ(builtInPresets().front().name, "mucosa");
    const fs::path folder =
        fs::path(std::getenv("HAUSTRA_SOURCE")) / "server/render/optics/presets";
    std::size_t files = 0;
    for (const auto& file : fs::directory_iterator(folder)) {
        ++files;
        EXPECT_TRUE(opticsPreset(file.path().stem().string())) << file.path();
    }
    EXPECT_EQ(builtInPresets().size(), files);
    for (const OpticsPreset& preset : builtInPresets())
        EXPECT_FALSE(preset.description.empty()) << preset.name;
}

TEST(OpticsPresets, TextGoesThereAndBack) {
    for (const OpticsPreset& preset : builtInPresets()) {
        const auto again = parsePreset(presetText(preset), "text");
        ASSERT_TRUE(again) << describe(again.error());
        EXPECT_EQ(again->name, preset.name);
        EXPECT_EQ(again->description, preset.description);
        EXPECT_EQ(again->optics, preset.optics) << preset.name;
    }
}

TEST(OpticsPresets, WhatIsMissingHasTheDefault) {
    const auto preset = parsePreset(sound, "text");
    ASSERT_TRUE(preset);
    Optics expected;
    expected.transferFunction.points = {{0.0, glm::dvec3(0.0), 0.0}, {10.0, glm::dvec3(1.0), 1.0}};
    EXPECT_EQ(preset->optics, expected);
}

TEST(OpticsPresets, HaveAtMostSoManyPointsInAllRows) {
    Optics optics;
    auto& function = optics.transferFunction;
    for (int n = 0; n < 64; ++n)
        function.points.push_back({double(n), glm::dvec3(1.0), 0.5});
    for (int n = 1; n < 16; ++n)
        function.rows.push_back({double(n), function.points});
    EXPECT_TRUE(checkOptics(optics));
    function.rows.back().points.push_back({64.0, glm::dvec3(1.0), 0.5});
    const auto refused = checkOptics(optics);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("1024"), std::string::npos);
}

TEST(OpticsPresets, SaysWhatIsWrongAndWhere) {
    const auto with = [](const std::string& from, const std::string& to) {
        std::string text = sound;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    const std::pair<std::string, const char*> bad[] = {
        {"", "JSON"},
        {"[]", "object"},
        {with("}]}", "}]"), "JSON"},
        {with("test-1", ""), "name"},
        {with("test-1", "../x"), "name"},
        {with("\"points\"", "\"point\""), "unknown key \"point\""},
        {with("\"opacity\": 0", "\"opacity\": \"0\""), "opacity"},
        {with("[0, 0, 0]", "[0, 0]"), "color"},
        {with("\"hu\": 0", "\"hu\": 20"), "lower HU"},
        {with("\"opacity\": 1}", "\"opacity\": 1.5}"), "opacity outside"},
        {with("\"name\"", "\"composition\": \"x-ray\", \"name\""), "composition"},
        {with("\"name\"", "\"shading\": 1, \"name\""), "shading"},
        {with("\"name\"", "\"light\": {\"ambient\": 1}, \"name\""), "halfDepthMm"},
        {with("\"name\"", "\"rows\": [{\"gradientHuPerMm\": 5}], \"name\""), "points"},
        {std::string(100000, '['), "JSON"},
    };
    for (const auto& [text, words] : bad) {
        const auto made = parsePreset(text, "place.json");
        ASSERT_FALSE(made) << words;
        EXPECT_EQ(made.error().kind, ErrorKind::badInput);
        EXPECT_EQ(made.error().place, "place.json");
        EXPECT_NE(made.error().message.find(words), std::string::npos) << made.error().message;
    }
}

class PresetFolder : public testing::Test {
protected:
    void write(const char* name, const std::string& text) const {
        std::ofstream(folder / name) << text;
    }
    const tests::TemporaryFolder temporary;
    const fs::path folder = temporary.path();
};

TEST_F(PresetFolder, AddsToTheBuiltInOnesAndReplacesThem) {
    std::string mucosa = sound;
    mucosa.replace(mucosa.find("test-1"), 6, "mucosa");
    write("a.json", mucosa);
    write("b.json", sound);
    write("c.json", "{");
    write("d.json", sound);
    write("notes.txt", "not read");
    const auto library = readPresets(folder);
    ASSERT_TRUE(library);
    EXPECT_EQ(library->presets.size(), builtInPresets().size() + 1);
    EXPECT_EQ(library->presets.front().name, "mucosa");
    EXPECT_EQ(library->find("mucosa")->optics.transferFunction.points.size(), 2u);
    EXPECT_TRUE(library->find("test-1"));
    EXPECT_FALSE(library->find("test-2"));
    ASSERT_EQ(library->refused.size(), 2u);
    EXPECT_EQ(library->refused[0].place, "c.json");
    EXPECT_EQ(library->refused[1].place, "d.json");
}

TEST_F(PresetFolder, HoldsNoMoreThanOneMessageDoes) {
    std::string text = sound;
    for (std::size_t n = 0; n < mostPresets; ++n) {
        const std::string name = "own-" + std::to_string(100 + n);
        std::string one = text;
        write((name + ".json").c_str(), one.replace(one.find("test-1"), 6, name));
    }
    const auto library = readPresets(folder);
    ASSERT_TRUE(library);
    EXPECT_EQ(library->presets.size(), mostPresets);
    ASSERT_EQ(library->refused.size(), builtInPresets().size());
    EXPECT_NE(library->refused[0].message.find("64"), std::string::npos);
}

TEST_F(PresetFolder, FilesAreWrittenWholeAndReadBack) {
    for (const OpticsPreset& preset : builtInPresets()) {
        ASSERT_TRUE(writePresetFile(folder / "a.json", preset));
        const auto read = readPresetFile(folder / "a.json");
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_EQ(*read, preset);
    }
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
    EXPECT_FALSE(writePresetFile(folder / "none" / "a.json", builtInPresets().front()));
    write("b.json", std::string((1 << 20) + 1, ' '));
    const auto tooLong = readPresetFile(folder / "b.json");
    ASSERT_FALSE(tooLong);
    EXPECT_EQ(tooLong.error().kind, ErrorKind::badInput);
}

TEST_F(PresetFolder, APipeInItIsNotWaitedFor) {
    ASSERT_EQ(::mkfifo((folder / "pipe.json").c_str(), 0600), 0);
    write("sound.json", sound);
    const auto library = readPresets(folder);
    ASSERT_TRUE(library);
    ASSERT_EQ(library->refused.size(), 1u);
    EXPECT_EQ(library->refused[0].place, "pipe.json");
    EXPECT_EQ(library->presets.size(), builtInPresets().size() + 1);
}

TEST_F(PresetFolder, ThatIsNotThereIsAFailure) {
    const auto library = readPresets(folder / "none");
    ASSERT_FALSE(library);
    EXPECT_EQ(library.error().kind, ErrorKind::io);
}

}  // namespace
}  // namespace haustra::render
