// Distances between surfaces and the shapes of their triangles, for tests and benchmarks.
#pragma once

#include "core/parallel.h"
#include "core/tri_mesh.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

namespace haustra::tests {

/// Nearest distances to a mesh (CGAL's AABB tree). distance() may be called from many threads.
class SurfaceDistance {
    using Kernel = CGAL::Simple_cartesian<double>;
    using Triangles = std::vector<Kernel::Triangle_3>;
    using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
    using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

public:
    explicit SurfaceDistance(const TriMesh& mesh) {
        const auto point = [&](int v) {
            const glm::dvec3& p = mesh.vertices[v];
            return Kernel::Point_3(p.x, p.y, p.z);
        };
        for (const glm::ivec3& t : mesh.triangles)
            triangles_.emplace_back(point(t[0]), point(t[1]), point(t[2]));
        tree_.insert(triangles_.cbegin(), triangles_.cend());
        tree_.build();
        tree_.accelerate_distance_queries();
    }

    double distance(const glm::dvec3& p) const {
        return std::sqrt(tree_.squared_distance(Kernel::Point_3(p.x, p.y, p.z)));
    }

private:
    Triangles triangles_;
    Tree tree_;
};

/// Points on the mesh's triangles: their corners and a lattice no wider than spacingMm.
inline std::vector<glm::dvec3> samplesOn(const TriMesh& mesh, double spacingMm) {
    std::vector<glm::dvec3> samples;
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
        const double longest =
            std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const int steps = std::max(1, int(std::ceil(longest / spacingMm)));
        for (int i = 0; i <= steps; ++i) {
            for (int j = 0; i + j <= steps; ++j)
                samples.push_back(a + (b - a) * (double(i) / steps) +
                                  (c - a) * (double(j) / steps));
        }
    }
    return samples;
}

/// Distances from the samples to the surface, ascending.
inline std::vector<double> sortedDistances(const std::vector<glm::dvec3>& samples,
                                           const SurfaceDistance& surface) {
    std::vector<double> distances(samples.size());
    haustra::parallelFor(samples.size(), 4096, 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            distances[i] = surface.distance(samples[i]);
    });
    std::sort(distances.begin(), distances.end());
    return distances;
}

/// Each triangle's smallest angle in degrees, ascending.
inline std::vector<double> sortedSmallestAngles(const TriMesh& mesh) {
    std::vector<double> angles;
    for (const glm::ivec3& t : mesh.triangles) {
        double smallest = 180.0;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 p = mesh.vertices[t[k]];
            const glm::dvec3 u = mesh.vertices[t[(k + 1) % 3]] - p;
            const glm::dvec3 v = mesh.vertices[t[(k + 2) % 3]] - p;
            const double angle = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
            smallest = std::min(smallest, angle * 180.0 / M_PI);
        }
        angles.push_back(smallest);
    }
    std::sort(angles.begin(), angles.end());
    return angles;
}

}  // namespace haustra::tests
