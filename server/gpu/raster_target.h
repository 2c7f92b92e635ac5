// What triangles are drawn into with a depth test.
#pragma once

#include "core/result.h"
#include "gpu/texture.h"

#include <cstddef>

#include <glm/glm.hpp>

namespace haustra::gpu {

/// A 2-D texture with a depth buffer. Row 0 of the texture is where gl_Position.y is −w. Belongs to
/// the thread of the context in which it was made, which must be current when it dies. Move-only.
class RasterTarget {
public:
    /// Fails as Texture::create does; `what` names the target in that message.
    static Result<RasterTarget> create(glm::ivec2 size, TexelFormat format, const char* what);
    ~RasterTarget();
    RasterTarget(RasterTarget&& other) noexcept;
    RasterTarget& operator=(RasterTarget&& other) noexcept;

    /// Fills a texture of floats or fractions, or one of integers, and takes all depths to the far
    /// end. What is drawn later covers the background wherever it is within gl_Position's bounds.
    void clear(glm::vec4 background) const;
    void clear(glm::ivec4 background) const;

    const Texture& texture() const { return texture_; }
    glm::ivec2 size() const { return glm::ivec2(texture_.size()); }
    std::size_t bytes() const;

private:
    friend class RasterProgram;
    explicit RasterTarget(Texture texture) : texture_(std::move(texture)) {}
    void clearDepth() const;
    Texture texture_;
    unsigned depth_ = 0, framebuffer_ = 0;
};

}  // namespace haustra::gpu
