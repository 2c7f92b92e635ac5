// Which way a picture lies in the patient, and its scales.
#include "cli/caption.h"

#include "flat_tube.h"

#include <cmath>

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
        return caption("p", frame, {200, 200});
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
        const pictures::Marks marks = caption("", frame, {512, 400});
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
    const pictures::Marks marks = stripCaption(map, size);
    ASSERT_GT(marks.lines.size(), 2u);
    double before = -1.0;
    int row = size.y + 1;
    std::size_t line = 0;
    for (const auto& words : marks.words) {
        if (!words.text.ends_with(" mm")) continue;
        const double arc = std::stod(words.text);
        EXPECT_GT(arc, before);
        EXPECT_LT(words.at.y, row);
        EXPECT_EQ(words.at.y, marks.lines[line++].from.y);
        before = arc;
        row = words.at.y;
    }
    EXPECT_EQ(line, marks.lines.size());
    EXPECT_LE(before, map.cameras.back().arcMm);
}

}  // namespace
}  // namespace haustra::cli
