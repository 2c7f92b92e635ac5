#include "core/quantile.h"
#include "coverage/calibration_libraries.h"
#include "coverage/square_lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace haustra::coverage::module {
namespace {

constexpr double pi = std::numbers::pi;
/// Smaller pictures are looked at at twice their size: squares of a capsule's are 8 pixels.
constexpr int smallSide = 500;
/// Grey levels between the board's dark and light.
constexpr double leastContrast = 12.0;

cv::Mat greyOf(const Image& picture) {
    const cv::Mat rgb(picture.height, picture.width, CV_8UC3,
                      const_cast<std::uint8_t*>(picture.rgb.data()));
    cv::Mat grey, numbers;
    cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
    grey.convertTo(numbers, CV_32F);
    return numbers;
}

double valueAt(const cv::Mat& image, double x, double y) {
    const int left = std::clamp(int(x), 0, image.cols - 2),
              top = std::clamp(int(y), 0, image.rows - 2);
    const double a = std::clamp(x - left, 0.0, 1.0), b = std::clamp(y - top, 0.0, 1.0);
    const float *upper = image.ptr<float>(top) + left, *lower = image.ptr<float>(top + 1) + left;
    return (1 - b) * ((1 - a) * upper[0] + a * upper[1]) + b * ((1 - a) * lower[0] + a * lower[1]);
}

/// The largest (or least) value within `reach` pixels of each.
cv::Mat extremes(const cv::Mat& image, int reach, bool largest) {
    const cv::Mat square =
        cv::getStructuringElement(cv::MORPH_RECT, {2 * reach + 1, 2 * reach + 1});
    cv::Mat result;
    if (largest)
        cv::dilate(image, result, square);
    else
        cv::erode(image, result, square);
    return result;
}

// ---- checkerboards

/// Around a corner of squares brightness is over and under the middle in turn, four times, and the
/// changes lie on two lines. The angle of one of the light quarters' bisectors, modulo π.
std::optional<double> lightAngle(const cv::Mat& image, cv::Point2d at, double radius) {
    constexpr int samples = 32;
    std::array<double, samples> ring;
    for (int n = 0; n < samples; ++n)
        ring[std::size_t(n)] = valueAt(image, at.x + radius * std::cos(2 * pi * n / samples),
                                       at.y + radius * std::sin(2 * pi * n / samples));
    const auto [least, most] = std::minmax_element(ring.begin(), ring.end());
    if (*most - *least < leastContrast) return std::nullopt;
    const double middle = 0.5 * (*least + *most);
    std::vector<double> changes;  // in samples
    bool firstRises = false;
    for (int n = 0; n < samples; ++n) {
        const double a = ring[std::size_t(n)] - middle,
                     b = ring[std::size_t((n + 1) % samples)] - middle;
        if ((a > 0.0) == (b > 0.0)) continue;
        if (changes.empty()) firstRises = b > 0.0;
        changes.push_back(n + a / (a - b));
    }
    if (changes.size() != 4) return std::nullopt;
    for (std::size_t n = 0; n < 4; ++n) {
        const double quarter = std::fmod(changes[(n + 1) % 4] - changes[n] + samples, samples);
        if (quarter < 2.5) return std::nullopt;
    }
    for (const std::size_t n : {0, 1})  // opposite changes lie on a line, within 40°
        if (std::abs(changes[n + 2] - changes[n] - samples / 2) > samples * 40.0 / 360.0)
            return std::nullopt;
    const double from = firstRises ? changes[0] : changes[1],
                 to = firstRises ? changes[1] : changes[2];
    return std::fmod(pi * (from + to) / samples, pi);
}

/// Saddles of brightness at one scale.
std::vector<LatticePoint> saddles(const cv::Mat& grey, double sigma) {
    cv::Mat blurred, xx, yy, xy;
    cv::GaussianBlur(grey, blurred, {}, sigma);
    cv::Sobel(blurred, xx, CV_32F, 2, 0, 3, 0.25);
    cv::Sobel(blurred, yy, CV_32F, 0, 2, 3, 0.25);
    cv::Sobel(blurred, xy, CV_32F, 1, 1, 3, 0.25);
    const cv::Mat strength = xy.mul(xy) - xx.mul(yy);
    const int reach = std::max(1, int(std::lround(1.5 * sigma)));
    const cv::Mat peaks = extremes(strength, reach, true);
    const cv::Mat darkest = extremes(blurred, int(std::lround(4 * sigma)), false),
                  lightest = extremes(blurred, int(std::lround(4 * sigma)), true);
    std::vector<LatticePoint> found;
    const int margin = int(std::ceil(3.0 * sigma)) + 1;
    for (int y = margin; y < grey.rows - margin; ++y) {
        for (int x = margin; x < grey.cols - margin; ++x) {
            const float here = strength.at<float>(y, x);
            if (here <= 0.0f || here < peaks.at<float>(y, x)) continue;
            const double contrast = lightest.at<float>(y, x) - darkest.at<float>(y, x);
            // An ideal corner's mixed derivative is contrast/(πσ²).
            const double ideal = contrast / (pi * sigma * sigma);
            if (contrast < leastContrast || here < 0.04 * ideal * ideal) continue;
            const double fx = 0.5 * (blurred.at<float>(y, x + 1) - blurred.at<float>(y, x - 1)),
                         fy = 0.5 * (blurred.at<float>(y + 1, x) - blurred.at<float>(y - 1, x));
            const double a = xx.at<float>(y, x), b = xy.at<float>(y, x), c = yy.at<float>(y, x);
            const double dx = (c * fx - b * fy) / here, dy = (a * fy - b * fx) / here;
            if (std::hypot(dx, dy) > 1.5 * sigma) continue;
            const cv::Point2d at(x + dx, y + dy);
            const auto light = lightAngle(blurred, at, 2.5 * sigma);
            if (!light) continue;
            found.push_back({{at.x, at.y}, *light, 0.0});
        }
    }
    return found;
}

/// The saddle of the quadric that fits the brightness around best, by Gaussian weights that stay
/// within the squares around it [Placht 2014]; from where it is, until it settles there. Corners
/// whose surroundings the picture cuts are taken out.
void refineCorners(const cv::Mat& grey, std::vector<LatticeCell>& cells) {
    std::vector<LatticeCell> refined;
    for (const LatticeCell& cell : cells) {
        double nearest = 1e9;
        for (const LatticeCell& other : cells)
            if (&other != &cell) nearest = std::min(nearest, glm::distance(cell.at, other.at));
        const double sigma = std::max(1.0, 0.12 * nearest);
        const int reach = int(std::ceil(2.5 * sigma));
        glm::dvec2 at = cell.at;
        if (glm::any(glm::lessThan(at, glm::dvec2(reach))) || at.x > grey.cols - 1 - reach ||
            at.y > grey.rows - 1 - reach)
            continue;
        for (int step = 0; step < 20; ++step) {
            const glm::ivec2 middle(glm::round(at));
            cv::Matx66d normal = cv::Matx66d::zeros();
            cv::Vec6d right = cv::Vec6d::all(0.0);
            for (int y = -reach; y <= reach; ++y) {
                for (int x = -reach; x <= reach; ++x) {
                    const glm::ivec2 p = middle + glm::ivec2(x, y);
                    if (p.x < 0 || p.y < 0 || p.x >= grey.cols || p.y >= grey.rows) continue;
                    const glm::dvec2 d = glm::dvec2(p) - at;
                    const double weight = std::exp(-0.5 * glm::dot(d, d) / (sigma * sigma));
                    const cv::Vec6d row(1.0, d.x, d.y, d.x * d.x, d.x * d.y, d.y * d.y);
                    normal += weight * row * row.t();
                    right += weight * double(grey.at<float>(p.y, p.x)) * row;
                }
            }
            const cv::Vec6d f = normal.solve(right, cv::DECOMP_CHOLESKY);
            const double determinant = 4.0 * f[3] * f[5] - f[4] * f[4];
            if (!(determinant < 0.0)) break;
            const glm::dvec2 move((f[4] * f[2] - 2.0 * f[5] * f[1]) / determinant,
                                  (f[4] * f[1] - 2.0 * f[3] * f[2]) / determinant);
            if (!(glm::length(move) < nearest)) break;
            at += move;
            if (glm::length(move) < 1e-3) break;
        }
        refined.push_back(cell);
        if (glm::distance(at, cell.at) < 0.25 * nearest) refined.back().at = at;
    }
    cells = std::move(refined);
}

// ---- dots

/// Clusters darker than midway between the least and the most around them, with the moments of a
/// filled ellipse; each with its centre by contrast and its area.
std::vector<LatticePoint> clusters(const cv::Mat& grey, int reach) {
    cv::Mat blurred;
    cv::GaussianBlur(grey, blurred, {}, 1.0);
    cv::Mat smoother;
    cv::GaussianBlur(grey, smoother, {}, 2.0);
    const cv::Mat darkest = extremes(smoother, reach, false),
                  lightest = extremes(smoother, reach, true);
    const cv::Mat dark =
        (blurred < 0.5 * (darkest + lightest)) & (lightest - darkest > leastContrast);
    cv::Mat labels, boxes, centroids;
    const int count = cv::connectedComponentsWithStats(dark, labels, boxes, centroids, 4, CV_32S);
    std::vector<LatticePoint> found;
    for (int label = 1; label < count; ++label) {
        const int area = boxes.at<int>(label, cv::CC_STAT_AREA);
        const cv::Rect box(
            boxes.at<int>(label, cv::CC_STAT_LEFT), boxes.at<int>(label, cv::CC_STAT_TOP),
            boxes.at<int>(label, cv::CC_STAT_WIDTH), boxes.at<int>(label, cv::CC_STAT_HEIGHT));
        constexpr int margin = 5;
        if (area < 20 || box.width > 2 * reach || box.height > 2 * reach || box.x < 2 ||
            box.y < 2 || box.br().x > grey.cols - 2 || box.br().y > grey.rows - 2)
            continue;
        const cv::Rect around =
            (box - cv::Point(margin, margin) + cv::Size(2 * margin, 2 * margin)) &
            cv::Rect(0, 0, grey.cols, grey.rows);
        const cv::Mat own = labels(around) == label;
        const cv::Moments moments = cv::moments(own, true);
        // Each pixel is spread over its square: 1/12.
        const double xx = moments.mu20 / area + 1.0 / 12, yy = moments.mu02 / area + 1.0 / 12,
                     xy = moments.mu11 / area;
        const double determinant = xx * yy - xy * xy, half = 0.5 * (xx + yy);
        const double spread = std::sqrt(std::max(0.0, half * half - determinant));
        const double filled = 4.0 * pi * std::sqrt(std::max(0.0, determinant)) / area;
        if (filled < 0.9 || filled > 1.12 || (half + spread) > 25.0 * (half - spread)) continue;

        // The centre by contrast, over the cluster and the slope of its edge.
        cv::Mat within, near, beyond;
        const cv::Mat disc = cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5});
        cv::dilate(own, within, disc);
        cv::dilate(within, beyond, disc);
        const cv::Mat others = (labels(around) != 0) & ~own;
        cv::dilate(others, others, disc);
        const cv::Mat ground = beyond & ~within & ~others;
        cv::erode(own, near, cv::getStructuringElement(cv::MORPH_ELLIPSE, {3, 3}));
        if (cv::countNonZero(ground) < 8) continue;
        const double light = cv::mean(grey(around), ground)[0],
                     shade = cv::mean(grey(around), cv::countNonZero(near) > 0 ? near : own)[0];
        if (light - shade < leastContrast) continue;
        double sum = 0.0, sumX = 0.0, sumY = 0.0;
        for (int y = 0; y < around.height; ++y) {
            for (int x = 0; x < around.width; ++x) {
                if (!within.at<std::uint8_t>(y, x)) continue;
                const double here = grey.at<float>(around.y + y, around.x + x);
                const double weight = std::clamp((light - here) / (light - shade), 0.0, 1.0);
                sum += weight, sumX += weight * (around.x + x), sumY += weight * (around.y + y);
            }
        }
        found.push_back({{sumX / sum, sumY / sum}, std::nullopt, sum});
    }
    return found;
}

