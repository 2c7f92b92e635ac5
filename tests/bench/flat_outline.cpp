#include "flat_outline.h"

#include "geodesic_frame.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace haustra::bench {
namespace {

double cross(glm::dvec2 a, glm::dvec2 b) {
    return a.x * b.y - a.y * b.x;
}

double areaMm2(const TriMesh& mesh, int triangle) {
    const glm::ivec3 t = mesh.triangles[std::size_t(triangle)];
    const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
    return 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - a,
                                        mesh.vertices[std::size_t(t.z)] - a));
}

class FieldCut {
public:
    FieldCut(const TriMesh& tube, const mesh::HalfedgeMesh& edges, const flatten::PeriodicMap& map,
             const std::function<double(glm::dvec3)>& inside)
        : tube_(tube), edges_(edges), map_(map), inside_(inside) {
        piece_.assign(tube.vertices.size(), -1);
        for (std::size_t v = 0; v < piece_.size(); ++v)
            if (inside(tube.vertices[v]) < 0.0) piece_[v] = none;
    }

    /// The vertices of the piece with the largest area get its number; −1 where there is none.
    int largestPiece() {
        std::map<int, double> areas;
        int count = 0;
        for (std::size_t v = 0; v < piece_.size(); ++v)
            if (piece_[v] == none && edges_.outgoing(int(v)) >= 0) spread(int(v), count++);
        for (std::size_t t = 0; t < tube_.triangles.size(); ++t) {
            for (int c = 0; c < 3; ++c) {
                const int piece = piece_[std::size_t(tube_.triangles[t][c])];
                if (piece >= 0) areas[piece] += areaMm2(tube_, int(t)) / 3.0;
            }
        }
        int best = -1;
        for (const auto& [piece, area] : areas)
            if (best < 0 || area > areas[best]) best = piece;
        return best;
    }

    double areaInside(int piece) const {
        double sum = 0.0;
        for (std::size_t t = 0; t < tube_.triangles.size(); ++t) {
            // What a corner inside, or one outside, cuts off has the product of both edges' shares.
            int inside = 0;
            double corner = 1.0, rest = 1.0;
            for (int h = int(3 * t); h < int(3 * t) + 3; ++h) {
                inside += piece_[std::size_t(edges_.origin(h))] == piece;
                const bool out = leaves(h, piece);
                if (!out && !(edges_.opposite(h) >= 0 && leaves(edges_.opposite(h), piece)))
                    continue;
                const double share = shareInside(out ? h : edges_.opposite(h));
                corner *= share, rest *= 1.0 - share;
            }
            const double part[4] = {0.0, corner, 1.0 - rest, 1.0};
            if (inside > 0) sum += part[inside] * areaMm2(tube_, int(t));
        }
        return sum;
    }

    /// Half-edges that leave the piece, in the order of the border, one list a border; false where
    /// one ends at a rim.
    bool borders(int piece, std::vector<std::vector<int>>& lists) const {
        std::vector<char> seen(std::size_t(edges_.halfedgeCount()), 0);
        for (int h = 0; h < edges_.halfedgeCount(); ++h) {
            if (seen[std::size_t(h)] || !leaves(h, piece)) continue;
            std::vector<int>& list = lists.emplace_back();
            int at = h;
            do {
                seen[std::size_t(at)] = 1;
                list.push_back(at);
                at = nextCrossing(at, piece);
                if (at < 0) return false;
            } while (at != h);
        }
        return true;
    }

    /// The border in space and in the plane; false where it runs around the colon.
    bool trace(const std::vector<int>& border, int piece, FlatOutline& outline) const {
        std::vector<char> wanted(piece_.size(), 0);
        for (std::size_t v = 0; v < piece_.size(); ++v)
            wanted[v] = piece_[v] == piece;
        const std::vector<glm::dvec2> unrolled = unroll(tube_, edges_, wanted);
        glm::dvec2 at = flatAt(border[0], shareInside(border[0]));
        const glm::dvec2 start = at;
        for (std::size_t n = 0; n < border.size(); ++n) {
            const int h = border[n], next = border[(n + 1) % border.size()];
            const double share = shareInside(h);
            outline.flat.push_back(at);
            outline.placesMm.push_back(glm::mix(tube_.vertices[std::size_t(edges_.origin(h))],
                                                tube_.vertices[std::size_t(edges_.target(h))],
                                                share));
            outline.unrolledMm.push_back(glm::mix(unrolled[std::size_t(edges_.origin(h))],
                                                  unrolled[std::size_t(edges_.target(h))], share));
            // Both crossings as the triangle between them has them.
            at += flatAt(edges_.opposite(next), 1.0 - shareInside(next)) - flatAt(h, share);
        }
        return glm::distance(at, start) < 0.5;
    }

private:
    static constexpr int none = -2;

    void spread(int from, int piece) {
        std::vector<int> open{from};
        piece_[std::size_t(from)] = piece;
        while (!open.empty()) {
            const int v = open.back();
            open.pop_back();
            const int begin = edges_.outgoing(v);
            int h = begin;
            do {
                // The edge before it in its triangle ends at `v`: both neighbours are met.
                for (const int w : {edges_.target(h), edges_.origin(edges_.previous(h))}) {
                    if (piece_[std::size_t(w)] != none) continue;
                    piece_[std::size_t(w)] = piece;
                    open.push_back(w);
                }
                h = edges_.turnLeft(h);
            } while (h >= 0 && h != begin);
        }
    }

    bool leaves(int h, int piece) const {
        return piece_[std::size_t(edges_.origin(h))] == piece &&
               piece_[std::size_t(edges_.target(h))] == -1;
    }

