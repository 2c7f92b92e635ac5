#include "flatten/tube/flip_repair.h"

#include "flatten/tube/shape_relaxation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>
#include <utility>

#include <Eigen/SparseLU>

namespace haustra::flatten {
namespace {

constexpr double leastHeight = 1e-4;  // of a triangle, against its longest side
constexpr int ringSteps[] = {0, 1, 2, 3, 5, 8, 12, 18};
/// A map with more flips than this, and one triangle in fifty, is not mended by patches, each of
/// which is solved for up to 24 times.
constexpr std::size_t mostFlips = 1000;
/// What a neighbour's weight is multiplied with for each ring that it lies further inside.
constexpr double leans[] = {1.0, 0.6, 0.3};

/// Turned over, or of as good as no height.
bool isFlipped(const PeriodicMap& map, const TriMesh& tube, int t) {
    const auto at = [&](int c) { return map.corner(tube, std::size_t(t), c); };
    const glm::dvec2 p = at(1) - at(0), q = at(2) - at(0), r = q - p;
    const double longest = std::max({glm::dot(p, p), glm::dot(q, q), glm::dot(r, r)});
    return !(p.x * q.y - p.y * q.x > leastHeight * longest);
}

/// tan of half the angle at a between b and c, kept within bounds.
double halfTangent(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const glm::dvec3 p = b - a, q = c - a;
    const double sine = glm::length(glm::cross(p, q)), cosine = glm::dot(p, q);
    const double full = std::sqrt(glm::dot(p, p) * glm::dot(q, q));
    if (sine > 1e-6 * full) return (full - cosine) / sine;
    return cosine > 0.0 ? 1e-6 : 1e6;
}

/// Points p with dot(inward, p) > offset lie on the inner side.
struct Line {
    glm::dvec2 inward;
    double offset;
};

/// The point whose least distance to the inner side of all lines is largest; none where that is not
/// positive. There it is equally far from three of them.
std::optional<glm::dvec2> farthestInside(const std::vector<Line>& lines) {
    const auto clearance = [&](const glm::dvec2& p) {
        double least = std::numeric_limits<double>::max();
        for (const Line& line : lines)
            least = std::min(least, glm::dot(line.inward, p) - line.offset);
        return least;
    };
    std::optional<glm::dvec2> best;
    double most = 0.0;
    for (std::size_t a = 0; a < lines.size(); ++a) {
        for (std::size_t b = a + 1; b < lines.size(); ++b) {
            for (std::size_t c = b + 1; c < lines.size(); ++c) {
                const glm::dvec2 ab = lines[a].inward - lines[b].inward,
                                 ac = lines[a].inward - lines[c].inward;
                const double determinant = ab.x * ac.y - ab.y * ac.x;
                if (std::abs(determinant) < 1e-12) continue;
                const double p = lines[a].offset - lines[b].offset,
                             q = lines[a].offset - lines[c].offset;
                const glm::dvec2 at =
                    glm::dvec2(p * ac.y - q * ab.y, q * ab.x - p * ac.x) / determinant;
                if (const double clear = clearance(at); clear > most) {
                    most = clear;
                    best = at;
                }
            }
        }
    }
    return best;
}

}  // namespace

bool centerInStar(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars, int v) {
    std::vector<Line> sides;
    for (const int corner : stars.of(v)) {
        const auto t = std::size_t(corner / 3);
        const int c = corner % 3;
        const glm::dvec2 at = map.corner(tube, t, c);
        const glm::dvec2 from = map.corner(tube, t, (c + 1) % 3) - at,
                         to = map.corner(tube, t, (c + 2) % 3) - at;
        const double length = glm::length(to - from);
        if (!(length > 0.0)) return false;
        const glm::dvec2 inward = glm::dvec2(from.y - to.y, to.x - from.x) / length;
        sides.push_back({inward, glm::dot(inward, from)});
    }
    const auto step = farthestInside(sides);
    if (step) map.flat[std::size_t(v)] += *step;
    return step.has_value();
}

namespace {

class Repair {
public:
    Repair(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars,
           const std::vector<char>& held)
        : map_(map), tube_(tube), stars_(stars), held_(held) {}

    /// The vertices moved, some more than once.
    std::vector<int> run(const std::vector<int>& bad) {
        std::vector<int> moved;
        for (const int t : bad) {
            // The repair of one before may have mended it, and between rims nothing can move.
            if (!isFlipped(map_, tube_, t) || onRims(t)) continue;
            const std::vector<int> patch = mend(t);
            moved.insert(moved.end(), patch.begin(), patch.end());
        }
        return moved;
    }

private:
    /// Vertices in rings round a triangle.
    struct Patch {
        std::vector<int> vertices;
        std::unordered_map<int, int> ringOf;
        int rings = -1;
    };

