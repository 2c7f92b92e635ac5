// Owner of one OpenGL texture.
#pragma once

#include "core/result.h"

#include <cstddef>

#include <glm/glm.hpp>

namespace haustra::gpu {

class MappedBuffer;

enum class TexelFormat {
    r16,      ///< one 16-bit fraction, 0…1
    r8ui,     ///< one byte, integer
    r32f,     ///< one float
    rgba8,    ///< four bytes, 0…1
    rgba16f,  ///< four half floats
    rgba32f,  ///< four floats
    rg32i,    ///< two integers
};

enum class Filter {
    nearest,  ///< also what integer formats need
    linear,
};

/// Immutable-size storage of one mip level, clamped at its edges. Belongs to the thread of the
/// context in which it was made, which must be current when it dies. Move-only.
class Texture {
public:
    /// Storage of `size` texels; y and z are 1 where there are fewer `dimensions` (1, 2 or 3). The
    /// content is undefined. Fails where the device's limits or its memory do not allow it, and
    /// then says which; `what` names the texture in that message.
    static Result<Texture> create(int dimensions, glm::ivec3 size, TexelFormat format,
                                  Filter filter, const char* what);
    ~Texture();
    Texture(Texture&& other) noexcept;
    Texture& operator=(Texture&& other) noexcept;

    /// Writes `texels`: slices [firstZ, firstZ + countZ) of a 3-D texture, tightly packed in the
    /// texture's own format, x fastest.
    void uploadSlices(int firstZ, int countZ, const void* texels);
    /// Writes the box of `size` texels at `corner` of a 3-D texture, when the GPU gets there, from
    /// `offset` on in `texels`, which must not change before a fence after this has passed.
    void uploadBox(glm::ivec3 corner, glm::ivec3 size, const MappedBuffer& texels,
                   std::size_t offset);
    /// Sets every texel to zero.
    void clear();
    /// Writes the whole of a 1-D or 2-D texture.
    void upload(const void* texels);
    /// Reads the whole texture back, tightly packed. `bytes` must be bytes().
    void read(void* texels, std::size_t bytes) const;

    /// As a sampler2D etc. with layout(binding = unit).
    void bind(unsigned unit) const;
    /// As an image, to read and write, with layout(binding = unit).
    void bindImage(unsigned unit) const;

    glm::ivec3 size() const { return size_; }
    std::size_t bytes() const;

private:
    friend class RasterProgram;
    friend class RasterTarget;
    Texture() = default;
    unsigned id_ = 0;
    int dimensions_ = 0;
    glm::ivec3 size_{0};
    TexelFormat format_ = TexelFormat::rgba8;
};

/// The longest side of a 3-D texture on the current context's device.
int maxTextureSide3d();

}  // namespace haustra::gpu
