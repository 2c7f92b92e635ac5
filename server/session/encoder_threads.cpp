#include "session/encoder_threads.h"

#include <new>

namespace haustra::session {
namespace {

Result<std::vector<std::uint8_t>> encodeGuarded(encode::TileEncoder& encoder, EncodeJob& job) {
    try {
        return encoder.encode(job.image, job.header);
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::device, "there is not enough memory", "encoder");
    }
}

void work(encode::TileEncoder encoder, WorkQueue<EncodeJob>& jobs) {
    for (auto taken = jobs.take(1); !taken.empty(); taken = jobs.take(1))
        taken.front().done(encodeGuarded(encoder, taken.front()));
}

}  // namespace

Result<std::unique_ptr<EncoderThreads>> EncoderThreads::start(int threads) {
    std::unique_ptr<EncoderThreads> self(new EncoderThreads);
    for (int n = 0; n < threads; ++n) {
        auto encoder = encode::TileEncoder::create();
        if (!encoder) return tl::make_unexpected(encoder.error());
        self->threads_.emplace_back(work, std::move(*encoder), std::ref(self->jobs_));
    }
    return self;
}

EncoderThreads::~EncoderThreads() {
    jobs_.close();
    for (std::thread& thread : threads_)
        thread.join();
}

}  // namespace haustra::session
