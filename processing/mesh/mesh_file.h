// Triangle meshes to and from files.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace haustra::mesh {

/// Reads PLY (text or binary), OBJ, OFF (text) or STL (text or binary), by the name's ending in any
/// case. Polygons are triangulated (see polygon_soup.h); STL's corners at one place become one
/// vertex; vertices that no triangle uses stay. Nothing is repaired: a mesh that is not manifold
/// comes as it is. Fails, naming the file, where it cannot be read or ends early, holds no
/// triangle, an index out of range or a coordinate that is not finite. Thread-safe.
///
/// The formats are read here because OpenMesh's readers round to float, take broken files for sound
/// ones and do not end on some (measured in METHODS §7.1 "Half-edges and mesh files"), and CGAL's
/// take as much memory as a hostile header claims.
Result<TriMesh> readMesh(const std::filesystem::path& file);

/// Writes PLY (binary, double), OBJ or OFF (text that reads back exactly) or STL (binary, float by
/// its definition) by the name's ending, coordinates in LPS mm, under a temporary name beside
/// `file` that is renamed. The same mesh gives the same bytes. Fails (io) naming the file.
Result<void> writeMesh(const std::filesystem::path& file, const TriMesh& mesh);

/// Writes a binary PLY as writeMesh does, whose faces have a number each besides (uchar, of the
/// name `property`). `values` are as many as triangles.
Result<void> writePly(const std::filesystem::path& file, const TriMesh& mesh,
                      const std::string& property, const std::vector<std::uint8_t>& values);

}  // namespace haustra::mesh