// ---- boards

/// Cells of a lattice as points of a board: of all turns, mirrorings and shifts, the one with the
/// most of them on the board. Dots of the others are no part of it.
BoardView placed(const std::vector<LatticeCell>& cells, const Board& board) {
    const bool slanted = board.pattern == BoardPattern::asymmetricDots;
    const int less = board.pattern == BoardPattern::checkerboard ? 1 : 0;
    // Rows of asymmetric dots are half a step apart: in steps of that the board is wider.
    const glm::ivec2 size =
        slanted ? glm::ivec2(2 * board.count.x, board.count.y) : board.count - less;
    const auto isPoint = [&](glm::ivec2 at) {
        return at.x >= 0 && at.y >= 0 && at.x < size.x && at.y < size.y &&
               (!slanted || (at.x + at.y) % 2 == 0);
    };
    std::vector<glm::ivec2> best;
    int most = 0;
    for (int turn = 0; turn < 8; ++turn) {
        std::vector<glm::ivec2> at;
        glm::ivec2 least(1 << 20), greatest(-(1 << 20));
        for (const LatticeCell& cell : cells) {
            glm::ivec2 c = cell.cell;
            if (turn & 1) c.x = -c.x;
            if (turn & 2) c.y = -c.y;
            if (turn & 4) std::swap(c.x, c.y);
            if (slanted) c = {c.x + c.y, c.x - c.y};
            at.push_back(c);
            least = glm::min(least, c), greatest = glm::max(greatest, c);
        }
        for (int dy = -greatest.y; dy < size.y - least.y; ++dy) {
            for (int dx = -greatest.x; dx < size.x - least.x; ++dx) {
                const glm::ivec2 shift(dx, dy);
                const int on = int(std::count_if(at.begin(), at.end(),
                                                 [&](glm::ivec2 c) { return isPoint(c + shift); }));
                if (on <= most) continue;
                most = on, best = at;
                for (glm::ivec2& c : best)
                    c += shift;
            }
        }
    }
    BoardView view;
    for (std::size_t n = 0; n < cells.size() && most > 0; ++n) {
        if (!isPoint(best[n])) continue;
        view.placesMm.push_back(board.spacingMm * glm::dvec2(best[n]));
        view.pixels.push_back(cells[n].at);
        view.areas.push_back(cells[n].area);
    }
    return view;
}

