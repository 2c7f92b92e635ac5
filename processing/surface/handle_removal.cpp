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

/// One handle less; `mesh` must have one.
Result<RemovedHandle> removeShortest(TriMesh& mesh, int threads) {
    const auto halves = LoopMesh::of(mesh);
    if (!halves) return tl::make_unexpected(halves.error());
    const auto places = coarsePlaces(mesh);
    if (!places) return tl::make_unexpected(places.error());
    LoopSearchOptions search;
    search.threads = threads;
    const Loop loop = shortestLoop(*halves, homologyMarks(*halves), *places, search);
    if (loop.halfedges.empty())
        return fail(ErrorKind::noResult, "a handle has no loop along the mesh's edges");
    RemovedHandle handle{{}, loop.lengthMm, 0.0};
    for (const int h : loop.halfedges)
        handle.loopMm.push_back(mesh.vertices[std::size_t(halves->origin(h))]);
    LoopCut cut = cutAlong(mesh, *halves, loop);
    handle.filledAreaMm2 = cut.filledAreaMm2;
    mesh = std::move(cut.mesh);
    return handle;
}

/// A connected piece of a mesh, and where its vertices and triangles are in the whole.
struct Piece {
    TriMesh mesh;
    std::vector<int> vertices;
    std::vector<std::size_t> triangles;
};

std::vector<Piece> piecesOf(const LoopMesh& halves, const TriMesh& mesh) {
    std::vector<Piece> pieces;
    std::vector<int> pieceOf(mesh.triangles.size(), -1), number(mesh.vertices.size(), -1), stack;
    for (std::size_t seed = 0; seed < mesh.triangles.size(); ++seed) {
        if (pieceOf[seed] >= 0) continue;
        pieceOf[seed] = int(pieces.size());
        pieces.emplace_back();
        stack.push_back(int(seed));
        while (!stack.empty()) {
            const int t = stack.back();
            stack.pop_back();
            for (int corner = 0; corner < 3; ++corner) {
                const int next = halves.opposite(3 * t + corner) / 3;
                if (pieceOf[next] >= 0) continue;
                pieceOf[next] = pieceOf[t];
                stack.push_back(next);
            }
        }
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Piece& piece = pieces[std::size_t(pieceOf[t])];
        glm::ivec3 triangle = mesh.triangles[t];
        for (int corner = 0; corner < 3; ++corner) {
            int& v = number[triangle[corner]];
            if (v < 0) {
                v = int(piece.vertices.size());
                piece.vertices.push_back(triangle[corner]);
                piece.mesh.vertices.push_back(mesh.vertices[triangle[corner]]);
            }
            triangle[corner] = v;
        }
        piece.triangles.push_back(t);
        piece.mesh.triangles.push_back(triangle);
    }
    return pieces;
}

/// Puts a changed piece back: what it had keeps its numbers in the whole, what is new comes last.
void putBack(TriMesh& whole, Piece piece) {
    for (std::size_t v = piece.vertices.size(); v < piece.mesh.vertices.size(); ++v) {
        piece.vertices.push_back(int(whole.vertices.size()));
        whole.vertices.emplace_back();
    }
    for (std::size_t v = 0; v < piece.vertices.size(); ++v)
        whole.vertices[std::size_t(piece.vertices[v])] = piece.mesh.vertices[v];
    for (std::size_t t = 0; t < piece.mesh.triangles.size(); ++t) {
        glm::ivec3 triangle = piece.mesh.triangles[t];
        for (int corner = 0; corner < 3; ++corner)
            triangle[corner] = piece.vertices[std::size_t(triangle[corner])];
        if (t < piece.triangles.size()) {
            whole.triangles[piece.triangles[t]] = triangle;
        } else {
            whole.triangles.push_back(triangle);
        }
    }
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