    bool isOnRim(int v) const {
        if (!held_.empty() && held_[std::size_t(v)]) return true;
        const double y = map_.flat[std::size_t(v)].y;
        return y == 0.0 || y == map_.height;
    }
    bool onRims(int t) const {
        const glm::ivec3& corners = tube_.triangles[std::size_t(t)];
        return isOnRim(corners[0]) && isOnRim(corners[1]) && isOnRim(corners[2]);
    }

    void add(Patch& patch, int t) const {
        for (int c = 0; c < 3; ++c) {
            const int v = tube_.triangles[std::size_t(t)][c];
            if (!isOnRim(v) && patch.ringOf.emplace(v, patch.rings).second)
                patch.vertices.push_back(v);
        }
    }

    void grow(Patch& patch) const {
        ++patch.rings;
        const std::size_t count = patch.vertices.size();
        for (std::size_t n = 0; n < count; ++n) {
            for (const int corner : stars_.of(patch.vertices[n]))
                add(patch, corner / 3);
        }
    }

    /// Moves v to the point within its star that is farthest from the star's sides; false where
    /// there is none from which all of its triangles would be upright.
    bool center(int v) { return centerInStar(map_, tube_, stars_, v); }

    /// The vertices that were moved for triangle t; none where nothing got better.
    std::vector<int> mend(int t) {
        for (int c = 0; c < 3; ++c) {
            const int v = tube_.triangles[std::size_t(t)][c];
            if (isOnRim(v)) continue;
            const glm::dvec2 before = map_.flat[std::size_t(v)];
            if (center(v) && !isFlipped(map_, tube_, t)) return {v};
            map_.flat[std::size_t(v)] = before;
        }
        Patch patch;
        patch.rings = 0;
        add(patch, t);
        int most = 0;  // flips mended
        std::vector<int> vertices;
        std::vector<glm::dvec2> places;
        bool whole = false;
        for (std::size_t n = 0; n < std::size(ringSteps) && !whole; ++n) {
            while (patch.rings < ringSteps[n])
                grow(patch);
            const std::vector<int> triangles = trianglesAround(patch);
            const std::vector<glm::dvec2> before = placesOf(patch.vertices);
            const int flipsBefore = flipsAmong(triangles);
            for (const double lean : leans) {
                if (!solve(patch, lean)) continue;
                const int flips = flipsAmong(triangles);
                if (flipsBefore - flips > most) {
                    most = flipsBefore - flips;
                    vertices = patch.vertices;
                    places = placesOf(vertices);
                }
                setPlaces(patch.vertices, before);
                whole = flips == 0;
                if (whole) break;
            }
        }
        setPlaces(vertices, places);
        return vertices;
    }

    std::vector<int> trianglesAround(const Patch& patch) const {
        std::vector<int> triangles;
        for (const int v : patch.vertices) {
            for (const int corner : stars_.of(v))
                triangles.push_back(corner / 3);
        }
        std::sort(triangles.begin(), triangles.end());
        triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
        return triangles;
    }

    int flipsAmong(const std::vector<int>& triangles) const {
        return int(std::count_if(triangles.begin(), triangles.end(),
                                 [&](int t) { return isFlipped(map_, tube_, t); }));
    }

    std::vector<glm::dvec2> placesOf(const std::vector<int>& vertices) const {
        std::vector<glm::dvec2> places;
        for (const int v : vertices)
            places.push_back(map_.flat[std::size_t(v)]);
        return places;
    }
    void setPlaces(const std::vector<int>& vertices, const std::vector<glm::dvec2>& places) {
        for (std::size_t n = 0; n < vertices.size(); ++n)
            map_.flat[std::size_t(vertices[n])] = places[n];
    }

