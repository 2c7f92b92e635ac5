// Triangle meshes to and from files.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <filesystem>

namespace haustra::surface {

/// Reads PLY, OBJ, OFF or STL (by the name's ending, any case; OpenMesh). Polygons are
/// triangulated; STL's corners at one place become one vertex. Fails, naming the file, where it
/// cannot be read, holds no triangle, an index out of range or a coordinate that is not finite.
/// Thread-safe.
Result<TriMesh> readMesh(const std::filesystem::path& file);

/// Writes PLY (binary, double), OBJ, OFF or STL (binary) by the name's ending, coordinates in LPS
/// mm, under a temporary name beside `file` that is renamed. The same mesh gives the same bytes.
Result<void> writeMesh(const std::filesystem::path& file, const TriMesh& mesh);

}  // namespace haustra::surface
