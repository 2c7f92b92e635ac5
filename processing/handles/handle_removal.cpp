#include "handles/handle_removal.h"

#include "core/tri_mesh.h"
#include "handles/covering_space.h"
#include "handles/loop_coarsening.h"
#include "handles/loop_cut.h"
#include "handles/loop_homology.h"
#include "handles/loop_search.h"
#include "handles/self_intersection.h"
#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace haustra::handles {
namespace {

/// One connected piece, and where its vertices and triangles are in the whole.
struct Piece {
    TriMesh mesh;
    std::vector<int> vertices;
    std::vector<std::size_t> triangles;
};

/// In the order of their first triangles; vertices that no triangle uses are in none. `halves` must
/// be HalfedgeMesh::ofClosed(mesh). O(n).
std::vector<Piece> piecesOf(const mesh::HalfedgeMesh& halves, const TriMesh& mesh) {
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

constexpr int coarseVertices = 3000;
/// Lengths on the coarse mesh are off by up to this: chords for arcs, zigzags for straight paths.
constexpr double coarseSlack = 1.5;
/// Classes of loops that are tried for one whose filling is clean.
constexpr std::size_t mostClasses = 4;

double areaOf(const TriMesh& mesh) {
    double area = 0.0;
    for (const glm::ivec3& t : mesh.triangles)
        area += triangleAreaMm2(mesh, t);
    return area;
}

/// Places on the fine mesh where short loops of the coarse mesh pass, best first.
Result<std::vector<int>> coarsePlaces(const TriMesh& mesh) {
    const CoarseMesh coarse = coarsen(mesh, coarseVertices);
    const auto halves = TRY(mesh::HalfedgeMesh::ofClosed(coarse.mesh));
    std::vector<int> places;
    std::vector<char> listed(mesh.vertices.size(), 0);
    for (const mesh::Loop& loop : coveringLoops(halves, homologyMarks(halves), coarseSlack)) {
        const int place = coarse.fineVertex[std::size_t(halves.origin(loop.halfedges.front()))];
        if (!listed[place]) places.push_back(place);
        listed[place] = 1;
    }
    return places;
}

struct Bounds {
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high = -low;

    void add(const glm::dvec3& p) { low = glm::min(low, p), high = glm::max(high, p); }
    bool meets(const Bounds& other) const {
        return glm::all(glm::lessThanEqual(low, other.high)) &&
               glm::all(glm::lessThanEqual(other.low, high));
    }
};

Bounds boundsOf(const TriMesh& mesh, const glm::ivec3& t) {
    Bounds bounds;
    for (int corner = 0; corner < 3; ++corner)
        bounds.add(mesh.vertices[std::size_t(t[corner])]);
    return bounds;
}

/// How many pairs of triangles cut through each other where `before` has been cut: one that is
/// filled in or has moved, and another of its own or of the `others`.
std::size_t crossingsAt(const LoopCut& cut, const TriMesh& before, const TriMesh& others) {
    const auto moved = [&](int v) {
        return std::size_t(v) >= before.vertices.size() ||
               cut.mesh.vertices[std::size_t(v)] != before.vertices[std::size_t(v)];
    };
    TriMesh near{cut.mesh.vertices, {}};  // what has changed comes first
    std::vector<glm::ivec3> rest;
    Bounds bounds;
    for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
        const glm::ivec3& corners = cut.mesh.triangles[t];
        if (t < cut.firstFilled && !moved(corners.x) && !moved(corners.y) && !moved(corners.z)) {
            rest.push_back(corners);
            continue;
        }
        near.triangles.push_back(corners);
        for (int corner = 0; corner < 3; ++corner)
            bounds.add(cut.mesh.vertices[std::size_t(corners[corner])]);
    }
    const int changed = int(near.triangles.size()), own = int(near.vertices.size());
    for (const glm::ivec3& t : rest)
        if (bounds.meets(boundsOf(cut.mesh, t))) near.triangles.push_back(t);
    near.vertices.insert(near.vertices.end(), others.vertices.begin(), others.vertices.end());
    for (const glm::ivec3& t : others.triangles)
        if (bounds.meets(boundsOf(others, t))) near.triangles.push_back(t + own);
    const auto pairs = selfIntersections(near);
    return std::size_t(std::count_if(pairs.begin(), pairs.end(), [&](const auto& pair) {
        return pair.first < changed && pair.first != pair.second;
    }));
}

/// The mesh without one of its pieces.
TriMesh othersThan(const Piece& piece, const TriMesh& whole) {
    TriMesh others{whole.vertices, {}};
    std::vector<char> own(whole.triangles.size(), 0);
    for (const std::size_t t : piece.triangles)
        own[t] = 1;
    for (std::size_t t = 0; t < whole.triangles.size(); ++t)
        if (!own[t]) others.triangles.push_back(whole.triangles[t]);
    return others;
}

/// One handle less; `mesh` must have one. `others` are what its fillings should not cut through.
Result<RemovedHandle> removeShortest(TriMesh& mesh, const TriMesh& others, int threads) {
    const auto halves = TRY(mesh::HalfedgeMesh::ofClosed(mesh));
    const auto places = TRY(coarsePlaces(mesh));
    const auto marks = homologyMarks(halves);
    LoopSearchOptions search;
    search.threads = threads;
    mesh::Loop best;
    LoopCut bestCut;
    std::size_t crossings = std::numeric_limits<std::size_t>::max();
    for (std::size_t tries = 0; crossings > 0 && tries < mostClasses; ++tries) {
        const mesh::Loop loop = shortestLoop(halves, marks, places, search);
        if (loop.halfedges.empty()) break;
        LoopCut cut = cutAlong(mesh, halves, loop);
        if (const std::size_t found = crossingsAt(cut, mesh, others); found < crossings) {
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
    RemovedHandle handle{{}, best.lengthMm, bestCut.filledAreaMm2, crossings};
    for (const int h : best.halfedges)
        handle.loopMm.push_back(mesh.vertices[std::size_t(halves.origin(h))]);
    mesh = std::move(bestCut.mesh);
    return handle;
}

}  // namespace

Result<HandleRemoval> removeHandles(const TriMesh& mesh, const HandleRemovalOptions& options) {
    if (mesh.triangles.empty()) return fail(ErrorKind::badInput, "the mesh has no triangles");
    const auto halves = TRY(mesh::HalfedgeMesh::ofClosed(mesh));
    const long handles = meshTopology(mesh).genus();
    const auto report = [&](std::size_t removed) {
        if (options.progress) options.progress(handles ? double(removed) / double(handles) : 1.0);
    };

    HandleRemoval removal{mesh, {}, 0.0};
    for (Piece& piece : piecesOf(halves, mesh)) {
        const long genus = meshTopology(piece.mesh).genus();
        const TriMesh others = genus > 0 ? othersThan(piece, removal.mesh) : TriMesh{};
        for (long removed = 0; removed < genus; ++removed) {
            report(removal.handles.size());
            auto handle = TRY(removeShortest(piece.mesh, others, options.threads));
            removal.handles.push_back(std::move(handle));
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

}  // namespace haustra::handles
