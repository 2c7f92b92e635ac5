// Which way a picture lies in the patient, and its scales.
#include "cli/caption.h"

#include "flat_tube.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::cli {
namespace {

/// Of the words at an edge of a picture of `size`.
std::string wordsAt(const pictures::Marks& marks, glm::dvec2 anchor) {
    std::string text;
    for (const auto& words : marks.words)
        if (words.anchor == anchor) text += words.text;
    return text;
}

struct Box {
    glm::dvec2 low, high;
};
Box boxOf(const pictures::Marks& marks, const pictures::Marks::Words& words) {
    const glm::dvec2 size(pictures::textWidth(words.text, marks.textHeight).value(),
                          marks.textHeight);
    const glm::dvec2 low = glm::dvec2(words.at) - words.anchor * size;
    return {low, low + size};
}

/// With a pixel of rim around each, no two words touch, and none leaves its panel of `size`.
void expectReadable(const pictures::Marks& marks, glm::ivec2 size, const std::string& picture) {
    std::vector<Box> boxes;
    for (const auto& words : marks.words) {
        const Box box = boxOf(marks, words);
        const int step = size.x + pictures::separatorPixels, left = words.at.x / step * step;
        EXPECT_GE(box.low.x, left + 1) << words.text << picture;
        EXPECT_LE(box.high.x, left + size.x - 1) << words.text << picture;
        EXPECT_GE(box.low.y, 1) << words.text << picture;
        EXPECT_LE(box.high.y, size.y - 1) << words.text << picture;
        for (std::size_t n = 0; n < boxes.size(); ++n)
            EXPECT_TRUE(box.low.x >= boxes[n].high.x + 2 || boxes[n].low.x >= box.high.x + 2 ||
                        box.low.y >= boxes[n].high.y + 2 || boxes[n].low.y >= box.high.y + 2)
                << words.text << " on " << marks.words[n].text << picture;
        boxes.push_back(box);
    }
}

int count(const pictures::Marks& marks, const std::string& text) {
    return int(std::count_if(marks.words.begin(), marks.words.end(),
                             [&](const auto& words) { return words.text == text; }));
}

// Whatever the size of the picture and the length of the case's name.
TEST(Caption, WordsDoNotTouchAndDirectionsAreAlwaysThere) {
    PictureFrame oblique;
    oblique.right = glm::normalize(glm::dvec3(1.0, 0.8, 0.1));
    oblique.down = glm::normalize(glm::cross(glm::dvec3(0.1, 0.1, 1.0), oblique.right));
    for (const glm::ivec2 size : {glm::ivec2(60, 60),
                                  {80, 60},
                                  {60, 400},
                                  {256, 256},
                                  {512, 512},
                                  {2048, 300},
                                  {300, 2048},
                                  {2048, 2048}})
        for (const std::string& name :
             {std::string("p"), std::string("Ab.cd_long-case-name.prone-2024-11-29"),
              std::string(120, 'W')})
            for (const PictureFrame& frame : {PictureFrame{}, oblique}) {
                const std::string picture =
                    " of " + name + " " + std::to_string(size.x) + "x" + std::to_string(size.y);
                const auto one = caption(name + "  axial  400 mm", frame, size).value(),
                           three = comparisonCaption(name + "  axial", frame, size).value();
                expectReadable(one, size, picture);
                expectReadable(three, size, picture);
                for (const glm::dvec3 direction :
                     {frame.right, -frame.right, frame.down, -frame.down}) {
                    EXPECT_EQ(count(one, orientation(direction)), 1) << picture;
                    EXPECT_EQ(count(three, orientation(direction)), 3) << picture;
                }
                for (const char* title : {"before", "tissues", "after"})
                    EXPECT_EQ(count(three, title), 1) << picture;
            }
}

TEST(Caption, ALineThatIsTooLongKeepsItsBeginningAndItsEnd) {
    std::string line(200, 'x');
    line.front() = 'A';
    line += "  axial  400 mm";
    const auto marks = caption(line, {}, {200, 100}).value();
    ASSERT_EQ(marks.words.size(), 1u);
    const std::string& text = marks.words.front().text;
    EXPECT_TRUE(text.starts_with("Ax")) << text;
    EXPECT_NE(text.find("..."), std::string::npos) << text;
    EXPECT_TRUE(text.ends_with("400 mm")) << text;
    EXPECT_GT(boxOf(marks, marks.words.front()).high.x, 150.0);  // no shorter than need be
}

// Of findings that lie side by side numbers have no room; rings say all the same where they are.
TEST(Caption, RingsAFindingAndNumbersItWhereItCanBeRead) {
    const glm::ivec2 size(400, 300);
    std::vector<NumberedPlace> places{{1, {100.0, 80.0}}, {2, {398.0, 100.0}}, {3, {500.0, 10.0}}};
    for (int n = 0; n < 12; ++n)
        places.push_back({10 + n, {200.0 + 3 * (n % 4), 150.0 + 3 * (n / 4)}});
    const pictures::Marks bare = caption("p", PictureFrame{}, size).value(),
                          marks = caption("p", PictureFrame{}, size, places).value();
    expectReadable(marks, size, "");
    EXPECT_EQ(count(marks, "1"), 1);
    EXPECT_EQ(count(marks, "2"), 1) << "to the left of its ring, at the picture's edge";
    EXPECT_EQ(count(marks, "3"), 0) << "it is not in the picture";
    EXPECT_LT(marks.words.size(), bare.words.size() + places.size() - 1);
    // A ring over words leaves them to be read.
    const pictures::Marks over =
        caption("a finding lies here", PictureFrame{}, size, {{7, {30.0, 12.0}}}).value();
    expectReadable(over, size, "");
    for (std::size_t n = bare.lines.size(); n < over.lines.size(); ++n)
        for (const auto& words : over.words) {
            const Box box = boxOf(over, words);
            const glm::dvec2 middle = 0.5 * glm::dvec2(over.lines[n].from + over.lines[n].to);
            EXPECT_FALSE(glm::all(glm::greaterThan(middle, box.low)) &&
                         glm::all(glm::lessThan(middle, box.high)))
                << words.text;
        }
    EXPECT_GT(over.lines.size(), bare.lines.size()) << "but what of it does not";
    // No number lies on a ring, of whatever finding.
    for (const auto& words : marks.words) {
        if (words.text.find_first_not_of("0123456789") != std::string::npos) continue;
        const Box box = boxOf(marks, words);
        for (std::size_t n = bare.lines.size(); n < marks.lines.size(); ++n)
            EXPECT_FALSE(glm::all(glm::greaterThan(glm::dvec2(marks.lines[n].from), box.low)) &&
                         glm::all(glm::lessThan(glm::dvec2(marks.lines[n].from), box.high)))
                << words.text;
    }
    // Each ring closes around its place.
    std::vector<pictures::Marks::Line> rings(
        marks.lines.begin() + std::ptrdiff_t(bare.lines.size()), marks.lines.end());
    ASSERT_EQ(rings.size() % (places.size() - 1), 0u);
    const std::size_t corners = rings.size() / (places.size() - 1);
    for (std::size_t n = 0; n < rings.size(); n += corners) {
        const std::size_t drawn = n / corners;
        const glm::dvec2 at = places[drawn < 2 ? drawn : drawn + 1].pixel;
        EXPECT_EQ(rings[n].from, rings[n + corners - 1].to);
        const double radius = glm::distance(glm::dvec2(rings[n].from), at);
        for (std::size_t corner = n; corner < n + corners; ++corner)
            EXPECT_NEAR(glm::distance(glm::dvec2(rings[corner].to), at), radius, 1.5);
    }
}

TEST(Caption, LettersSayWhereDirectionsPoint) {
    EXPECT_EQ(orientation({1, 0, 0}), "L");
    EXPECT_EQ(orientation({-1, 0, 0}), "R");
    EXPECT_EQ(orientation({0, 1, 0}), "P");
    EXPECT_EQ(orientation({0, -1, 0}), "A");
    EXPECT_EQ(orientation({0, 0, 1}), "H");
    EXPECT_EQ(orientation({0, 0, -1}), "F");
    EXPECT_EQ(orientation({0.2, -0.1, 0.97}), "H");
    EXPECT_EQ(orientation({0.6, -0.1, -0.8}), "FL");
}

// The radiological convention: the patient's left on an axial slice's right, the front above.
TEST(Caption, SlicesAreSeenAsRadiologistsDo) {
    const Grid grid = axisAlignedGrid({50, 40, 60}, {0.8, 0.8, 1.5});
    const auto marksOf = [&](View plane) {
        const SliceView view{plane, grid.patientFromVoxelPoint({25, 20, 30}), 1.0, {}};
        const PictureFrame frame = frameOf(*placeSlice(view, grid, 200, 200));
        EXPECT_NEAR(glm::length(frame.right), 1.0, 1e-12);
        return caption("p", frame, {200, 200}).value();
    };
    const glm::dvec2 left(0.0, 0.5), right(1.0, 0.5), top(0.5, 0.0), bottom(0.5, 1.0);
    const pictures::Marks axial = marksOf(View::axial), coronal = marksOf(View::coronal),
                          sagittal = marksOf(View::sagittal);
    EXPECT_EQ(wordsAt(axial, left) + wordsAt(axial, right), "RL");
    EXPECT_EQ(wordsAt(axial, top) + wordsAt(axial, bottom), "AP");
    EXPECT_EQ(wordsAt(coronal, left) + wordsAt(coronal, right), "RL");
    EXPECT_EQ(wordsAt(coronal, top) + wordsAt(coronal, bottom), "HF");
    EXPECT_EQ(wordsAt(sagittal, left) + wordsAt(sagittal, right), "AP");
    EXPECT_EQ(wordsAt(sagittal, top) + wordsAt(sagittal, bottom), "HF");
}

TEST(Caption, TheBarIsAsLongAsItSays) {
    for (const double mmPerPixel : {0.013, 0.2, 0.77, 3.1}) {
        PictureFrame frame;
        frame.mmPerPixel = mmPerPixel;
        const pictures::Marks marks = caption("", frame, {512, 400}).value();
        double mm = 0.0;
        for (const auto& words : marks.words)
            if (words.text.ends_with(" mm")) mm = std::stod(words.text);
        const auto& bar = marks.lines.front();
        EXPECT_GT(mm, 0.0);
        EXPECT_NEAR((bar.to.x - bar.from.x) * mmPerPixel, mm, 0.51 * mmPerPixel);
        EXPECT_LE(bar.to.x - bar.from.x, 128);
        EXPECT_GE(bar.to.x - bar.from.x, 50);
    }
}

TEST(Caption, OnlyParallelRaysHaveAScale) {
    Camera camera;
    EXPECT_FALSE(frameOf(camera, 100));
    camera.lens = Lens::orthographic;
    camera.heightMm = 50.0;
    const auto frame = frameOf(camera, 100);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->mmPerPixel, 0.5);
    EXPECT_EQ(orientation(frame->right), "L");
    EXPECT_EQ(orientation(frame->down), "P");
}

