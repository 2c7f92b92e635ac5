#include "flatten/intrinsic_delaunay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

constexpr double leastSlack = 1e-12;     // of the mean length
constexpr double roundingShare = 1e-12;  // of the cotangents' magnitudes

/// Twice the area's square root is lost on slivers by Heron's own formula; this form is Kahan's.
double areaOf(double a, double b, double c) {
    if (a < b) std::swap(a, b);
    if (b < c) std::swap(b, c);
    if (a < b) std::swap(a, b);
    const double product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    return 0.25 * std::sqrt(std::max(product, 0.0));
}

/// The longest side's lack of length against the other two together.
double slackOf(double a, double b, double c) {
    return std::min({b + c - a, a + c - b, a + b - c});
}

struct Edge {
    int origin, opposite;
    double length;
    std::int8_t turns;
    char kept;
};

/// Where the half-edges around a flipped one go, see Flipper::flip.
std::array<std::pair<int, int>, 4> movesAround(int h, int g) {
    const int hNext = HalfedgeMesh::next(h), hPrevious = HalfedgeMesh::previous(h);
    const int gNext = HalfedgeMesh::next(g), gPrevious = HalfedgeMesh::previous(g);
    return {{{hPrevious, hNext}, {gNext, hPrevious}, {gPrevious, gNext}, {hNext, gPrevious}}};
}

bool isNegative(const IntrinsicMesh& mesh, int h) {
    const int other = mesh.opposite[std::size_t(h)];
    if (other < 0) return false;
    const double a = cotangent(mesh, h), b = cotangent(mesh, other);
    return a + b < -roundingShare * (std::abs(a) + std::abs(b));
}

class Flipper {
public:
    Flipper(IntrinsicMesh& mesh, std::vector<EdgeFlip>* flips) : mesh_(mesh), flips_(flips) {}

    int run() {
        std::vector<int> edges;
        for (int h = 0; h < mesh_.halfedgeCount(); ++h) {
            if (mesh_.opposite[std::size_t(h)] > h && isNegative(mesh_, h)) edges.push_back(h);
        }
        // Each flip lowers the Dirichlet energy; the bound is for what rounding may do.
        const int most = 20 * mesh_.halfedgeCount();
        int flips = 0;
        while (!edges.empty() && flips < most) {
            const int h = edges.back();
            edges.pop_back();
            if (!isNegative(mesh_, h) || !flip(h)) continue;
            ++flips;
            const int other = mesh_.opposite[std::size_t(h)];
            if (flips_) flips_->push_back({h, other});
            for (const int side : {HalfedgeMesh::next(h), HalfedgeMesh::previous(h),
                                   HalfedgeMesh::next(other), HalfedgeMesh::previous(other)}) {
                if (isNegative(mesh_, side)) edges.push_back(side);
            }
        }
        return flips;
    }

private:
    Edge edge(int h) const {
        const auto at = std::size_t(h);
        return {mesh_.origin[at], mesh_.opposite[at], mesh_.length[at], mesh_.turns[at], kept(h)};
    }
    void put(int h, const Edge& e) {
        const auto at = std::size_t(h);
        mesh_.origin[at] = e.origin;
        mesh_.opposite[at] = e.opposite;
        mesh_.length[at] = e.length;
        mesh_.turns[at] = e.turns;
        if (!mesh_.kept.empty()) mesh_.kept[at] = e.kept;
    }
    char kept(int h) const { return mesh_.kept.empty() ? 0 : mesh_.kept[std::size_t(h)]; }

