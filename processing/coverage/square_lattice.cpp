#include "coverage/square_lattice.h"

#include "core/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace haustra::coverage {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::size_t mostSeeds = 120;
using Key = std::pair<int, int>;

Key keyOf(glm::ivec2 cell) {
    return {cell.x, cell.y};
}

bool canBeNeighbours(const LatticePoint& a, const LatticePoint& b) {
    if (a.area > 0.0 && (b.area > 2.5 * a.area || a.area > 2.5 * b.area)) return false;
    if (!a.lightAngle || !b.lightAngle) return true;
    const double turn = std::abs(std::remainder(*a.lightAngle - *b.lightAngle, pi));
    return turn > pi / 4;
}

class Growth {
public:
    /// `points` are sorted by x.
    Growth(const std::vector<LatticePoint>& points, std::size_t seed, glm::dvec2 across,
           glm::dvec2 down, std::size_t most)
        : points_(points), used_(points.size(), false), across_(across), down_(down) {
        put({0, 0}, seed);
        while (!open_.empty() && cells_.size() < most) {
            const glm::ivec2 cell = open_.front();
            open_.pop_front();
            for (const glm::ivec2 step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
                if (!at(cell + step)) grow(cell, step);
        }
        prune();
    }

    std::vector<LatticeCell> cells() const {
        std::vector<LatticeCell> result;
        for (const auto& [key, point] : cells_)
            result.push_back({{key.first, key.second}, points_[point].at, points_[point].area});
        return result;
    }

    /// Points strewn at random have such lattices too, with others in between, and each up to a
    /// third of a step off.
    bool isChance() const { return !isEven() || 2 * strangers() > cells_.size(); }

private:
    /// Each fourth place in a row is where the three before it foretell it, to less than an eighth
    /// of a step in half of all rows.
    bool isEven() const {
        std::vector<double> off;
        for (const auto& [key, point] : cells_) {
            const glm::ivec2 cell(key.first, key.second);
            for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
                const auto b = at(cell + step), c = at(cell + 2 * step), d = at(cell + 3 * step);
                if (!b || !c || !d) continue;
                const glm::dvec2 a = points_[point].at;
                off.push_back(3.0 * glm::distance(a + 3.0 * *c, *d + 3.0 * *b) /
                              glm::distance(a, *d));
            }
        }
        if (off.empty()) return true;  // three a side
        return medianOf(off) < 0.125;
    }
    /// How many points that are no cells lie nearer to one than its neighbours do.
    std::size_t strangers() const {
        std::vector<bool> isCell(points_.size(), false), isStranger(points_.size(), false);
        for (const auto& [key, point] : cells_)
            isCell[point] = true;
        for (const auto& [key, point] : cells_) {
            const glm::dvec2 here = points_[point].at;
            double nearest = std::numeric_limits<double>::infinity();
            for (const glm::ivec2 step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}})
                if (const auto beside = at(glm::ivec2(key.first, key.second) + step))
                    nearest = std::min(nearest, glm::distance(*beside, here));
            for (std::size_t n = firstFrom(here.x - 0.8 * nearest);
                 n < points_.size() && points_[n].at.x < here.x + 0.8 * nearest; ++n)
                if (!isCell[n] && glm::distance(points_[n].at, here) < 0.8 * nearest)
                    isStranger[n] = true;
        }
        return std::size_t(std::count(isStranger.begin(), isStranger.end(), true));
    }
    std::size_t firstFrom(double x) const {
        const auto first =
            std::partition_point(points_.begin(), points_.end(),
                                 [&](const LatticePoint& point) { return point.at.x < x; });
        return std::size_t(first - points_.begin());
    }
    std::optional<glm::dvec2> at(glm::ivec2 cell) const {
        const auto found = cells_.find(keyOf(cell));
        if (found == cells_.end()) return std::nullopt;
        return points_[found->second].at;
    }
    void put(glm::ivec2 cell, std::size_t point) {
        cells_[keyOf(cell)] = point;
        used_[point] = true;
        open_.push_back(cell);
    }
    /// The step from a cell, as the places before it in its row, or beside it, foretell it.
    glm::dvec2 stepFrom(glm::ivec2 cell, glm::ivec2 step) const {
        const glm::dvec2 here = *at(cell);
        if (const auto before = at(cell - step)) {
            const glm::dvec2 last = here - *before;
            const auto earlier = at(cell - 2 * step);
            return earlier ? 2.0 * last - (*before - *earlier) : last;
        }
        const glm::ivec2 aside(step.y, step.x);
        for (const glm::ivec2 beside : {cell + aside, cell - aside}) {
            const auto from = at(beside), to = at(beside + step);
            if (from && to) return *to - *from;
        }
        // At the seed, or one row beside it.
        const glm::dvec2 basis = step.x != 0 ? across_ : down_;
        return double(step.x + step.y) * basis;
    }
    void grow(glm::ivec2 cell, glm::ivec2 step) {
        const LatticePoint& here = points_[cells_.at(keyOf(cell))];
        const glm::dvec2 by = stepFrom(cell, step);
        double nearest = glm::length(by) / 3.0;
        std::optional<std::size_t> next;
        const glm::dvec2 foretold = here.at + by;
        for (std::size_t n = firstFrom(foretold.x - nearest);
             n < points_.size() && points_[n].at.x < foretold.x + nearest; ++n) {
            const double distance = glm::distance(points_[n].at, foretold);
            if (used_[n] || distance >= nearest || !canBeNeighbours(here, points_[n])) continue;
            nearest = distance, next = n;
        }
        if (next) put(cell + step, *next);
    }
    /// Takes cells out that lie off the middle of two opposite neighbours, or off the line through
    /// their only one and that one's, by more than a third of a step; and those with none.
    void prune() {
        for (bool changed = true; std::exchange(changed, false);) {
            for (auto cell = cells_.begin(); cell != cells_.end();) {
                const glm::ivec2 c(cell->first.first, cell->first.second);
                const bool stays = agrees(c, points_[cell->second].at);
                changed |= !stays;
                cell = stays ? std::next(cell) : cells_.erase(cell);
            }
        }
    }
    bool agrees(glm::ivec2 c, glm::dvec2 here) const {
        int neighbours = 0;
        glm::ivec2 only(0);
        for (const glm::ivec2 step : {glm::ivec2(1, 0), glm::ivec2(0, 1)}) {
            const auto before = at(c - step), after = at(c + step);
            if (before && after &&
                glm::distance(0.5 * (*before + *after), here) >
                    glm::distance(*before, *after) / 6.0)
                return false;
            if (before) ++neighbours, only = -step;
            if (after) ++neighbours, only = step;
        }
        if (neighbours != 1) return neighbours > 1;
        const glm::dvec2 near = *at(c + only);
        const auto next = at(c + 2 * only);
        return next && glm::distance(2.0 * near - *next, here) < glm::distance(near, *next) / 3.0;
    }

    const std::vector<LatticePoint>& points_;
    std::vector<bool> used_;
    glm::dvec2 across_, down_;
    std::map<Key, std::size_t> cells_;
    std::deque<glm::ivec2> open_;
};

