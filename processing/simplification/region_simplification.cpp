#include "simplification/region_simplification.h"

#include "simplification/contact.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace haustra::simplification {
namespace {

constexpr float guardMm = 1.0f;                          // about a contact
constexpr int guardedAttempts = 4;                       // then the guard is everywhere
constexpr float everywhereMm = float(2.0 * farthestMm);  // from the middle
constexpr double wantedAngleDegrees = 20.0;              // sharper corners are bettered
constexpr int maxValence = 12;
constexpr double leastNormalCosine = 0.3;  // between a triangle and what takes its place

double cosineOf(double degrees) {
    return std::cos(degrees * (std::numbers::pi / 180.0));
}

/// Cosine of the smallest angle of a triangle; 1 where it has no area.
double sharpestCosine(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    double s = glm::dot(b - a, b - a), m = glm::dot(c - b, c - b), l = glm::dot(a - c, a - c);
    if (s > m) std::swap(s, m);
    if (s > l) std::swap(s, l);
    const double product = m * l;
    return product > 0.0 ? 0.5 * (m + l - s) / std::sqrt(product) : 1.0;
}

glm::dvec3 upright(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::cross(b - a, c - a);
}

/// One attempt at a region. Of one thread.
class RegionSimplification {
public:
    /// Contacts of the surface with itself are refused in the `guarded` boxes only.
    RegionSimplification(RegionPart& part, double minAngleDegrees,
                         std::span<const FloatBox> guarded);
    void run();

private:
    struct Candidate {
        float error;
        int a, b;  ///< a < b
        std::uint32_t version;
        bool operator<(const Candidate& other) const {
            // std::push_heap keeps the greatest on top; the least error is wanted there.
            if (error != other.error) return error > other.error;
            return a != other.a ? a > other.a : b > other.b;
        }
    };

    enum class Quality { noSharper, better };

    bool inBox(const glm::dvec3& p) const;
    bool movable(int v) const { return part_.movable[v] && mesh_.cornerOf[v] >= 0; }
    const glm::dvec3& place(const Replacement& replacement, int v) const {
        return replacement.placeOf(mesh_, v);
    }

    void collapseEdges();
    void push(int a, int b);
    void pushEdgesAround(int v);
    bool collapseEdge(int a, int b, const glm::dvec3& place, Quality quality);
    bool linkCondition(int a, int b, int cornerAtA) const;

    void betterCorners();
    void betterVertex(int v);
    bool relax(int v);
    bool flip(int corner);
    double sharpestAround(int v) const;

    bool permitted(const Replacement& replacement, Quality quality);
    bool shapesPermitted(const Replacement& replacement, Quality quality) const;
    bool withinBound(const Replacement& replacement);
    void commit(const Replacement& replacement);

    RegionPart& part_;
    CornerMesh& mesh_;
    ContactGuard guard_;
    std::vector<Candidate> heap_;
    AttachedSamples::Patch patch_;
    Replacement replacement_;
    double sharpestCosine_;
};

RegionSimplification::RegionSimplification(RegionPart& part, double minAngleDegrees,
                                           std::span<const FloatBox> guarded)
    : part_(part),
      mesh_(part.mesh),
      guard_(part.mesh, guarded),
      sharpestCosine_(cosineOf(minAngleDegrees)) {}

bool RegionSimplification::inBox(const glm::dvec3& p) const {
    return glm::all(glm::lessThanEqual(part_.box().low, p)) &&
           glm::all(glm::lessThan(p, part_.box().high));
}

void RegionSimplification::run() {
    // What is movable stays so: a collapse or flip in the box gives no vertex a neighbour outside.
    collapseEdges();
    betterCorners();
    for (int v = 0; v < part_.insideCount(); ++v)
        part_.settled[v] |= part_.movable[v];
}

// ------------------------------------------------------------------------------------- collapses

void RegionSimplification::collapseEdges() {
    for (int v = 0; v < part_.insideCount(); ++v) {
        if (part_.settled[v] || !movable(v)) continue;
        mesh_.aroundVertex(v, [&](int corner) {
            const int w = mesh_.vertex[CornerMesh::next(corner)];
            if (v < w || part_.settled[w]) push(v, w);
        });
    }
    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end());
        const Candidate candidate = heap_.back();
        heap_.pop_back();
        const auto [error, a, b, version] = candidate;
        if (part_.version[a] + part_.version[b] != version) continue;
        const Quadric sum = part_.quadric[a] + part_.quadric[b];
        const glm::dvec3 middle = 0.5 * (mesh_.position[a] + mesh_.position[b]);
        if (collapseEdge(a, b, sum.minimiser(middle), Quality::noSharper)) pushEdgesAround(a);
    }
}

