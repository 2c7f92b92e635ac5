#include "session/case_loader.h"

#include "session/case_presets.h"
#include "session/worker.h"

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
            prepared.wall = files.facts.surface = std::move(*surface);
        else
            spdlog::warn("a case opens without its colon in the overview: {}",
                         surface.error().message);
    }
    if (files.findings) {
        if (auto findings = readFindings(source, files.facts.grid, files.facts.centerline,
                                         files.facts.wall.get())) {
            files.facts.findings = std::move(*findings);
            // Without it the case has the fixed colours.
            if (auto biopsy = scanBiopsyOf(files.facts.findings->product))
                files.facts.scanBiopsy = std::move(*biopsy);
            else
                spdlog::warn("a case opens without its own biopsy colours: {}",
                             biopsy.error().message);
        } else {
            files.facts.findingsDamaged = true;
            spdlog::warn("a case opens without its findings: {}", findings.error().message);
        }
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

CaseLoader::CaseLoader(store::CaseStore store, RenderThread& renderer) {
    worker_.start("loader", 1, [this, &renderer, store = std::move(store)](auto& taken) {
        const Request& request = taken.front();
        if (request.session.expired() || stopping_) return;
        request.opened(guarded([&] { return load(store, renderer, request.name); }));
    });
}

void CaseLoader::openCase(std::string name, std::weak_ptr<const void> session, Opened opened) {
    worker_.push({std::move(name), std::move(session), std::move(opened)});
}

}  // namespace haustra::session
