#include "flatten/tube/seam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace haustra::flatten {
namespace {

constexpr int columns = 720;
// Beyond the seam a picture repeats about so much of the circumference; it is to be quiet too.
constexpr double marginTurns = 0.04;
// A vertex this near to the seam, in edges, lies on it: a cut there would leave a sliver. Nearer
// than the least hair its x would not survive the addition of a turn.
constexpr double hairShare = 1e-6, leastHair = 1e-12;

glm::dvec3 corner(const TriMesh& tube, std::size_t triangle, int c) {
    return tube.vertices[std::size_t(tube.triangles[triangle][c])];
}

int columnOf(double x) {
    const int column = int(std::floor((x - std::floor(x)) * columns));
    return std::clamp(column, 0, columns - 1);
}

/// The mean of `values` over the margin to both sides of each column.
std::vector<double> overMargin(const std::vector<double>& values) {
    const int reach = int(std::lround(marginTurns * columns));
    std::vector<double> means(columns);
    for (int column = 0; column < columns; ++column) {
        double sum = 0.0;
        for (int step = -reach; step <= reach; ++step)
            sum += values[std::size_t((column + step + columns) % columns)];
        means[std::size_t(column)] = sum / (2 * reach + 1);
    }
    return means;
}

/// ∫ |mean curvature| ds along the vertical trajectories of each column, but for a factor. An edge
/// holds the bend angle · length of its surroundings' area; per millimetre across, of which a turn
/// has length / flat length, that is angle · flat length.
std::vector<double> bendOfColumns(const TriMesh& tube, const PeriodicMap& map) {
    struct Side {
        glm::dvec3 normal;
        double flatLength, x;
    };
    std::unordered_map<std::uint64_t, Side> waiting;
    waiting.reserve(tube.triangles.size() * 2);
    std::vector<double> bend(columns, 0.0);
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        const glm::dvec3 p = corner(tube, t, 0);
        const glm::dvec3 normal = glm::cross(corner(tube, t, 1) - p, corner(tube, t, 2) - p);
        for (int c = 0; c < 3; ++c) {
            const int next = (c + 1) % 3;
            const auto a = std::uint64_t(tube.triangles[t][c]),
                       b = std::uint64_t(tube.triangles[t][next]);
            const glm::dvec2 from = map.corner(tube, t, c), to = map.corner(tube, t, next);
            const auto [other, first] =
                waiting.try_emplace(std::min(a, b) << 32 | std::max(a, b),
                                    Side{normal, glm::distance(from, to), 0.5 * (from.x + to.x)});
            if (first) continue;
            const double angle = std::atan2(glm::length(glm::cross(normal, other->second.normal)),
                                            glm::dot(normal, other->second.normal));
            bend[std::size_t(columnOf(other->second.x))] += angle * other->second.flatLength;
            waiting.erase(other);
        }
    }
    return bend;
}

/// How many of `keepAwayMm` each column passes within the radius: vertices that hang together with
/// the one nearest to the place, so that another bend of the colon nearby does not count.
std::vector<double> nearbyPlaces(const TriMesh& tube, const PeriodicMap& map,
                                 const SeamOptions& options) {
    std::vector<double> count(columns, 0.0);
    for (const glm::dvec3& place : options.keepAwayMm) {
        std::vector<char> within(tube.vertices.size(), 0), reached(tube.vertices.size(), 0);
        std::size_t nearest = 0;
        for (std::size_t v = 0; v < tube.vertices.size(); ++v) {
            const double distance = glm::distance(tube.vertices[v], place);
            within[v] = distance <= options.keepAwayRadiusMm;
            if (distance < glm::distance(tube.vertices[nearest], place)) nearest = v;
        }
        if (!within[nearest]) continue;
        reached[nearest] = 1;
        std::vector<char> touched(columns, 0);
        for (bool more = true; more;) {
            more = false;
            for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
                const glm::ivec3& corners = tube.triangles[t];
                bool meets = false;
                for (int c = 0; c < 3; ++c)
                    meets = meets || reached[std::size_t(corners[c])];
                if (!meets) continue;
                double low = std::numeric_limits<double>::infinity(), high = -low;
                for (int c = 0; c < 3; ++c) {
                    const auto v = std::size_t(corners[c]);
                    more = more || (within[v] && !reached[v]);
                    reached[v] = reached[v] || within[v];
                    low = std::min(low, map.corner(tube, t, c).x);
                    high = std::max(high, map.corner(tube, t, c).x);
                }
                const double step = 1.0 / columns;
                for (double x = low; x < high + step; x += step)
                    touched[std::size_t(columnOf(std::min(x, high)))] = 1;
            }
        }
        for (int column = 0; column < columns; ++column)
            count[std::size_t(column)] += touched[std::size_t(column)];
    }
    return count;
}

/// Of two equal numbers it is that number, which rounding would miss.
double between(double from, double to, double share) {
    return std::clamp(from + share * (to - from), std::min(from, to), std::max(from, to));
}

/// Cuts triangle after triangle at the whole numbers of x. Lines are cut in ascending order, so
/// that two triangles cut the edge between them at the same places.
class SeamCut {
public:
    SeamCut(const TriMesh& tube, const PeriodicMap& map) : tube_(tube), map_(map) {
        const std::size_t vertices = tube.vertices.size();
        points_.reserve(vertices);
        for (std::size_t v = 0; v < vertices; ++v)
            points_.push_back({tube.vertices[v], map.flat[v]});
        copies_.assign(vertices, {-1, -1});
    }

