// Discs of a tube by where its map has them.
#pragma once

#include "flatten/tube/pouches.h"
#include "flatten/tube/vertex_stars.h"
#include "mesh/halfedge_mesh.h"

#include <optional>
#include <vector>

namespace haustra::flatten {

/// Where a cluster lies in the plane, and how far it reaches from there.
struct Spot {
    std::vector<int> triangles;
    glm::dvec2 middle{0.0};
    double reach = 0.0;
};

Spot spotOf(const TriMesh& tube, const PeriodicMap& map, std::vector<int> triangles);

/// Radius, in circumferences, below which a circle around `middle` meets neither a rim nor, around
/// the strip, itself.
double largestRadiusAround(const PeriodicMap& map, glm::dvec2 middle);

/// Discs of the surface that a circle in the plane encloses.
class Discs {
public:
    Discs(const TriMesh& tube, const mesh::HalfedgeMesh& halfedges, const VertexStars& stars)
        : tube_(tube), halfedges_(halfedges), stars_(stars), inside_(tube.triangles.size(), 0) {}

    /// The triangles within the circle that hang together with one of `seeds`, which must be among
    /// them, with what they enclose; nothing where these are no disc with a border that is seen
    /// from a point within, or are already `taken`.
    std::optional<Pouch> within(const PeriodicMap& map, const std::vector<int>& seeds,
                                glm::dvec2 middle, double radius, const std::vector<char>& taken);

private:
    bool isBorder(int h) const {
        const int other = halfedges_.opposite(h);
        return other < 0 || !inside_[std::size_t(other / 3)];
    }
    /// Appends the triangles that can be reached from `triangles` across edges, and of which
    /// take(triangle) holds.
    template <class Take>
    void grow(std::vector<int>& triangles, const Take& take) const;
    /// Adds what the triangles enclose, and what they meet at a vertex alone; false where they
    /// still are no disc.
    bool close(std::vector<int>& found);
    /// Of the pieces that the triangles leave, all but the largest join them.
    bool fillHoles(std::vector<int>& found, const std::vector<int>& starts);

    const TriMesh& tube_;
    const mesh::HalfedgeMesh& halfedges_;
    const VertexStars& stars_;
    std::vector<char> inside_;
};

}  // namespace haustra::flatten
