// A closed, folded tube with its mesh and its flat map, for the tests of what draws by them.
#pragma once

#include "render_scene.h"

#include <numbers>

namespace haustra::tests {

/// Half the tube's length, mm.
inline constexpr double tubeEndMm = 18.0;

inline double tubeRadius(double z, double angle) {
    return 12.0 + 3.0 * std::sin(0.6 * z) + 1.5 * std::sin(3.0 * angle);
}

/// The tube of foldedTube, closed at both ends.
inline double closedTube(glm::dvec3 p) {
    const double beside = std::hypot(p.x, p.y) - tubeRadius(p.z, std::atan2(p.y, p.x));
    const double outside = std::max(beside, std::abs(p.z) - tubeEndMm);
    return -480.0 + 520.0 * std::tanh(outside / 1.2);
}

/// Residue in it: a ball that no mesh of the wall knows of.
inline double tubeWithResidue(glm::dvec3 p) {
    return std::max(closedTube(p), 300.0 - 400.0 * (glm::length(p - glm::dvec3(3, -4, 6)) - 2.0));
}

struct Tube {
    TriMesh wall;
    FlatMap map;  ///< of all but the ends
};

/// `around` vertices to a ring and as many rings as make its triangles about equal sided. The flat
/// map is x = angle / 2π and y = (z + end) / (2π · 12 mm).
inline Tube makeTube(int around) {
    const int along = around / 2;
    Tube tube;
    const auto place = [&](int ring, int step) {
        const double z = tubeEndMm * (2.0 * ring / along - 1.0);
        const double angle = 2.0 * std::numbers::pi * (step % around) / around;
        const double radius = tubeRadius(z, angle);
        return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), z);
    };
    TriMesh& cut = tube.map.surface;
    const double circumferenceMm = 2.0 * std::numbers::pi * 12.0;
    for (int ring = 0; ring <= along; ++ring) {
        for (int step = 0; step <= around; ++step) {
            const glm::dvec3 at = place(ring, step);
            cut.vertices.push_back(at);
            tube.map.flat.push_back({double(step) / around, (at.z + tubeEndMm) / circumferenceMm});
            tube.map.camera.push_back(0);
            if (step < around) tube.wall.vertices.push_back(at);
        }
    }
    tube.map.cameras = {{glm::dvec3(0.0), 0.0}};
    tube.map.height = 2.0 * tubeEndMm / circumferenceMm;
    const auto closed = [&](int ring, int step) { return ring * around + step % around; };
    const auto opened = [&](int ring, int step) { return ring * (around + 1) + step; };
    for (int ring = 0; ring < along; ++ring) {
        for (int step = 0; step < around; ++step) {
            for (const bool upper : {false, true}) {
                // Counter-clockwise seen from outside.
                const auto triangle = [&](const auto& of) {
                    return upper
                               ? glm::ivec3(of(ring, step + 1), of(ring + 1, step + 1),
                                            of(ring + 1, step))
                               : glm::ivec3(of(ring, step), of(ring, step + 1), of(ring + 1, step));
                };
                tube.map.sourceTriangle.push_back(int(tube.wall.triangles.size()));
                tube.wall.triangles.push_back(triangle(closed));
                cut.triangles.push_back(triangle(opened));
            }
        }
    }
    for (const int ring : {0, along}) {
        const int middle = int(tube.wall.vertices.size());
        tube.wall.vertices.push_back({0.0, 0.0, ring == 0 ? -tubeEndMm : tubeEndMm});
        for (int step = 0; step < around; ++step) {
            const int here = closed(ring, step), next = closed(ring, step + 1);
            tube.wall.triangles.push_back(ring == 0 ? glm::ivec3(middle, next, here)
                                                    : glm::ivec3(middle, here, next));
        }
    }
    return tube;
}

}  // namespace haustra::tests
