#include "gpu/buffer.h"

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

namespace {

/// A new buffer's name, or 0 where the device has no room.
unsigned newBuffer(const void* data, std::size_t bytes, GLbitfield flags) {
    unsigned id = 0;
    glCreateBuffers(1, &id);
    while (glGetError() != GL_NO_ERROR) {
    }
    glNamedBufferStorage(id, GLsizeiptr(bytes), data, flags);
    if (glGetError() == GL_NO_ERROR) return id;
    glDeleteBuffers(1, &id);
    return 0;
}

}  // namespace

Result<UniformBuffer> UniformBuffer::create(std::size_t bytes) {
    UniformBuffer buffer;
    buffer.id_ = newBuffer(nullptr, bytes, GL_DYNAMIC_STORAGE_BIT);
    if (!buffer.id_) return fail(ErrorKind::device, "the device has no room for a uniform buffer");
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

Result<StorageBuffer> StorageBuffer::createFromBytes(const void* data, std::size_t bytes,
                                                     const char* what) {
    StorageBuffer buffer;
    buffer.id_ = newBuffer(data, bytes, 0);
    buffer.bytes_ = bytes;
    if (!buffer.id_)
        return fail(ErrorKind::device,
                    "the device has no room for " + std::to_string(bytes >> 10) + " KiB", what);
    return buffer;
}

StorageBuffer::~StorageBuffer() {
    if (id_) glDeleteBuffers(1, &id_);
}

StorageBuffer::StorageBuffer(StorageBuffer&& other) noexcept {
    *this = std::move(other);
}

StorageBuffer& StorageBuffer::operator=(StorageBuffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void StorageBuffer::read(void* items, std::size_t bytes) const {
    glGetNamedBufferSubData(id_, 0, GLsizeiptr(bytes), items);
}

void StorageBuffer::bind(unsigned binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}

}  // namespace haustra::gpu
