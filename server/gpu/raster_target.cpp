#include "gpu/raster_target.h"

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

Result<RasterTarget> RasterTarget::create(glm::ivec2 size, TexelFormat format, const char* what) {
    auto texture = TRY(Texture::create(2, {size, 1}, format, Filter::nearest, what));
    RasterTarget target(std::move(texture));
    glCreateRenderbuffers(1, &target.depth_);
    glNamedRenderbufferStorage(target.depth_, GL_DEPTH_COMPONENT32F, size.x, size.y);
    glCreateFramebuffers(1, &target.framebuffer_);
    glNamedFramebufferTexture(target.framebuffer_, GL_COLOR_ATTACHMENT0, target.texture_.id_, 0);
    glNamedFramebufferRenderbuffer(target.framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                   target.depth_);
    if (glCheckNamedFramebufferStatus(target.framebuffer_, GL_DRAW_FRAMEBUFFER) !=
        GL_FRAMEBUFFER_COMPLETE)
        return fail(ErrorKind::device, "the device draws no triangles into such a picture", what);
    return target;
}

RasterTarget::~RasterTarget() {
    if (framebuffer_) glDeleteFramebuffers(1, &framebuffer_);
    if (depth_) glDeleteRenderbuffers(1, &depth_);
}

RasterTarget::RasterTarget(RasterTarget&& other) noexcept : texture_(std::move(other.texture_)) {
    std::swap(depth_, other.depth_);
    std::swap(framebuffer_, other.framebuffer_);
}

RasterTarget& RasterTarget::operator=(RasterTarget&& other) noexcept {
    std::swap(texture_, other.texture_);
    std::swap(depth_, other.depth_);
    std::swap(framebuffer_, other.framebuffer_);
    return *this;
}

void RasterTarget::clear(glm::vec4 background) const {
    glClearNamedFramebufferfv(framebuffer_, GL_COLOR, 0, &background.x);
    clearDepth();
}

void RasterTarget::clear(glm::ivec4 background) const {
    glClearNamedFramebufferiv(framebuffer_, GL_COLOR, 0, &background.x);
    clearDepth();
}

void RasterTarget::clearDepth() const {
    constexpr float far = 1.0f;
    glClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &far);
}

std::size_t RasterTarget::bytes() const {
    return texture_.bytes() + 4 * std::size_t(size().x) * std::size_t(size().y);
}

}  // namespace haustra::gpu
