#include "flatten/tube/cut_pouch.h"

#include "core/flat_map.h"
#include "core/flood_fill.h"
#include "flatten/tube/conformal_tube.h"
#include "flatten/tube/disc_embedding.h"
#include "flatten/tube/flat_places.h"
#include "flatten/tube/flip_repair.h"
#include "flatten/tube/grid_drawing.h"
#include "flatten/tube/polygon_roll.h"
#include "flatten/tube/shape_relaxation.h"
#include "flatten/tube/spreading.h"
#include "flatten/tube/vertex_stars.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

/// crowdedUnits (pouches.h) on a pouch, which is shrunk once more when it is set in; and how many
/// pouches may sit on each other.
constexpr double fingerUnits = 4096.0;
constexpr int mostDepth = 3;
/// What lies deepest in a pouch is shrunk by no more than the exponential of this.
constexpr double mostFall = 7.0;
/// A pouch of more triangles than this is not embedded where one in a hundred is folded in the
/// target; one of more than the other, whose system would cost more than all else, not at all.
constexpr std::size_t mostFolded = 2000, mostEmbedded = 8000;
/// What has more triangles is drawn on a grid only where all else has failed.
constexpr std::size_t usuallyDrawn = 8000;
/// So many triangles that are too thin, and one in fifty, are widened one by one.
constexpr std::size_t fewThin = 30;

/// How far a place is to the left of the nearest side of a polygon; negative beyond one.
double clearance(const std::vector<glm::dvec2>& polygon, glm::dvec2 at) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < polygon.size(); ++n) {
        const glm::dvec2 from = polygon[n], to = polygon[(n + 1) % polygon.size()];
        const double length = glm::distance(from, to);
        if (length > 0.0) least = std::min(least, cross(to - from, at - from) / length);
    }
    return least;
}

/// A place from which all of the polygon is seen, as far from its sides as descent finds.
std::optional<glm::dvec2> centerOf(const std::vector<glm::dvec2>& polygon, glm::dvec2 middle,
                                   double radius) {
    glm::dvec2 mean(0.0);
    for (const glm::dvec2& p : polygon)
        mean += p / double(polygon.size());
    glm::dvec2 best = clearance(polygon, mean) > clearance(polygon, middle) ? mean : middle;
    double most = clearance(polygon, best);
    double step = 0.5 * radius;
    for (int n = 0; n < 60 && step > 1e-4 * radius; ++n) {
        glm::dvec2 next = best;
        double there = most;
        for (int d = 0; d < 8; ++d) {
            const double angle = 0.25 * std::numbers::pi * d;
            const glm::dvec2 tried = best + step * glm::dvec2(std::cos(angle), std::sin(angle));
            if (const double clear = clearance(polygon, tried); clear > there)
                there = clear, next = tried;
        }
        if (!(there > most)) step *= 0.5;
        best = next;
        most = there;
    }
    if (!(most > 0.0)) return std::nullopt;
    return best;
}

/// A pouch cut along its ring, with all that belongs to it numbered: the border's vertices, the
/// ring's, and the others.
class CutPouch {
public:
    CutPouch(const TriMesh& tube, const HalfedgeMesh& halfedges, const std::vector<char>& inside,
             const Pouch& pouch, int depth, PouchWork* work = nullptr)
        : tube_(tube),
          halfedges_(halfedges),
          inside_(inside),
          pouch_(pouch),
          depth_(depth),
          work_(work) {}

    /// The radius of a circle within the border, from whose middle all of that is seen, as a share
    /// of the pouch's; 0 where there is none. First of all.
    double roundness(const PeriodicMap& map) {
        if (!findBorder()) return 0.0;
        for (const int v : border_)
            borderFlat_.push_back(placeNear(map, v, pouch_.middle));
        center_ = centerOf(borderFlat_, pouch_.middle, pouch_.radius);
        return center_ ? clearance(borderFlat_, *center_) / pouch_.radius : 0.0;
    }

    /// Embeds what is within the ring as its own conformal map would have it. False where that
    /// cannot be made, or has triangles too thin for the lattice (thin()).
    bool place(double units) {
        if (!work_->take(pouch_.triangles.size()) || !cutAlong(1)) return false;
        shape();
        embed(units);
        return thin_ == 0;
    }

    /// In place of place: rolls up what is within two rings, of which no edge joins two of the
    /// outer one's vertices, as one that does would be a line on the strip. False as place is.
    bool placeApart(double units) {
        if (!work_->take(pouch_.triangles.size()) || !cutAlong(2) || ringsMeet()) return false;
        shape();
        return placeRolled(units);
    }

