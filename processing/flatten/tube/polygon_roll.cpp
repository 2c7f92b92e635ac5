#include "flatten/tube/polygon_roll.h"

#include "flatten/tube/flat_places.h"
#include "flatten/tube/vertex_stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <unordered_map>
#include <utility>

namespace haustra::flatten {
namespace {

constexpr std::size_t mostCorners = 6, mostLevels = 12, trianglesPerLevel = 100;
constexpr double turn = 2.0 * std::numbers::pi, widest = 0.42 * turn;
/// A vertex so near to a cut, of the way to its nearest neighbour along x or y, moves onto it.
constexpr double snapShare = 0.2;
/// What is nearer to a line than this, in turns, is on it: its x would not survive that a turn is
/// added.
constexpr double hair = 1e-9;

std::uint64_t keyOf(int a, int b) {
    return std::uint64_t(std::uint32_t(std::min(a, b))) << 32 | std::uint32_t(std::max(a, b));
}

/// The polygons' corners: which of the ring's vertices, their x in ascending order, from one turn's
/// beginning on, and their directions.
struct Corners {
    std::vector<double> x;
    std::vector<glm::dvec2> at;
};

std::optional<Corners> chooseCorners(const PeriodicMap& strip, const std::vector<double>& angles) {
    const std::size_t count = angles.size(), wanted = std::min(mostCorners, count);
    if (count < 3) return std::nullopt;
    std::vector<std::size_t> chosen;
    for (std::size_t k = 0; k < wanted; ++k) {
        const double aim = angles[0] + turn * double(k) / double(wanted);
        const auto nearest = std::ranges::min_element(
            angles, {}, [&](double angle) { return std::abs(angle - aim); });
        const auto n = std::size_t(nearest - angles.begin());
        if (chosen.empty() || n > chosen.back()) chosen.push_back(n);
    }
    Corners corners;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
        const std::size_t n = chosen[k];
        const double next = k + 1 < chosen.size() ? angles[chosen[k + 1]] : angles[0] + turn;
        if (!(next - angles[n] < widest)) return std::nullopt;
        double x = strip.flat[n].x;
        if (k > 0) x += std::ceil(corners.x.back() - x);
        if (k > 0 &&
            !(x > corners.x.back() + 2.0 * hair && x < corners.x.front() + 1.0 - 2.0 * hair))
            return std::nullopt;
        corners.x.push_back(x);
        corners.at.push_back({std::cos(angles[n]), std::sin(angles[n])});
    }
    return corners;
}

class Roll {
public:
    Roll(const TriMesh& disc, const PeriodicMap& strip, int tip, Corners corners)
        : strip_(strip), corners_(std::move(corners)), tip_(tip) {
        made_.disc.vertices = disc.vertices;
        at_ = strip.flat;
        at_.resize(disc.vertices.size(), glm::dvec2(0.0));
        // From the first corner on, so that the lines are at their own x in the first turn.
        shift_.assign(at_.size(), 0);
        for (std::size_t v = 0; v < at_.size(); ++v) {
            const double turns = std::floor(at_[v].x - corners_.x.front() + hair);
            at_[v].x -= turns;
            shift_[v] = int(turns);
            for (const double line : corners_.x) {
                if (std::abs(at_[v].x - line) < hair) at_[v].x = line;
            }
        }
        for (std::size_t t = 0; t < disc.triangles.size(); ++t)
            add(disc.triangles[t], int(t));
    }

    bool run() {
        if (!liftTip()) return false;
        chooseLevels();
        snap();
        for (const double x : corners_.x)
            cutAlong(x, 0);
        for (std::size_t k = 1; k + 1 < levels_.size(); ++k)
            cutAlong(levels_[k], 1);
        if (rimCut_) return false;
        place();
        return true;
    }

    RolledDisc take() { return std::move(made_); }

private:
    /// How many turns its corners are to the right of where at_ has them.
    using Turns = std::array<int, 3>;

    void add(const glm::ivec3& t, int number) {
        made_.disc.triangles.push_back(t);
        made_.sourceTriangle.push_back(number);
        Turns turns{};
        if (std::size_t(number) < strip_.turns.size()) {
            for (int c = 0; c < 3; ++c)
                turns[std::size_t(c)] =
                    strip_.turns[std::size_t(number)][std::size_t(c)] + shift_[std::size_t(t[c])];
        }
        turns_.push_back(turns);
    }