void sortByPlace(BoardView& view) {
    std::vector<std::size_t> order(view.pixels.size());
    for (std::size_t n = 0; n < order.size(); ++n)
        order[n] = n;
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const glm::dvec2 &p = view.placesMm[a], &q = view.placesMm[b];
        return std::pair(p.y, p.x) < std::pair(q.y, q.x);
    });
    BoardView sorted;
    for (const std::size_t n : order) {
        sorted.placesMm.push_back(view.placesMm[n]);
        sorted.pixels.push_back(view.pixels[n]);
        sorted.areas.push_back(view.areas[n]);
    }
    view = std::move(sorted);
}

}  // namespace

Result<BoardView> findBoard(const Image& picture, const Board& board) try {
    const bool squares = board.pattern == BoardPattern::checkerboard;
    cv::Mat grey = greyOf(picture);
    const double scale = std::min(grey.cols, grey.rows) < smallSide ? 2.0 : 1.0;
    if (scale != 1.0) cv::resize(grey, grey, {}, scale, scale, cv::INTER_CUBIC);
    const std::size_t all = std::size_t(pointCount(board));
    std::size_t seen = 0, together = 0;
    BoardView best;
    const auto look = [&](const std::vector<LatticePoint>& points) {
        seen = std::max(seen, points.size());
        for (std::vector<LatticeCell>& cells : growLattices(points, all)) {
            together = std::max(together, cells.size());
            if (cells.size() <= best.pixels.size()) continue;
            if (squares) refineCorners(grey, cells);
            BoardView view = placed(cells, board);
            if (view.pixels.size() > best.pixels.size()) best = std::move(view);
        }
    };
    if (squares) {
        for (const double sigma : {2.0, 1.4, 3.0, 4.5, 7.0})
            if (best.pixels.size() < all) look(saddles(grey, sigma));
    } else {
        const cv::Mat negative = 255.0 - grey;
        for (const cv::Mat* ground : {static_cast<const cv::Mat*>(&grey), &negative})
            for (const int reach : {15, 25, 45, 80, 150})
                if (best.pixels.size() < all) look(clusters(*ground, reach));
    }
    if (2 * best.pixels.size() < all || best.pixels.size() < 6) {
        const std::string what = squares ? "corners of squares" : "dots";
        return fail(ErrorKind::noResult,
                    "no " + textOf(board) + " is seen: of " + std::to_string(seen) + " " + what +
                        " at most " + std::to_string(together) +
                        " lie as on a grid, and the board has " + std::to_string(all));
    }
    for (glm::dvec2& pixel : best.pixels)
        pixel = (pixel + 0.5) / scale - 0.5;
    for (double& area : best.areas)
        area /= scale * scale;
    sortByPlace(best);
    if (squares) best.areas.clear();
    return best;
} catch (const std::exception&) {
    return fail(ErrorKind::badInput, "the picture cannot be searched for a board");
}

