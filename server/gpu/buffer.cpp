#include "gpu/buffer.h"

#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

Result<UniformBuffer> UniformBuffer::create(std::size_t bytes) {
    UniformBuffer buffer;
    glCreateBuffers(1, &buffer.id_);
    while (glGetError() != GL_NO_ERROR) {
    }
    glNamedBufferStorage(buffer.id_, GLsizeiptr(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
    if (glGetError() != GL_NO_ERROR)
        return fail(ErrorKind::device, "the device has no room for a uniform buffer");
    return buffer;
}

UniformBuffer::~UniformBuffer() {
    if (id_) glDeleteBuffers(1, &id_);
}

UniformBuffer::UniformBuffer(UniformBuffer&& other) noexcept {
    std::swap(id_, other.id_);
}

UniformBuffer& UniformBuffer::operator=(UniformBuffer&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
}

void UniformBuffer::writeBytes(const void* bytes, std::size_t count) {
    glNamedBufferSubData(id_, 0, GLsizeiptr(count), bytes);
}

void UniformBuffer::bind(unsigned binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
}

}  // namespace haustra::gpu
