// From a view to what the ray caster's shader is told.
#pragma once

#include "core/grid.h"
#include "render/optics/transfer_table.h"
#include "render/scene/picture.h"
#include "shaders/uniforms.h"

namespace haustra::render {

/// Pixels along a tile's side in the cone pass, whose rays share the way through empty space.
inline constexpr int coneTile = 8;

/// Millimetres between samples on this grid.
double stepMm(const MarchOptions& march, const Grid& grid);

/// The uniform block of optics.glsl for rays from anywhere, in a picture of `size` pixels; the
/// fields of a camera are left zero. `blocks` is the leap map's size; `table` is made for this
/// step.
shaders::MarchUniforms marchUniforms(const Optics& optics, const MarchOptions& march,
                                     const Grid& grid, const TransferTable& table,
                                     glm::ivec3 blocks, glm::ivec2 size);

/// The same for a camera's rays. The view must have passed its checks.
shaders::MarchUniforms marchUniforms(const CameraView& view, const Grid& grid,
                                     const TransferTable& table, glm::ivec3 blocks,
                                     glm::ivec2 size);

}  // namespace haustra::render