namespace {

/// Least squares of a(x² ) + b y² + c x + d y = 1 about the points' middle; none where it is no
/// ellipse.
std::optional<FieldEllipse> ellipseThrough(const std::vector<glm::dvec2>& points) {
    glm::dvec2 middle(0.0);
    for (const glm::dvec2& p : points)
        middle += p / double(points.size());
    double size = 1.0;
    for (const glm::dvec2& p : points)
        size = std::max(size, glm::distance(p, middle));
    cv::Mat rows(int(points.size()), 4, CV_64F),
        ones = cv::Mat::ones(int(points.size()), 1, CV_64F);
    for (int n = 0; n < rows.rows; ++n) {
        const glm::dvec2 p = (points[std::size_t(n)] - middle) / size;
        double* row = rows.ptr<double>(n);
        row[0] = p.x * p.x, row[1] = p.y * p.y, row[2] = p.x, row[3] = p.y;
    }
    cv::Mat fit;
    if (!cv::solve(rows, ones, fit, cv::DECOMP_SVD)) return std::nullopt;
    const double a = fit.at<double>(0), b = fit.at<double>(1), c = fit.at<double>(2),
                 d = fit.at<double>(3);
    if (!(a > 0.0 && b > 0.0)) return std::nullopt;
    const glm::dvec2 center(-0.5 * c / a, -0.5 * d / b);
    const double right = 1.0 + a * center.x * center.x + b * center.y * center.y;
    return FieldEllipse{middle + size * center,
                        size * glm::dvec2(std::sqrt(right / a), std::sqrt(right / b))};
}

/// How far a point lies from an ellipse, to first order, pixels.
double distanceOf(const FieldEllipse& field, glm::dvec2 point) {
    const glm::dvec2 in = (point - field.center) / field.radii;
    const double gradient = glm::length(in / field.radii);
    const double level = glm::length(in);
    return gradient > 0.0 ? std::abs(level - 1.0) * level / gradient : glm::length(field.radii);
}

}  // namespace

