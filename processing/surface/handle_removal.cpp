#include "surface/handle_removal.h"

#include "surface/covering_loops.h"
#include "surface/loop_coarsening.h"
#include "surface/loop_cut.h"
#include "surface/loop_homology.h"
#include "surface/loop_pieces.h"
#include "surface/loop_search.h"
#include "surface/self_intersection.h"

#include <limits>

namespace haustra::surface {
namespace {

constexpr int coarseVertices = 3000;
/// Lengths on the coarse mesh are off by up to this: chords for arcs, zigzags for straight paths.
constexpr double coarseSlack = 1.5;
/// Classes of loops that are tried for one whose filling is clean.
constexpr std::size_t mostClasses = 4;

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

/// How many pairs of triangles cut through each other where a cut has been filled.
std::size_t crossingsAt(const LoopCut& cut) {
    const auto cornersOf = [&](std::size_t t, auto&& use) {
        for (int corner = 0; corner < 3; ++corner)
            use(cut.mesh.vertices[std::size_t(cut.mesh.triangles[t][corner])]);
    };
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (std::size_t t = cut.firstFilled; t < cut.mesh.triangles.size(); ++t)
        cornersOf(t,
                  [&](const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); });
    TriMesh near{cut.mesh.vertices, {}};
    for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
        glm::dvec3 lower(std::numeric_limits<double>::infinity()), upper = -lower;
        cornersOf(t, [&](const glm::dvec3& p) {
            lower = glm::min(lower, p), upper = glm::max(upper, p);
        });
        if (glm::all(glm::lessThanEqual(lower, high)) && glm::all(glm::lessThanEqual(low, upper)))
            near.triangles.push_back(cut.mesh.triangles[t]);
    }
    return selfIntersections(near).size();
}

/// One handle less; `mesh` must have one.
Result<RemovedHandle> removeShortest(TriMesh& mesh, int threads) {
    const auto halves = LoopMesh::of(mesh);
    if (!halves) return tl::make_unexpected(halves.error());
    const auto places = coarsePlaces(mesh);
    if (!places) return tl::make_unexpected(places.error());
    const auto marks = homologyMarks(*halves);
    LoopSearchOptions search;
    search.threads = threads;
    Loop best;
    LoopCut bestCut;
    for (std::size_t crossings = std::numeric_limits<std::size_t>::max(), tries = 0;
         crossings > 0 && tries < mostClasses; ++tries) {
        const Loop loop = shortestLoop(*halves, marks, *places, search);
        if (loop.halfedges.empty()) break;
        LoopCut cut = cutAlong(mesh, *halves, loop);
        if (const std::size_t found = crossingsAt(cut); found < crossings) {
            crossings = found;
            best = loop;
            bestCut = std::move(cut);
        }
        std::uint64_t sum = 0;
        for (const int h : loop.halfedges)
            sum ^= marks[h];
        search.passOver.push_back(sum);
    }
    if (best.halfedges.empty())
        return fail(ErrorKind::noResult, "a handle has no loop along the mesh's edges");
    RemovedHandle handle{{}, best.lengthMm, bestCut.filledAreaMm2};
    for (const int h : best.halfedges)
        handle.loopMm.push_back(mesh.vertices[std::size_t(halves->origin(h))]);
    mesh = std::move(bestCut.mesh);
    return handle;
}

}  // namespace

Result<HandleRemoval> removeHandles(const TriMesh& mesh, const HandleRemovalOptions& options) {
    if (mesh.triangles.empty()) return fail(ErrorKind::badInput, "the mesh has no triangles");
    const auto halves = LoopMesh::of(mesh);
    if (!halves) return tl::make_unexpected(halves.error());
    const long handles = meshTopology(mesh).genus();
    const auto report = [&](std::size_t removed) {
        if (options.progress) options.progress(handles ? double(removed) / double(handles) : 1.0);
    };

    HandleRemoval removal{mesh, {}, 0.0};
    for (Piece& piece : piecesOf(*halves, mesh)) {
        const long genus = meshTopology(piece.mesh).genus();
        for (long removed = 0; removed < genus; ++removed) {
            report(removal.handles.size());
            auto handle = removeShortest(piece.mesh, options.threads);
            if (!handle) return tl::make_unexpected(handle.error());
            removal.handles.push_back(std::move(*handle));
        }
        const MeshTopology after = meshTopology(piece.mesh);
        if (!after.closed() || after.components != 1 || after.genus() != 0)
            return fail(ErrorKind::noResult, "cutting the handles did not leave a sphere");
        if (genus > 0) putBack(removal.mesh, std::move(piece));
    }
    if (!removal.handles.empty()) removal.areaChangeMm2 = areaOf(removal.mesh) - areaOf(mesh);
    report(removal.handles.size());
    return removal;
}

}  // namespace haustra::surface