void RegionSimplification::push(int a, int b) {
    if (!movable(a) || !movable(b)) return;
    if (a > b) std::swap(a, b);
    const Quadric sum = part_.quadric[a] + part_.quadric[b];
    const glm::dvec3 middle = 0.5 * (mesh_.position[a] + mesh_.position[b]);
    const double error = sum(sum.minimiser(middle));
    heap_.push_back({float(error), a, b, part_.version[a] + part_.version[b]});
    std::push_heap(heap_.begin(), heap_.end());
}

void RegionSimplification::pushEdgesAround(int v) {
    mesh_.aroundVertex(v, [&](int corner) { push(v, mesh_.vertex[CornerMesh::next(corner)]); });
}

bool RegionSimplification::linkCondition(int a, int b, int cornerAtA) const {
    const int c = mesh_.vertex[CornerMesh::previous(cornerAtA)];
    const int d = mesh_.vertex[mesh_.opposite[CornerMesh::previous(cornerAtA)]];
    if (mesh_.valence[c] <= 3 || mesh_.valence[d] <= 3) return false;
    int common = 0;
    mesh_.aroundVertex(a, [&](int cornerA) {
        const int v = mesh_.vertex[CornerMesh::next(cornerA)];
        mesh_.aroundVertex(
            b, [&](int cornerB) { common += mesh_.vertex[CornerMesh::next(cornerB)] == v; });
    });
    return common == 2;
}

bool RegionSimplification::collapseEdge(int a, int b, const glm::dvec3& place, Quality quality) {
    if (!inBox(place) || !movable(a) || !movable(b)) return false;
    if (mesh_.valence[a] + mesh_.valence[b] - 4 > maxValence) return false;
    const int edge = mesh_.cornerOfEdge(a, b);
    if (edge < 0 || !linkCondition(a, b, edge)) return false;

    Replacement& r = replacement_;
    r.oldTriangles.clear();
    r.newTriangles.clear();
    r.corners.clear();
    r.moved = a;
    r.place = place;
    const int removed[] = {edge / 3, mesh_.opposite[CornerMesh::previous(edge)] / 3};
    for (const int v : {a, b}) {
        mesh_.aroundVertex(v, [&](int corner) {
            const int triangle = corner / 3;
            if (triangle == removed[0] || triangle == removed[1]) {
                if (v == a) r.oldTriangles.push_back(triangle);
                return;
            }
            r.oldTriangles.push_back(triangle);
            r.newTriangles.push_back(triangle);
            r.corners.push_back({a, mesh_.vertex[CornerMesh::next(corner)],
                                 mesh_.vertex[CornerMesh::previous(corner)]});
        });
    }
    if (!permitted(r, quality)) return false;
    guard_.remove(r);
    mesh_.collapse(edge);
    mesh_.position[a] = place;
    part_.quadric[a] = part_.quadric[a] + part_.quadric[b];
    ++part_.version[b];
    commit(r);
    return true;
}

// ------------------------------------------------------------------------- what may be replaced

bool RegionSimplification::permitted(const Replacement& r, Quality quality) {
    return shapesPermitted(r, quality) && withinBound(r) && !guard_.refuses(r);
}