Result<FieldEllipse> findField(const std::vector<Image>& pictures) try {
    cv::Mat lightest;
    for (const Image& picture : pictures) {
        const cv::Mat grey = greyOf(picture);
        if (lightest.empty())
            lightest = grey.clone();
        else
            cv::max(lightest, grey, lightest);
    }
    const auto none = [] {
        return fail(ErrorKind::noResult, "the pictures have no dark surround that tells the field");
    };
    if (lightest.empty()) return none();
    cv::GaussianBlur(lightest, lightest, {}, 1.5);
    double brightest = 0.0;
    cv::minMaxLoc(lightest, nullptr, &brightest);
    // The surround is black: a tenth of the brightest lies between it and a dim edge.
    const cv::Mat open = lightest > std::max(10.0, 0.1 * brightest);
    const double share = double(cv::countNonZero(open)) / double(open.total());
    if (share > 0.98 || share < 0.05) return none();
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(open, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    const auto largest = std::max_element(
        outlines.begin(), outlines.end(),
        [](const auto& a, const auto& b) { return cv::contourArea(a) < cv::contourArea(b); });
    std::vector<glm::dvec2> rim;
    constexpr int border = 3;
    for (const cv::Point& p : *largest)
        if (p.x >= border && p.y >= border && p.x < open.cols - border && p.y < open.rows - border)
            rim.emplace_back(p.x, p.y);
    std::vector<glm::dvec2> kept = rim;
    std::optional<FieldEllipse> field;
    for (int round = 0; round < 12; ++round) {
        if (kept.size() < 50) return none();
        field = ellipseThrough(kept);
        if (!field) return none();
        std::vector<double> off;
        for (const glm::dvec2& p : rim)
            off.push_back(distanceOf(*field, p));
        std::vector<double> sorted = off;
        const double most = std::max(1.5, 2.5 * medianOf(sorted));
        kept.clear();
        for (std::size_t n = 0; n < rim.size(); ++n)
            if (off[n] <= most) kept.push_back(rim[n]);
    }
    const double half = 0.5 * std::max(open.cols, open.rows);
    const double ratio = field->radii.x / field->radii.y;
    if (glm::any(glm::greaterThan(field->radii, glm::dvec2(4.0 * half))) ||
        glm::any(glm::lessThan(field->radii, glm::dvec2(0.1 * half))) || ratio > 3.0 ||
        ratio < 1.0 / 3.0)
        return none();
    return *field;
} catch (const std::exception&) {
    return fail(ErrorKind::badInput, "the pictures' field cannot be looked for");
}

}  // namespace haustra::coverage::module
