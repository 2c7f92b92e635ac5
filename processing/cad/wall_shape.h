// What shape the wall has at a place: shape index and curvedness.
#pragma once

#include "cad/smooth_scan.h"
#include "cad/wall_samples.h"

#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Of the surface of equal HU through a place. Curvatures are positive where tissue bulges into the
/// lumen.
struct WallShape {
    glm::vec3 intoWall{0.0f, 0.0f, 1.0f};  ///< unit, along the gradient: from gas into tissue
    float gradient = 0.0f;                 ///< HU/mm
    float hu = 0.0f;                       ///< of the scan that was measured
    float k1 = 0.0f, k2 = 0.0f;            ///< principal curvatures, 1/mm, k1 ≥ k2

    /// SI = ½ + (1/π) atan((k1 + k2)/(k1 − k2)): 0 cup, ¼ rut, ½ saddle, ¾ ridge, 1 cap (Koenderink
    /// and van Doorn 1992; Yoshida and Näppi, IEEE TMI 2001; 20: 1261). ½ where the wall is flat.
    float shapeIndex() const;
    /// √((k1² + k2²)/2), 1/mm: a ball of radius r has 1/r.
    float curvedness() const;
};

/// From the derivatives of a scan in which tissue is brighter than what it borders on. A place
/// without a gradient is flat.
WallShape shapeOf(const Derivatives& scan);

/// At each sample; of these it needs `mesh.vertices` alone. O(samples).
std::vector<WallShape> shapesOf(const WallSamples& samples, const SmoothScan& scan, int threads);

}  // namespace haustra::cad
