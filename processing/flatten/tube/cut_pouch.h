// One pouch of a tube, mapped apart.
#pragma once

#include "flatten/tube/pouches.h"
#include "mesh/halfedge_mesh.h"

#include <optional>
#include <unordered_map>
#include <vector>

namespace haustra::flatten {

/// A pouch in its place in the map: what comes instead of its triangles, cut along a ring.
struct PlacedPouch {
    /// A part of a triangle of the tube, `source`. Its corners are numbers of vertices; of the
    /// collar's, those not below 0 are border vertices of the tube, and −1 − n is vertex n.
    struct Piece {
        glm::ivec3 corners;
        int source;
    };
    std::vector<int> triangles;  ///< of the tube, which the pieces replace
    std::vector<glm::dvec3> verticesMm;
    std::vector<glm::dvec2> places;  ///< of the vertices in the map
    std::vector<int> tubeVertex;     ///< which of the tube's each vertex is; −1: a new one
    /// Of the tube's vertices on the border, in the copy of the strip in which the pouch lies.
    std::unordered_map<int, glm::dvec2> borderPlaces;
    std::vector<Piece> collar, inner;  ///< outside and within the ring
};

/// The radius of a circle within the border of a pouch, whose triangles `inside` marks, from whose
/// middle all of the border is seen, as a share of the pouch's; 0 where there is none.
double roundness(const TriMesh& tube, const mesh::HalfedgeMesh& halfedges, const PeriodicMap& map,
                 const std::vector<char>& inside, const Pouch& pouch);

/// The pouch, whose triangles `inside` marks, in its place: in its own shape, or else, trimmed, on
/// a grid (a large one only for Grids::any, and where rolling it up leaves something thin), or else
/// rolled up with at most `most` of its triangles too thin for the lattice. Nothing where its
/// border is not rounder than `roundness`, or none of this is possible.
std::optional<PlacedPouch> placed(const TriMesh& tube, const mesh::HalfedgeMesh& halfedges,
                                  const PeriodicMap& map, const std::vector<char>& inside,
                                  const Pouch& pouch, int depth, double roundness, std::size_t most,
                                  Grids grids, PouchWork& work);

}  // namespace haustra::flatten
