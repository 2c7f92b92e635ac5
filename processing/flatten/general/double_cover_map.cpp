#include "flatten/general/double_cover_map.h"

#include "flatten/general/double_cover.h"
#include "flatten/tube/tube_topology.h"

#include <cmath>
#include <utility>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

std::complex<double> aroundRim(const HalfedgeMesh& tube, const std::vector<char>& onRim,
                               const ComplexForm& form) {
    std::complex<double> sum;
    for (int h = 0; h < tube.halfedgeCount(); ++h) {
        if (tube.opposite(h) < 0 && onRim[std::size_t(tube.origin(h))]) sum += form[std::size_t(h)];
    }
    return sum;
}

/// The form's integral from the first vertex, over a spanning tree of the tube's edges.
std::vector<std::complex<double>> integrate(const HalfedgeMesh& tube, int first,
                                            const ComplexForm& form) {
    std::vector<std::complex<double>> z(std::size_t(tube.vertexCount()));
    std::vector<char> placed(z.size(), 0);
    std::vector<int> queue{first};
    placed[std::size_t(first)] = 1;
    const auto reach = [&](int from, int to, std::complex<double> step) {
        if (placed[std::size_t(to)]) return;
        placed[std::size_t(to)] = 1;
        z[std::size_t(to)] = z[std::size_t(from)] + step;
        queue.push_back(to);
    };
    for (std::size_t n = 0; n < queue.size(); ++n) {
        const int v = queue[n];
        int h = tube.outgoing(v);
        do {
            const int back = HalfedgeMesh::previous(h);
            reach(v, tube.target(h), form[std::size_t(h)]);
            // At the rim the last edge is known from its other end alone.
            reach(v, tube.origin(back), -form[std::size_t(back)]);
            h = tube.turnLeft(h);
        } while (h >= 0 && h != tube.outgoing(v));
    }
    return z;
}

}  // namespace

Result<DoubleCoverMap> tubeMapFromDoubleCover(const TriMesh& tube, int firstLoop,
                                              HolomorphicOptions options) {
    const auto surface = TRY(HalfedgeMesh::of(tube));
    const auto topology = TRY(tubeTopology(surface, firstLoop));
    const auto cover = TRY(doubleCover(tube));

    const int count = surface.halfedgeCount();
    options.kept.assign(std::size_t(2 * count), 0);
    for (int h = 0; h < count; ++h) {
        if (surface.opposite(h) >= 0) continue;
        options.kept[std::size_t(h)] = options.kept[std::size_t(mirrored(h, count))] = 1;
    }
    const auto basis = TRY(holomorphicBasis(cover.halfedges, options));

    std::vector<char> onRim[2];
    for (int rim = 0; rim < 2; ++rim) {
        onRim[rim].assign(tube.vertices.size(), 0);
        for (const int v : topology.rims[rim])
            onRim[rim][std::size_t(v)] = 1;
    }
    ComplexForm form = basis.holomorphic(std::size_t(0));
    // The tube lies to the left of the first rim's half-edges, as the strip above y = 0.
    const std::complex<double> turn = aroundRim(surface, onRim[0], form);
    for (std::complex<double>& value : form)
        value /= turn;
    const std::vector<std::complex<double>> z = integrate(surface, topology.rims[0].front(), form);

    DoubleCoverMap made;
    made.certificate = basis.certificate;
    made.modulus = z[std::size_t(topology.rims[1].front())].imag();
    made.map.height = made.modulus;
    for (std::size_t v = 0; v < z.size(); ++v) {
        const double x = z[v].real() - std::floor(z[v].real());
        const double y = onRim[0][v] ? 0.0 : onRim[1][v] ? made.modulus : z[v].imag();
        made.map.flat.push_back({x < 1.0 ? x : 0.0, y});
    }
    for (std::size_t t = 0; t < tube.triangles.size(); ++t) {
        const glm::ivec3& corners = tube.triangles[t];
        const auto turnTo = [&](int corner, std::complex<double> step) {
            const double x = made.map.flat[std::size_t(corners.x)].x + step.real();
            return std::int8_t(std::lround(x - made.map.flat[std::size_t(corners[corner])].x));
        };
        made.map.turns.push_back({0, turnTo(1, form[3 * t]), turnTo(2, -form[3 * t + 2])});
    }
    return made;
}

}  // namespace haustra::flatten
