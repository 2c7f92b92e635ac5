// Curves through space as points.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace haustra::phantom {

using Points = std::vector<glm::dvec3>;

/// The Catmull-Rom spline through the points at `u` on their index axis; held at both ends.
glm::dvec3 catmullRom(const Points& points, double u);

double lengthOf(const Points& points);

/// Points a constant arc apart (about `stepMm`), and each one's place on the input's index axis.
Points resample(const Points& fine, double stepMm, std::vector<double>* place = nullptr);

}  // namespace haustra::phantom
