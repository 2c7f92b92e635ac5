// What mesh files hold before it is known to be a mesh: points, and polygons over them.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace haustra::mesh {

/// Polygon p has the corners corners[firstCorner[p]] … corners[firstCorner[p + 1] − 1].
struct PolygonSoup {
    std::vector<glm::dvec3> points;
    std::vector<std::int64_t> corners;  ///< as the file gives them, counted from 0; unchecked
    std::vector<std::size_t> firstCorner{0};

    void endPolygon() { firstCorner.push_back(corners.size()); }
    std::size_t polygonCount() const { return firstCorner.size() - 1; }
};

/// Read the bytes of one file. Whatever the bytes, these neither crash nor take memory beyond a
/// small multiple of their number: what a header claims is never believed before it is read.
/// Errors (badInput, unsupported) have `place` as their place. Thread-safe.
Result<PolygonSoup> readPly(std::span<const char> bytes, const std::string& place);
Result<PolygonSoup> readObj(std::span<const char> bytes, const std::string& place);
Result<PolygonSoup> readOff(std::span<const char> bytes, const std::string& place);
/// Each facet's corners are points of their own.
Result<PolygonSoup> readStl(std::span<const char> bytes, const std::string& place);

/// Points at one place (bit for bit, but −0 is 0) become the first of them. O(n) expected.
void weldPoints(PolygonSoup& soup);

/// The soup's polygons as triangles: ears clipped in the polygon's mean plane (Newell's normal), a
/// quadrilateral along its shorter diagonal where both are inside. Corners that repeat the one
/// before are left out, and polygons of fewer than three corners with them. Fails (badInput) where
/// a corner is not a point, a point is not finite, a polygon has over 10,000 corners, or there is
/// no triangle or more than 2³⁰ of anything.
Result<TriMesh> triangulated(const PolygonSoup& soup, const std::string& place);

}  // namespace haustra::mesh