    /// After place: rolls the same up as a polygon, and keeps the better.
    bool placeRolled(double units) {
        if (thin_ > 0 && strip_) roll(units);
        return thin_ == 0;
    }

    /// After place: how many of its triangles the lattice may turn over; more than all where there
    /// is no map.
    std::size_t thin() const { return thin_; }
    std::size_t innerCount() const { return inner_.size(); }

    /// The ring becomes a triangle with round corners, which lets a second one within it, and all
    /// that this encloses, be drawn in the triangle of these corners. False where the grid is too
    /// fine for the lattice.
    bool placeOnGrid(double units) {
        if (!work_->take(pouch_.triangles.size()) || !cutAlong(2)) return false;
        if (ringsMeet()) return false;
        const std::vector<double> angles = ringAngles(*center_);
        const auto corners = cornersFor(angles);
        if (!corners) return false;
        std::vector<int> number(placesMm_.size());
        for (std::size_t n = 0; n < number.size(); ++n)
            number[n] = n < ring_ ? corners->of[n] : int(n - ring_) + 3;
        std::vector<glm::ivec3> triangles;
        for (const Piece& piece : inner_) {
            const glm::ivec3 t(number[std::size_t(piece.corners.x)],
                               number[std::size_t(piece.corners.y)],
                               number[std::size_t(piece.corners.z)]);
            if (t.x != t.y && t.y != t.z && t.z != t.x) triangles.push_back(t);
        }
        const int count = int(placesMm_.size() - ring_) + 3;
        const auto drawn = drawOnGrid(triangles, count);
        if (!drawn) return false;
        // In which corners 0, 1 and 2 have their own weights.
        const glm::dmat3 weights = glm::inverse(
            glm::dmat3(glm::dvec3((*drawn)[0]), glm::dvec3((*drawn)[1]), glm::dvec3((*drawn)[2])));
        // Where the ellipses around the corners look in the ring's directions.
        std::vector<double> ellipse;
        for (std::size_t n = 0; n < ring_; ++n) {
            const int c = corners->of[n];
            const glm::dvec2 outward(std::cos(angles[n]), std::sin(angles[n]));
            ellipse.push_back(
                std::atan2(glm::dot(corners->at[c] - corners->at[(c + 2) % 3], outward),
                           glm::dot(corners->at[c] - corners->at[(c + 1) % 3], outward)));
        }
        const double clear = clearance(borderFlat_, *center_);
        for (const double share : {0.9, 0.75, 0.5, 0.25}) {
            for (const double round : {0.125, 0.03125, 0.0078125}) {
                const auto inWeights = [&](const glm::dvec3& w) {
                    return share * clear * (1.0 - round) *
                           (w.x * corners->at[0] + w.y * corners->at[1] + w.z * corners->at[2]);
                };
                const Grid grid = gridFor(*center_ + inWeights(glm::dvec3(1.0 / 3.0)),
                                          inWeights(weights * glm::dvec3(-1.0, 1.0, 0.0)),
                                          inWeights(weights * glm::dvec3(-1.0, 0.0, 1.0)),
                                          double(count - 1), units);
                places_.clear();
                for (std::size_t n = 0; n < ring_; ++n) {
                    const int c = corners->of[n];
                    const glm::dvec2 place = grid.beyondCorner(c, (*drawn)[std::size_t(c)],
                                                               ellipse[n], share * clear * round);
                    places_.push_back(glm::round(place * units) / units);
                }
                for (std::size_t n = ring_; n < placesMm_.size(); ++n)
                    places_.push_back(grid.at((*drawn)[std::size_t(number[n])]));
                if (fillCollar(units) && gridUpright(units)) return true;
            }
        }
        return false;
    }

    /// After place: what comes instead of the pouch.
    PlacedPouch result() && {
        PlacedPouch placed;
        placed.triangles = pouch_.triangles;
        placed.verticesMm = std::move(placesMm_);
        placed.places = std::move(places_);
        placed.tubeVertex = std::move(innerVertex_);
        placed.tubeVertex.resize(placed.verticesMm.size(), -1);
        for (std::size_t n = 0; n < border_.size(); ++n)
            placed.borderPlaces.emplace(border_[n], borderFlat_[n]);
        placed.collar = std::move(collarTriangles_);
        placed.inner = std::move(inner_);
        return placed;
    }

private:
    using Piece = PlacedPouch::Piece;
    struct Polygon {
        std::vector<int> corners;
        int source;
    };

