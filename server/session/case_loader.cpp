#include "session/case_loader.h"

#include "session/guarded.h"

#include <utility>

#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

Result<std::shared_ptr<const OpenCase>> load(const store::CaseStore& store, RenderThread& renderer,
                                             const std::string& name) {
    const auto source = TRY(store.openCase(name));
    auto files = TRY(readCase(source));
    if (auto there = renderer.find(files.facts)) return there;
    if (!files.facts.cleansed)
        spdlog::info("a case has no cleansed scan: its endoscopic views show the scan as it is");
    auto prepared = TRY(render::prepareCase(files.ct, files.cleansed));
    files.facts.histogram = histogramOf(prepared.endoscopic());
    if (files.flattened) {
        // Without it the case can still be read.
        if (auto wall = readWall(source)) {
            files.facts.wall = std::move(*wall);
            prepared.flatMap = files.facts.wall->map;
        } else {
            spdlog::warn("a case opens without its flattened views: {}", wall.error().message);
        }
    }
    if (files.surface) {
        if (auto surface = readSurface(source))
            prepared.wall = std::move(*surface);
        else
            spdlog::warn("a case's overview has no colon: {}", surface.error().message);
    }
    if (!files.facts.centerline.points.empty())
        prepared.path = std::make_shared<const Centerline>(files.facts.centerline);
    // Its products were read one after the other, and all must be of one scan.
    const auto scan = TRY(source.scan());
    if (!scan || scan->key.hex != files.facts.scan)
        return fail(ErrorKind::io, "the case became one of another scan while it was opened", name);
    return renderer.upload(std::move(files.facts), std::move(prepared));
}

}  // namespace

std::unique_ptr<CaseLoader> CaseLoader::start(store::CaseStore store, RenderThread& renderer) {
    std::unique_ptr<CaseLoader> self(new CaseLoader);
    self->thread_ = std::thread([&my = *self, &renderer, store = std::move(store)] {
        serveQueue(my.requests_, 1, "loader", [&](auto& taken) {
            const Request& request = taken.front();
            if (request.session.expired() || my.stopping_) return;
            request.opened(guarded([&] { return load(store, renderer, request.name); }));
        });
    });
    return self;
}

CaseLoader::~CaseLoader() {
    stopping_ = true;
    requests_.close();
    if (thread_.joinable()) thread_.join();
}

void CaseLoader::openCase(std::string name, std::weak_ptr<const void> session, Opened opened) {
    requests_.push({std::move(name), std::move(session), std::move(opened)});
}

}  // namespace haustra::session