bool RegionSimplification::shapesPermitted(const Replacement& r, Quality quality) const {
    double newSharpest = -1.0, oldSharpest = -1.0;
    glm::dvec3 oldSum(0.0);
    for (const int triangle : r.oldTriangles) {
        const int* v = &mesh_.vertex[3 * triangle];
        const glm::dvec3 &a = mesh_.position[v[0]], &b = mesh_.position[v[1]],
                         &c = mesh_.position[v[2]];
        oldSharpest = std::max(oldSharpest, sharpestCosine(a, b, c));
        oldSum += upright(a, b, c);
    }
    const double limit =
        quality == Quality::better ? oldSharpest - 1e-3 : std::max(oldSharpest, sharpestCosine_);
    for (std::size_t i = 0; i < r.corners.size(); ++i) {
        const glm::dvec3 a = place(r, r.corners[i][0]), b = place(r, r.corners[i][1]),
                         c = place(r, r.corners[i][2]);
        newSharpest = std::max(newSharpest, sharpestCosine(a, b, c));
        if (newSharpest > limit) return false;
        const int* v = &mesh_.vertex[3 * r.newTriangles[i]];
        const glm::dvec3 before =
            r.moved >= 0 ? upright(mesh_.position[v[0]], mesh_.position[v[1]], mesh_.position[v[2]])
                         : oldSum;
        const glm::dvec3 after = upright(a, b, c);
        const double along = glm::dot(before, after);
        if (along <= 0.0 || along * along < leastNormalCosine * leastNormalCosine *
                                                glm::dot(before, before) * glm::dot(after, after)) {
            return false;
        }
    }
    return true;
}

bool RegionSimplification::withinBound(const Replacement& r) {
    part_.samples.gather(r.oldTriangles, patch_);
    if (r.moved >= 0 && !part_.samples.nearInput(glm::vec3(r.place), patch_)) return false;
    patch_.triangles.clear();
    for (const auto& v : r.corners) {
        patch_.triangles.emplace_back(glm::vec3(place(r, v[0])), glm::vec3(place(r, v[1])),
                                      glm::vec3(place(r, v[2])));
    }
    if (!part_.samples.findTriangles(patch_)) return false;
    for (const NearTriangle& t : patch_.triangles) {
        // Corner 0 moves, or ends the new edge 0–1; each spoke is the edge from it in one triangle.
        const glm::vec3 center = (t.corner[0] + t.corner[1] + t.corner[2]) * (1.0f / 3.0f);
        if (!part_.samples.nearInput(center, patch_)) return false;
        for (const float share : {0.25f, 0.5f, 0.75f}) {
            if (!part_.samples.nearInput(t.corner[0] + share * t.edge[0], patch_)) return false;
        }
    }
    return true;
}

void RegionSimplification::commit(const Replacement& r) {
    if (r.moved >= 0) ++part_.version[r.moved];
    for (const auto& corners : r.corners) {
        for (const int v : corners)
            part_.disturbed[v] = 1;
    }
    for (const int triangle : r.newTriangles)
        part_.changed[triangle] = 1;
    guard_.insert(r);
    part_.samples.reattach(r.oldTriangles, r.newTriangles, patch_);
}

// ---------------------------------------------------------------------------------- sharp corners

void RegionSimplification::betterCorners() {
    for (int v = 0; v < part_.insideCount(); ++v)
        part_.disturbed[v] =
            movable(v) && (!part_.settled[v] || sharpestAround(v) > sharpestCosine_);
    for (int round = 0; round < 3; ++round) {
        for (int v = 0; v < part_.insideCount(); ++v) {
            // What could not be bettered cannot be now, unless something changed beside it.
            if (!movable(v) || !part_.disturbed[v]) continue;
            part_.disturbed[v] = 0;
            betterVertex(v);
        }
    }
}

double RegionSimplification::sharpestAround(int v) const {
    double sharpest = -1.0;
    mesh_.aroundVertex(v, [&](int corner) {
        const int* t = &mesh_.vertex[corner - corner % 3];
        sharpest = std::max(sharpest, sharpestCosine(mesh_.position[t[0]], mesh_.position[t[1]],
                                                     mesh_.position[t[2]]));
    });
    return sharpest;
}

