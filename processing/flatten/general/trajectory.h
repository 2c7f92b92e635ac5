// Straight lines of a form's flat metric, traced on the surface.
#pragma once

#include "core/result.h"
#include "flatten/general/carved_surface.h"

namespace haustra::flatten {

/// Carves the trajectory that leaves `base` in the flat direction `direction` and comes back to it,
/// and marks its edges as cut (dissertation §4.2.2.3, steps 4 and 5, over the whole surface instead
/// of from one side of a cut to the other). It is the line along which the integral of the form,
/// divided by `direction`, is real; each edge that it crosses is split at the crossing, exactly: to
/// the left of the line that integral's imaginary part is positive. Where it passes a vertex within
/// 10⁻⁹ of the triangle's size it goes through the vertex. `direction` must be a period of the
/// form, or no line comes back. Returns the carved half-edges. Fails (noResult) where the line
/// meets a cut elsewhere than at `base`, or does not come back, as it may where the form turns
/// triangles over. O(triangles crossed).
Result<std::vector<int>> traceTrajectory(CarvedSurface& surface, int base,
                                         std::complex<double> direction);

}  // namespace haustra::flatten
