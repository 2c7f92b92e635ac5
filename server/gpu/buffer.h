// Owner of one uniform buffer that holds one struct shared with GLSL.
#pragma once

#include "core/result.h"

#include <cstddef>
#include <type_traits>

namespace haustra::gpu {

/// Fixed-size storage for a uniform block. Belongs to the thread of the context in which it was
/// made, which must be current when it dies. Move-only.
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

}  // namespace haustra::gpu