    /// Triangles i j k and j i l become i l k and j k l; h is i → j before, l → k after.
    bool flip(int h) {
        const int g = mesh_.opposite[std::size_t(h)];
        if (h / 3 == g / 3 || kept(h)) return false;
        const int hNext = HalfedgeMesh::next(h), hPrevious = HalfedgeMesh::previous(h);
        const int gNext = HalfedgeMesh::next(g), gPrevious = HalfedgeMesh::previous(g);
        const Edge ij = edge(h), jk = edge(hNext), ki = edge(hPrevious), il = edge(gNext),
                   lj = edge(gPrevious);
        // k and l in the plane of both triangles, i at the origin and j on the x axis.
        const double base = ij.length;
        const auto along = [&](double toI, double toJ) {
            return (toI * toI + (base - toJ) * (base + toJ)) / (2.0 * base);
        };
        const double kx = along(ki.length, jk.length), lx = along(il.length, lj.length);
        const double height =
            2.0 / base * (areaOf(base, jk.length, ki.length) + areaOf(base, il.length, lj.length));
        const double length = std::hypot(kx - lx, height);
        if (!(length > 0.0)) return false;
        const auto turns = std::int8_t(-il.turns - ki.turns);  // l → i → k
        const int k = ki.origin, l = lj.origin;
        put(h, {l, g, length, turns, 0});
        put(g, {k, h, length, std::int8_t(-turns), 0});
        const auto moves = movesAround(h, g);
        const Edge moved[] = {ki, il, lj, jk};
        const auto slotOf = [&](int old) {
            for (const auto& [from, to] : moves) {
                if (from == old) return to;
            }
            return old;
        };
        for (std::size_t n = 0; n < 4; ++n) {
            Edge e = moved[n];
            e.opposite = slotOf(e.opposite);
            put(moves[n].second, e);
            if (e.opposite >= 0) mesh_.opposite[std::size_t(e.opposite)] = moves[n].second;
        }
        return true;
    }

    IntrinsicMesh& mesh_;
    std::vector<EdgeFlip>* flips_;
};

}  // namespace

IntrinsicMesh intrinsicMesh(const HalfedgeMesh& mesh, const std::vector<std::int8_t>& cornerTurns) {
    const auto count = std::size_t(mesh.halfedgeCount());
    IntrinsicMesh made{std::vector<int>(count),
                       std::vector<int>(count),
                       std::vector<double>(count),
                       std::vector<std::int8_t>(count),
                       {}};
    double sum = 0.0;
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        const auto at = std::size_t(h);
        made.origin[at] = mesh.origin(h);
        made.opposite[at] = mesh.opposite(h);
        made.length[at] = mesh.lengthMm(h);
        made.turns[at] =
            std::int8_t(cornerTurns[std::size_t(HalfedgeMesh::next(h))] - cornerTurns[at]);
        sum += made.length[at];
    }
    const double least = leastSlack * sum / double(count);
    double lack = 0.0;
    for (std::size_t h = 0; h < count; h += 3) {
        lack =
            std::max(lack, least - slackOf(made.length[h], made.length[h + 1], made.length[h + 2]));
    }
    if (lack > 0.0) {
        for (double& length : made.length)
            length += lack;
    }
    return made;
}

double cotangent(const IntrinsicMesh& mesh, int h) {
    const double across = mesh.length[std::size_t(h)];
    const double a = mesh.length[std::size_t(HalfedgeMesh::next(h))];
    const double b = mesh.length[std::size_t(HalfedgeMesh::previous(h))];
    return (a * a + (b - across) * (b + across)) / (4.0 * areaOf(across, a, b));
}

double cotangentSum(const IntrinsicMesh& mesh, int h) {
    const int other = mesh.opposite[std::size_t(h)];
    return cotangent(mesh, h) + (other < 0 ? 0.0 : cotangent(mesh, other));
}

int countNegative(const IntrinsicMesh& mesh) {
    int negative = 0;
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        negative += mesh.opposite[std::size_t(h)] > h && isNegative(mesh, h);
    return negative;
}

int makeDelaunay(IntrinsicMesh& mesh, std::vector<EdgeFlip>* flips) {
    return Flipper(mesh, flips).run();
}

void carryThroughFlips(const std::vector<EdgeFlip>& flips, std::vector<std::int8_t>& form) {
    const auto value = [&](int h) -> std::int8_t& { return form[std::size_t(h)]; };
    for (const auto& [h, g] : flips) {
        const auto moves = movesAround(h, g);
        std::array<std::int8_t, 4> moved;
        for (std::size_t n = 0; n < 4; ++n)
            moved[n] = value(moves[n].first);
        for (std::size_t n = 0; n < 4; ++n)
            value(moves[n].second) = moved[n];
        // l → i → k, as Flipper::flip.
        value(h) = std::int8_t(-moved[1] - moved[0]);
        value(g) = std::int8_t(-value(h));
    }
}

}  // namespace haustra::flatten
