#include "render/hybrid/reader_balances.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {

bool ReaderBalances::near(const Camera& a, const Camera& b) const {
    return a.lens == b.lens && a.fovDegrees == b.fovDegrees && a.heightMm == b.heightMm &&
           glm::distance(a.positionMm, b.positionMm) <= nearMm_ &&
           glm::dot(glm::normalize(a.forward), glm::normalize(b.forward)) >=
               std::cos(glm::radians(nearDegrees));
}

ReaderBalances::Reader& ReaderBalances::readerOf(const CameraView& view, const Band& band,
                                                 double stepMm) {
    const auto sameColours = [&](const Reader& one) {
        return one.stepMm == stepMm && one.optics == view.optics;
    };
    const auto goesOn = [&](const std::unique_ptr<Reader>& one) {
        return one->nextRow == band.firstRow && one->camera == view.camera &&
               one->size == band.pictureSize && sameColours(*one);
    };
    const auto isNear = [&](const std::unique_ptr<Reader>& one) {
        return one->size == band.pictureSize && near(one->camera, view.camera) && sameColours(*one);
    };
    if (band.firstRow > 0)
        if (const auto* known = readers_.find(goesOn)) return **known;
    if (const auto* known = readers_.find(isNear)) return **known;
    auto made = std::make_unique<Reader>();
    const auto& all = readers_.all();
    const auto like =
        std::find_if(all.rbegin(), all.rend(), [&](const auto& one) { return sameColours(*one); });
    if (like != all.rend()) made->balance = (*like)->balance;
    made->balance.elsewhere();
    made->optics = view.optics;
    made->stepMm = stepMm;
    made->size = band.pictureSize;
    return **readers_.keep(std::move(made));
}

const HybridControls& ReaderBalances::controls(const CameraView& view, const Band& band,
                                               double stepMm) {
    Reader& reader = readerOf(view, band, stepMm);
    band_ = band;
    drawing_ = &reader;
    if (band.firstRow == 0) {
        reader.camera = view.camera;
        reader.nextRow = 0;
        reader.cpuMs = reader.gpuMs = reader.ms = 0.0;
    } else if (reader.nextRow != band.firstRow || !(reader.camera == view.camera)) {
        drawing_ = nullptr;
    }
    return reader.balance.controls();
}

void ReaderBalances::drew(double cpuMs, double gpuMs, double bandMs) {
    if (!drawing_) return;
    Reader& reader = *drawing_;
    drawing_ = nullptr;
    reader.cpuMs += cpuMs;
    reader.gpuMs += gpuMs;
    reader.ms += bandMs;
    reader.nextRow = band_.firstRow + band_.rows;
    if (reader.nextRow < reader.size.y) return;
    reader.nextRow = 0;
    reader.balance.drew(reader.cpuMs, reader.gpuMs, reader.ms);
}

}  // namespace haustra::render
