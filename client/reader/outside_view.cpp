#include "reader/outside_view.h"

#include "reader/overview_map.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {

void OutsideView::open(std::shared_ptr<const CaseInfo> info) {
    case_ = std::move(info);
    reset();
}

void OutsideView::setPaneSize(glm::ivec2 pixels) {
    paneSize_ = glm::max(pixels, glm::ivec2(1));
    if (!isOwn_) reset();
}

Overview OutsideView::state() const {
    Overview overview;
    overview.camera = cameraOf(orbit_);
    overview.body = showsBody_;
    return overview;
}

void OutsideView::turn(double azimuthDegrees, double elevationDegrees) {
    orbit_.azimuthDegrees = std::remainder(orbit_.azimuthDegrees + azimuthDegrees, 360.0);
    orbit_.elevationDegrees = std::clamp(orbit_.elevationDegrees + elevationDegrees, -90.0, 90.0);
    isOwn_ = true;
}

void OutsideView::zoom(double factor) {
    orbit_.heightMm = std::clamp(orbit_.heightMm / factor, 20.0, 1500.0);
    isOwn_ = true;
}

void OutsideView::reset() {
    isOwn_ = false;
    if (!case_) return;
    const double aspect = double(paneSize_.x) / paneSize_.y;
    orbit_ = orbitOf(case_->centerline, aspect);
    if (!case_->centerline.points.empty()) return;
    // Without a path, all of the scan.
    const Grid& grid = case_->grid;
    const glm::dvec3 a = grid.patientFromVoxelPoint(glm::dvec3(0.0)),
                     b = grid.patientFromVoxelPoint(glm::dvec3(grid.size - 1));
    orbit_ = orbitAround(glm::min(a, b), glm::max(a, b), aspect);
}

}  // namespace haustra::reader