    /// The border goes on through the triangle to the left of h, and leaves it over the edge whose
    /// other half-edge leaves the piece.
    int nextCrossing(int h, int piece) const {
        for (const int other : {edges_.next(h), edges_.previous(h)}) {
            const int across = edges_.opposite(other);
            const bool enters = piece_[std::size_t(edges_.origin(other))] == -1 &&
                                piece_[std::size_t(edges_.target(other))] == piece;
            if (enters) return across;
        }
        return -1;
    }

    /// How far along h, which leaves the piece, the field changes its sign.
    double shareInside(int h) const {
        const glm::dvec3 a = tube_.vertices[std::size_t(edges_.origin(h))],
                         b = tube_.vertices[std::size_t(edges_.target(h))];
        double low = 0.0, high = 1.0;
        for (int round = 0; round < 32; ++round) {
            const double middle = 0.5 * (low + high);
            (inside_(glm::mix(a, b, middle)) < 0.0 ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    glm::dvec2 flatAt(int h, double t) const {
        const auto triangle = std::size_t(h / 3);
        return glm::mix(map_.corner(tube_, triangle, h % 3),
                        map_.corner(tube_, triangle, (h + 1) % 3), t);
    }

    const TriMesh& tube_;
    const mesh::HalfedgeMesh& edges_;
    const flatten::PeriodicMap& map_;
    const std::function<double(glm::dvec3)>& inside_;
    std::vector<int> piece_;  ///< per vertex; −1: outside
};

}  // namespace

std::optional<FlatOutline> outlineOf(const TriMesh& tube, const mesh::HalfedgeMesh& edges,
                                     const flatten::PeriodicMap& map,
                                     const std::function<double(glm::dvec3)>& inside) {
    FieldCut cut(tube, edges, map, inside);
    const int piece = cut.largestPiece();
    std::vector<std::vector<int>> borders;
    if (piece < 0 || !cut.borders(piece, borders)) return std::nullopt;
    std::optional<FlatOutline> best;
    double bestArea = 0.0;
    for (const auto& border : borders) {
        FlatOutline outline;
        if (!cut.trace(border, piece, outline)) return std::nullopt;
        const double area = shapeOf(outline.flat).area;
        if (area > bestArea) bestArea = area, best = std::move(outline);
    }
    if (best) best->insideMm2 = cut.areaInside(piece);
    return best;
}

OutlineShape shapeOf(const std::vector<glm::dvec2>& polygon) {
    if (polygon.size() < 3) return {};
    // Moments by Green's theorem, about the first corner.
    double area = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    glm::dvec2 sum(0.0);
    for (std::size_t n = 1; n + 1 < polygon.size(); ++n) {
        const glm::dvec2 a = polygon[n] - polygon[0], b = polygon[n + 1] - polygon[0];
        const double doubled = cross(a, b);
        area += doubled / 2.0;
        sum += doubled / 6.0 * (a + b);
        xx += doubled / 12.0 * (a.x * a.x + a.x * b.x + b.x * b.x);
        yy += doubled / 12.0 * (a.y * a.y + a.y * b.y + b.y * b.y);
        xy += doubled / 24.0 * (2.0 * a.x * a.y + a.x * b.y + a.y * b.x + 2.0 * b.x * b.y);
    }
    if (area == 0.0) return {};
    const glm::dvec2 middle = sum / area;
    const double u = xx / area - middle.x * middle.x, v = yy / area - middle.y * middle.y,
                 w = xy / area - middle.x * middle.y;
    const double mean = 0.5 * (u + v), half = std::hypot(0.5 * (u - v), w);
    return {std::abs(area), std::sqrt((mean + half) / std::max(mean - half, 1e-300))};
}

std::vector<glm::dvec2> fromAbove(const std::vector<glm::dvec3>& curve) {
    std::vector<glm::dvec2> seen;
    if (curve.size() < 3) return seen;
    glm::dvec3 vectorArea(0.0);
    for (std::size_t n = 1; n + 1 < curve.size(); ++n)
        vectorArea += glm::cross(curve[n] - curve[0], curve[n + 1] - curve[0]);
    const glm::dvec3 along = glm::normalize(vectorArea);
    const glm::dvec3 u = glm::normalize(
        glm::cross(along, std::abs(along.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 v = glm::cross(along, u);
    for (const glm::dvec3& p : curve)
        seen.push_back({glm::dot(p - curve[0], u), glm::dot(p - curve[0], v)});
    return seen;
}

double stretchBetween(const std::vector<glm::dvec2>& from, const std::vector<glm::dvec2>& to) {
    const std::size_t count = from.size();
    if (count < 3) return 1.0;
    std::vector<double> weight(count);
    double sum = 0.0;
    glm::dvec2 fromMiddle(0.0), toMiddle(0.0);
    for (std::size_t n = 0; n < count; ++n) {
        weight[n] = glm::distance(from[n], from[(n + 1) % count]) +
                    glm::distance(from[n], from[(n + count - 1) % count]);
        sum += weight[n];
        fromMiddle += weight[n] * from[n];
        toMiddle += weight[n] * to[n];
    }
    fromMiddle /= sum, toMiddle /= sum;
    glm::dmat2 both(0.0), own(0.0);
    for (std::size_t n = 0; n < count; ++n) {
        both += weight[n] * glm::outerProduct(to[n] - toMiddle, from[n] - fromMiddle);
        own += weight[n] * glm::outerProduct(from[n] - fromMiddle, from[n] - fromMiddle);
    }
    const glm::dmat2 map = both * glm::inverse(own);
    const double conformal = 0.5 * std::hypot(map[0][0] + map[1][1], map[0][1] - map[1][0]),
                 rest = 0.5 * std::hypot(map[0][0] - map[1][1], map[0][1] + map[1][0]);
    return (conformal + rest) / std::abs(conformal - rest);
}

}  // namespace haustra::bench
