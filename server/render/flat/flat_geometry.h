// A flat map in the form in which its pictures are drawn.
#pragma once

#include "core/flat_map.h"
#include "core/grid.h"
#include "core/result.h"
#include "core/strip_layout.h"
#include "render/scene/raycaster.h"
#include "shaders/uniforms.h"

#include <memory>
#include <vector>

namespace haustra::render {

/// Triangles [first, first + count), in drawing order.
struct TriangleRange {
    int first = 0, count = 0;
};

/// How a band's pixels lie over the strip; see FlatUniforms. What depends on the step or on who
/// draws (reachPixels, mostStepsBack, riseThatEnds, mostStepsOn) is zero.
struct FlatLattice {
    shaders::FlatUniforms uniforms{};
    TriangleRange triangles;  ///< all that the band shows, and more
    int copies = 0;           ///< of the strip that it shows, from uniforms.lattice.w on
};

/// The map's vertices, triangles and cameras as shaders/uniforms.h has them; immutable.
class FlatGeometry {
public:
    /// Millimetres are counted from `originMm`, which should be near. Fails (badInput) where the
    /// map is not sound: numbers of flat coordinates and cameras that differ from the vertices',
    /// indices out of range, values that are not finite, nothing in it, or a height over
    /// maxFlatHeight. O(n log n); 48 bytes a vertex and 32 a triangle. Any thread.
    static Result<std::shared_ptr<const FlatGeometry>> of(const FlatMap& map, glm::dvec3 originMm);
    /// The same, counted from the centre of a volume on `grid`, as packets and shaders expect it.
    static Result<std::shared_ptr<const FlatGeometry>> of(const FlatMap& map, const Grid& grid);

    double height() const { return height_; }
    glm::dvec3 originMm() const { return originMm_; }
    /// Flat coordinates are whole numbers of 1 / unitsPerCircumference, a power of two.
    int unitsPerCircumference() const { return unitsPerCircumference_; }

    const std::vector<shaders::FlatVertex>& vertices() const { return vertices_; }
    /// By their lowest flat coordinate.
    const std::vector<glm::ivec3>& triangles() const { return triangles_; }
    const std::vector<shaders::FlatEye>& cameras() const { return cameras_; }
    /// The number in the map of a triangle.
    int mapTriangle(int triangle) const { return mapTriangle_[std::size_t(triangle)]; }

    /// A range that holds every triangle with a place in lowY … highY. O(log n).
    TriangleRange trianglesWithin(double lowY, double highY) const;
    /// Of a band, as if it were a picture of its own, of the same pixels to the bit. The window
    /// must have passed its check.
    FlatLattice lattice(const FlatWindow& window, const Band& band) const;

private:
    std::vector<shaders::FlatVertex> vertices_;
    std::vector<glm::ivec3> triangles_;
    std::vector<shaders::FlatEye> cameras_;
    std::vector<int> mapTriangle_;
    std::vector<double> lowestY_;        // of each triangle: rising
    std::vector<double> highestYSoFar_;  // of all triangles up to each: rising
    glm::dvec3 originMm_{0.0};
    double height_ = 0.0;
    int unitsPerCircumference_ = 0;
};

}  // namespace haustra::render
