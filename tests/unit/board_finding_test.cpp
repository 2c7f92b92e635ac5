// Boards in pictures that are drawn through a fisheye: every point, to a fraction of a pixel; and
// from such pictures the lens that drew them.
#include "board_scenes.h"
#include "coverage/board.h"
#include "coverage/calibrate.h"

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace haustra::coverage {
namespace {

using tests::BoardPainter, tests::BoardPose, tests::facing;

struct Scene {
    Board board;
    double dotRadiusMm;
};
const std::vector<Scene>& scenes() {
    static const std::vector<Scene> all{{{BoardPattern::checkerboard, {9, 8}, 5.0}, 0.0},
                                        {{BoardPattern::dots, {8, 7}, 5.0}, 1.5},
                                        {{BoardPattern::asymmetricDots, {4, 9}, 3.6}, 1.6}};
    return all;
}

const BoardPainter& olympus() {
    static const BoardPainter painter(olympusCfQ160l());
    return painter;
}

BoardPose poseOf(const Board& board, int n) {
    return facing(board, 36.0 - 1.5 * n, 7.0 * n, 100.0 * n,
                  {22.0 * std::cos(2.0 * n), 22.0 * std::sin(2.0 * n), 40.0 * n});
}

/// Root mean square of the distances to the nearest true point; a failure where two found points
/// have the same one.
double errorOf(const BoardView& view, const std::vector<glm::dvec2>& truth) {
    double squares = 0.0;
    std::set<std::size_t> taken;
    for (const glm::dvec2 pixel : view.pixels) {
        std::size_t nearest = 0;
        for (std::size_t n = 1; n < truth.size(); ++n)
            if (glm::distance(pixel, truth[n]) < glm::distance(pixel, truth[nearest])) nearest = n;
        EXPECT_TRUE(taken.insert(nearest).second);
        squares += glm::dot(pixel - truth[nearest], pixel - truth[nearest]);
    }
    return std::sqrt(squares / double(view.pixels.size()));
}

/// Of points well within the open part and the picture: none of those may be missed.
int wellShown(const Colonoscope& scope, const std::vector<glm::dvec2>& shown, double marginPixels) {
    return int(std::count_if(shown.begin(), shown.end(), [&](glm::dvec2 p) {
        const glm::dvec2 in = (p - scope.openCenter) / (scope.openRadii - marginPixels);
        return glm::dot(in, in) < 1.0 && p.x >= marginPixels && p.y >= marginPixels &&
               p.x <= scope.pictureSize.x - 1 - marginPixels &&
               p.y <= scope.pictureSize.y - 1 - marginPixels;
    }));
}

std::vector<glm::dvec2> shownPoints(const FisheyeLens& lens, const Board& board,
                                    const BoardPose& pose) {
    std::vector<glm::dvec2> shown;
    for (const glm::dvec2 place : tests::placesOf(board))
        shown.push_back(pixelOf(lens, pose(place)).value());
    return shown;
}

// From drawn pictures, end to end: all points are found, and the source's lens comes back.
TEST(BoardFinding, DrawnBoardsGiveBackTheLensThatDrewThem) {
    const Colonoscope scope = olympusCfQ160l();
    for (const Scene& scene : scenes()) {
        const std::string name = textOf(scene.board);
        std::vector<BoardView> views;
        std::vector<Image> pictures;
        for (int n = 0; n < 5; ++n) {
            const BoardPose pose = poseOf(scene.board, n);
            pictures.push_back(
                olympus().paint(scene.board, pose, scene.dotRadiusMm, 2.0, unsigned(n)));
            const auto view = findBoard(pictures.back(), scene.board);
            ASSERT_TRUE(view) << name << " " << n << ": " << describe(view.error());
            const auto shown = shownPoints(scope.lens, scene.board, pose);
            EXPECT_GE(int(view->pixels.size()), wellShown(scope, shown, 25.0)) << name << " " << n;
            if (n == 0) {
                EXPECT_EQ(int(view->pixels.size()), pointCount(scene.board)) << name;
            }
            // A disc's picture has its centre off its centre's picture.
            const bool corners = scene.board.pattern == BoardPattern::checkerboard;
            EXPECT_LT(errorOf(*view, shown), corners ? 0.1 : 0.5) << name << " " << n;
            views.push_back(*view);
        }
        const auto field = findField(pictures);
        ASSERT_TRUE(field) << describe(field.error());
        CalibrationOptions options;
        options.model = findLensModel("kannala-brandt");
        options.pictureSize = scope.pictureSize;
        options.field = *field;
        options.pixelsPerMm = scope.lens.mu;
        const auto fit = calibrate(views, options);
        ASSERT_TRUE(fit) << describe(fit.error());
        std::printf(
            "%s: RMS %.3f; k1 %.4f ± %.4f, k2 %.4f ± %.4f, m_v %.4f ± %.4f, u0 %.3f ± "
            "%.3f, v0 %.3f ± %.3f\n",
            name.c_str(), fit->rmsPixels, fit->lens.k[0], fit->standardErrors[0], fit->lens.k[1],
            fit->standardErrors[1], fit->lens.mv, fit->standardErrors[6], fit->lens.u0,
            fit->standardErrors[7], fit->lens.v0, fit->standardErrors[8]);
        EXPECT_LT(fit->rmsPixels, 0.15) << name;
        for (const double degrees : {10.0, 30.0, 50.0, 65.0}) {
            const double theta = glm::radians(degrees);
            EXPECT_NEAR(radiusOf(fit->lens, theta) / radiusOf(scope.lens, theta), 1.0, 0.004)
                << name << " " << degrees;
        }
        EXPECT_LT(glm::distance(glm::dvec2(fit->lens.u0, fit->lens.v0),
                                glm::dvec2(scope.lens.u0, scope.lens.v0)),
                  1.0)
            << name;
        EXPECT_NEAR(fit->dotRadiusMm, scene.dotRadiusMm, 0.1) << name;
    }
}

// Without distortion OpenCV's own finders see the same points.
TEST(BoardFinding, OpenCvsFindersSeeTheSamePoints) {
    Colonoscope camera = olympusCfQ160l();
    camera.lens = {{1, 0, 0, 0, 0}, 420.0, 420.0, 262.0, 219.5, Projection::perspective};
    camera.openRadii = {1000.0, 1000.0};
    const BoardPainter painter(camera);
    for (const Scene& scene : scenes()) {
        const BoardPose pose = facing(scene.board, 75.0, 4.0, 30.0, {15.0, -20.0, 10.0});
        const Image picture = painter.paint(scene.board, pose, scene.dotRadiusMm, 1.0, 3);
        const auto view = findBoard(picture, scene.board);
        ASSERT_TRUE(view) << describe(view.error());
        const cv::Mat rgb(picture.height, picture.width, CV_8UC3,
                          const_cast<std::uint8_t*>(picture.rgb.data()));
        cv::Mat grey;
        cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
        std::vector<cv::Point2f> points;
        const cv::Size count(scene.board.count.x, scene.board.count.y);
        const bool seen = scene.board.pattern == BoardPattern::checkerboard
                              ? cv::findChessboardCornersSB(grey, count - cv::Size(1, 1), points,
                                                            cv::CALIB_CB_ACCURACY)
                              : cv::findCirclesGrid(grey, count, points,
                                                    scene.board.pattern == BoardPattern::dots
                                                        ? cv::CALIB_CB_SYMMETRIC_GRID
                                                        : cv::CALIB_CB_ASYMMETRIC_GRID);
        ASSERT_TRUE(seen) << textOf(scene.board);
        std::vector<glm::dvec2> theirs;
        for (const cv::Point2f& point : points)
            theirs.emplace_back(point.x, point.y);
        ASSERT_EQ(view->pixels.size(), theirs.size());
        EXPECT_LT(errorOf(*view, theirs), 0.25) << textOf(scene.board);
        // And ours are no further from the truth than theirs.
        const auto truth = shownPoints(camera.lens, scene.board, pose);
        BoardView opencv;
        opencv.pixels = theirs;
        EXPECT_LT(errorOf(*view, truth), errorOf(opencv, truth) + 0.02) << textOf(scene.board);
    }
}

// A board that the picture cuts is a view; what is less than half, another board or none is
// refused with what was seen.
TEST(BoardFinding, PartsAreViewsAndWhatIsNoBoardIsNamed) {
    const Board board = scenes()[0].board;
    const BoardPose beside = facing(board, 28.0, 40.0, 0.0, {0, 10, 0});
    const auto part = findBoard(olympus().paint(board, beside, 0.0, 2.0, 1), board);
    ASSERT_TRUE(part) << describe(part.error());
    EXPECT_LT(int(part->pixels.size()), pointCount(board));
    EXPECT_GE(2 * int(part->pixels.size()), pointCount(board));
    EXPECT_LT(errorOf(*part, shownPoints(olympusCfQ160l().lens, board, beside)), 0.15);

    const auto refused = [](const Image& picture, const Board& wanted) {
        const auto none = findBoard(picture, wanted);
        ASSERT_FALSE(none);
        EXPECT_EQ(none.error().kind, ErrorKind::noResult);
        EXPECT_NE(none.error().message.find(textOf(wanted)), std::string::npos);
        EXPECT_NE(none.error().message.find("at most"), std::string::npos);
    };
    refused(blankImage({200, 160}), board);
    const Image squares = olympus().paint(board, poseOf(board, 1), 0.0, 2.0, 1);
    refused(squares, scenes()[1].board);
    refused(squares, {BoardPattern::checkerboard, {20, 20}, 5.0});
    Image noise = blankImage({300, 300});
    std::mt19937 random(7);
    for (auto& byte : noise.rgb)
        byte = std::uint8_t(random());
    refused(noise, board);
    refused(noise, scenes()[2].board);
    EXPECT_FALSE(findField({noise}));
}

TEST(BoardFinding, BoardsAreNamedOrRefused) {
    for (const char* text : {"checkerboard:8x7", "dots:3x20", "asymmetric-dots:3x11"}) {
        const auto board = boardOfText(text);
        ASSERT_TRUE(board) << text;
        EXPECT_EQ(textOf(*board), text);
    }
    EXPECT_EQ(pointCount(*boardOfText("checkerboard:8x7")), 42);
    EXPECT_EQ(pointCount(*boardOfText("asymmetric-dots:3x11")), 33);
    for (const char* text : {"", "dots", "dots:", "dots:3", "dots:3x", "dots:3x4x5", "dots:x",
                             "dots:2x9", "checkerboard:3x8", "dots:-3x5", "dots:3 x5", "dots:201x5",
                             "rings:5x5", "dots:99999999999x5", "dots:3x5 "})
        EXPECT_FALSE(boardOfText(text)) << text;
}

}  // namespace
}  // namespace haustra::coverage