    /// Where a grid's points lie: on the lattice, so that nothing is rounded.
    struct Grid {
        glm::dvec2 origin, second, third;  ///< and the steps along those coordinates

        glm::dvec2 at(glm::ivec3 place) const {
            return origin + double(place.y) * second + double(place.z) * third;
        }

        /// A place for one of the vertices that corner `c` of the grid, at `drawn`, stands for:
        /// corner − p (a cos φ + b sin φ), where a and b are the steps from it along its sides,
        /// 0 < φ < π / 2, and p so that the longer one is `away`. That lies beyond both sides. Of
        /// two neighbours of the corner that follow each other around it, the second is never
        /// farther along a and never less far along b (Schnyder), so that their triangle with it
        /// has no less area than with the corner; two such vertices, φ ascending, make upright
        /// triangles with any place within the grid.
        glm::dvec2 beyondCorner(int c, glm::ivec3 drawn, double phi, double away) const {
            const glm::dvec2 steps[3] = {{0.0, 0.0}, second, third};
            const glm::dvec2 a = steps[(c + 1) % 3] - steps[c], b = steps[(c + 2) % 3] - steps[c];
            const double p = away / std::max(glm::length(a), glm::length(b));
            return at(drawn) - p * (std::cos(phi) * a + std::sin(phi) * b);
        }
    };

    /// With about these steps, and three coordinates of `sum` / 3 at about `middle`.
    static Grid gridFor(glm::dvec2 middle, glm::dvec2 second, glm::dvec2 third, double sum,
                        double units) {
        const auto onLattice = [&](glm::dvec2 at) { return glm::round(at * units) / units; };
        Grid grid{{}, onLattice(second), onLattice(third)};
        grid.origin = onLattice(middle - sum / 3.0 * (grid.second + grid.third));
        return grid;
    }

    /// Whether all that is within the ring is upright, whose places are the lattice's own: those
    /// of a pouch that is still to be rolled up with what it is on will not be.
    bool gridUpright(double units) const {
        if (depth_ > 0) return allUpright(innerTriangles(), units);
        return std::ranges::all_of(inner_, [&](const Piece& piece) {
            const auto at = [&](int corner) { return places_[std::size_t(piece.corners[corner])]; };
            return cross(at(1) - at(0), at(2) - at(0)) > 0.0;
        });
    }

    bool isBorder(int h) const { return !inside_[std::size_t(halfedges_.opposite(h) / 3)]; }

    bool findBorder() {
        std::unordered_map<int, int> leaves;
        int start = -1;
        for (const int t : pouch_.triangles) {
            for (int h = 3 * t; h < 3 * t + 3; ++h) {
                if (!isBorder(h)) continue;
                leaves[halfedges_.origin(h)] = h;
                if (start < 0) start = h;
            }
        }
        if (start < 0) return false;
        int h = start;
        do {
            borderIndex_.emplace(halfedges_.origin(h), int(border_.size()));
            border_.push_back(halfedges_.origin(h));
            leaving_.push_back(h);
            const auto next = leaves.find(halfedges_.target(h));
            if (next == leaves.end() || border_.size() > leaves.size()) return false;
            h = next->second;
        } while (h != start);
        return border_.size() == leaves.size() && border_.size() >= 3;
    }

    static std::uint64_t keyOf(int from, int to) {
        return std::uint64_t(std::uint32_t(from)) << 32 | std::uint32_t(to);
    }

    /// Whether both rings run along one edge.
    bool ringsMeet() const {
        return std::ranges::any_of(collar_, [](const Polygon& p) { return p.corners.size() == 5; });
    }

    /// Numbers and cuts what is within the border, along one ring or two; false where that is
    /// none.
    bool cutAlong(int rings) {
        if (!center_) return false;
        rings_ = rings;
        splitInwards();
        if (ring_ < 3) return false;
        number();
        cut();
        return true;
    }

