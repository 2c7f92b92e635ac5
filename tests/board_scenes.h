// Boards before a lens: where their points are shown, and whole pictures of them.
#pragma once

#include "core/image.h"
#include "coverage/board.h"
#include "coverage/colonoscope.h"

#include <cmath>
#include <random>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::tests {

/// A board's rotation into the camera's frame and its first point there, mm.
struct BoardPose {
    glm::dmat3 cameraFromBoard{1.0};
    glm::dvec3 originMm{0.0};
    glm::dvec3 operator()(glm::dvec2 placeMm) const {
        return cameraFromBoard * glm::dvec3(placeMm, 0.0) + originMm;
    }
};

inline glm::dmat3 turned(double aboutX, double aboutY, double aboutZ) {
    const auto c = [](double a) { return std::cos(glm::radians(a)); };
    const auto s = [](double a) { return std::sin(glm::radians(a)); };
    // Columns.
    const glm::dmat3 x(1, 0, 0, 0, c(aboutX), s(aboutX), 0, -s(aboutX), c(aboutX)),
        y(c(aboutY), 0, -s(aboutY), 0, 1, 0, s(aboutY), 0, c(aboutY)),
        z(c(aboutZ), s(aboutZ), 0, -s(aboutZ), c(aboutZ), 0, 0, 0, 1);
    return z * y * x;
}

/// Where a board's points are, mm from the first; row after row.
inline std::vector<glm::dvec2> placesOf(const coverage::Board& board) {
    const int less = board.pattern == coverage::BoardPattern::checkerboard ? 1 : 0;
    const bool slanted = board.pattern == coverage::BoardPattern::asymmetricDots;
    std::vector<glm::dvec2> places;
    for (int row = 0; row < board.count.y - less; ++row)
        for (int column = 0; column < board.count.x - less; ++column)
            places.push_back(board.spacingMm *
                             glm::dvec2(slanted ? 2 * column + row % 2 : column, row));
    return places;
}

/// The board with its middle `awayMm` along a direction that makes `offDegrees` with the axis at an
/// azimuth, facing the camera but for a tilt.
inline BoardPose facing(const coverage::Board& board, double awayMm, double offDegrees,
                        double azimuthDegrees, glm::dvec3 tiltDegrees) {
    const auto places = placesOf(board);
    const glm::dvec2 middle = 0.5 * (places.front() + places.back());
    const double off = glm::radians(offDegrees), azimuth = glm::radians(azimuthDegrees);
    const glm::dvec3 along(std::sin(off) * std::cos(azimuth), std::sin(off) * std::sin(azimuth),
                           std::cos(off));
    // Turns the axis to `along`.
    const glm::dmat3 aim =
        turned(0, 0, azimuthDegrees) * turned(0, offDegrees, 0) * turned(0, 0, -azimuthDegrees);
    BoardPose pose;
    pose.cameraFromBoard = aim * turned(tiltDegrees.x, tiltDegrees.y, tiltDegrees.z);
    pose.originMm = awayMm * along - pose.cameraFromBoard * glm::dvec3(middle, 0.0);
    return pose;
}

/// What is found of a board, with Gaussian noise in each coordinate; without points that are not
/// shown in the picture.
inline coverage::BoardView viewOf(const coverage::FisheyeLens& lens, glm::ivec2 pictureSize,
                                  const coverage::Board& board, const BoardPose& pose,
                                  double noisePixels, std::mt19937& random) {
    std::normal_distribution<double> noise(0.0, 1.0);
    coverage::BoardView view;
    for (const glm::dvec2 place : placesOf(board)) {
        const auto pixel = coverage::pixelOf(lens, pose(place));
        if (!pixel || pixel->x < 0.0 || pixel->y < 0.0 || pixel->x > pictureSize.x - 1.0 ||
            pixel->y > pictureSize.y - 1.0)
            continue;
        const double dx = noise(random), dy = noise(random);
        view.placesMm.push_back(place);
        view.pixels.push_back(*pixel + noisePixels * glm::dvec2(dx, dy));
    }
    return view;
}

/// Draws boards on white ground through a colonoscope's lens: black outside its open part, darker
/// towards the rim, nine rays a pixel, of which no two are in one row or column: an edge along
/// either is told to a ninth of a pixel.
class BoardPainter {
public:
    explicit BoardPainter(const coverage::Colonoscope& scope) : size_(scope.pictureSize) {
        directions_.resize(std::size_t(9 * size_.x * size_.y), glm::dvec3(0.0));
        std::size_t at = 0;
        for (int y = 0; y < size_.y; ++y)
            for (int x = 0; x < size_.x; ++x)
                for (int ray = 0; ray < 9; ++ray, ++at)
                    if (const auto direction = coverage::directionOf(
                            scope, {x + (ray - 4) / 9.0, y + (2 * ray % 9 - 4) / 9.0}))
                        directions_[at] = *direction;
    }

    Image paint(const coverage::Board& board, const BoardPose& pose, double dotRadiusMm,
                double noiseLevels, unsigned seed) const {
        std::mt19937 random(seed);
        std::normal_distribution<double> noise(0.0, noiseLevels);
        const auto places = placesOf(board);
        const glm::dmat3 boardFromCamera = glm::transpose(pose.cameraFromBoard);
        const glm::dvec3 eye = -(boardFromCamera * pose.originMm);
        Image image = blankImage(size_);
        for (std::size_t pixel = 0; pixel < image.rgb.size() / 3; ++pixel) {
            double light = 0.0;
            for (std::size_t ray = 9 * pixel; ray < 9 * pixel + 9; ++ray) {
                const glm::dvec3 direction = boardFromCamera * directions_[ray];
                const double along = -eye.z / direction.z;
                if (!(along > 0.0 && std::isfinite(along))) continue;
                const glm::dvec2 at(eye + along * direction);
                light += (0.35 + 0.65 * directions_[ray].z) *
                         (isDark(board, at, dotRadiusMm) ? 30.0 : 210.0) / 9.0;
            }
            const double value =
                std::min(255.0, std::max(0.0, light + (light > 0 ? noise(random) : 0)));
            for (std::size_t c = 0; c < 3; ++c)
                image.rgb[3 * pixel + c] = std::uint8_t(value + 0.5);
        }
        return image;
    }

private:
    static bool isDark(const coverage::Board& board, glm::dvec2 at, double dotRadiusMm) {
        const glm::dvec2 steps = at / board.spacingMm;
        if (board.pattern == coverage::BoardPattern::checkerboard) {
            // The first point is one square in.
            const glm::ivec2 square(glm::floor(steps + 1.0));
            return square.x >= 0 && square.y >= 0 && square.x < board.count.x &&
                   square.y < board.count.y && (square.x + square.y) % 2 == 0;
        }
        const int row = int(std::lround(steps.y));
        if (row < 0 || row >= board.count.y) return false;
        const bool slanted = board.pattern == coverage::BoardPattern::asymmetricDots;
        const double step = slanted ? 2.0 : 1.0, first = slanted ? row % 2 : 0.0;
        const int column = int(std::lround((steps.x - first) / step));
        if (column < 0 || column >= board.count.x) return false;
        return glm::distance(at, board.spacingMm * glm::dvec2(first + step * column, row)) <
               dotRadiusMm;
    }

    glm::ivec2 size_;
    std::vector<glm::dvec3> directions_;
};

}  // namespace haustra::tests