void RegionSimplification::betterVertex(int v) {
    const double wanted = cosineOf(wantedAngleDegrees);
    if (sharpestAround(v) <= wanted) return;
    relax(v);
    int corners[maxValence + 1], count = 0;
    mesh_.aroundVertex(v, [&](int corner) {
        if (count <= maxValence) corners[count++] = corner;
    });
    for (int i = 0; i < count; ++i) {
        if (flip(corners[i])) break;  // the other corners may no longer be at v
    }
    if (sharpestAround(v) <= sharpestCosine_) return;
    int nearest = -1;
    const auto squaredTo = [&](int w) {
        const glm::dvec3 away = mesh_.position[w] - mesh_.position[v];
        return glm::dot(away, away);
    };
    mesh_.aroundVertex(v, [&](int corner) {
        const int w = mesh_.vertex[CornerMesh::next(corner)];
        if (nearest < 0 || squaredTo(w) < squaredTo(nearest)) nearest = w;
    });
    const glm::dvec3 here = mesh_.position[v], there = mesh_.position[nearest];
    for (const double share : {0.5, 0.0, 1.0}) {
        if (collapseEdge(v, nearest, here + share * (there - here), Quality::better)) return;
    }
}

bool RegionSimplification::relax(int v) {
    Replacement& r = replacement_;
    r.oldTriangles.clear();
    r.corners.clear();
    glm::dvec3 normal(0.0), center(0.0);
    double weights = 0.0;
    mesh_.aroundVertex(v, [&](int corner) {
        const int b = mesh_.vertex[CornerMesh::next(corner)];
        const int c = mesh_.vertex[CornerMesh::previous(corner)];
        r.oldTriangles.push_back(corner / 3);
        r.corners.push_back({v, b, c});
        normal += upright(mesh_.position[v], mesh_.position[b], mesh_.position[c]);
        const double length = glm::distance(mesh_.position[b], mesh_.position[c]);
        center += length * (mesh_.position[b] + mesh_.position[c]) * 0.5;
        weights += length;
    });
    const double squared = glm::dot(normal, normal);
    if (!(squared > 0.0)) return false;
    r.newTriangles = r.oldTriangles;
    r.moved = v;
    glm::dvec3 step = center / weights - mesh_.position[v];
    step -= normal * (glm::dot(normal, step) / squared);
    for (const double share : {1.0, 0.5, 0.2}) {
        r.place = mesh_.position[v] + share * step;
        if (!inBox(r.place) || !permitted(r, Quality::better)) continue;
        guard_.remove(r);
        mesh_.position[v] = r.place;
        commit(r);
        return true;
    }
    return false;
}

bool RegionSimplification::flip(int corner) {
    const int across = mesh_.opposite[corner];
    const int c = mesh_.vertex[corner], a = mesh_.vertex[CornerMesh::next(corner)];
    const int d = mesh_.vertex[across], b = mesh_.vertex[CornerMesh::previous(corner)];
    if (!inBox(mesh_.position[d]) || mesh_.valence[a] <= 4 || mesh_.valence[b] <= 4 ||
        mesh_.valence[c] >= maxValence || mesh_.valence[d] >= maxValence ||
        mesh_.cornerOfEdge(c, d) >= 0) {
        return false;
    }
    Replacement& r = replacement_;
    r.oldTriangles = {corner / 3, across / 3};
    r.newTriangles = r.oldTriangles;
    r.corners = {{d, c, a}, {c, d, b}};
    r.moved = -1;
    if (!permitted(r, Quality::better)) return false;
    guard_.remove(r);
    mesh_.flip(corner);
    commit(r);
    return true;
}

}  // namespace

void simplifyRegion(Simplification& shared, const Region& region) {
    std::vector<FloatBox> guarded;
    for (int attempt = 0;; ++attempt) {
        RegionPart part(shared, region);
        if (attempt == guardedAttempts) {
            guarded = {{glm::vec3(-everywhereMm), glm::vec3(everywhereMm)}};
        }
        RegionSimplification(part, shared.minAngleDegrees, guarded).run();
        std::vector<FloatBox> found;
        if (attempt < guardedAttempts) found = contacts(part.mesh, part.changed);
        if (found.empty()) {
            part.writeTo(shared);
            return;
        }
        for (const FloatBox& box : found)
            guarded.push_back({box.low - guardMm, box.high + guardMm});
    }
}

}  // namespace haustra::simplification
