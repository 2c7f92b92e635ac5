#include "session/render_thread.h"

#include "gpu/context.h"
#include "render/case_renderer.h"

#include <algorithm>
#include <condition_variable>
#include <future>
#include <mutex>
#include <new>
#include <utility>

#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

struct OpenRequest {
    std::string name;
    RenderThread::Opened opened;
};

std::uint32_t microsecondsBetween(Clock::time_point from, Clock::time_point to) {
    const auto count = std::chrono::duration_cast<std::chrono::microseconds>(to - from).count();
    return std::uint32_t(std::clamp<std::int64_t>(count, 0, UINT32_MAX));
}

}  // namespace

struct RenderThread::Shared {
    std::mutex mutex;
    std::condition_variable wake;
    // All guarded by mutex.
    std::deque<OpenRequest> opens;
    PictureQueue pictures;
    bool caseLeft = false;  // the last session of some case is gone
    bool stopping = false;
};

// What lives on the render thread, from its start to its end.
struct RenderThread::Drawing {
    struct Entry {
        std::weak_ptr<const OpenCase> of;
        std::unique_ptr<render::CaseRenderer> renderer;
    };

    std::shared_ptr<Shared> shared;
    store::CaseStore store;
    std::unique_ptr<gpu::Context> context;
    std::vector<Entry> cases;

    void run() {
        std::unique_lock lock(shared->mutex);
        for (;;) {
            shared->wake.wait(lock, [&] {
                return shared->stopping || shared->caseLeft || !shared->opens.empty() ||
                       !shared->pictures.empty();
            });
            if (shared->stopping) return;
            if (std::exchange(shared->caseLeft, false)) {
                lock.unlock();
                std::erase_if(cases, [](const Entry& entry) { return entry.of.expired(); });
            } else if (!shared->opens.empty()) {
                OpenRequest request = std::move(shared->opens.front());
                shared->opens.pop_front();
                lock.unlock();
                request.opened(guarded([&] { return open(request.name); }));
            } else if (auto job = shared->pictures.take()) {
                lock.unlock();
                draw(*job);
                job.reset();  // may be a case's last user, so not under the lock
            }
            lock.lock();
        }
    }

    // Memory may run out in a library; that costs one request.
    template <class Work>
    static auto guarded(const Work& work) -> decltype(work()) {
        try {
            return work();
        } catch (const std::bad_alloc&) {
            return fail(ErrorKind::device, "there is not enough memory", "render");
        } catch (const std::exception& error) {
            return fail(ErrorKind::device, error.what(), "render");
        }
    }

    Result<std::shared_ptr<const OpenCase>> open(const std::string& name) {
        auto files = readCase(store, name);
        if (!files) return tl::make_unexpected(files.error());
        for (const Entry& entry : cases) {
            auto of = entry.of.lock();
            if (of && of->name == name && of->content == files->facts.content) return of;
        }
        const auto start = Clock::now();
        auto renderer = render::CaseRenderer::create(*context, files->ct, files->lumen);
        if (!renderer) return tl::make_unexpected(renderer.error());
        spdlog::info("a case is on the GPU: {} MiB, after {:.1f} s", (*renderer)->gpuBytes() >> 20,
                     1e-6 * microsecondsBetween(start, Clock::now()));
        std::shared_ptr<const OpenCase> of(
            new OpenCase(std::move(files->facts)),
            [queues = std::weak_ptr<Shared>(shared)](const OpenCase* left) {
                delete left;
                if (const auto alive = queues.lock()) {
                    const std::lock_guard lock(alive->mutex);
                    alive->caseLeft = true;
                    alive->wake.notify_one();
                }
            });
        cases.push_back({of, std::move(*renderer)});
        return of;
    }

    void draw(PictureJob& job) {
        const auto entry = std::find_if(cases.begin(), cases.end(), [&](const Entry& candidate) {
            return candidate.of.lock() == job.of;
        });
        if (entry == cases.end()) return;  // cannot be: the job keeps its case alive
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

Result<std::unique_ptr<RenderThread>> RenderThread::start(store::CaseStore store) {
    std::unique_ptr<RenderThread> self(new RenderThread);
    self->shared_ = std::make_shared<Shared>();
    std::promise<Result<std::string>> started;
    auto rendererName = started.get_future();
    self->thread_ = std::thread([&started, shared = self->shared_, cases = std::move(store)] {
        auto context = gpu::Context::create();
        if (!context) return started.set_value(tl::make_unexpected(context.error()));
        Drawing drawing{shared, cases, std::move(*context), {}};
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

void RenderThread::openCase(std::string name, Opened opened) {
    const std::lock_guard lock(shared_->mutex);
    shared_->opens.push_back({std::move(name), std::move(opened)});
    shared_->wake.notify_one();
}

void RenderThread::submit(PictureJob job) {
    const std::lock_guard lock(shared_->mutex);
    shared_->pictures.add(std::move(job));
    shared_->wake.notify_one();
}

bool RenderThread::replace(PictureJob job) {
    const std::lock_guard lock(shared_->mutex);
    return shared_->pictures.replace(job);
}

void RenderThread::withdraw(SessionId session) {
    const std::lock_guard lock(shared_->mutex);
    shared_->pictures.withdraw(session);
}

}  // namespace haustra::session
