// The threads that turn pictures into bytes.
#pragma once

#include "encode/tile_encoder.h"
#include "session/work_queue.h"

#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace haustra::session {

struct EncodeJob {
    Image image;
    protocol::TileHeader header;  ///< as TileEncoder::encode takes it
    /// Called on an encoder thread with the picture's frames.
    std::function<void(Result<std::vector<std::uint8_t>>)> done;
};

/// Each thread owns a TileEncoder. A session has one job here at a time, so its pictures stay in
/// order.
class EncoderThreads {
public:
    static Result<std::unique_ptr<EncoderThreads>> start(int threads);
    /// Finishes what waits, and joins.
    ~EncoderThreads();
    EncoderThreads(const EncoderThreads&) = delete;
    EncoderThreads& operator=(const EncoderThreads&) = delete;

    /// From any thread; never blocks.
    void submit(EncodeJob job) { jobs_.push(std::move(job)); }

private:
    EncoderThreads() = default;
    WorkQueue<EncodeJob> jobs_;
    std::vector<std::thread> threads_;
};

}  // namespace haustra::session
