// The shapes that the overview draws beside the wall: the path, the reader and bookmarks.
#pragma once

#include "core/centerline.h"
#include "core/tri_mesh.h"
#include "render/scene/picture.h"
#include "shaders/overview_uniforms.h"

#include <cstdint>
#include <vector>

namespace haustra::render {

/// Triangles for overview.vert.
struct OverviewShapes {
    std::vector<shaders::OverviewVertex> vertices;
    std::vector<std::uint32_t> indices;  ///< three a triangle
};

/// How many patient millimetres the whole picture is high where `placeMm` lies; 0 behind the
/// camera. Of a perspective or orthographic lens.
double pictureHeightMm(const Camera& camera, glm::dvec3 placeMm);

/// The wall with smooth normals (each vertex's the mean of its triangles', by area). O(mesh).
OverviewShapes wallShape(const TriMesh& wall, glm::dvec3 originMm);

/// The path as a tube, left out in gaps; the reader's camera as a cone from where it is to where it
/// looks; bookmarks as balls. Their sizes are parts of the picture's height, so that they can be
/// seen from any distance. `path` may be null.
OverviewShapes markShapes(const OverviewView& view, const Centerline* path, glm::dvec3 originMm);

}  // namespace haustra::render
