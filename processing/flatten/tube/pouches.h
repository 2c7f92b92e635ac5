// Blind fingers of a tube, which its conformal map leaves no room: mapped apart, and set in.
#pragma once

#include "core/tri_mesh.h"
#include "flatten/periodic_map.h"

#include <vector>

namespace haustra::flatten {

/// A disc of the surface that is to be mapped apart.
struct Pouch {
    std::vector<int> triangles;
    glm::dvec2 middle{0.0};  ///< where the map shrinks it to; x may be outside [0, 1)
    double radius = 0.0;     ///< in the plane, of the round hole in the map that its neck leaves
};

/// A triangle whose longest side is shorter than this may lose its shape to rounding.
inline constexpr double crowdedUnits = 16.0;

/// Along a blind finger of radius r a conformal map shrinks as exp(−depth / r), until the corners
/// of triangles fall together on the lattice that flat maps are drawn on (core/flat_map.h). Finds
/// the triangles whose sides are all shorter than `sideUnits` of it, and around each of their
/// clusters cuts the finger off at its neck: of the circles around that place in the plane, which
/// are loops around the finger on the surface, the one whose square is least against the area that
/// it encloses (after Cheeger), none being so small that it leaves no room itself. In ascending
/// order of their lowest triangles, but clusters of a thousand or more first, the largest of all
/// before the others, in whose pouches smaller ones may lie. Nothing of a tube that has room
/// everywhere; a cluster without such a circle, as beside a rim, is left out. `map` need not be
/// without flips. O(n) for each cluster.
std::vector<Pouch> findPouches(const TriMesh& tube, const PeriodicMap& map,
                               double sideUnits = crowdedUnits);

/// How much may still be mapped apart, so that a surface that cannot be mapped costs no more than a
/// few times one that can.
struct PouchWork {
    std::size_t left = 0;  ///< triangles; each time that one is mapped counts
    std::size_t done = 0;

    /// False where there is not so much left.
    bool take(std::size_t triangles) {
        if (triangles > left) return false;
        left -= triangles;
        done += triangles;
        return true;
    }
};

/// How many triangles may be drawn on one grid, which tells nothing of their shape: some thousand,
/// or, where all else has failed, as many as the lattice has room for. (Fingers on pouches: some
/// thousand.)
enum class Grids { small, any };

/// A map in which pouches have been set in. Their triangles are cut along a ring in them.
struct SetIn {
    TriMesh tube;  ///< the vertices of the tube before, and new ones
    PeriodicMap map;
    std::vector<int> sourceTriangle;  ///< per triangle: the one that it is, or is a part of
    std::vector<char> apart;          ///< per triangle: mapped apart
    std::size_t pouches = 0;          ///< how many; those with a border that could not be are left
    std::size_t spread = 0;           ///< of mendFolds: clusters that got room where they are
};

/// Outside of the pouches the map stays as it is, to the bit. A pouch keeps its border's places,
/// which must all be seen from one point between them. Its triangles are cut along the ring that
/// runs through all edges from the border inwards; between border and ring each triangle's part is
/// a polygon, and the ring becomes a circle around that point, small enough for all of these to be
/// upright. What is within the ring goes on the circle's disc by embedDisc, without a fold. Its
/// target: the disc without its tip is a tube, whose own conformal map has room all along (fingers
/// on it are set into that likewise), rolled up with radii that fall by no more than e⁷ from neck
/// to tip, where a conformal map's fall as exp(−2π y). Vertices of what is thin move to the middles
/// of their stars. A pouch that still comes out with a triangle that rounding to the lattice might
/// turn over, as a thread does whose every cross-section is a narrow neck, is cut along two rings
/// instead; the outer one becomes a triangle with round corners, in which drawOnGrid draws the
/// rest, on places of the lattice itself. Triangles with two sides on its border then stay out. One
/// that is too large for that (Grids) is rolled up by rollAsPolygon, which folds nothing unless it
/// is rounded, however many they are. It is set in with up to a tenth of its triangles thin, for
/// mendFolds, or left as it was. O(n) while there is work left, beside the systems of those of up
/// to 8,000 triangles. `depth` counts the pouches on which these lie: the third's own fingers stay.
SetIn setIn(const TriMesh& tube, const PeriodicMap& map, const std::vector<Pouch>& pouches,
            PouchWork& work, int depth = 0, Grids grids = Grids::small);

/// Unfolds single places. Vertices around a cluster of at most 30 of `folded` (triangles of `tube`)
/// move to the middles of their stars, up to six rings of them, and stay there where all of their
/// triangles come to stand. Other clusters are mapped apart likewise, in the least round hole in
/// the map that has room for its triangles and leaves half as many folds or fewer. A cluster for
/// which there is no work left stays. Holes are tried with radii that grow by `radiusFactor`, over
/// 1, and have some thousand triangles at most but for Grids::any.
SetIn mendFolds(const TriMesh& tube, const PeriodicMap& map, const std::vector<int>& folded,
                double radiusFactor, Grids grids, PouchWork& work);

}  // namespace haustra::flatten