    /// Puts each of the patch's vertices at the mean of its neighbours; false where that fails.
    bool solve(const Patch& patch, double lean) {
        const int size = int(patch.vertices.size());
        std::unordered_map<int, int> unknownOf;
        for (int n = 0; n < size; ++n)
            unknownOf.emplace(patch.vertices[std::size_t(n)], n);
        std::vector<Eigen::Triplet<double>> entries;
        Eigen::MatrixX2d right = Eigen::MatrixX2d::Zero(size, 2);
        for (int n = 0; n < size; ++n) {
            const int v = patch.vertices[std::size_t(n)];
            const int ring = patch.ringOf.at(v);
            double sum = 0.0;
            forWeights(v, [&](int w, double weight, double turns) {
                const auto inside = patch.ringOf.find(w);
                const int ringOfNeighbour =
                    inside == patch.ringOf.end() ? patch.rings + 1 : inside->second;
                weight *= std::pow(lean, ring - ringOfNeighbour);
                sum += weight;
                right(n, 0) += weight * turns;
                if (inside != patch.ringOf.end()) {
                    entries.emplace_back(n, unknownOf.at(w), -weight);
                } else {
                    right(n, 0) += weight * map_.flat[std::size_t(w)].x;
                    right(n, 1) += weight * map_.flat[std::size_t(w)].y;
                }
            });
            entries.emplace_back(n, n, sum);
        }
        Eigen::SparseMatrix<double> matrix(size, size);
        matrix.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SparseLU<Eigen::SparseMatrix<double>> lu(matrix);
        if (lu.info() != Eigen::Success) return false;
        const Eigen::MatrixX2d found = lu.solve(right);
        if (!found.allFinite()) return false;
        for (int n = 0; n < size; ++n) {
            glm::dvec2& at = map_.flat[std::size_t(patch.vertices[std::size_t(n)])];
            at = {found(n, 0), found(n, 1)};
        }
        return true;
    }

    /// Calls visit(w, weight, turns) for each neighbour w of v, twice for most; turns are those of
    /// w's place against v's where they share a triangle.
    template <class Visit>
    void forWeights(int v, const Visit& visit) const {
        const glm::dvec3& at = tube_.vertices[std::size_t(v)];
        for (const int corner : stars_.of(v)) {
            const auto t = std::size_t(corner / 3);
            const std::size_t here = std::size_t(corner % 3);
            const std::size_t others[2] = {(here + 1) % 3, (here + 2) % 3};
            const auto vertex = [&](std::size_t c) { return tube_.triangles[t][int(c)]; };
            const double tangent = halfTangent(at, tube_.vertices[std::size_t(vertex(others[0]))],
                                               tube_.vertices[std::size_t(vertex(others[1]))]);
            for (const std::size_t other : others) {
                const double mm = glm::distance(at, tube_.vertices[std::size_t(vertex(other))]);
                visit(vertex(other), tangent / std::max(mm, 1e-9),
                      double(map_.turns[t][other] - map_.turns[t][here]));
            }
        }
    }

    PeriodicMap& map_;
    const TriMesh& tube_;
    const VertexStars& stars_;
    const std::vector<char>& held_;  ///< they count as on a rim
};

}  // namespace

std::vector<int> unfold(PeriodicMap& map, const TriMesh& tube, const VertexStars& stars,
                        const std::vector<char>& held) {
    std::vector<int> flipped;
    for (int t = 0; t < int(tube.triangles.size()); ++t) {
        if (isFlipped(map, tube, t)) flipped.push_back(t);
    }
    if (flipped.size() > mostFlips + tube.triangles.size() / 50) return {};
    std::vector<int> moved = Repair(map, tube, stars, held).run(flipped);
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    return moved;
}

namespace {

int repair(PeriodicMap& map, const TriMesh& tube, const std::vector<char>& held) {
    constexpr double mostDilatation = 4.0;
    constexpr int sweeps = 20, mostRounds = 4;
    const VertexStars stars(tube);
    std::vector<int> moved;
    for (int round = 0; round < mostRounds; ++round) {
        const std::vector<int> unfolded = unfold(map, tube, stars, held);
        if (round > 0 && unfolded.empty()) break;
        std::vector<int> stretched = stretchedVertices(map, tube, stars, mostDilatation);
        std::erase_if(stretched, [&](int v) { return !held.empty() && held[std::size_t(v)]; });
        relaxShapes(map, tube, stars, stretched, sweeps);
        moved.insert(moved.end(), unfolded.begin(), unfolded.end());
        moved.insert(moved.end(), stretched.begin(), stretched.end());
    }
    std::sort(moved.begin(), moved.end());
    moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
    return int(moved.size());
}

}  // namespace

int repairMap(PeriodicMap& map, const TriMesh& tube, const std::vector<char>& apart) {
    int moved = 0;
    if (apart.empty()) {
        moved = repair(map, tube, {});
    } else {
        // The map without these triangles; their vertices are held where they are.
        TriMesh rest{tube.vertices, {}};
        PeriodicMap restMap{std::move(map.flat), {}, map.height};
        std::vector<char> held(tube.vertices.size(), 0);
        for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
            if (!apart[t]) {
                rest.triangles.push_back(tube.triangles[t]);
                restMap.turns.push_back(map.turns[t]);
                continue;
            }
            for (int c = 0; c < 3; ++c)
                held[std::size_t(tube.triangles[t][c])] = 1;
        }
        moved = repair(restMap, rest, held);
        map.flat = std::move(restMap.flat);
    }
    rotate(map, tube, 0.0);
    return moved;
}

}  // namespace haustra::flatten
