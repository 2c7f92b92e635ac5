#include "session/encoder_threads.h"

#include "session/guarded.h"

namespace haustra::session {
namespace {

void work(encode::TileEncoder encoder, WorkQueue<EncodeJob>& jobs) {
    serveQueue(jobs, 1, "encoder", [&](auto& taken) {
        EncodeJob& job = taken.front();
        job.done(guarded([&] { return encoder.encode(job.image, job.header); }));
    });
}

}  // namespace

Result<std::unique_ptr<EncoderThreads>> EncoderThreads::start(int threads) {
    std::unique_ptr<EncoderThreads> self(new EncoderThreads);
    for (int n = 0; n < threads; ++n) {
        auto encoder = TRY(encode::TileEncoder::create());
        self->threads_.emplace_back(work, std::move(encoder), std::ref(self->jobs_));
    }
    return self;
}

EncoderThreads::~EncoderThreads() {
    jobs_.close();
    for (std::thread& thread : threads_)
        thread.join();
}

}  // namespace haustra::session