TEST(Caption, TheStripsScaleRunsFromTheRectumUp) {
    const FlatMap map = tests::FlatTube().map();
    const glm::ivec2 size(300, int(300 * map.height));
    const pictures::Marks marks = stripCaption(map, size).value();
    ASSERT_GT(marks.lines.size(), 2u);
    double before = -1.0;
    int row = size.y + 1;
    std::size_t line = 0;
    for (const auto& words : marks.words) {
        if (!words.text.ends_with(" mm")) continue;
        const double arc = std::stod(words.text);
        EXPECT_GT(arc, before);
        EXPECT_LT(words.at.y, row);
        EXPECT_NEAR(words.at.y, marks.lines[line++].from.y, marks.textHeight);
        before = arc;
        row = words.at.y;
    }
    EXPECT_EQ(line, marks.lines.size());
    EXPECT_LE(before, map.cameras.back().arcMm);
}

// Half of the colon in a hundredth of the strip.
TEST(Caption, TheStripsScaleCanBeReadWhereTheMapIsSqueezed) {
    FlatMap map = tests::FlatTube().map();
    for (glm::dvec2& place : map.flat) {
        const double up = place.y / map.height;
        place.y = map.height * (up < 0.5 ? 0.02 * up : 0.01 + 1.98 * (up - 0.5));
    }
    const glm::ivec2 size(300, 900);
    const pictures::Marks marks = stripCaption(map, size).value();
    expectReadable(marks, size, "");
    EXPECT_GT(marks.lines.size(), 3u);
    EXPECT_EQ(marks.words.size(), marks.lines.size() + 2);  // and the strip's ends
}

}  // namespace
}  // namespace haustra::cli
