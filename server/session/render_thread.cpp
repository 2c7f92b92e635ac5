#include "session/render_thread.h"

#include "gpu/context.h"
#include "session/worker.h"

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <utility>

namespace haustra::session {
namespace {

double msBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

std::uint32_t microseconds(double ms) {
    return std::uint32_t(std::clamp(1e3 * ms, 0.0, double(UINT32_MAX)));
}

// The band's rows of the frame's picture, in the size that the frame is drawn in.
Result<void> draw(render::CaseRenderer& renderer, Frame& frame, const render::Band& band) {
    const glm::ivec2 size = frame.size;
    const AnyView view = size.x == frame.job.width
                             ? frame.job.view
                             : scaledView(frame.job.view, frame.job.width, size.x);
    if (frame.picture.rgb.empty()) frame.picture = blankImage(size);
    return std::visit([&](const auto& any) { return renderer.render(any, band, frame.picture); },
                      view);
}

}  // namespace

struct RenderThread::Shared {
    std::mutex mutex;
    std::condition_variable wake;
    // All guarded by mutex.
    std::function<void(Drawing&)> errand;  // of the loader, which waits for its end
    FrameScheduler frames;
    bool caseLeft = false;  // the last session of some case is gone
    bool stopping = false;
};

// What lives on the render thread, from its start to its end.
struct RenderThread::Drawing {
    std::shared_ptr<Shared> shared;
    std::unique_ptr<gpu::Context> context;
    GpuCases cases;
    Lost lost;

    void run() {
        // An errand is followed by as many milliseconds of pictures, where there are any.
        double owedMs = 0.0;
        std::unique_lock lock(shared->mutex);
        for (;;) {
            const auto called = [&] {
                return shared->stopping || shared->caseLeft || shared->errand ||
                       !shared->frames.empty();
            };
            if (const auto until = cases.nextRelease())
                shared->wake.wait_until(lock, *until, called);
            else
                shared->wake.wait(lock, called);
            if (shared->stopping) return;
            shared->caseLeft = false;
            auto turn =
                shared->errand && owedMs <= 0.0 ? std::nullopt : shared->frames.next(Clock::now());
            auto errand = turn ? nullptr : std::exchange(shared->errand, nullptr);
            lock.unlock();
            const auto start = Clock::now();
            try {
                cases.releaseLeft(start);
                if (errand) {
                    errand(*this);
                    owedMs = msBetween(start, Clock::now());
                }
                if (turn) {
                    drawTurn(*turn);
                    owedMs -= msBetween(start, Clock::now());
                }
            } catch (const std::exception& error) {
                logFault("render", error);
            }
            turn.reset();  // may be a case's last user, so not under the lock
            lock.lock();
        }
    }

