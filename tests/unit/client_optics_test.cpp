// Optics while a hand changes them: always such as a server takes, kept beside each other, and as
// a preset's file there and back. And as messages there and back.
#include "protocol/optics_message.h"
#include "reader/optics_editor.h"
#include "temporary_folder.h"

#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

OpticsPreset wall() {
    OpticsPreset preset{"wall", "opaque", {}};
    preset.optics.transferFunction.points = {
        {-750.0, {0.9, 0.5, 0.4}, 0.0}, {-550.0, {0.9, 0.6, 0.5}, 0.97}, {250.0, {1, 1, 1}, 1.0}};
    preset.optics.preIntegrated = true;
    return preset;
}

OpticsPreset borders() {
    OpticsPreset preset{"borders", "", {}};
    // A step, and rows of different lengths.
    preset.optics.transferFunction.points = {
        {0.0, {0, 0, 0}, 0.0}, {80.0, {0, 0, 0}, 0.0}, {80.0, {1, 1, 1}, 1.0}, {255.0, {}, 1.0}};
    preset.optics.transferFunction.rows = {
        {60.0, {{-1000.0, {1, 0, 0}, 0.1}, {100.0, {1, 0, 0}, 0.5}}},
        {160.5, {{-1000.0, {0, 1, 0}, 0.0}, {-999.5, {0, 1, 0}, 0.2}, {100.0, {}, 0.5}}}};
    preset.optics.composition = Composition::firstHit;
    preset.optics.light = {30.0, 0.2, 0.7, 0.4, 12.0};
    return preset;
}

TEST(TransferCurves, AddingAPointOnTheCurveChangesNoValue) {
    for (const OpticsPreset& preset : {wall(), borders()}) {
        SCOPED_TRACE(preset.name);
        const TransferCurve before(preset.optics.transferFunction.points);
        TransferCurve after = before;
        const double hu = 0.3 * before.points().front().hu + 0.7 * before.points().back().hu;
        const std::size_t point = after.add(hu, before.at(hu).opacity);
        EXPECT_EQ(after.points()[point].hu, hu);
        EXPECT_EQ(after.points().size(), before.points().size() + 1);
        for (double x = -1100.0; x < 400.0; x += 13.7) {
            EXPECT_NEAR(after.at(x).opacity, before.at(x).opacity, 1e-12);
            EXPECT_NEAR(glm::distance(after.at(x).color, before.at(x).color), 0.0, 1e-12);
        }
        ASSERT_TRUE(after.remove(point));
        EXPECT_EQ(after.points(), before.points());
    }
}

TEST(OpticsEditor, HoldsWhatAServerTakesWhateverTheHandDoes) {
    std::mt19937 random(7);
    const auto within = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    OpticsEditor editor;
    EXPECT_TRUE(checkOptics(editor.optics()));
    editor.offer({wall(), borders()});
    std::size_t mostRows = 0, mostPoints = 0;
    for (int n = 0; n < 20'000; ++n) {
        TransferCurve curve = editor.curve();
        const std::size_t point = random() % curve.points().size();
        switch (random() % 14) {
            case 0:
            case 1:
            case 2:
                curve.add(within(-4e4, 4e4), within(-0.5, 1.5));
                break;
            case 3:
                curve.move(point, random() % 20 ? within(-4e4, 4e4) : NAN, within(-0.5, 1.5));
                break;
            case 4:
                curve.setColor(point, {within(-1, 2), within(-1, 2), within(-1, 2)});
                break;
            case 5:
                curve.remove(point);
                break;
            case 6:
                editor.addRow();
                break;
            case 7:
                if (random() % 2) editor.removeRow();
                break;
            case 8:
                editor.setGradient(random() % 70, random() % 20 ? within(-10, 1e5) : NAN);
                break;
            case 9:
                editor.setComposition(Composition(random() % 3));
                editor.setShading(random() % 2);
                break;
            case 10:
                editor.setPreIntegrated(true);
                break;
            case 11:
                editor.setLight({within(-1, 1e10), within(-1, 20), within(-1, 20), within(-1, 20),
                                 within(-1, 2000)});
                break;
            case 12:
                editor.chooseRow(random() % 70);
                break;
            default:
                if (random() % 50 == 0) editor.backToPreset();
                if (random() % 20 == 0) editor.choose(random() % 3);
        }
        if (editor.curve().points().size() != curve.points().size() || random() % 2)
            editor.setCurve(curve);
        const auto sound = checkOptics(editor.optics());
        ASSERT_TRUE(sound) << "after step " << n << ": " << describe(sound.error());
        ASSERT_LT(editor.row(), editor.rows());
        mostRows = std::max(mostRows, editor.rows());
        mostPoints = std::max(mostPoints, editor.curve().points().size());
    }
    EXPECT_GT(mostRows, 5u);
    EXPECT_GT(mostPoints, 20u);
}

