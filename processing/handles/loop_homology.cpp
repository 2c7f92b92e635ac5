#include "handles/loop_homology.h"

#include "core/disjoint_sets.h"

#include <numeric>

namespace haustra::handles {
namespace {

std::uint64_t mixedBits(std::uint64_t x) {  // splitmix64
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

}  // namespace

std::vector<std::uint64_t> homologyMarks(const mesh::HalfedgeMesh& mesh) {
    const int halfedges = mesh.halfedgeCount(), faces = halfedges / 3;
    std::vector<std::uint64_t> marks(halfedges, 0);
    if (faces == 0) return marks;

    // The half-edge by which the dual tree entered each face, from within it.
    std::vector<int> entry(faces, -1), order{0};
    std::vector<char> inDualTree(halfedges, 0);
    order.reserve(faces);
    for (std::size_t next = 0; next < order.size(); ++next) {
        for (int corner = 0; corner < 3; ++corner) {
            const int h = 3 * order[next] + corner, across = mesh.opposite(h);
            const int face = across / 3;
            if (face == 0 || entry[face] >= 0) continue;
            entry[face] = across;
            inDualTree[h] = inDualTree[across] = 1;
            order.push_back(face);
        }
    }

    std::vector<int> parent(mesh.vertexCount());
    std::iota(parent.begin(), parent.end(), 0);
    std::vector<int> generators;
    for (int h = 0; h < halfedges; ++h) {
        if (inDualTree[h] || h > mesh.opposite(h)) continue;
        const int a = mesh.origin(h), b = mesh.target(h);
        if (rootOf(parent, a) == rootOf(parent, b)) {
            generators.push_back(h);
        } else {
            unite(parent, a, b);
        }
    }

    // Curve i crosses generator i and runs to the dual tree's root from both of its faces.
    std::vector<std::uint64_t> below(faces, 0);
    for (std::size_t i = 0; i < generators.size(); ++i) {
        const int h = generators[i];
        const std::uint64_t bit =
            generators.size() <= 64 ? std::uint64_t(1) << i : mixedBits(std::uint64_t(i));
        marks[h] = marks[mesh.opposite(h)] = bit;
        below[h / 3] ^= bit;
        below[mesh.opposite(h) / 3] ^= bit;
    }
    for (std::size_t i = order.size(); i-- > 1;) {
        const int h = entry[order[i]], across = mesh.opposite(h);
        marks[h] = marks[across] = below[order[i]];
        below[across / 3] ^= below[order[i]];
    }
    return marks;
}

}  // namespace haustra::handles