    void drawTurn(const FrameScheduler::Turn& turn) {
        Frame& frame = *turn.frame;
        const auto start = Clock::now();
        render::CaseRenderer* const renderer = cases.rendererOf(frame.job.of);
        auto drawn = guarded([&]() -> Result<void> {
            if (!renderer) return fail(ErrorKind::device, "the case is not on the GPU", "render");
            return draw(*renderer, frame, turn.band);
        });
        if (auto whole = cases.checkWhole(frame.job.of); !whole) {
            drawn = std::move(whole);
            lost(frame.job.of);
        }
        const auto end = Clock::now();
        using Outcome = FrameScheduler::Outcome;
        Outcome outcome = Outcome::unwanted;
        {
            const std::lock_guard lock(shared->mutex);
            const double ms = msBetween(start, end);
            if (drawn)
                outcome = shared->frames.drawn(turn, ms, end);
            else if (shared->frames.failed(turn, ms, end))
                outcome = Outcome::finished;
        }
        if (outcome != Outcome::finished) return;
        protocol::TileHeader header = frame.job.header;
        header.queueMicroseconds = microseconds(msBetween(frame.job.inputAt, frame.begunAt));
        header.renderMicroseconds = microseconds(frame.spentMs);
        if (renderer) header.raycaster = raycasterEntry(renderer->raycaster()).wireId;
        if (drawn)
            frame.job.done(header, std::move(frame.picture));
        else
            frame.job.done(header, tl::make_unexpected(drawn.error()));
    }
};

Result<std::unique_ptr<RenderThread>> RenderThread::start(DrawingOptions options, Lost lost) {
    std::unique_ptr<RenderThread> self(new RenderThread);
    self->shared_ = std::make_shared<Shared>();
    std::promise<Result<std::string>> started;
    auto rendererName = started.get_future();
    self->thread_ =
        std::thread([&started, options, shared = self->shared_, lost = std::move(lost)]() mutable {
            auto context = gpu::Context::create();
            if (!context) return started.set_value(tl::make_unexpected(context.error()));
            gpu::Context& made = **context;
            const auto caseLeft = [weak = std::weak_ptr<Shared>(shared)] {
                if (const auto alive = weak.lock()) {
                    const std::lock_guard lock(alive->mutex);
                    alive->caseLeft = true;
                    alive->wake.notify_one();
                }
            };
            Drawing drawing{shared, std::move(*context), GpuCases(made, options, caseLeft),
                            std::move(lost)};
            started.set_value(made.renderer());
            drawing.run();
        });
    auto name = TRY(rendererName.get());
    self->renderer_ = std::move(name);
    return self;
}

RenderThread::~RenderThread() {
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->stopping = true;
    }
    shared_->wake.notify_one();
    if (thread_.joinable()) thread_.join();
}

void RenderThread::runThere(std::function<void(Drawing&)> errand) {
    // Shared, so that it outlives its own set_value.
    const auto ended = std::make_shared<std::promise<void>>();
    auto end = ended->get_future();
    {
        const std::lock_guard lock(shared_->mutex);
        shared_->errand = [ended, errand = std::move(errand)](Drawing& drawing) {
            try {
                errand(drawing);
                ended->set_value();
            } catch (...) {
                ended->set_exception(std::current_exception());
            }
        };
        shared_->wake.notify_one();
    }
    end.get();
}

std::shared_ptr<const OpenCase> RenderThread::find(const OpenCase& facts) {
    std::shared_ptr<const OpenCase> found;
    runThere([&](Drawing& drawing) { found = drawing.cases.find(facts); });
    return found;
}

Result<std::shared_ptr<const OpenCase>> RenderThread::upload(OpenCase facts,
                                                             render::PreparedCase prepared) {
    Result<void> there;
    runThere([&](Drawing& drawing) {
        there = drawing.cases.upload(std::move(facts), std::move(prepared));
    });
    if (!there) return tl::make_unexpected(there.error());
    for (bool more = true; more;)
        runThere([&](Drawing& drawing) { more = drawing.cases.tryRaycaster(); });
    Result<std::shared_ptr<const OpenCase>> opened;
    runThere([&](Drawing& drawing) { opened = drawing.cases.opened(); });
    return opened;
}

// What the scheduler gives up is destroyed after the lock is let go.

void RenderThread::submit(PictureJob job) {
    FrameScheduler::GivenUp givenUp;
    const std::lock_guard lock(shared_->mutex);
    givenUp = shared_->frames.add(std::move(job));
    shared_->wake.notify_one();
}

bool RenderThread::replace(PictureJob job) {
    FrameScheduler::GivenUp givenUp;
    const std::lock_guard lock(shared_->mutex);
    return shared_->frames.replace(job, givenUp);
}

void RenderThread::withdraw(SessionId session) {
    FrameScheduler::GivenUp givenUp;
    const std::lock_guard lock(shared_->mutex);
    givenUp = shared_->frames.withdraw(session);
}

void RenderThread::end(SessionId session) {
    FrameScheduler::GivenUp givenUp;
    const std::lock_guard lock(shared_->mutex);
    givenUp = shared_->frames.end(session);
}

}  // namespace haustra::session