    glm::dvec2 corner(std::size_t t, int c) const {
        const glm::dvec2 at = at_[std::size_t(made_.disc.triangles[t][c])];
        return {at.x + turns_[t][std::size_t(c)], at.y};
    }

    /// The tip's triangles lie as the strip's do beyond their edges.
    bool liftTip() {
        std::unordered_map<std::uint64_t, std::pair<int, int>> across;
        const std::size_t strips = strip_.turns.size();
        for (std::size_t t = 0; t < strips; ++t) {
            for (int c = 0; c < 3; ++c) {
                const int a = made_.disc.triangles[t][c], b = made_.disc.triangles[t][(c + 1) % 3];
                if (at_[std::size_t(a)].y == strip_.height &&
                    at_[std::size_t(b)].y == strip_.height)
                    across[keyOf(a, b)] = {
                        a, turns_[t][std::size_t((c + 1) % 3)] - turns_[t][std::size_t(c)]};
            }
        }
        for (std::size_t t = strips; t < turns_.size(); ++t) {
            glm::ivec3& at = made_.disc.triangles[t];
            while (at.z != tip_) {
                if (at.x != tip_ && at.y != tip_) return false;
                at = {at.y, at.z, at.x};
            }
            const auto edge = across.find(keyOf(at.x, at.y));
            if (edge == across.end()) return false;
            const int turns =
                edge->second.first == at.x ? edge->second.second : -edge->second.second;
            turns_[t] = {0, turns, 0};
        }
        return true;
    }

    /// Levels with the same number of triangles between them, and their radii.
    void chooseLevels() {
        std::vector<double> ys;
        for (std::size_t t = 0; t < strip_.turns.size(); ++t)
            ys.push_back((corner(t, 0).y + corner(t, 1).y + corner(t, 2).y) / 3.0);
        std::sort(ys.begin(), ys.end());
        const std::size_t rows =
            std::clamp<std::size_t>(ys.size() / trianglesPerLevel, 1, mostLevels);
        const double atTip = double(turns_.size() - ys.size());
        levels_.assign(1, 0.0);
        std::vector<double> within{double(ys.size()) + atTip}, steps;
        for (std::size_t k = 1; k <= rows; ++k) {
            const std::size_t end = ys.size() * k / rows;
            const double to = k < rows ? ys[end] : strip_.height;
            const double high = to - levels_.back(),
                         count = within.back() - atTip - double(ys.size() - end);
            if (!(high > 0.0)) continue;
            // Of sides 1 / n a strip has 4 n² / √3 triangles for each unit of height.
            steps.push_back(std::sqrt(0.25 * std::numbers::sqrt3 * count * high));
            levels_.push_back(to);
            within.push_back(double(ys.size() - end) + atTip);
        }
        double beyond = 1.0, all = 1.0;
        for (const double step : steps)
            all += step;
        radii_.assign(levels_.size(), 1.0);
        for (std::size_t k = steps.size(); k > 0; --k) {
            radii_[k] = 0.5 * (std::sqrt(within[k] / within[0]) + beyond / all);
            beyond += steps[k - 1];
        }
    }

    /// Whether the triangles around a vertex are upright on the strip.
    bool stands(const VertexStars& stars, int v) const {
        return std::ranges::all_of(stars.of(v), [&](int n) {
            const auto t = std::size_t(n / 3);
            if (t >= strip_.turns.size()) return true;
            const glm::dvec2 a = corner(t, 0);
            return cross(corner(t, 1) - a, corner(t, 2) - a) > 0.0;
        });
    }

    void snap() {
        const VertexStars stars(made_.disc);
        for (int v = 0; v < int(at_.size()); ++v) {
            if (v == tip_) continue;
            snapTo(stars, v, 0, corners_.x);
            const double y = at_[std::size_t(v)].y;
            if (y > 0.0 && y < strip_.height) snapTo(stars, v, 1, levels_);
        }
    }

