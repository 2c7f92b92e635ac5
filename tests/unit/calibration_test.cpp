// Calibration: lenses come back from what they show, within their standard errors; agreement with
// OpenCV; real endoscopes.
#include "board_scenes.h"
#include "coverage/calibrate.h"
#include "coverage/lens_field.h"
#include "data_folder.h"
#include "picture_files.h"

#include <numbers>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace haustra::coverage {
namespace {

namespace fs = std::filesystem;
using tests::BoardPose, tests::facing, tests::viewOf;

CalibrationOptions optionsOf(const char* model, glm::ivec2 size) {
    CalibrationOptions options;
    options.model = findLensModel(model);
    options.pictureSize = size;
    return options;
}

/// A board of 10×10 squares of 5 mm before a colonoscope, from the middle to the edge, tilted.
std::vector<BoardPose> posesOf(const Board& board) {
    std::vector<BoardPose> poses;
    for (int n = 0; n < 8; ++n)
        poses.push_back(facing(board, 45.0 - 2.0 * n, 5.0 * n, 137.0 * n,
                               {25.0 * std::cos(2.0 * n), 25.0 * std::sin(2.0 * n), 31.0 * n}));
    return poses;
}

std::vector<BoardView> viewsOf(const FisheyeLens& lens, glm::ivec2 size, double noisePixels,
                               unsigned seed) {
    const Board board{BoardPattern::checkerboard, {10, 10}, 5.0};
    std::mt19937 random(seed);
    std::vector<BoardView> views;
    for (const BoardPose& pose : posesOf(board)) {
        views.push_back(viewOf(lens, size, board, pose, noisePixels, random));
        EXPECT_GE(views.back().pixels.size(), 40u);
    }
    return views;
}

// The dissertation's lens at 0.1, 0.3 and 1 pixel of noise: errors are within three standard errors
// as often as those of a normal law are, and as large as the standard errors say.
TEST(Calibration, TheSourcesParametersComeBackWithinTheirStandardErrors) {
    const Colonoscope scope = olympusCfQ160l();
    CalibrationOptions options = optionsOf("kannala-brandt", scope.pictureSize);
    options.field = FieldEllipse{scope.openCenter, scope.openRadii};
    options.fieldDegrees = scope.fieldDegrees;
    options.pixelsPerMm = scope.lens.mu;
    const auto truth = numbersOf(scope.lens);
    const std::vector<std::size_t> sought{0, 1, 6, 7, 8};
    constexpr unsigned seeds = 16;
    for (const double noise : {0.1, 0.3, 1.0}) {
        std::vector<double> offs;
        std::size_t beyond = 0;
        for (unsigned seed = 1; seed <= seeds; ++seed) {
            const auto fit =
                calibrate(viewsOf(scope.lens, scope.pictureSize, noise, seed), options);
            ASSERT_TRUE(fit) << describe(fit.error());
            const auto numbers = numbersOf(fit->lens);
            for (const std::size_t n : sought) {
                ASSERT_GT(fit->standardErrors[n], 0.0);
                offs.push_back((numbers[n] - truth[n]) / fit->standardErrors[n]);
                beyond += std::abs(offs.back()) > 3.0;
                if (seed == 1) {
                    EXPECT_LT(std::abs(offs.back()), 3.0) << lensNumberNames()[n] << " " << noise;
                }
            }
            EXPECT_EQ(numbers[5], scope.lens.mu);
            EXPECT_EQ(fit->standardErrors[5], 0.0);
            EXPECT_NEAR(fit->rmsPixels, noise * std::numbers::sqrt2, 0.1 * noise);
            if (seed == 1) {
                std::string line = "noise " + std::to_string(noise) + ":";
                for (const std::size_t n : sought)
                    line += std::string(" ") + lensNumberNames()[n] + " " +
                            std::to_string(numbers[n]) + " ± " +
                            std::to_string(fit->standardErrors[n]);
                std::printf("%s\n", line.c_str());
            }
        }
        double squares = 0.0;
        for (const double off : offs)
            squares += off * off / double(offs.size());
        // 80 of a normal law: 0.2 are expected beyond three; the mean square is 1 ± 0.16, and a
        // lens' numbers are not independent.
        EXPECT_LE(beyond, 2u) << noise;
        EXPECT_GT(std::sqrt(squares), 0.7) << noise;
        EXPECT_LT(std::sqrt(squares), 1.3) << noise;
    }
}

// From whatever nominal values, and whichever number is held, pictures tell the same products.
TEST(Calibration, NominalValuesAndWhatIsHeldChangeNothingThatPicturesShow) {
    const Colonoscope scope = olympusCfQ160l();
    const auto views = viewsOf(scope.lens, scope.pictureSize, 0.2, 4);
    CalibrationOptions plain = optionsOf("kannala-brandt", scope.pictureSize);
    const auto first = calibrate(views, plain);
    ASSERT_TRUE(first) << describe(first.error());
    EXPECT_EQ(first->lens.k[0], 1.0);
    std::vector<CalibrationOptions> others(4, plain);
    others[0].focalMm = 2.8;
    others[0].fieldDegrees = 170.0;
    others[1].pixelsPerMm = 300.0;
    others[1].nominal = Projection::orthogonal;
    others[2].field = FieldEllipse{{250.0, 240.0}, {280.0, 330.0}};
    others[2].fieldDegrees = 110.0;
    others[3].start = olympusCfQ160l().lens;
    for (const CalibrationOptions& options : others) {
        const auto fit = calibrate(views, options);
        ASSERT_TRUE(fit) << describe(fit.error());
        EXPECT_NEAR(fit->rmsPixels, first->rmsPixels, 1e-6);
        EXPECT_NEAR(fit->focalPixels, first->focalPixels, 1e-3);
        EXPECT_NEAR(fit->focalError, first->focalError, 1e-3 * first->focalError);
        for (const double theta : {0.2, 0.7, 1.2})
            EXPECT_NEAR(fit->lens.mv * radiusOf(fit->lens, theta),
                        first->lens.mv * radiusOf(first->lens, theta), 1e-3);
    }
    EXPECT_EQ(calibrate(views, others[0])->lens.k[0], 2.8);
    EXPECT_EQ(calibrate(views, others[1])->lens.mu, 300.0);
    EXPECT_EQ(calibrate(views, others[3])->lens.mu, scope.lens.mu);
}

// Without noise every model finds its own lens again, from no nominal value at all.
TEST(Calibration, EveryModelFindsItsOwnLens) {
    const glm::ivec2 size(640, 560);
    for (const LensModel& model : lensModels()) {
        FisheyeLens lens{{1.0, 0.0, 0.0, 0.0, 0.0}, 210.0, 205.0, 325.0, 271.0, model.projection};
        constexpr std::array bends{1.0, -0.08, 0.012, -0.002, 0.0004};
        for (int n = 0; n < model.coefficients; ++n)
            lens.k[std::size_t(n)] = bends[std::size_t(n)];
        if (model.projection == Projection::perspective) lens.mu = lens.mv = 330.0;
        if (model.decentring) lens.decentring = {0.002, -0.001};
        const auto fit = calibrate(viewsOf(lens, size, 0.0, 1), optionsOf(model.name, size));
        ASSERT_TRUE(fit) << model.name << ": " << describe(fit.error());
        EXPECT_LT(fit->rmsPixels, 1e-5) << model.name;
        const auto numbers = numbersOf(fit->lens), truth = numbersOf(lens);
        for (std::size_t n = 0; n < lensNumbers; ++n)
            EXPECT_NEAR(numbers[n], truth[n], 1e-3 * std::max(1.0, std::abs(truth[n])) * 0.1)
                << model.name << " " << lensNumberNames()[n];
    }
}

// OpenCV's own solver on the same points ends at the same lens, or at a worse one.
TEST(Calibration, OpenCvsFisheyeEndsAtTheSameLens) {
    const FisheyeLens lens{{1.0, -0.05, 0.01, -0.004, 0.0}, 210.0, 205.0, 325.0, 271.0};
    const glm::ivec2 size(640, 560);
    const auto views = viewsOf(lens, size, 0.3, 9);
    const auto fit = calibrate(views, optionsOf("opencv-fisheye", size));
    ASSERT_TRUE(fit) << describe(fit.error());
    std::vector<std::vector<cv::Point3d>> places;
    std::vector<std::vector<cv::Point2d>> pixels;
    for (const BoardView& view : views) {
        places.emplace_back(), pixels.emplace_back();
        for (std::size_t n = 0; n < view.pixels.size(); ++n) {
            places.back().emplace_back(view.placesMm[n].x, view.placesMm[n].y, 0.0);
            pixels.back().emplace_back(view.pixels[n].x, view.pixels[n].y);
        }
    }
    cv::Matx33d camera;
    cv::Vec4d d;
    const double rms = cv::fisheye::calibrate(
        places, pixels, {size.x, size.y}, camera, d, cv::noArray(), cv::noArray(),
        cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW,
        {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12});
    EXPECT_NEAR(fit->rmsPixels, rms, 1e-4);
    EXPECT_NEAR(fit->lens.mu, camera(0, 0), 0.02);
    EXPECT_NEAR(fit->lens.u0, camera(0, 2), 0.02);
    for (int n = 0; n < 4; ++n)
        EXPECT_NEAR(fit->lens.k[std::size_t(n) + 1], d[n],
                    0.1 * fit->standardErrors[std::size_t(n) + 1]);
}

TEST(Calibration, WhatPicturesDoNotTellIsRefusedOrSaid) {
    const Board board{BoardPattern::checkerboard, {10, 10}, 5.0};
    const FisheyeLens lens = olympusCfQ160l().lens;
    const glm::ivec2 size = olympusCfQ160l().pictureSize;
    std::mt19937 random(1);
    CalibrationOptions options = optionsOf("brown-radial", size);
    const auto wrong = [&](const std::vector<BoardView>& views, ErrorKind kind) {
        const auto fit = calibrate(views, options);
        ASSERT_FALSE(fit);
        EXPECT_EQ(fit.error().kind, kind);
        EXPECT_FALSE(fit.error().message.empty());
    };
    wrong({}, ErrorKind::badInput);
    BoardView few = viewOf(lens, size, board, facing(board, 60, 0, 0, {}), 0.0, random);
    few.pixels.resize(5), few.placesMm.resize(5);
    wrong({few}, ErrorKind::badInput);
    few.pixels.resize(9);
    wrong({few}, ErrorKind::badInput);
    // A pinhole camera that looks straight at a board may be near and wide or far and narrow.
    FisheyeLens pinhole{{1.0, 0, 0, 0, 0}, 300.0, 300.0, 262.0, 219.5};
    pinhole.projection = Projection::perspective;
    wrong({viewOf(pinhole, size, board, facing(board, 60, 0, 0, {}), 0.0, random)},
          ErrorKind::noResult);
    const auto told = calibrate(
        {viewOf(pinhole, size, board, facing(board, 60, 0, 0, {}), 0.3, random)}, options);
    if (told) {
        EXPECT_GT(told->focalError, 0.1 * told->focalPixels);
    }
    options.fieldDegrees = 190.0;
    wrong(viewsOf(lens, size, 0.0, 1), ErrorKind::badInput);
    options.fieldDegrees.reset();
    options.start = lens;
    wrong(viewsOf(lens, size, 0.0, 1), ErrorKind::badInput);
}

// Large discs' pictures have their centres off their centres' pictures: without the correction the
// lens is wrong by many standard errors, with it by none.
TEST(Calibration, DotsAreCorrectedForWhatTheirCentresAreOff) {
    const Colonoscope scope = olympusCfQ160l();
    const Board board{BoardPattern::dots, {7, 7}, 6.0};
    constexpr double radiusMm = 2.4;
    std::mt19937 random(2);
    std::vector<BoardView> views;
    for (const BoardPose& pose : posesOf(board)) {
        BoardView view;
        for (const glm::dvec2 place : tests::placesOf(board)) {
            // The centre of the disc's picture by adding up its parts.
            glm::dvec2 moment(0.0);
            double area = 0.0;
            bool seen = true;
            constexpr int rings = 60, spokes = 60;
            for (int ring = 0; ring < rings && seen; ++ring) {
                for (int spoke = 0; spoke < spokes && seen; ++spoke) {
                    const double r = radiusMm * (ring + 0.5) / rings,
                                 a = 2 * std::numbers::pi * spoke / spokes, e = 1e-4;
                    const glm::dvec2 at = place + r * glm::dvec2(std::cos(a), std::sin(a));
                    const auto p = pixelOf(scope.lens, pose(at)),
                               px = pixelOf(scope.lens, pose(at + glm::dvec2(e, 0))),
                               py = pixelOf(scope.lens, pose(at + glm::dvec2(0, e)));
                    seen = p && px && py;
                    if (!seen) break;
                    const glm::dvec2 u = (*px - *p) / e, v = (*py - *p) / e;
                    const double part = std::abs(u.x * v.y - u.y * v.x) * r;
                    area += part, moment += part * *p;
                }
            }
            if (!seen) continue;
            view.placesMm.push_back(place);
            view.pixels.push_back(moment / area);
            view.areas.push_back(area * (radiusMm / 60) * (2 * std::numbers::pi / 60));
        }
        views.push_back(view);
    }
    CalibrationOptions options = optionsOf("kannala-brandt", scope.pictureSize);
    options.pixelsPerMm = scope.lens.mu;
    const auto corrected = calibrate(views, options);
    ASSERT_TRUE(corrected) << describe(corrected.error());
    EXPECT_NEAR(corrected->dotRadiusMm, radiusMm, 0.02);
    EXPECT_GT(corrected->largestBiasPixels, 0.3);
    EXPECT_LT(corrected->rmsPixels, 0.01);
    EXPECT_NEAR(corrected->lens.k[0], scope.lens.k[0], 0.005);
    EXPECT_NEAR(corrected->lens.k[1], scope.lens.k[1], 0.005);
    for (BoardView& view : views)
        view.areas.clear();
    const auto plain = calibrate(views, options);
    ASSERT_TRUE(plain);
    EXPECT_GT(plain->rmsPixels, 10 * corrected->rmsPixels);
}

// ---- real endoscopes

struct Found {
    std::vector<Image> pictures;
    std::vector<BoardView> views;
};
Found findAll(const fs::path& folder, const std::string& kind, double spacingMm) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".jpg") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    Board board = boardOfText(kind).value();
    board.spacingMm = spacingMm;
    Found found;
    for (const fs::path& file : files) {
        found.pictures.push_back(tests::readPicture(file));
        auto view = findBoard(found.pictures.back(), board);
        EXPECT_TRUE(view) << file << ": " << describe(view.error());
        if (!view) continue;
        EXPECT_EQ(int(view->pixels.size()), pointCount(board)) << file;
        found.views.push_back(std::move(*view));
    }
    return found;
}

