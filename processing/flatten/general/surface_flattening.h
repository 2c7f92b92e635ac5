// Any surface on the plane: a tube as a strip, a sphere as the tube that it is without its ends,
// everything else by its holomorphic forms.
#pragma once

#include "flatten/general/fundamental_domain.h"
#include "flatten/tube/end_holes.h"
#include "flatten/tube/flattening.h"

#include <array>
#include <complex>
#include <optional>

namespace haustra::flatten {

struct SurfaceShape {
    long parts = 0;
    long genus = 0;  ///< of all parts together
    long boundaryLoops = 0;
};

/// Fails (badInput) where the mesh is not manifold. O(n log n).
Result<SurfaceShape> shapeOf(const TriMesh& mesh);

struct SurfaceFlatteningOptions {
    /// Of a sphere: where its ends are; else the two vertices that are farthest apart along edges,
    /// found from any first one in two sweeps.
    std::optional<std::array<glm::dvec3, 2>> endsMm;
    /// Of a sphere: its holes' rims; 0: 15 mm, or a tenth of the square root of the area where that
    /// is less.
    double rimMm = 0.0;
    double areaWeight = 0.0;  ///< of a strip: see FlatteningOptions
    int threads = 0;
    Progress progress;
};

struct SurfaceFlattening {
    SurfaceShape shape;
    /// Without cameras. A strip as in core/flat_map.h; of a torus the parallelogram 0, 1, 1 + τ, τ,
    /// its height Im τ; of any other surface the integral of a holomorphic form over a fundamental
    /// domain, which covers the plane several times.
    FlatMap map;
    std::optional<Flattening> strip;          ///< its map is in `map`
    std::optional<PunchedTube> punched;       ///< of a sphere; its tube is moved on
    std::optional<std::complex<double>> tau;  ///< of a torus
    std::size_t formZeros = 0;                ///< of the form, with their orders
    double certificate = 0.0;
    Distortion distortion;
    std::size_t flips = 0;  ///< 0 of a strip, which is not given with any
};

/// A tube, a sphere, a closed surface of any genus, and through its double cover (of which one half
/// is kept) any surface with boundary but the disc. Fails (badInput) on a mesh that is not manifold
/// or in several parts, on a disc, and as what it calls.
Result<SurfaceFlattening> flattenSurface(const TriMesh& mesh,
                                         const SurfaceFlatteningOptions& options = {});

}  // namespace haustra::flatten
