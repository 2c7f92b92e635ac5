// Threads that bring cells into the memory from which the GPU takes them.
#pragma once

#include "gpu/streaming.h"
#include "render/object_order/cell_source.h"

#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace haustra::render {

/// A ring of staging buffers, mapped for good: the middle level of the three (dissertation §5.2,
/// figure 5.1). Cells are read into them ahead of their turn, behind the drawing. Belongs to the
/// thread of the context.
class CellReaders {
public:
    /// `buffers` of side³ texels each, and `threads` that fill them (≤ 0: all cores).
    static Result<std::unique_ptr<CellReaders>> create(std::shared_ptr<const CellSource> source,
                                                       int side, int buffers, int threads);
    ~CellReaders();
    CellReaders(const CellReaders&) = delete;
    CellReaders& operator=(const CellReaders&) = delete;

    std::size_t bufferBytes() const { return bufferBytes_; }
    int buffers() const { return int(buffers_.size()); }

    bool isAhead(int cell) const;
    /// Begins to read a cell, where a buffer is free; else does nothing and says so.
    bool readAhead(int cell, glm::ivec3 corner);
    /// The cell's texels on their way into `atlas` at `slot`; reads it first, or waits for whoever
    /// does, whose exception is thrown here. What is read ahead and not needed after all is given
    /// up for it.
    void upload(int cell, glm::ivec3 corner, gpu::Texture& atlas, glm::ivec3 slot);
    /// Forgets what has been read ahead.
    void giveUp();
    /// Milliseconds that upload() has waited for reading or for the GPU, since the last call.
    double takeWaitedMs();

private:
    enum class State { free, reading, ready, uploading };
    struct Buffer {
        State state = State::free;
        int cell = -1;
        glm::ivec3 corner{0};
        gpu::Fence uploaded;
        std::exception_ptr failure;  // of its reading
    };
    CellReaders(std::shared_ptr<const CellSource> source, int side, gpu::MappedBuffer memory,
                int buffers, int threads);
    void serve();
    Buffer* freeBuffer();
    void begin(Buffer& buffer, int cell, glm::ivec3 corner);

    std::shared_ptr<const CellSource> source_;
    int side_;
    std::size_t bufferBytes_;
    gpu::MappedBuffer memory_;
    std::vector<Buffer> buffers_;  // states reading and ready: under the mutex
    std::size_t next_ = 0;
    double waitedMs_ = 0.0;

    mutable std::mutex mutex_;
    std::condition_variable wanted_, done_;
    std::deque<std::size_t> queue_;
    bool ending_ = false;
    std::vector<std::thread> threads_;  // last: they use the rest
};

}  // namespace haustra::render