    /// Cuts each edge that leads from the border inwards, in order around the rings.
    void splitInwards() {
        std::vector<glm::dvec3> second;
        for (std::size_t n = 0; n < border_.size(); ++n) {
            const int q = border_[n];
            std::vector<int> inwards;
            for (int h = leaving_[n];;) {
                const int previous = HalfedgeMesh::previous(h);
                if (isBorder(previous)) break;
                h = halfedges_.opposite(previous);
                inwards.push_back(halfedges_.target(h));
            }
            std::reverse(inwards.begin(), inwards.end());
            for (std::size_t k = 0; k < inwards.size(); ++k) {
                const int to = inwards[k];
                // An edge from border to border is cut from both ends.
                const double share = 1.0 / ((borderIndex_.contains(to) ? 2 : 1) * rings_ + 1);
                const glm::dvec3 from = tube_.vertices[std::size_t(q)],
                                 towards = tube_.vertices[std::size_t(to)];
                split_.emplace(keyOf(q, to), int(ring_++));
                placesMm_.push_back(glm::mix(from, towards, share));
                if (rings_ > 1) second.push_back(glm::mix(from, towards, 2.0 * share));
                slot_.push_back({int(n), (double(k) + 0.5) / double(inwards.size())});
            }
        }
        placesMm_.insert(placesMm_.end(), second.begin(), second.end());
    }

    void number() {
        innerVertex_.assign(placesMm_.size(), -1);
        for (const int t : pouch_.triangles) {
            for (int c = 0; c < 3; ++c) {
                const int v = tube_.triangles[std::size_t(t)][c];
                if (borderIndex_.contains(v)) continue;
                if (!innerNumber_.emplace(v, int(innerVertex_.size())).second) continue;
                innerVertex_.push_back(v);
                placesMm_.push_back(tube_.vertices[std::size_t(v)]);
            }
        }
    }

    /// Each triangle's part within the last ring, as a fan, its parts between two, and its parts
    /// outside, as polygons.
    void cut() {
        const int lastRing = (rings_ - 1) * int(ring_);
        for (const int t : pouch_.triangles) {
            int corner[3];
            bool on[3], side[3];  // the side from a corner to the next is one of the border
            for (int c = 0; c < 3; ++c) {
                corner[c] = halfedges_.origin(3 * t + c);
                on[c] = borderIndex_.contains(corner[c]);
                side[c] = isBorder(3 * t + c);
            }
            const auto splitAt = [&](int from, int to) {
                return split_.at(keyOf(corner[from], corner[to]));
            };
            std::vector<int> within;
            for (int c = 0; c < 3; ++c) {
                const int next = (c + 1) % 3, last = (c + 2) % 3;
                if (!on[c]) {
                    within.push_back(innerNumber_.at(corner[c]));
                    continue;
                }
                if (!side[last]) within.push_back(lastRing + splitAt(c, last));
                if (!side[c]) within.push_back(lastRing + splitAt(c, next));
            }
            for (std::size_t n = 1; n + 1 < within.size(); ++n)
                inner_.push_back({{within[0], within[n], within[n + 1]}, t});
            // Corners along the border hang together.
            for (int c = 0; c < 3; ++c) {
                if (!on[c] || side[(c + 2) % 3]) continue;
                const int first = splitAt(c, (c + 2) % 3);
                Polygon polygon{{-1 - first}, t};
                int at = c;
                polygon.corners.push_back(corner[at]);
                while (side[at]) {
                    at = (at + 1) % 3;
                    polygon.corners.push_back(corner[at]);
                }
                const int second = splitAt(at, (at + 1) % 3);
                polygon.corners.push_back(-1 - second);
                collar_.push_back(std::move(polygon));
                if (rings_ == 1) continue;
                inner_.push_back({{first, second, lastRing + second}, t});
                inner_.push_back({{first, lastRing + second, lastRing + first}, t});
            }
        }
    }

    std::vector<glm::ivec3> innerTriangles() const {
        std::vector<glm::ivec3> triangles;
        for (const Piece& piece : inner_)
            triangles.push_back(piece.corners);
        return triangles;
    }

    /// The inner vertex that is most edges away from the ring; −1 where its triangles reach that.
    int farthest() const {
        TriMesh disc{placesMm_, innerTriangles()};
        const VertexStars stars(disc);
        std::vector<int> edges(placesMm_.size(), -1), front(ring_);
        std::iota(front.begin(), front.end(), 0);
        std::fill(edges.begin(), edges.begin() + std::ptrdiff_t(ring_), 0);
        const auto starOf = [&](int v, const auto& visit) {
            for (const int corner : stars.of(v)) {
                for (int c = 0; c < 3; ++c)
                    visit(disc.triangles[std::size_t(corner / 3)][c], edges[std::size_t(v)] + 1);
            }
        };
        floodFill(front, starOf, [&](int w, int away) {
            if (edges[std::size_t(w)] >= 0) return false;
            edges[std::size_t(w)] = away;
            return true;
        });
        return edges[std::size_t(front.back())] >= 3 ? front.back() : -1;
    }

