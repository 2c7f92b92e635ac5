// Flat maps as files that other programs read.
#pragma once

#include "core/flat_map.h"
#include "core/result.h"

#include <filesystem>

namespace haustra::mesh {

/// Writes the cut surface with its flat coordinates by the name's ending; coordinates in LPS mm,
/// flat ones in circumferences: the first in [0, 1], the second in [0, height].
///
///   .obj  text: v, and for each a vt; faces v/vt
///   .ply  binary: vertices x, y, z, s, t (double), and where the map has cameras also camera
///         (int, counted from 0) and arc_mm (double); faces vertex_indices and source_triangle (of
///         the closed surface), and where `bridged` is given, one for each triangle
///         (core/bridges.h), bridge (uchar); and an element `camera` of x, y, z, arc_mm (double)
///
/// The same map gives the same bytes; text reads back exactly. Under a temporary name beside
/// `file` that is renamed. Fails (unsupported) on another ending, (io) naming the file.
Result<void> writeFlatMap(const std::filesystem::path& file, const FlatMap& map,
                          const std::vector<std::uint8_t>& bridged = {});

}  // namespace haustra::mesh
