#include "session/render_thread.h"

#include "gpu/context.h"
#include "render/case_renderer.h"
#include "session/guarded.h"

#include <algorithm>
#include <condition_variable>
#include <future>
#include <mutex>
#include <optional>
#include <utility>

#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

std::uint32_t microsecondsBetween(Clock::time_point from, Clock::time_point to) {
    const auto count = std::chrono::duration_cast<std::chrono::microseconds>(to - from).count();
    return std::uint32_t(std::clamp<std::int64_t>(count, 0, UINT32_MAX));
}

}  // namespace

struct RenderThread::Shared {
    std::mutex mutex;
    std::condition_variable wake;
    // All guarded by mutex.
    std::function<void(Drawing&)> errand;  // of the loader, which waits for its end
    PictureQueue pictures;
    bool caseLeft = false;  // the last session of some case is gone
    bool stopping = false;
};

// What lives on the render thread, from its start to its end.
struct RenderThread::Drawing {
    struct Entry {
        std::string name, content;
        std::shared_ptr<const Wall> wall;  // facts that are read anew have none
        std::weak_ptr<const OpenCase> of;
        std::optional<Clock::time_point> leftAt;  // since when nobody has it open
        std::unique_ptr<render::CaseRenderer> renderer;
    };

    std::shared_ptr<Shared> shared;
    std::unique_ptr<gpu::Context> context;
    std::vector<Entry> cases;

    void run() {
        std::unique_lock lock(shared->mutex);
        for (;;) {
            const auto called = [&] {
                return shared->stopping || shared->caseLeft || shared->errand ||
                       !shared->pictures.empty();
            };
            if (const auto until = nextRelease())
                shared->wake.wait_until(lock, *until, called);
            else
                shared->wake.wait(lock, called);
            if (shared->stopping) return;
            shared->caseLeft = false;
            auto errand = std::exchange(shared->errand, nullptr);
            auto job = errand ? std::nullopt : shared->pictures.take();
            lock.unlock();
            releaseLeft(Clock::now());
            if (errand) errand(*this);
            if (job) draw(*job);
            job.reset();  // may be a case's last user, so not under the lock
            lock.lock();
        }
    }

    std::optional<Clock::time_point> nextRelease() const {
        std::optional<Clock::time_point> first;
        for (const Entry& entry : cases)
            if (entry.leftAt && (!first || *entry.leftAt + keptAfterUse < *first))
                first = *entry.leftAt + keptAfterUse;
        return first;
    }

    void releaseLeft(Clock::time_point now) {
        for (Entry& entry : cases)
            if (!entry.leftAt && entry.of.expired()) entry.leftAt = now;
        std::erase_if(cases, [&](const Entry& entry) {
            return entry.leftAt && now >= *entry.leftAt + keptAfterUse;
        });
    }

    // The pointer of which sessions hold copies.
    std::shared_ptr<const OpenCase> lend(OpenCase facts) const {
        return {new OpenCase(std::move(facts)),
                [queues = std::weak_ptr<Shared>(shared)](const OpenCase* left) {
                    delete left;
                    if (const auto alive = queues.lock()) {
                        const std::lock_guard lock(alive->mutex);
                        alive->caseLeft = true;
                        alive->wake.notify_one();
                    }
                }};
    }

    std::shared_ptr<const OpenCase> find(const OpenCase& facts) {
        for (Entry& entry : cases) {
            if (entry.name != facts.name || entry.content != facts.content) continue;
            if (auto of = entry.of.lock()) return of;
            OpenCase again = facts;
            again.wall = entry.wall;
            auto of = lend(std::move(again));
            entry.of = of;
            entry.leftAt.reset();
            return of;
        }
        return nullptr;
    }

    Result<std::shared_ptr<const OpenCase>> upload(OpenCase facts, render::PreparedCase prepared) {
        std::erase_if(cases, [](const Entry& entry) { return entry.of.expired(); });
        const auto start = Clock::now();
        auto renderer = render::CaseRenderer::upload(*context, std::move(prepared));
        if (!renderer) return tl::make_unexpected(renderer.error());
        spdlog::info("a case is on the GPU: {} MiB, copied in {:.1f} s",
                     (*renderer)->gpuBytes() >> 20,
                     1e-6 * microsecondsBetween(start, Clock::now()));
        Entry entry{facts.name, facts.content, facts.wall, {}, {}, std::move(*renderer)};
        auto of = lend(std::move(facts));
        entry.of = of;
        cases.push_back(std::move(entry));
        return of;
    }

    void draw(PictureJob& job) {
        const auto entry = std::find_if(cases.begin(), cases.end(), [&](const Entry& candidate) {
            return candidate.of.lock() == job.of;
        });
        if (entry == cases.end()) {
            return job.done(job.header, fail(ErrorKind::device, "the case is not on the GPU"));
        }
        const auto start = Clock::now();
        auto image = guarded([&] {
            return std::visit(
                [&](const auto& view) {
                    return entry->renderer->render(view, job.width, job.height);
                },
                job.view);
        });
        protocol::TileHeader header = job.header;
        header.queueMicroseconds = microsecondsBetween(job.inputAt, start);
        header.renderMicroseconds = microsecondsBetween(start, Clock::now());
        job.done(header, std::move(image));
    }
};

Result<std::unique_ptr<RenderThread>> RenderThread::start() {
    std::unique_ptr<RenderThread> self(new RenderThread);
    self->shared_ = std::make_shared<Shared>();
    std::promise<Result<std::string>> started;
    auto rendererName = started.get_future();
    self->thread_ = std::thread([&started, shared = self->shared_] {
        auto context = gpu::Context::create();
        if (!context) return started.set_value(tl::make_unexpected(context.error()));
        Drawing drawing{shared, std::move(*context), {}};
        started.set_value(drawing.context->renderer());
        drawing.run();
        drawing.cases.clear();  // before the context that they need
    });
    auto name = rendererName.get();
    if (!name) return tl::make_unexpected(name.error());
    self->renderer_ = std::move(*name);
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
    runThere([&](Drawing& drawing) { found = drawing.find(facts); });
    return found;
}

Result<std::shared_ptr<const OpenCase>> RenderThread::upload(OpenCase facts,
                                                             render::PreparedCase prepared) {
    Result<std::shared_ptr<const OpenCase>> opened;
    runThere(
        [&](Drawing& drawing) { opened = drawing.upload(std::move(facts), std::move(prepared)); });
    return opened;
}

void RenderThread::submit(PictureJob job) {
    std::optional<PictureJob> dropped;  // destroyed after the lock is let go
    const std::lock_guard lock(shared_->mutex);
    dropped = shared_->pictures.add(std::move(job));
    shared_->wake.notify_one();
}

bool RenderThread::replace(PictureJob job) {
    const std::lock_guard lock(shared_->mutex);
    return shared_->pictures.replace(job);
}

void RenderThread::withdraw(SessionId session) {
    std::optional<PictureJob> dropped;  // destroyed after the lock is let go
    const std::lock_guard lock(shared_->mutex);
    dropped = shared_->pictures.withdraw(session);
}

}  // namespace haustra::session
