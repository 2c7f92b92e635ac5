#include "render/hybrid/quad_list.h"

#include <cstring>

namespace haustra::render {

Result<QuadLists> QuadLists::create(int quads) {
    const std::size_t alignment = gpu::storageAlignment();
    const std::size_t list = headerBytes + sizeof(glm::uvec2) * std::size_t(quads);
    const std::size_t stride = (list + alignment - 1) / alignment * alignment;
    auto memory = TRY(gpu::MappedBuffer::create(stride * lists, "lists of quads"));
    return QuadLists(std::move(memory), stride, quads);
}

std::span<glm::uvec2> QuadLists::begin() {
    read_[next_].wait();
    return {reinterpret_cast<glm::uvec2*>(at() + headerBytes), std::size_t(quads_)};
}

void QuadLists::bind(unsigned binding, int count, int samples) {
    const std::uint32_t header[4] = {std::uint32_t(count), std::uint32_t(samples), 0, 0};
    std::memcpy(at(), header, sizeof header);
    memory_.bind(binding, stride_ * std::size_t(next_),
                 headerBytes + sizeof(glm::uvec2) * std::size_t(quads_));
}

void QuadLists::given() {
    read_[next_] = gpu::Fence::place();
    next_ = (next_ + 1) % lists;
}

}  // namespace haustra::render