TEST(OpticsEditor, StartsFromEachPresetsOwnPointsAndKeepsChangesBesideEachOther) {
    OpticsEditor editor;
    editor.offer({wall(), borders()});
    EXPECT_EQ(editor.optics(), wall().optics);
    EXPECT_EQ(editor.choice(), OpticsChoice("wall"));
    const auto before = editor.revision();
    TransferCurve curve = editor.curve();
    curve.move(1, -500.0, 0.5);
    editor.setCurve(curve);
    EXPECT_GT(editor.revision(), before);
    EXPECT_TRUE(editor.isChanged(0));
    EXPECT_EQ(editor.choice(), OpticsChoice(editor.optics()));
    const Optics changed = editor.optics();

    ASSERT_TRUE(editor.choose("borders"));
    EXPECT_EQ(editor.optics(), borders().optics);
    EXPECT_FALSE(editor.choose("marble"));
    EXPECT_EQ(editor.chosen(), 1u);
    ASSERT_TRUE(editor.choose("wall"));
    EXPECT_EQ(editor.optics(), changed);
    editor.backToPreset();
    EXPECT_EQ(editor.choice(), OpticsChoice("wall"));
}

TEST(OpticsEditor, ARowMoreIsOfTheRowBeforeUntilItIsChanged) {
    OpticsEditor editor;
    editor.offer({wall()});
    ASSERT_TRUE(editor.addRow());
    EXPECT_FALSE(editor.optics().preIntegrated);
    EXPECT_EQ(editor.row(), 1u);
    EXPECT_EQ(editor.curve().points(), wall().optics.transferFunction.points);
    editor.setGradient(1, 200.0);
    editor.chooseRow(0);
    ASSERT_TRUE(editor.addRow());  // between 0 and 200
    EXPECT_EQ(editor.gradientOf(1), 100.0);
    editor.setGradient(1, 1000.0);
    EXPECT_LT(editor.gradientOf(1), 200.0);
    EXPECT_TRUE(editor.removeRow());
    EXPECT_EQ(editor.row(), 0u);
    EXPECT_FALSE(editor.removeRow());
    EXPECT_EQ(editor.rows(), 2u);
}

TEST(OpticsEditor, SavesAndOpensPresetsFiles) {
    namespace fs = std::filesystem;
    const tests::TemporaryFolder temporary;
    const fs::path folder = temporary.path();
    OpticsEditor editor;
    editor.offer({wall(), borders()});
    ASSERT_TRUE(editor.choose("borders"));
    editor.chooseRow(1);
    TransferCurve curve = editor.curve();
    curve.add(12.25, 1.0 / 3.0);
    editor.setCurve(curve);
    const Optics made = editor.optics();
    ASSERT_TRUE(editor.save(folder / "mine.json"));
    EXPECT_EQ(editor.preset(editor.chosen()).name, "mine");
    EXPECT_EQ(editor.choice(), OpticsChoice(made));  // no server knows it by its name
    EXPECT_EQ(editor.presets(), 3u);
    const auto read = readPresetFile(folder / "mine.json");
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(read->optics, made);
    EXPECT_EQ(read->name, "mine");

    OpticsEditor other;
    other.offer({wall()});
    ASSERT_TRUE(other.open(folder / "mine.json"));
    EXPECT_EQ(other.optics(), made);
    EXPECT_EQ(other.choice(), OpticsChoice(made));
    ASSERT_TRUE(other.open(folder / "mine.json"));
    EXPECT_EQ(other.presets(), 2u);

    EXPECT_FALSE(editor.save(folder / "of mine.json"));
    EXPECT_FALSE(editor.save(folder / "mine.txt"));
    EXPECT_FALSE(editor.save(folder / "none" / "mine.json"));
    EXPECT_FALSE(editor.open(folder / "none.json"));
    std::ofstream(folder / "broken.json") << "{";
    EXPECT_FALSE(editor.open(folder / "broken.json"));
    EXPECT_EQ(editor.optics(), made);
}

TEST(OpticsMessage, GoesThereAndBack) {
    for (const OpticsPreset& preset : {wall(), borders()}) {
        protocol::OpticsPreset message;
        protocol::fill(message, preset);
        protocol::fill(message, preset);  // replaces what was there
        const auto back = protocol::presetFrom(message);
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_EQ(*back, preset);
        message.set_name("../x");
        EXPECT_FALSE(protocol::presetFrom(message));
    }
}

}  // namespace
}  // namespace haustra::reader
