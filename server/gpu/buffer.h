// Owners of buffers on the device.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <span>
#include <type_traits>

namespace haustra::gpu {

/// Fixed-size storage for one struct that is shared with GLSL as a uniform block. Belongs to the
/// thread of the context in which it was made, which must be current when it dies. Move-only.
class UniformBuffer {
public:
    static Result<UniformBuffer> create(std::size_t bytes);
    ~UniformBuffer();
    UniformBuffer(UniformBuffer&& other) noexcept;
    UniformBuffer& operator=(UniformBuffer&& other) noexcept;

    /// Replaces the content. `Block` is a struct of shaders/uniforms.h, of the size created.
    template <class Block>
    void write(const Block& block) {
        static_assert(std::is_trivially_copyable_v<Block> && sizeof(Block) % 16 == 0,
                      "std140 rows");
        writeBytes(&block, sizeof block);
    }
    /// As a block with layout(std140, binding = binding).
    void bind(unsigned binding) const;

private:
    UniformBuffer() = default;
    void writeBytes(const void* bytes, std::size_t count);
    unsigned id_ = 0;
};

/// An array that the CPU writes once, for shaders to read, or to write, as a storage block or for a
/// raster program as its triangles' indices. Belongs to the thread of the context in which it was
/// made, which must be current when it dies. Move-only.
class StorageBuffer {
public:
    /// Copies `items`, of which there must be at least one, to the device. Fails where it has no
    /// room; `what` names the buffer in that message.
    template <class Item>
    static Result<StorageBuffer> create(std::span<const Item> items, const char* what) {
        static_assert(std::is_trivially_copyable_v<Item>);
        return createFromBytes(items.data(), items.size_bytes(), what);
    }
    ~StorageBuffer();
    StorageBuffer(StorageBuffer&& other) noexcept;
    StorageBuffer& operator=(StorageBuffer&& other) noexcept;

    /// As a block with layout(std430, binding = binding).
    void bind(unsigned binding) const;
    std::size_t bytes() const { return bytes_; }
    /// Copies it back, once the GPU has done what it was told before. `bytes` must be bytes().
    void read(void* items, std::size_t bytes) const;

private:
    friend class RasterProgram;
    StorageBuffer() = default;
    static Result<StorageBuffer> createFromBytes(const void* data, std::size_t bytes,
                                                 const char* what);
    unsigned id_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace haustra::gpu