// A capsule: every corner is found; the lens that another program fitted to these pictures
// (Scaramuzza's polynomial) is ours within what the pictures tell, and OpenCV's solver ends at the
// same residuals on the same corners.
TEST(Calibration, MiroCamAgreesWithAnotherProgramsFit) {
    HAUSTRA_REAL_DATA(folder, "calibration/MiroCam");
    const Found found = findAll(folder, "checkerboard:8x7", 2.0);
    ASSERT_EQ(found.views.size(), 10u);
    const auto stored = [](double theta) {
        double low = 0.0, high = 165.0;  // it grows to there
        for (int step = 0; step < 60; ++step) {
            const double r = 0.5 * (low + high);
            const double z = 135.9994 + r * r * (-5.6873e-3 + r * (5.8175e-5 - 2.2785e-7 * r));
            (std::atan2(r, z) < theta ? low : high) = r;
        }
        return low;
    };
    CalibrationOptions options = optionsOf("kannala-brandt-4", {320, 320});
    options.field = findField(found.pictures).value();
    const auto fit = calibrate(found.views, options);
    ASSERT_TRUE(fit) << describe(fit.error());
    EXPECT_LT(fit->rmsPixels, 0.71);
    const double side = std::sqrt(fit->lens.mu * fit->lens.mv);
    double worst = 0.0;
    std::vector<double> ratios;
    for (int degrees = 2; degrees <= 60; ++degrees) {
        const double theta = glm::radians(double(degrees));
        ratios.push_back(side * radiusOf(fit->lens, theta) / stored(theta));
        worst = std::max(worst, std::abs(ratios.back() - 1.0));
    }
    // The scale is known to 5 %; shapes agree better than that.
    EXPECT_LT(worst, 0.02);
    EXPECT_LT(worst, fit->focalError / fit->focalPixels);
    EXPECT_LT(
        glm::distance(glm::dvec2(fit->lens.u0, fit->lens.v0), glm::dvec2(163.242, 161.534) - 1.0),
        2.0);  // theirs counts from 1

    std::vector<std::vector<cv::Point3d>> places;
    std::vector<std::vector<cv::Point2d>> pixels;
    for (const BoardView& view : found.views) {
        places.emplace_back(), pixels.emplace_back();
        for (std::size_t n = 0; n < view.pixels.size(); ++n) {
            places.back().emplace_back(view.placesMm[n].x, view.placesMm[n].y, 0.0);
            pixels.back().emplace_back(view.pixels[n].x, view.pixels[n].y);
        }
    }
    cv::Matx33d camera;
    cv::Vec4d d;
    const double openCv =
        cv::fisheye::calibrate(places, pixels, {320, 320}, camera, d, cv::noArray(), cv::noArray(),
                               cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW,
                               {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 500, 1e-12});
    const auto same = calibrate(found.views, optionsOf("opencv-fisheye", {320, 320}));
    ASSERT_TRUE(same) << describe(same.error());
    std::printf(
        "MiroCam: r(t) within %.2f %% of the stored fit to 60 degrees; RMS %.4f (4 "
        "coefficients), %.4f as OpenCV's model, OpenCV's solver %.4f\n",
        100 * worst, fit->rmsPixels, same->rmsPixels, openCv);
    EXPECT_LE(same->rmsPixels, openCv + 1e-4);
}

