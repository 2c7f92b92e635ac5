#include "reader/slice_views.h"

#include <algorithm>

namespace haustra::reader {

glm::dvec3 sliceNormal(View view) {
    switch (view) {
        case View::coronal:
            return {0, 1, 0};
        case View::sagittal:
            return {1, 0, 0};
        default:
            return {0, 0, 1};
    }
}

void SliceViews::open(std::shared_ptr<const CaseInfo> info, glm::dvec3 cameraMm) {
    case_ = std::move(info);
    focusMm_ = followedMm_ = cameraMm;
    zoom_ = 1.0;
    aheadMm_ = 0.0;
    heightMm_ = ObliqueView{}.heightMm;
    cleansed_ = false;
}

void SliceViews::follow(glm::dvec3 cameraMm) {
    if (cameraMm != followedMm_) focusMm_ = followedMm_ = cameraMm;
}

void SliceViews::show(glm::dvec3 placeMm, glm::dvec3 cameraMm) {
    focusMm_ = placeMm;
    followedMm_ = cameraMm;
}

SliceView SliceViews::slice(View plane) const {
    return {plane, focusMm_, zoom_, window_, scan()};
}

void SliceViews::scroll(View plane, double mm) {
    if (!case_) return;
    focusMm_ += mm * sliceNormal(plane);
    // Kept within the scan: a slice outside it is black, and the way back hard to find.
    const Grid& grid = case_->grid;
    const glm::dvec3 voxel = glm::clamp(grid.voxelFromPatientPoint(focusMm_), glm::dvec3(0.0),
                                        glm::dvec3(grid.size - 1));
    focusMm_ = grid.patientFromVoxelPoint(voxel);
}

void SliceViews::zoom(double factor) {
    zoom_ = std::clamp(zoom_ * factor, 1.0, 32.0);
}

ObliqueView SliceViews::oblique(const Camera& gaze) const {
    return {gaze.positionMm + aheadMm_ * gaze.forward,
            gaze.forward,
            gaze.up,
            heightMm_,
            window_,
            scan()};
}

void SliceViews::scrollOblique(double mm) {
    aheadMm_ = std::clamp(aheadMm_ + mm, -50.0, 200.0);
}

void SliceViews::zoomOblique(double factor) {
    heightMm_ = std::clamp(heightMm_ / factor, 10.0, 400.0);
}

void SliceViews::setCleansed(bool cleansed) {
    cleansed_ = cleansed && case_ && case_->cleansed;
}

void SliceViews::setWindow(WindowLevel window) {
    window_.widthHu = std::clamp(window.widthHu, 1.0, 6000.0);
    window_.centerHu = std::clamp(window.centerHu, -2000.0, 4000.0);
}

}  // namespace haustra::reader