    /// Finds strip_: what is within the ring without its tip is a tube, which a conformal map
    /// gives room all along; fingers on it are pouches of their own. None where there are too few
    /// vertices for that.
    void shape() {
        const int end = farthest();
        if (end < 0) return;
        TriMesh tube{placesMm_, {}};
        std::vector<Piece> rest, atTip;
        for (const Piece& piece : inner_) {
            const glm::ivec3 t = piece.corners;
            const bool touches = t.x == end || t.y == end || t.z == end;
            (touches ? atTip : rest).push_back(piece);
            if (!touches) tube.triangles.push_back(t);
        }
        ConformalTubeOptions options;
        options.threads = 1;
        options.repairFlips = false;
        auto flat = conformalTube(tube, 0, options);
        if (!flat) return;
        PeriodicMap map = std::move(flat->map);
        std::vector<Pouch> fingers;
        if (depth_ < mostDepth) fingers = findPouches(tube, map, fingerUnits);
        std::vector<char> apart;
        if (!fingers.empty()) apart.assign(tube.triangles.size(), 0);
        for (const Pouch& finger : fingers) {
            for (const int t : finger.triangles)
                apart[std::size_t(t)] = 1;
        }
        repairMap(map, tube, apart);
        if (!fingers.empty()) {
            SetIn made = setIn(tube, map, fingers, *work_, depth_ + 1);
            std::vector<Piece> pieces;
            for (std::size_t t = 0; t < made.tube.triangles.size(); ++t) {
                const auto source = std::size_t(made.sourceTriangle[t]);
                pieces.push_back({made.tube.triangles[t], rest[source].source});
            }
            rest = std::move(pieces);
            placesMm_ = std::move(made.tube.vertices);
            map = std::move(made.map);
        }
        inner_ = std::move(rest);
        inner_.insert(inner_.end(), atTip.begin(), atTip.end());
        strip_ = std::move(map);
        tip_ = end;
    }

    /// The strip rolled up to a disc, as what is to be aimed at. A conformal map would have radii
    /// of exp(−2π y); they fall more gently where that leaves the tip no room. Without a strip all
    /// vertices count alike.
    void rollUp() {
        target_.assign(placesMm_.size(), glm::dvec2(0.0));
        if (!strip_) return;
        const double fall = std::min(2.0 * std::numbers::pi, mostFall / strip_->height);
        for (std::size_t v = 0; v < target_.size(); ++v) {
            if (int(v) == tip_) continue;
            const glm::dvec2 at = strip_->flat[v];
            const double angle = 2.0 * std::numbers::pi * at.x;
            target_[v] = std::exp(-fall * at.y) * glm::dvec2(std::cos(angle), std::sin(angle));
        }
    }

    std::size_t foldsOfTarget() const {
        return std::size_t(std::ranges::count_if(inner_, [&](const Piece& piece) {
            const glm::dvec2 a = target_[std::size_t(piece.corners.x)];
            return !(cross(target_[std::size_t(piece.corners.y)] - a,
                           target_[std::size_t(piece.corners.z)] - a) > 0.0);
        }));
    }

    /// The directions from `center` in which the ring's vertices may lie, in order.
    std::vector<double> ringAngles(glm::dvec2 center) const {
        std::vector<double> angle;
        for (std::size_t n = 0; n < borderFlat_.size(); ++n) {
            const glm::dvec2 away = borderFlat_[n] - center;
            double at = std::atan2(away.y, away.x);
            if (n > 0)
                at += 2.0 * std::numbers::pi *
                      std::ceil((angle.back() - at) / (2.0 * std::numbers::pi));
            angle.push_back(at);
        }
        const auto count = int(angle.size());
        const auto angleAt = [&](int n) {
            if (n < 0) return angle.back() - 2.0 * std::numbers::pi;
            if (n >= count) return angle.front() + 2.0 * std::numbers::pi;
            return angle[std::size_t(n)];
        };
        std::vector<double> ring;
        for (const auto& [n, share] : slot_) {
            const double low = 0.5 * (angleAt(n - 1) + angleAt(n)),
                         high = 0.5 * (angleAt(n) + angleAt(n + 1));
            ring.push_back(low + share * (high - low));
        }
        return ring;
    }

    /// A triangle within the unit circle, and for each of the ring's vertices the corner whose
    /// supporting directions its own is among.
    struct Corners {
        glm::dvec2 at[3];
        std::vector<int> of;
    };

