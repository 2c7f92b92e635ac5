// From a texture of a picture's rows to main memory.
#pragma once

#include "gpu/context.h"
#include "gpu/texture.h"
#include "render/scene/picture.h"

namespace haustra::render {

/// Copies `rows`, a 2-D rgba8 texture, as wide as `picture`, into it from row `firstRow` on. Fails
/// (device) where the driver has reported an error since `errorsBefore`.
Result<void> readBack(gpu::Context& context, const gpu::Texture& rows, int errorsBefore,
                      int firstRow, Image& picture);

}  // namespace haustra::render