    void snapTo(const VertexStars& stars, int v, int axis, const std::vector<double>& lines) {
        glm::dvec2& at = at_[std::size_t(v)];
        double nearest = lines.front();
        for (const double line : lines) {
            if (std::abs(line - at[axis]) < std::abs(nearest - at[axis])) nearest = line;
        }
        if (nearest == at[axis] || !stands(stars, v)) return;
        double least = std::numeric_limits<double>::infinity();
        for (const int n : stars.of(v)) {
            const auto t = std::size_t(n / 3);
            if (t >= strip_.turns.size()) continue;
            for (int c = 1; c < 3; ++c)
                least =
                    std::min(least, glm::distance(corner(t, n % 3), corner(t, (n % 3 + c) % 3)));
        }
        if (!(std::abs(nearest - at[axis]) < snapShare * least)) return;
        // A rim's own vertices are where the lines are; others of it would meet them.
        if (axis == 0 && (at.y == 0.0 || at.y == strip_.height)) return;
        const double before = at[axis];
        at[axis] = nearest;
        if (!stands(stars, v)) at[axis] = before;
    }

    /// Parts every triangle that has corners on both sides of a line.
    void cutAlong(double line, int axis) {
        std::unordered_map<std::uint64_t, int> middles;
        for (std::size_t t = 0, count = made_.disc.triangles.size(); t < count; ++t)
            cut(t, line, axis, middles);
    }

    void cut(std::size_t t, double line, int axis,
             std::unordered_map<std::uint64_t, int>& middles) {
        const glm::ivec3 at = made_.disc.triangles[t];
        const bool isTips = at.z == tip_;
        if (isTips && axis == 1) return;
        // From the line, and for x from which of its copies: the one right of the leftmost corner.
        double away[3] = {0.0, 0.0, 0.0};
        const int corners = isTips ? 2 : 3;
        for (int c = 0; c < corners; ++c)
            away[c] = at_[std::size_t(at[c])][axis] - line;
        if (axis == 0) {
            const Turns& turns = turns_[t];
            copy_ = std::numeric_limits<int>::max();
            for (int c = 0; c < corners; ++c)
                copy_ = std::min(copy_, turns[std::size_t(c)] + (away[c] < 0.0 ? 0 : 1));
            for (int c = 0; c < corners; ++c)
                away[c] += turns[std::size_t(c)] - copy_;
        }
        const auto sides = [&](int c, int d) { return away[c] * away[d] < 0.0; };
        int one = -1;  // the corner that is alone on its side, or between a cut edge and one on it
        for (int c = 0; c < 3; ++c) {
            const int next = (c + 1) % 3, last = (c + 2) % 3;
            if (sides(c, next) && sides(c, last)) one = c;
        }
        if (one >= 0) return cutOff(t, one, away, line, axis, middles);
        for (int c = 0; c < 3; ++c) {
            if (sides(c, (c + 1) % 3)) return halve(t, c, away, line, axis, middles);
        }
    }

    /// The vertex at which the edge from corner c to corner d is cut, and its turns in t.
    std::pair<int, int> middle(std::size_t t, int c, int d, const double* away, double line,
                               int axis, std::unordered_map<std::uint64_t, int>& middles) {
        const int a = made_.disc.triangles[t][c], b = made_.disc.triangles[t][d];
        const auto [entry, isNew] = middles.try_emplace(keyOf(a, b), int(at_.size()));
        const double share = away[c] / (away[c] - away[d]);
        glm::dvec2 there = glm::mix(corner(t, c), corner(t, d), share);
        there[axis] = line + (axis == 0 ? copy_ : 0);
        if (isNew) {
            rimCut_ = rimCut_ || (at_[std::size_t(a)].y == 0.0 && at_[std::size_t(b)].y == 0.0);
            made_.disc.vertices.push_back(glm::mix(made_.disc.vertices[std::size_t(a)],
                                                   made_.disc.vertices[std::size_t(b)], share));
            at_.push_back(there);
            if (axis == 0) at_.back().x = line;
        }
        const int v = entry->second;
        return {v, int(std::lround(there.x - at_[std::size_t(v)].x))};
    }

    void replace(std::size_t t, const glm::ivec3& at, const Turns& turns) {
        made_.disc.triangles[t] = at;
        turns_[t] = turns;
    }
    void append(std::size_t from, const glm::ivec3& at, const Turns& turns) {
        made_.disc.triangles.push_back(at);
        made_.sourceTriangle.push_back(made_.sourceTriangle[from]);
        turns_.push_back(turns);
    }

