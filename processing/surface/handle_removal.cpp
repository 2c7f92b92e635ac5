#include "surface/handle_removal.h"

#include "surface/covering_loops.h"
#include "surface/loop_coarsening.h"
#include "surface/loop_cut.h"
#include "surface/loop_homology.h"
#include "surface/loop_search.h"

namespace haustra::surface {
namespace {

constexpr int coarseVertices = 3000;
/// Lengths on the coarse mesh are off by up to this: chords for arcs, zigzags for straight paths.
constexpr double coarseSlack = 1.5;

double areaOf(const TriMesh& mesh) {
    double area = 0.0;
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 &a = mesh.vertices[t.x], &b = mesh.vertices[t.y], &c = mesh.vertices[t.z];
        area += 0.5 * glm::length(glm::cross(b - a, c - a));
    }
    return area;
}

/// Places on the fine mesh where short loops of the coarse mesh pass, best first.
Result<std::vector<int>> coarsePlaces(const TriMesh& mesh) {
    const CoarseMesh coarse = coarsen(mesh, coarseVertices);
    const auto halves = LoopMesh::of(coarse.mesh);
    if (!halves) return tl::make_unexpected(halves.error());
    std::vector<int> places;
    std::vector<char> listed(mesh.vertices.size(), 0);
    for (const Loop& loop : coveringLoops(*halves, homologyMarks(*halves), coarseSlack)) {
        const int place = coarse.fineVertex[std::size_t(halves->origin(loop.halfedges.front()))];
        if (!listed[place]) places.push_back(place);
        listed[place] = 1;
    }
    return places;
}

}  // namespace

Result<HandleRemoval> removeHandles(const TriMesh& mesh, const HandleRemovalOptions& options) {
    if (mesh.triangles.empty()) return fail(ErrorKind::badInput, "the mesh has no triangles");
    auto halves = LoopMesh::of(mesh);
    if (!halves) return tl::make_unexpected(halves.error());
    const MeshTopology topology = meshTopology(mesh);
    if (topology.components != 1) {
        return fail(ErrorKind::badInput, "the mesh is in " + std::to_string(topology.components) +
                                             " pieces, not in one");
    }

    HandleRemoval removal{mesh, {}, -areaOf(mesh)};
    const long genus = topology.genus();
    for (long removed = 0; removed < genus; ++removed) {
        if (options.progress) options.progress(double(removed) / double(genus));
        if (removed > 0) halves = LoopMesh::of(removal.mesh);
        const auto places = coarsePlaces(removal.mesh);
        if (!halves || !places)
            return fail(ErrorKind::noResult, "cutting a handle left a mesh that is not manifold");
        LoopSearchOptions search;
        search.threads = options.threads;
        const Loop loop = shortestLoop(*halves, homologyMarks(*halves), *places, search);
        if (loop.halfedges.size() < 3)
            return fail(ErrorKind::noResult, "a handle has no loop along the mesh's edges");
        RemovedHandle& handle = removal.handles.emplace_back();
        handle.lengthMm = loop.lengthMm;
        for (const int h : loop.halfedges)
            handle.loopMm.push_back(removal.mesh.vertices[std::size_t(halves->origin(h))]);
        LoopCut cut = cutAlong(removal.mesh, *halves, loop);
        handle.filledAreaMm2 = cut.filledAreaMm2;
        removal.mesh = std::move(cut.mesh);
    }
    const MeshTopology after = meshTopology(removal.mesh);
    if (!after.closed() || after.components != 1 || after.genus() != 0)
        return fail(ErrorKind::noResult, "cutting the handles did not leave a sphere");
    removal.areaChangeMm2 += areaOf(removal.mesh);
    if (options.progress) options.progress(1.0);
    return removal;
}

}  // namespace haustra::surface
