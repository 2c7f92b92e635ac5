#include "flatten/general/surface_flattening.h"

#include "flatten/general/double_cover.h"
#include "flatten/general/torus_map.h"
#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <queue>
#include <string>

namespace haustra::flatten {
namespace {

using mesh::HalfedgeMesh;

constexpr double usualRimMm = 15.0, rimOfRootArea = 0.1;

SurfaceShape shapeOf(const TriMesh& mesh, const HalfedgeMesh& halfedges) {
    const MeshTopology topology = meshTopology(mesh);
    SurfaceShape shape;
    shape.parts = topology.components;
    std::vector<char> seen(std::size_t(halfedges.halfedgeCount()), 0);
    for (int h = 0; h < halfedges.halfedgeCount(); ++h) {
        if (halfedges.opposite(h) >= 0 || seen[std::size_t(h)]) continue;
        ++shape.boundaryLoops;
        for (int at = h; !seen[std::size_t(at)]; at = halfedges.outgoing(halfedges.target(at)))
            seen[std::size_t(at)] = 1;
    }
    shape.genus = (2 * shape.parts - topology.eulerCharacteristic - shape.boundaryLoops) / 2;
    return shape;
}

/// The vertex that is farthest from `from` along edges.
int farthest(const HalfedgeMesh& halfedges, int from) {
    std::vector<double> distance(std::size_t(halfedges.vertexCount()),
                                 std::numeric_limits<double>::infinity());
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    distance[std::size_t(from)] = 0.0;
    front.push({0.0, from});
    int last = from;
    while (!front.empty()) {
        const auto [reached, v] = front.top();
        front.pop();
        if (reached != distance[std::size_t(v)]) continue;
        last = v;
        int h = halfedges.outgoing(v);
        do {
            const auto to = std::size_t(halfedges.target(h));
            const double next = reached + halfedges.lengthMm(h);
            if (next < distance[to]) {
                distance[to] = next;
                front.push({next, int(to)});
            }
            h = halfedges.turnLeft(h);
        } while (h != halfedges.outgoing(v));
    }
    return last;
}

double rootAreaMm(const TriMesh& mesh) {
    double twice = 0.0;
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
        twice += glm::length(
            glm::cross(mesh.vertices[std::size_t(t.y)] - a, mesh.vertices[std::size_t(t.z)] - a));
    }
    return std::sqrt(0.5 * twice);
}

Result<void> flattenStrip(SurfaceFlattening& made, const TriMesh& tube, int firstLoop,
                          const SurfaceFlatteningOptions& options) {
    FlatteningOptions flattening;
    flattening.areaWeight = options.areaWeight;
    flattening.threads = options.threads;
    flattening.progress = options.progress;
    auto flat = TRY(flattenTube(tube, firstLoop, flattening));
    made.map = std::move(flat.map);
    made.certificate = flat.certificate;
    made.distortion = flat.distortion;
    made.strip = std::move(flat);
    return {};
}

Result<void> flattenSphere(SurfaceFlattening& made, const TriMesh& closed,
                           const HalfedgeMesh& halfedges, const SurfaceFlatteningOptions& options) {
    glm::dvec3 ends[2];
    if (options.endsMm) {
        std::copy(options.endsMm->begin(), options.endsMm->end(), ends);
    } else {
        const int first = farthest(halfedges, closed.triangles[0].x);
        ends[0] = closed.vertices[std::size_t(first)];
        ends[1] = closed.vertices[std::size_t(farthest(halfedges, first))];
    }
    const glm::dvec3 anywhere[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
    const double rimMm = options.rimMm > 0.0
                             ? options.rimMm
                             : std::min(usualRimMm, rimOfRootArea * rootAreaMm(closed));
    auto punched = TRY(punchEnds(closed, ends, anywhere, {rimMm}));
    TRY(flattenStrip(made, punched.tube, punched.firstLoop, options));
    for (std::int32_t& source : made.map.sourceTriangle)
        source = punched.sourceTriangle[std::size_t(source)];
    punched.tube = {};
    made.punched = std::move(punched);
    return {};
}

void takeDomain(SurfaceFlattening& made, FundamentalDomain domain) {
    made.distortion = measureDistortion(domain.cut, [&](std::size_t t, int corner) {
        const auto at = domain.flat[std::size_t(domain.cut.triangles[t][corner])];
        return glm::dvec2(at.real(), at.imag());
    });
    made.flips = domain.flips;
    made.map.surface = std::move(domain.cut);
    made.map.sourceTriangle.assign(domain.triangleOfCut.begin(), domain.triangleOfCut.end());
    for (const std::complex<double>& at : domain.flat)
        made.map.flat.push_back({at.real(), at.imag()});
}

Result<void> flattenTorus(SurfaceFlattening& made, const TriMesh& torus,
                          const SurfaceFlatteningOptions& options) {
    HolomorphicOptions holomorphic;
    holomorphic.progress = options.progress;
    auto flat = TRY(torusMap(torus, -1, holomorphic));
    made.tau = flat.tau;
    made.certificate = flat.certificate;
    takeDomain(made, std::move(flat.domain));
    made.map.height = flat.tau.imag();
    return {};
}

/// The first `triangles` of the domain's surface are kept: all, or one half of a double cover.
void keepFirst(FundamentalDomain& domain, std::size_t triangles) {
    FundamentalDomain kept;
    std::vector<int> number(domain.flat.size(), -1);
    for (std::size_t t = 0; t < domain.cut.triangles.size(); ++t) {
        if (std::size_t(domain.triangleOfCut[t]) >= triangles) continue;
        glm::ivec3 corners = domain.cut.triangles[t];
        for (int c = 0; c < 3; ++c) {
            const auto v = std::size_t(corners[c]);
            if (number[v] < 0) {
                number[v] = int(kept.flat.size());
                kept.cut.vertices.push_back(domain.cut.vertices[v]);
                kept.flat.push_back(domain.flat[v]);
            }
            corners[c] = number[v];
        }
        const auto a = kept.flat[std::size_t(corners.x)];
        const auto u = kept.flat[std::size_t(corners.y)] - a,
                   w = kept.flat[std::size_t(corners.z)] - a;
        kept.flips += !(u.real() * w.imag() - u.imag() * w.real() > 0.0);
        kept.cut.triangles.push_back(corners);
        kept.triangleOfCut.push_back(domain.triangleOfCut[t]);
    }
    domain = std::move(kept);
}

Result<void> flattenDomain(SurfaceFlattening& made, const TriMesh& closed,
                           const HalfedgeMesh& halfedges, std::size_t triangles,
                           const SurfaceFlatteningOptions& options) {
    HolomorphicOptions holomorphic;
    holomorphic.progress = options.progress;
    const auto basis = TRY(holomorphicBasis(halfedges, holomorphic));
    const ComplexForm form = basis.holomorphic(std::size_t(0));
    auto domain = TRY(fundamentalDomainMap(closed, halfedges, form));
    for (const FormZero& zero : formZeros(halfedges, form))
        made.formZeros += std::size_t(std::abs(zero.order));
    keepFirst(domain, triangles);
    made.certificate = basis.certificate;
    takeDomain(made, std::move(domain));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const glm::dvec2& at : made.map.flat)
        low = std::min(low, at.y), high = std::max(high, at.y);
    made.map.height = high - low;
    return {};
}

}  // namespace

