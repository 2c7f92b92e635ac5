#include "gpu/texture.h"

#include "gpu/streaming.h"

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

namespace {

struct Layout {
    GLenum internal, format, type;
    std::size_t bytes;
};

Layout layoutOf(TexelFormat format) {
    switch (format) {
        case TexelFormat::r16:
            return {GL_R16, GL_RED, GL_UNSIGNED_SHORT, 2};
        case TexelFormat::r8ui:
            return {GL_R8UI, GL_RED_INTEGER, GL_UNSIGNED_BYTE, 1};
        case TexelFormat::r32f:
            return {GL_R32F, GL_RED, GL_FLOAT, 4};
        case TexelFormat::rgba8:
            return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, 4};
        case TexelFormat::rgba16f:
            return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT, 8};
        case TexelFormat::rgba32f:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
        case TexelFormat::rg32i:
            return {GL_RG32I, GL_RG_INTEGER, GL_INT, 8};
    }
    return {};
}

int limit(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

}  // namespace

int maxTextureSide3d() {
    return limit(GL_MAX_3D_TEXTURE_SIZE);
}

Result<Texture> Texture::create(int dimensions, glm::ivec3 size, TexelFormat format, Filter filter,
                                const char* what) {
    const int longest = glm::max(size.x, glm::max(size.y, size.z));
    const int most = dimensions == 3 ? maxTextureSide3d() : limit(GL_MAX_TEXTURE_SIZE);
    if (longest > most)
        return fail(ErrorKind::device,
                    "a side of " + std::to_string(longest) + " is over the device's limit of " +
                        std::to_string(most),
                    what);
    const GLenum target = dimensions == 1   ? GL_TEXTURE_1D
                          : dimensions == 2 ? GL_TEXTURE_2D
                                            : GL_TEXTURE_3D;
    const Layout layout = layoutOf(format);
    Texture texture;
    texture.dimensions_ = dimensions;
    texture.size_ = size;
    texture.format_ = format;
    glCreateTextures(target, 1, &texture.id_);
    while (glGetError() != GL_NO_ERROR) {
    }
    if (dimensions == 1) glTextureStorage1D(texture.id_, 1, layout.internal, size.x);
    if (dimensions == 2) glTextureStorage2D(texture.id_, 1, layout.internal, size.x, size.y);
    if (dimensions == 3)
        glTextureStorage3D(texture.id_, 1, layout.internal, size.x, size.y, size.z);
    if (glGetError() != GL_NO_ERROR)
        return fail(ErrorKind::device,
                    "the device has no room for " + std::to_string(texture.bytes() >> 20) + " MiB",
                    what);
    const GLint mode = filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
    glTextureParameteri(texture.id_, GL_TEXTURE_MIN_FILTER, mode);
    glTextureParameteri(texture.id_, GL_TEXTURE_MAG_FILTER, mode);
    for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
        glTextureParameteri(texture.id_, axis, GL_CLAMP_TO_EDGE);
    return texture;
}

Texture::~Texture() {
    if (id_) glDeleteTextures(1, &id_);
}

Texture::Texture(Texture&& other) noexcept {
    *this = std::move(other);
}

Texture& Texture::operator=(Texture&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(dimensions_, other.dimensions_);
    std::swap(size_, other.size_);
    std::swap(format_, other.format_);
    return *this;
}

void Texture::uploadSlices(int firstZ, int countZ, const void* texels) {
    const Layout layout = layoutOf(format_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage3D(id_, 0, 0, 0, firstZ, size_.x, size_.y, countZ, layout.format, layout.type,
                        texels);
}

void Texture::uploadBox(glm::ivec3 corner, glm::ivec3 size, const MappedBuffer& texels,
                        std::size_t offset) {
    const Layout layout = layoutOf(format_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, texels.id_);
    glTextureSubImage3D(id_, 0, corner.x, corner.y, corner.z, size.x, size.y, size.z, layout.format,
                        layout.type, reinterpret_cast<const void*>(offset));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

void Texture::clear() {
    const Layout layout = layoutOf(format_);
    glClearTexImage(id_, 0, layout.format, layout.type, nullptr);
}

void Texture::upload(const void* texels) {
    const Layout layout = layoutOf(format_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    if (dimensions_ == 1)
        glTextureSubImage1D(id_, 0, 0, size_.x, layout.format, layout.type, texels);
    if (dimensions_ == 2)
        glTextureSubImage2D(id_, 0, 0, 0, size_.x, size_.y, layout.format, layout.type, texels);
}

void Texture::read(void* texels, std::size_t bytes) const {
    const Layout layout = layoutOf(format_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(id_, 0, layout.format, layout.type, GLsizei(bytes), texels);
}

void Texture::bind(unsigned unit) const {
    glBindTextureUnit(unit, id_);
}

void Texture::bindImage(unsigned unit) const {
    glBindImageTexture(unit, id_, 0, dimensions_ == 3, 0, GL_READ_WRITE,
                       layoutOf(format_).internal);
}

std::size_t Texture::bytes() const {
    return std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z) *
           layoutOf(format_).bytes;
}

}  // namespace haustra::gpu