    /// As regular as the ring's directions, in ascending order, allow; nothing where one is without
    /// any near enough.
    static std::optional<Corners> cornersFor(const std::vector<double>& angles) {
        constexpr double turn = 2.0 * std::numbers::pi, third = turn / 3.0, widest = 0.47 * turn;
        const std::size_t count = angles.size();
        // A side of the triangle looks in the middle between two vertices.
        const auto between = [&](std::size_t n) {
            return 0.5 * (angles[n] + (n + 1 < count ? angles[n + 1] : angles[0] + turn));
        };
        double best = widest;
        std::array<std::size_t, 3> sides{};
        for (std::size_t a = 0; a < count; ++a) {
            const auto nearest = [&](double away) {
                std::size_t found = a;
                double least = turn;
                for (std::size_t n = 0; n < count; ++n) {
                    const double there = between(n) - between(a) + (n < a ? turn : 0.0);
                    if (n == a || !(std::abs(there - away) < least)) continue;
                    least = std::abs(there - away);
                    found = n;
                }
                return found;
            };
            std::array<std::size_t, 3> tried{a, nearest(third), nearest(2.0 * third)};
            if (tried[0] == tried[1] || tried[1] == tried[2] || tried[2] == tried[0]) continue;
            std::sort(tried.begin(), tried.end());
            const double gap = std::max({between(tried[1]) - between(tried[0]),
                                         between(tried[2]) - between(tried[1]),
                                         between(tried[0]) + turn - between(tried[2])});
            if (gap < best) best = gap, sides = tried;
        }
        if (!(best < widest)) return std::nullopt;
        Corners corners;
        double farthest = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            // Between the sides c and c + 1, both of which touch the unit circle.
            const double low = between(sides[c]),
                         high = c < 2 ? between(sides[c + 1]) : between(sides[0]) + turn;
            const double middle = 0.5 * (low + high), away = 1.0 / std::cos(0.5 * (high - low));
            corners.at[c] = away * glm::dvec2(std::cos(middle), std::sin(middle));
            farthest = std::max(farthest, away);
        }
        for (glm::dvec2& at : corners.at)
            at /= farthest;
        for (std::size_t n = 0; n < count; ++n)
            corners.of.push_back(n > sides[0] && n <= sides[1]   ? 0
                                 : n > sides[1] && n <= sides[2] ? 1
                                                                 : 2);
        return corners;
    }

    /// Triangulates what is between the border and the ring in its places; false where it cannot.
    bool fillCollar(double units) {
        const auto placeOf = [&](int key) {
            return key >= 0 ? borderFlat_[std::size_t(borderIndex_.at(key))]
                            : places_[std::size_t(-1 - key)];
        };
        collarTriangles_.clear();
        for (const Polygon& polygon : collar_) {
            const std::size_t corners = polygon.corners.size();
            bool done = false;
            for (std::size_t first = 0; first < corners && !done; ++first) {
                // Of five corners four are on one edge: only from the fifth no piece is a line.
                if (corners == 5 && first != 2) continue;
                const auto at = [&](std::size_t n) {
                    return polygon.corners[(first + n) % corners];
                };
                done = true;
                for (std::size_t n = 1; n + 1 < corners && done; ++n)
                    done = upright(placeOf(at(0)), placeOf(at(n)), placeOf(at(n + 1)), units);
                if (!done) continue;
                for (std::size_t n = 1; n + 1 < corners; ++n)
                    collarTriangles_.push_back({{at(0), at(n), at(n + 1)}, polygon.source});
            }
            if (!done) return false;
        }
        return true;
    }

    bool allUpright(const std::vector<glm::ivec3>& triangles, double units) const {
        return std::ranges::all_of(triangles, [&](const glm::ivec3& t) {
            return upright(places_[std::size_t(t.x)], places_[std::size_t(t.y)],
                           places_[std::size_t(t.z)], units);
        });
    }

    /// The largest circle for the ring, of these directions and distances in it, that leaves the
    /// collar room; what is within only shrinks with it.
    std::optional<double> collarRadius(const std::vector<glm::dvec2>& ring, double units) {
        for (const double share : {0.9, 0.75, 0.5, 0.25}) {
            const double radius = share * clearance(borderFlat_, *center_);
            places_.clear();
            for (const glm::dvec2& at : ring)
                places_.push_back(*center_ + radius * at);
            if (fillCollar(units)) return radius;
        }
        return std::nullopt;
    }

    std::size_t thinTriangles(double units) const {
        std::size_t count = 0;
        for (const Piece& piece : inner_) {
            const glm::ivec3 t = piece.corners;
            count += !upright(places_[std::size_t(t.x)], places_[std::size_t(t.y)],
                              places_[std::size_t(t.z)], units);
        }
        return count;
    }

    /// Embeds what is within the ring, which becomes a circle.
    void embed(double units) {
        std::vector<glm::dvec2> ring;
        for (const double angle : ringAngles(*center_))
            ring.push_back({std::cos(angle), std::sin(angle)});
        if (!collarRadius(ring, units)) return;
        rollUp();
        // Around folds of the target all neighbours weigh the same, and rows of those shrink by a
        // factor each.
        if (inner_.size() > mostEmbedded ||
            (inner_.size() > mostFolded && foldsOfTarget() > inner_.size() / 100))
            return;
        if (!work_->take(inner_.size())) return;
        const std::vector<glm::ivec3> triangles = innerTriangles();
        auto places = embedDisc(triangles, places_, target_);
        if (!places) return;
        places_ = std::move(*places);
        settle(units);
    }

    /// Rolls up what is within the ring, which becomes a polygon; keeps that where it is better.
    void roll(double units) {
        if (!work_->take(inner_.size())) return;
        auto rolled =
            rollAsPolygon({placesMm_, innerTriangles()}, *strip_, tip_, ringAngles(*center_));
        if (!rolled) return;
        const auto before = std::tuple(places_, placesMm_, inner_, collarTriangles_, thin_);
        const std::vector<glm::dvec2> ring(rolled->places.begin(),
                                           rolled->places.begin() + std::ptrdiff_t(ring_));
        thin_ = std::numeric_limits<std::size_t>::max();
        if (const auto radius = collarRadius(ring, units)) {
            for (glm::dvec2& at : rolled->places)
                at = *center_ + *radius * at;
            places_ = std::move(rolled->places);
            placesMm_ = std::move(rolled->disc.vertices);
            std::vector<Piece> pieces;
            for (std::size_t t = 0; t < rolled->disc.triangles.size(); ++t) {
                const auto source = std::size_t(rolled->sourceTriangle[t]);
                pieces.push_back({rolled->disc.triangles[t], inner_[source].source});
            }
            inner_ = std::move(pieces);
            settle(units);
        }
        if (thin_ >= std::get<std::size_t>(before))
            std::tie(places_, placesMm_, inner_, collarTriangles_, thin_) = before;
    }

    /// Widens what is thin, unless that is too much, and counts what remains of it.
    void settle(double units) {
        thin_ = thinTriangles(units);
        if (thin_ == 0 || thin_ > fewThin + inner_.size() / 50) return;
        widen(innerTriangles(), units);
        thin_ = thinTriangles(units);
    }

    /// What is thin gets its shape back where it can; the border stays.
    void widen(const std::vector<glm::ivec3>& triangles, double units) {
        const TriMesh disc{placesMm_, triangles};
        std::vector<char> held(placesMm_.size(), 0);
        std::fill(held.begin(), held.begin() + std::ptrdiff_t(ring_), char(1));
        PeriodicMap map{std::move(places_),
                        std::vector<std::array<std::int8_t, 3>>(triangles.size()), 0.0};
        const VertexStars stars(disc);
        unfold(map, disc, stars, held);
        std::vector<int> thin;
        for (std::size_t t = 0; t < triangles.size(); ++t) {
            if (upright(map.corner(disc, t, 0), map.corner(disc, t, 1), map.corner(disc, t, 2),
                        units))
                continue;
            for (int c = 0; c < 3; ++c) {
                for (const int corner : stars.of(triangles[t][c])) {
                    for (int n = 0; n < 3; ++n)
                        thin.push_back(triangles[std::size_t(corner / 3)][n]);
                }
            }
        }
        std::sort(thin.begin(), thin.end());
        thin.erase(std::unique(thin.begin(), thin.end()), thin.end());
        std::erase_if(thin, [&](int v) { return held[std::size_t(v)] != 0; });
        constexpr int sweeps = 20;
        relaxShapes(map, disc, stars, thin, sweeps);
        spread(map, disc, stars, held, units);
        places_ = std::move(map.flat);
    }

    /// What is thin still takes room from its neighbours.
    static void spread(PeriodicMap& map, const TriMesh& disc, const VertexStars& stars,
                       const std::vector<char>& held, double units) {
        std::vector<int> thin;
        for (int t = 0; t < int(disc.triangles.size()); ++t) {
            const auto at = [&](int c) { return map.corner(disc, std::size_t(t), c); };
            if (!upright(at(0), at(1), at(2), units)) thin.push_back(t);
        }
        Spreading spreading(map, disc, stars, held, units);
        for (const std::vector<int>& cluster : clustersOf(disc, stars, thin))
            spreading.run(cluster);
    }

    const TriMesh& tube_;
    const HalfedgeMesh& halfedges_;
    const std::vector<char>& inside_;
    const Pouch pouch_;
    std::vector<int> border_, leaving_;  ///< vertices in order, and the half-edges that leave them
    std::unordered_map<int, int> borderIndex_;
    std::vector<glm::dvec2> borderFlat_;
    std::optional<glm::dvec2> center_;
    std::unordered_map<std::uint64_t, int> split_;  ///< the ring's vertices, by the edge's ends
    int rings_ = 1;
    std::size_t ring_ = 0;                      ///< vertices of a ring
    std::vector<std::pair<int, double>> slot_;  ///< of the ring's vertices: which border vertex's,
                                                ///< and where in its share of the circle
    /// The rings' vertices, the pouch's others, and those that its own fingers' rings add.
    std::vector<glm::dvec3> placesMm_;
    std::vector<int> innerVertex_;  ///< the tube's, −1 on the ring
    std::unordered_map<int, int> innerNumber_;
    std::vector<Piece> inner_, collarTriangles_;
    std::vector<Polygon> collar_;
    std::optional<PeriodicMap> strip_;
    int tip_ = -1;  ///< the vertex that is not on it
    std::vector<glm::dvec2> target_, places_;
    std::size_t thin_ = std::numeric_limits<std::size_t>::max();
    int depth_;  ///< of pouches that this is on
    PouchWork* work_;
};