Result<SurfaceShape> shapeOf(const TriMesh& mesh) {
    return HalfedgeMesh::of(mesh).map(
        [&](const HalfedgeMesh& made) { return shapeOf(mesh, made); });
}

Result<SurfaceFlattening> flattenSurface(const TriMesh& mesh,
                                         const SurfaceFlatteningOptions& options) {
    const auto halfedges = TRY(HalfedgeMesh::of(mesh));
    SurfaceFlattening made;
    made.shape = shapeOf(mesh, halfedges);
    const auto [parts, genus, loops] = made.shape;
    if (parts != 1) {
        return fail(ErrorKind::badInput,
                    "the mesh has " + std::to_string(parts) + " parts; one is flattened");
    }
    if (genus == 0 && loops == 1) {
        return fail(
            ErrorKind::badInput,
            "the mesh is a disc, of genus 0 with one boundary loop: only what one can go around "
            "is flattened, a tube, a closed surface or one with handles");
    }
    TRY([&]() -> Result<void> {
        if (genus == 0 && loops == 2) return flattenStrip(made, mesh, -1, options);
        if (genus == 0 && loops == 0) return flattenSphere(made, mesh, halfedges, options);
        if (genus == 1 && loops == 0) return flattenTorus(made, mesh, options);
        if (loops == 0) return flattenDomain(made, mesh, halfedges, mesh.triangles.size(), options);
        const auto cover = TRY(doubleCover(mesh));
        return flattenDomain(made, cover.mesh, cover.halfedges, mesh.triangles.size(), options);
    }());
    return made;
}

}  // namespace haustra::flatten
