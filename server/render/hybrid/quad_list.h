// Lists of quads on their way to the GPU.
#pragma once

#include "gpu/streaming.h"

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

namespace haustra::render {

/// Memory that the GPU reads lists of quads from while the CPU writes the next ones. Belongs to the
/// thread of the context. Move-only.
class QuadLists {
public:
    /// For lists of up to `quads` quads each.
    static Result<QuadLists> create(int quads);

    /// Room for a list of up to the `quads` of create(): xy as the shader packs them. Waits where
    /// the GPU still reads what was there.
    std::span<glm::uvec2> begin();
    /// Binds the list of the first `count` entries as shaders/hybrid_slab.comp reads it; `samples`
    /// of a slab, or 0.
    void bind(unsigned binding, int count, int samples);
    /// The command that reads the list has been given: the next begin() is another list.
    void given();
    std::size_t bytes() const { return memory_.bytes(); }

private:
    static constexpr int lists = 4;
    static constexpr std::size_t headerBytes = 16;
    QuadLists(gpu::MappedBuffer memory, std::size_t stride, int quads)
        : memory_(std::move(memory)), stride_(stride), quads_(quads) {}
    std::byte* at() const { return memory_.data() + stride_ * std::size_t(next_); }
    gpu::MappedBuffer memory_;
    std::size_t stride_;
    int quads_, next_ = 0;
    gpu::Fence read_[lists];
};

}  // namespace haustra::render
