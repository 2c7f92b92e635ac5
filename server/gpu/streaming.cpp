#include "gpu/streaming.h"

#include <string>
#include <utility>

#include <epoxy/gl.h>

namespace haustra::gpu {

Result<MappedBuffer> MappedBuffer::create(std::size_t bytes, const char* what) {
    constexpr GLbitfield access =
        GL_MAP_READ_BIT | GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    MappedBuffer buffer;
    buffer.bytes_ = bytes;
    glCreateBuffers(1, &buffer.id_);
    while (glGetError() != GL_NO_ERROR) {
    }
    glNamedBufferStorage(buffer.id_, GLsizeiptr(bytes), nullptr, access | GL_CLIENT_STORAGE_BIT);
    if (glGetError() == GL_NO_ERROR)
        buffer.data_ = static_cast<std::byte*>(
            glMapNamedBufferRange(buffer.id_, 0, GLsizeiptr(bytes), access));
    if (!buffer.data_)
        return fail(ErrorKind::device,
                    "the device has no room for " + std::to_string(bytes >> 10) + " KiB", what);
    return buffer;
}

MappedBuffer::~MappedBuffer() {
    if (id_) glDeleteBuffers(1, &id_);
}

MappedBuffer::MappedBuffer(MappedBuffer&& other) noexcept {
    *this = std::move(other);
}

MappedBuffer& MappedBuffer::operator=(MappedBuffer&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

void MappedBuffer::bind(unsigned binding, std::size_t offset, std::size_t bytes) const {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, binding, id_, GLintptr(offset), GLsizeiptr(bytes));
}

std::size_t storageAlignment() {
    GLint alignment = 256;
    glGetIntegerv(GL_SHADER_STORAGE_BUFFER_OFFSET_ALIGNMENT, &alignment);
    return std::size_t(alignment);
}

Fence Fence::place() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    // A command that stays in a queue of the driver's would never be done.
    glFlush();
    return fence;
}

Fence::~Fence() {
    if (sync_) glDeleteSync(static_cast<GLsync>(sync_));
}

Fence::Fence(Fence&& other) noexcept {
    *this = std::move(other);
}

Fence& Fence::operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
}

bool Fence::passed() {
    if (!sync_) return true;
    const GLenum is = glClientWaitSync(static_cast<GLsync>(sync_), 0, 0);
    return is == GL_ALREADY_SIGNALED || is == GL_CONDITION_SATISFIED;
}

void Fence::wait() {
    if (!sync_) return;
    constexpr GLuint64 second = 1'000'000'000;
    while (glClientWaitSync(static_cast<GLsync>(sync_), GL_SYNC_FLUSH_COMMANDS_BIT, second) ==
           GL_TIMEOUT_EXPIRED) {
    }
}

}  // namespace haustra::gpu