// A rigid endoscope: better than the stored result, by the same model on the same pictures.
TEST(Calibration, EndocalIsNoWorseThanItsStoredResult) {
    HAUSTRA_REAL_DATA(folder, "calibration/endocal_001");
    const Found found = findAll(folder, "asymmetric-dots:3x11", 1.0);
    ASSERT_EQ(found.views.size(), 11u);
    const auto fit = calibrate({found.views.begin(), found.views.begin() + 10},
                               optionsOf("brown-radial", {768, 710}));
    ASSERT_TRUE(fit) << describe(fit.error());
    std::printf("endocal_001: RMS %.4f, stored 0.2843\n", fit->rmsPixels);
    EXPECT_LE(fit->rmsPixels, 0.284);
}

// The stored result's own points give the stored result: the solver, apart from the finder.
TEST(Calibration, EndocalsStoredPointsGiveItsStoredLens) {
    HAUSTRA_REAL_DATA(file, "calibration/endocal_001/calibration_001-010.xml");
    const cv::FileStorage stored(file, cv::FileStorage::READ);
    cv::Mat points, camera, d, errors;
    stored["Image_points"] >> points;
    stored["Camera_Matrix"] >> camera;
    stored["Distortion_Coefficients"] >> d;
    const auto places = tests::placesOf(*boardOfText("asymmetric-dots:3x11"));
    std::vector<BoardView> views;
    for (int row = 0; row < points.rows; ++row) {
        views.emplace_back().placesMm = places;
        for (int n = 0; n < points.cols; ++n) {
            const auto p = points.at<cv::Vec2f>(row, n);
            views.back().pixels.emplace_back(p[0], p[1]);
        }
    }
    const auto fit = calibrate(views, optionsOf("brown-radial", {768, 710}));
    ASSERT_TRUE(fit) << describe(fit.error());
    EXPECT_NEAR(fit->rmsPixels, double(stored["Avg_Reprojection_Error"]), 1e-5);
    EXPECT_NEAR(fit->lens.mu, camera.at<double>(0, 0), 0.05);
    EXPECT_NEAR(fit->lens.mv, camera.at<double>(1, 1), 0.05);
    EXPECT_NEAR(fit->lens.u0, camera.at<double>(0, 2), 0.01);
    EXPECT_NEAR(fit->lens.v0, camera.at<double>(1, 2), 0.01);
    EXPECT_NEAR(fit->lens.k[1], d.at<double>(0), 1e-4);
    EXPECT_NEAR(fit->lens.k[2], d.at<double>(1), 1e-3);
    EXPECT_NEAR(fit->lens.k[3], d.at<double>(4), 1e-3);
}

}  // namespace
}  // namespace haustra::coverage