    FlatMap cut() {
        for (std::size_t t = 0; t < tube_.triangles.size(); ++t) {
            source_ = std::int32_t(t);
            Piece piece;
            for (int c = 0; c < 3; ++c) {
                piece[std::size_t(c)] = {tube_.triangles[t][c],
                                         std::int64_t(map_.turns[t][std::size_t(c)])};
            }
            split(piece);
        }
        made_.height = map_.height;
        return std::move(made_);
    }

private:
    struct Point {
        glm::dvec3 positionMm;
        glm::dvec2 flat;  ///< x in [0, 1), exactly 0 on the seam
    };
    struct Corner {
        std::int32_t point;
        std::int64_t turn;
    };
    using Piece = std::array<Corner, 3>;

    double xOf(Corner corner) const {
        return points_[std::size_t(corner.point)].flat.x + double(corner.turn);
    }

    void split(const Piece& piece) {
        // Without a seam between its lowest and highest x, a piece goes to the result.
        double low = xOf(piece[0]), high = low;
        for (const Corner& corner : piece)
            low = std::min(low, xOf(corner)), high = std::max(high, xOf(corner));
        const double line = std::floor(low) + 1.0;
        if (high <= line) return emit(piece, std::int64_t(line) - 1);
        for (std::size_t c = 0; c < 3; ++c) {  // the corner that is alone on its side, first
            const Corner &a = piece[c], &b = piece[(c + 1) % 3], &d = piece[(c + 2) % 3];
            const double xa = xOf(a) - line, xb = xOf(b) - line, xd = xOf(d) - line;
            if (xa == 0.0 && xb * xd < 0.0) {
                const Corner m = crossing(b, d, line);
                split({a, b, m});
                return split({a, m, d});
            }
            if (xa * xb < 0.0 && xa * xd < 0.0) {
                const Corner p = crossing(a, b, line), q = crossing(d, a, line);
                split({a, p, q});
                split({p, b, d});
                return split({p, d, q});
            }
        }
    }

    /// Where the edge meets the line; the same point from both its sides.
    Corner crossing(Corner a, Corner b, double line) {
        if (a.point > b.point || (a.point == b.point && a.turn > b.turn)) std::swap(a, b);
        const std::uint64_t key = std::uint64_t(a.point) << 32 | std::uint64_t(b.point);
        const auto [made, isNew] = crossings_.try_emplace(key, std::int32_t(points_.size()));
        if (isNew) {
            const double share = (line - xOf(a)) / (xOf(b) - xOf(a));
            const Point from = points_[std::size_t(a.point)], to = points_[std::size_t(b.point)];
            points_.push_back({glm::mix(from.positionMm, to.positionMm, share),
                               {0.0, between(from.flat.y, to.flat.y, share)}});
            copies_.push_back({-1, -1});
        }
        return {made->second, std::int64_t(line)};
    }

    void emit(const Piece& piece, std::int64_t turn) {
        glm::ivec3 triangle;
        for (int c = 0; c < 3; ++c) {
            const Corner& corner = piece[std::size_t(c)];
            const Point& point = points_[std::size_t(corner.point)];
            // 1 at the far side of the seam, where its copy stands; else 0.
            const std::int64_t side = corner.turn - turn;
            std::int32_t& copy = copies_[std::size_t(corner.point)][std::size_t(side)];
            if (copy < 0) {
                copy = std::int32_t(made_.flat.size());
                made_.surface.vertices.push_back(point.positionMm);
                made_.flat.push_back({point.flat.x + double(side), point.flat.y});
            }
            triangle[c] = copy;
        }
        made_.surface.triangles.push_back(triangle);
        made_.sourceTriangle.push_back(source_);
    }

    const TriMesh& tube_;
    const PeriodicMap& map_;
    std::vector<Point> points_;
    std::vector<std::array<std::int32_t, 2>> copies_;  ///< of each point, at x and at x + 1
    std::unordered_map<std::uint64_t, std::int32_t> crossings_;
    std::int32_t source_ = 0;
    FlatMap made_;
};

/// Vertices within a hair of x = 0 move onto it.
void snapToSeam(PeriodicMap& map, const TriMesh& tube) {
    std::vector<double> shortest(map.flat.size(), 1.0);
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        for (int c = 0; c < 3; ++c) {
            const double length =
                glm::distance(map.corner(tube, t, c), map.corner(tube, t, (c + 1) % 3));
            for (const int end : {c, (c + 1) % 3}) {
                double& least = shortest[std::size_t(tube.triangles[t][end])];
                least = std::min(least, length);
            }
        }
    }
    std::vector<std::int8_t> raised(map.flat.size(), 0);
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        double& x = map.flat[v].x;
        const double hair = std::max(hairShare * shortest[v], leastHair);
        if (x > 1.0 - hair) raised[v] = 1;
        if (raised[v] || x < hair) x = 0.0;
    }
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        for (int c = 0; c < 3; ++c)
            map.turns[t][std::size_t(c)] += raised[std::size_t(tube.triangles[t][c])];
    }
}

}  // namespace

double bestSeam(const TriMesh& tube, const PeriodicMap& map, const SeamOptions& options) {
    const std::vector<double> bend = overMargin(bendOfColumns(tube, map));
    const std::vector<double> nearby = overMargin(nearbyPlaces(tube, map, options));
    int best = 0;
    for (int column = 1; column < columns; ++column) {
        const auto at = std::size_t(column), held = std::size_t(best);
        if (std::pair(nearby[at], bend[at]) < std::pair(nearby[held], bend[held])) best = column;
    }
    return (best + 0.5) / columns;
}

FlatMap cutAlongSeam(const TriMesh& tube, PeriodicMap map, double seam) {
    rotate(map, tube, seam);
    // Rounding must not carry a vertex past the rims.
    for (glm::dvec2& at : map.flat)
        at.y = std::clamp(at.y, 0.0, map.height);
    snapToSeam(map, tube);
    return SeamCut(tube, map).cut();
}

}  // namespace haustra::flatten
