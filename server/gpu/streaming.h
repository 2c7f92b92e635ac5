// Memory that CPU and GPU share while the GPU works, and how to know when it is done.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <memory>

namespace haustra::gpu {

/// A buffer that stays mapped, coherently: what the CPU writes the GPU's next commands see, and
/// what the GPU has written the CPU sees after a fence. For texels on their way into a texture
/// (Texture::uploadBox) and for storage blocks that change all the time. Belongs to the thread of
/// the context in which it was made, which must be current when it dies; other threads may read
/// and write the memory. Move-only.
class MappedBuffer {
public:
    /// Fails where the device has no room; `what` names the buffer in that message.
    static Result<MappedBuffer> create(std::size_t bytes, const char* what);
    ~MappedBuffer();
    MappedBuffer(MappedBuffer&& other) noexcept;
    MappedBuffer& operator=(MappedBuffer&& other) noexcept;

    std::byte* data() const { return data_; }
    std::size_t bytes() const { return bytes_; }
    /// `bytes` from `offset` on, a multiple of storageAlignment(), as a block with
    /// layout(std430, binding = binding).
    void bind(unsigned binding, std::size_t offset, std::size_t bytes) const;

private:
    friend class Texture;
    MappedBuffer() = default;
    unsigned id_ = 0;
    std::byte* data_ = nullptr;
    std::size_t bytes_ = 0;
};

/// What offsets into storage blocks must be multiples of on the current context's device.
std::size_t storageAlignment();

/// Marks a place in the context's commands. Belongs to the thread of the context. Move-only.
class Fence {
public:
    Fence() = default;  ///< marks nothing, and is passed
    static Fence place();
    ~Fence();
    Fence(Fence&& other) noexcept;
    Fence& operator=(Fence&& other) noexcept;

    /// Whether all commands before it are done.
    bool passed();
    /// Returns when they are.
    void wait();

private:
    void* sync_ = nullptr;
};

}  // namespace haustra::gpu
