#include "flatten/general/trajectory.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

constexpr double atVertex = 1e-9;  // of the triangle's flat size

/// Where the line goes on from a vertex: to the target of `along`, or through the edge `across` at
/// the fraction `at` of it.
struct Step {
    int along = -1;
    int across = -1;
    double at = 0.0;
    double offset = 0.0;  ///< of the vertex it comes to, left of the line
};

std::optional<Step> nextStep(const CarvedSurface& surface, int v, double offset,
                             std::complex<double> direction) {
    int h = surface.outgoing(v);
    do {
        const int across = HalfedgeMesh::next(h), back = HalfedgeMesh::previous(h);
        const std::complex<double> right = surface.form(h) / direction;
        const std::complex<double> left = -surface.form(back) / direction;
        const double size = std::max(std::abs(right), std::abs(left));
        const double rightOffset = offset + right.imag(), leftOffset = offset + left.imag();
        if (rightOffset < 0.0 && leftOffset >= 0.0) {
            if (-rightOffset <= atVertex * size) return Step{h, -1, 0.0, rightOffset};
            if (leftOffset <= atVertex * size)
                return Step{surface.opposite(back), -1, 0.0, leftOffset};
            return Step{-1, across, rightOffset / (rightOffset - leftOffset), 0.0};
        }
        h = surface.turnLeft(h);
    } while (h != surface.outgoing(v));
    return std::nullopt;
}

bool onCut(const CarvedSurface& surface, int v) {
    int h = surface.outgoing(v);
    do {
        if (surface.cut(h)) return true;
        h = surface.turnLeft(h);
    } while (h != surface.outgoing(v));
    return false;
}

/// The half-edge from one vertex to a neighbour of it.
int halfedgeBetween(const CarvedSurface& surface, int from, int to) {
    int h = surface.outgoing(from);
    while (surface.target(h) != to)
        h = surface.turnLeft(h);
    return h;
}

}  // namespace

Result<std::vector<int>> traceTrajectory(CarvedSurface& surface, int base,
                                         std::complex<double> direction) {
    std::vector<int> carved;
    double offset = 0.0;
    const int most = surface.halfedgeCount();
    for (int v = base; int(carved.size()) < most;) {
        const std::optional<Step> step = nextStep(surface, v, offset, direction);
        if (!step) break;
        int along = step->along;
        if (along < 0) {
            if (surface.cut(step->across)) break;
            const int p = surface.split(step->across, step->at);
            along = halfedgeBetween(surface, v, p);
        }
        const int w = surface.target(along);
        if (w != base && onCut(surface, w)) break;
        carved.push_back(along);
        surface.setCut(along);
        if (w == base) return carved;
        v = w;
        offset = step->offset;
    }
    return fail(ErrorKind::noResult,
                "the surface cannot be cut along its trajectories: triangles that the map turns "
                "over lie on them");
}

}  // namespace haustra::flatten