/// The nearest point that can be a neighbour, and the nearest one aside of it.
std::optional<std::pair<glm::dvec2, glm::dvec2>> stepsAround(
    const std::vector<LatticePoint>& points, std::size_t seed) {
    std::vector<glm::dvec2> steps;
    for (std::size_t n = 0; n < points.size(); ++n)
        if (n != seed && canBeNeighbours(points[seed], points[n]))
            steps.push_back(points[n].at - points[seed].at);
    const std::size_t near = std::min<std::size_t>(12, steps.size());
    std::partial_sort(steps.begin(), steps.begin() + std::ptrdiff_t(near), steps.end(),
                      [](glm::dvec2 a, glm::dvec2 b) { return glm::dot(a, a) < glm::dot(b, b); });
    for (std::size_t n = 1; n < near; ++n) {
        const double sine = (steps[0].x * steps[n].y - steps[0].y * steps[n].x) /
                            (glm::length(steps[0]) * glm::length(steps[n]));
        if (std::abs(sine) > 0.6) return std::pair(steps[0], steps[n]);
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::vector<LatticeCell>> growLattices(std::vector<LatticePoint> points,
                                                   std::size_t enough) {
    std::stable_sort(points.begin(), points.end(),
                     [](const LatticePoint& a, const LatticePoint& b) { return a.at.x < b.at.x; });
    // From the middle outwards, where a board most likely has neighbours on all sides.
    glm::dvec2 middle(0.0);
    for (const LatticePoint& point : points)
        middle += point.at / double(points.size());
    std::vector<std::size_t> seeds(points.size());
    for (std::size_t n = 0; n < seeds.size(); ++n)
        seeds[n] = n;
    std::stable_sort(seeds.begin(), seeds.end(), [&](std::size_t a, std::size_t b) {
        return glm::distance(points[a].at, middle) < glm::distance(points[b].at, middle);
    });
    std::map<std::size_t, std::vector<LatticeCell>, std::greater<>> found;
    for (std::size_t n = 0; n < std::min(mostSeeds, seeds.size()); ++n) {
        const auto steps = stepsAround(points, seeds[n]);
        if (!steps) continue;
        const Growth growth(points, seeds[n], steps->first, steps->second, 4 * enough);
        if (growth.isChance()) continue;
        auto cells = growth.cells();
        const std::size_t size = cells.size();
        found.emplace(size, std::move(cells));
        if (size == enough) break;
    }
    std::vector<std::vector<LatticeCell>> lattices;
    for (auto& [size, cells] : found)
        lattices.push_back(std::move(cells));
    return lattices;
}

}  // namespace haustra::coverage
