#include "render/object_order/cell_readers.h"

#include "core/parallel.h"

#include <algorithm>
#include <chrono>

namespace haustra::render {

namespace {

/// Adds the time until it dies.
class Stopwatch {
public:
    explicit Stopwatch(double& ms) : ms_(ms) {}
    ~Stopwatch() {
        ms_ += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
                   .count();
    }

private:
    double& ms_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace

Result<std::unique_ptr<CellReaders>> CellReaders::create(std::shared_ptr<const CellSource> source,
                                                         int side, int buffers, int threads) {
    const std::size_t bytes = source->texelBytes() * std::size_t(side) * std::size_t(side) *
                              std::size_t(side) * std::size_t(buffers);
    auto memory = TRY(gpu::MappedBuffer::create(bytes, "cells on their way to the GPU"));
    return std::unique_ptr<CellReaders>(
        new CellReaders(std::move(source), side, std::move(memory), buffers, threads));
}

CellReaders::CellReaders(std::shared_ptr<const CellSource> source, int side,
                         gpu::MappedBuffer memory, int buffers, int threads)
    : source_(std::move(source)),
      side_(side),
      bufferBytes_(memory.bytes() / std::size_t(buffers)),
      memory_(std::move(memory)),
      buffers_(std::size_t(buffers)) {
    for (int i = 0; i < threadCount(threads); ++i)
        threads_.emplace_back([this] { serve(); });
}

CellReaders::~CellReaders() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wanted_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void CellReaders::serve() {
    std::unique_lock lock(mutex_);
    while (true) {
        wanted_.wait(lock, [&] { return ending_ || !queue_.empty(); });
        if (ending_) return;
        const std::size_t index = queue_.front();
        queue_.pop_front();
        const VoxelBox box{buffers_[index].corner, side_};
        lock.unlock();
        std::exception_ptr failure;
        try {
            source_->read(box, memory_.data() + index * bufferBytes_);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        buffers_[index].failure = failure;
        buffers_[index].state = State::ready;
        done_.notify_all();
    }
}

bool CellReaders::isAhead(int cell) const {
    const std::lock_guard lock(mutex_);
    return std::any_of(buffers_.begin(), buffers_.end(), [&](const Buffer& buffer) {
        return buffer.cell == cell &&
               (buffer.state == State::reading || buffer.state == State::ready);
    });
}

CellReaders::Buffer* CellReaders::freeBuffer() {
    for (std::size_t i = 0; i < buffers_.size(); ++i) {
        Buffer& buffer = buffers_[next_];
        next_ = (next_ + 1) % buffers_.size();
        if (buffer.state == State::free ||
            (buffer.state == State::uploading && buffer.uploaded.passed()))
            return &buffer;
    }
    return nullptr;
}

void CellReaders::begin(Buffer& buffer, int cell, glm::ivec3 corner) {
    buffer.state = State::reading;
    buffer.cell = cell;
    buffer.corner = corner;
    buffer.uploaded = {};
    queue_.push_back(std::size_t(&buffer - buffers_.data()));
    wanted_.notify_one();
}

bool CellReaders::readAhead(int cell, glm::ivec3 corner) {
    const std::lock_guard lock(mutex_);
    Buffer* buffer = freeBuffer();
    if (!buffer) return false;
    begin(*buffer, cell, corner);
    return true;
}

void CellReaders::upload(int cell, glm::ivec3 corner, gpu::Texture& atlas, glm::ivec3 slot) {
    const Stopwatch watch(waitedMs_);
    std::unique_lock lock(mutex_);
    const auto mine = [&] {
        return std::find_if(buffers_.begin(), buffers_.end(), [&](const Buffer& buffer) {
            return buffer.cell == cell &&
                   (buffer.state == State::reading || buffer.state == State::ready);
        });
    };
    auto buffer = mine();
    while (buffer == buffers_.end()) {
        Buffer* unused = freeBuffer();
        if (!unused) {
            const auto is = [&](State state) {
                return std::find_if(buffers_.begin(), buffers_.end(),
                                    [&](const Buffer& one) { return one.state == state; });
            };
            if (const auto taken = is(State::uploading); taken != buffers_.end())
                taken->uploaded.wait();
            else if (const auto spare = is(State::ready); spare != buffers_.end())
                spare->state = State::free;
            else
                done_.wait(lock);
            continue;
        }
        begin(*unused, cell, corner);
        buffer = mine();
    }
    done_.wait(lock, [&] { return buffer->state == State::ready; });
    if (const auto failure = std::exchange(buffer->failure, nullptr)) {
        buffer->state = State::free;
        std::rethrow_exception(failure);
    }
    buffer->state = State::uploading;
    lock.unlock();
    const std::size_t index = std::size_t(buffer - buffers_.begin());
    atlas.uploadBox(slot, glm::ivec3(side_), memory_, index * bufferBytes_);
    buffer->uploaded = gpu::Fence::place();
}

void CellReaders::giveUp() {
    const std::lock_guard lock(mutex_);
    for (const std::size_t index : queue_)
        buffers_[index].state = State::free;
    queue_.clear();
    for (Buffer& buffer : buffers_)
        if (buffer.state == State::ready) buffer.state = State::free;
}

double CellReaders::takeWaitedMs() {
    return std::exchange(waitedMs_, 0.0);
}

}  // namespace haustra::render