/// Leaves out the triangles that have two sides on the border and lie well where they are.
void trim(const TriMesh& tube, const HalfedgeMesh& halfedges, const PeriodicMap& map,
          std::vector<char>& inside, Pouch& pouch) {
    const double units = flatUnitsPerCircumference(map.height);
    for (bool again = true; again;) {
        again = false;
        for (const int t : pouch.triangles) {
            if (!inside[std::size_t(t)]) continue;
            int sides = 0;
            for (int h = 3 * t; h < 3 * t + 3; ++h)
                sides += !inside[std::size_t(halfedges.opposite(h) / 3)];
            const auto at = [&](int c) { return map.corner(tube, std::size_t(t), c); };
            if (sides != 2 || !upright(at(0), at(1), at(2), units)) continue;
            inside[std::size_t(t)] = 0;
            again = true;
        }
    }
    std::erase_if(pouch.triangles, [&](int t) { return !inside[std::size_t(t)]; });
}

}  // namespace

double roundness(const TriMesh& tube, const HalfedgeMesh& halfedges, const PeriodicMap& map,
                 const std::vector<char>& inside, const Pouch& pouch) {
    return CutPouch(tube, halfedges, inside, pouch, 0).roundness(map);
}

std::optional<PlacedPouch> placed(const TriMesh& tube, const HalfedgeMesh& halfedges,
                                  const PeriodicMap& map, const std::vector<char>& inside,
                                  const Pouch& pouch, int depth, double roundness, std::size_t most,
                                  Grids grids, PouchWork& work) {
    const double units = flatUnitsPerCircumference(map.height);
    std::optional<CutPouch> shaped(std::in_place, tube, halfedges, inside, pouch, depth, &work);
    if (!(shaped->roundness(map) > roundness)) return std::nullopt;
    if (shaped->place(units)) return std::move(*shaped).result();
    Pouch trimmed = pouch;
    std::vector<char> within = inside;
    trim(tube, halfedges, map, within, trimmed);
    std::optional<CutPouch> drawn(std::in_place, tube, halfedges, within, trimmed, depth, &work);
    const bool isLarge = trimmed.triangles.size() > usuallyDrawn,
               seen = drawn->roundness(map) > 0.0;
    if (!isLarge && seen && drawn->placeOnGrid(units)) return std::move(*drawn).result();
    if (shaped->placeRolled(units)) return std::move(*shaped).result();
    if (isLarge && grids == Grids::any && seen && drawn->placeOnGrid(units))
        return std::move(*drawn).result();
    if (shaped->thin() <= most) return std::move(*shaped).result();
    std::optional<CutPouch> apart(std::in_place, tube, halfedges, within, trimmed, depth, &work);
    if (apart->roundness(map) > 0.0) apart->placeApart(units);
    if (apart->thin() <= most) return std::move(*apart).result();
    return std::nullopt;
}

}  // namespace haustra::flatten