    void cutOff(std::size_t t, int one, const double* away, double line, int axis,
                std::unordered_map<std::uint64_t, int>& middles) {
        const int next = (one + 1) % 3, last = (one + 2) % 3;
        const auto [p, pTurns] = middle(t, one, next, away, line, axis, middles);
        const auto [q, qTurns] = middle(t, one, last, away, line, axis, middles);
        const glm::ivec3 at = made_.disc.triangles[t];
        const Turns turns = turns_[t];
        const int a = at[one], b = at[next], c = at[last];
        const int ta = turns[std::size_t(one)], tb = turns[std::size_t(next)],
                  tc = turns[std::size_t(last)];
        replace(t, {a, p, q}, {ta, pTurns, qTurns});
        // The quadrilateral by its shorter diagonal on the strip.
        const auto place = [&](int v, int n) {
            return glm::dvec2(at_[std::size_t(v)].x + n, at_[std::size_t(v)].y);
        };
        if (glm::distance(place(p, pTurns), place(c, tc)) <
            glm::distance(place(b, tb), place(q, qTurns))) {
            append(t, {p, b, c}, {pTurns, tb, tc});
            append(t, {p, c, q}, {pTurns, tc, qTurns});
        } else {
            append(t, {p, b, q}, {pTurns, tb, qTurns});
            append(t, {b, c, q}, {tb, tc, qTurns});
        }
    }

    /// Cut through the corner opposite of the edge from c on.
    void halve(std::size_t t, int c, const double* away, double line, int axis,
               std::unordered_map<std::uint64_t, int>& middles) {
        const int next = (c + 1) % 3, last = (c + 2) % 3;
        const auto [p, pTurns] = middle(t, c, next, away, line, axis, middles);
        const glm::ivec3 at = made_.disc.triangles[t];
        const Turns turns = turns_[t];
        const auto turnsOf = [&](int n) { return turns[std::size_t(n)]; };
        append(t, {p, at[next], at[last]}, {pTurns, turnsOf(next), turnsOf(last)});
        replace(t, {at[c], p, at[last]}, {turnsOf(c), pTurns, turnsOf(last)});
    }

    void place() {
        for (std::size_t v = 0; v < at_.size(); ++v) {
            made_.places.push_back(int(v) == tip_ ? glm::dvec2(0.0)
                                                  : radiusAt(at_[v].y) * sideAt(at_[v].x));
        }
    }

    double radiusAt(double y) const {
        auto next = std::upper_bound(levels_.begin() + 1, levels_.end() - 1, y);
        const auto k = std::size_t(next - levels_.begin());
        const double t = (y - levels_[k - 1]) / (levels_[k] - levels_[k - 1]);
        return 1.0 / ((1.0 - t) / radii_[k - 1] + t / radii_[k]);
    }

    glm::dvec2 sideAt(double x) const {
        const double first = corners_.x.front();
        x -= std::floor(x - first);
        const auto next = std::upper_bound(corners_.x.begin() + 1, corners_.x.end(), x);
        const auto k = std::size_t(next - corners_.x.begin());
        const bool last = k == corners_.x.size();
        const double from = corners_.x[k - 1], to = last ? first + 1.0 : corners_.x[k];
        return glm::mix(corners_.at[k - 1], corners_.at[last ? 0 : k],
                        std::clamp((x - from) / (to - from), 0.0, 1.0));
    }

    const PeriodicMap& strip_;
    Corners corners_;
    int tip_;
    RolledDisc made_;
    std::vector<glm::dvec2> at_;  ///< on the strip
    std::vector<int> shift_;
    std::vector<Turns> turns_;
    std::vector<double> levels_, radii_;
    int copy_ = 0;         ///< of the line, where a triangle is being cut
    bool rimCut_ = false;  ///< an edge along y = 0, which must not be
};

}  // namespace

std::optional<RolledDisc> rollAsPolygon(const TriMesh& disc, const PeriodicMap& strip, int tip,
                                        const std::vector<double>& ringAngles) {
    auto corners = chooseCorners(strip, ringAngles);
    if (!corners) return std::nullopt;
    Roll roll(disc, strip, tip, std::move(*corners));
    if (!roll.run()) return std::nullopt;
    return roll.take();
}

}  // namespace haustra::flatten
