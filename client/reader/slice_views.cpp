#include "reader/slice_views.h"

#include "core/slice_placement.h"

#include <algorithm>

namespace haustra::reader {
namespace {

glm::dvec2 withinReach(glm::dvec2 panMm) {
    constexpr double farthestMm = 1000.0;
    return glm::clamp(panMm, glm::dvec2(-farthestMm), glm::dvec2(farthestMm));
}

}  // namespace

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

SliceViews::Plane& SliceViews::of(View plane) {
    return planes_[plane == View::coronal ? 1 : plane == View::sagittal ? 2 : 0];
}

void SliceViews::open(std::shared_ptr<const CaseInfo> info, glm::dvec3 cameraMm, bool canPan) {
    case_ = std::move(info);
    canPan_ = canPan;
    if (!canPan) slab_ = {};
    planes_.fill({cameraMm, 1.0, glm::dvec2(0.0)});
    followedMm_ = cameraMm;
    shown_.reset();
    across_ = {};
    heightMm_ = ObliqueView{}.heightMm;
    cleansed_ = false;
}

void SliceViews::follow(glm::dvec3 cameraMm) {
    if (cameraMm == followedMm_) return;
    followedMm_ = cameraMm;
    shown_.reset();
    if (!linked_) return;
    for (Plane& plane : planes_)
        plane.focusMm = cameraMm;
}

void SliceViews::show(glm::dvec3 placeMm, glm::dvec3 cameraMm, std::optional<View> plane) {
    if (linked_)
        shown_ = {placeMm, {}};
    else if (cameraMm != followedMm_)
        shown_.reset();
    followedMm_ = cameraMm;
    for (const View each : {View::axial, View::coronal, View::sagittal}) {
        if (!linked_ && each != plane) continue;
        if (each == plane)
            showWithoutMoving(each, placeMm);
        else
            of(each).focusMm = placeMm, of(each).panMm = glm::dvec2(0.0);
    }
}

// A picture that is enlarged follows its focus: here it stays where it is.
void SliceViews::showWithoutMoving(View plane, glm::dvec3 placeMm) {
    constexpr int side = 2;  // of any size: only its middle counts
    const auto before = placeSlice(slice(plane), case_->grid, side, side);
    of(plane).focusMm = placeMm;
    const auto after = placeSlice(slice(plane), case_->grid, side, side);
    if (!before || !after) return;
    const glm::dvec3 moved = after->topLeftMm - before->topLeftMm;
    pan(plane, {glm::dot(moved, glm::normalize(after->rightMm)),
                glm::dot(moved, glm::normalize(after->downMm))});
}

void SliceViews::showAs(const SliceViews& other) {
    for (std::size_t n = 0; n < planes_.size(); ++n)
        planes_[n].focusMm = other.planes_[n].focusMm, planes_[n].panMm = other.planes_[n].panMm;
    followedMm_ = other.followedMm_;
    shown_ = other.shown_;
}

void SliceViews::reopenAs(const SliceViews& other) {
    planes_ = other.planes_;
    followedMm_ = other.followedMm_;
    shown_ = other.shown_;
    across_ = other.across_;
    heightMm_ = other.heightMm_;
    linked_ = other.linked_;
    window_ = other.window_;
    setCleansed(other.cleansed_);
    if (canPan_)
        slab_ = other.slab_;
    else
        for (Plane& plane : planes_)
            plane.panMm = glm::dvec2(0.0);
}

SliceView SliceViews::slice(View plane) const {
    const Plane& shown = of(plane);
    return {plane, shown.focusMm, shown.zoom, window_, scan(), shown.panMm, slab_};
}

// A slice outside the scan is black, and the way back hard to find.
glm::dvec3 SliceViews::withinScan(glm::dvec3 mm) const {
    const Grid& grid = case_->grid;
    const glm::dvec3 voxel =
        glm::clamp(grid.voxelFromPatientPoint(mm), glm::dvec3(0.0), glm::dvec3(grid.size - 1));
    return grid.patientFromVoxelPoint(voxel);
}

void SliceViews::scroll(View plane, double mm) {
    if (!case_) return;
    const glm::dvec3 there = withinScan(of(plane).focusMm + mm * sliceNormal(plane));
    of(plane).focusMm = there;
    if (linked_)
        for (Plane& each : planes_)
            each.focusMm = there;
}

void SliceViews::zoom(View plane, double factor, glm::dvec2 pixel, glm::ivec2 size) {
    if (!case_) return;
    const auto before = placeSlice(slice(plane), case_->grid, size.x, size.y);
    const double zoomed = std::clamp(of(plane).zoom * factor, 1.0, maxZoom);
    of(plane).zoom = zoomed;
    if (linked_)
        for (Plane& each : planes_)
            each.zoom = zoomed;
    const auto after = placeSlice(slice(plane), case_->grid, size.x, size.y);
    if (!before || !after) return;
    const glm::dvec2 moved = after->pixelFromPatient(before->patientFromPixel(pixel)) - pixel;
    pan(plane, -moved * after->pixelMm());
    if (zoomed == 1.0) of(plane).panMm = glm::dvec2(0.0);
}

void SliceViews::pan(View plane, glm::dvec2 mm) {
    if (!canPan_) return;
    of(plane).panMm = withinReach(of(plane).panMm + mm);
}

void SliceViews::showWhole(View plane) {
    for (Plane& each : planes_)
        if (linked_ || &each == &of(plane)) each.zoom = 1.0, each.panMm = glm::dvec2(0.0);
}

void SliceViews::setLinked(bool linked) {
    if (linked && !linked_) {
        const double zoom = planes_[0].zoom;
        for (Plane& plane : planes_)
            plane.focusMm = followedMm_, plane.zoom = zoom;
        shown_.reset();
    }
    linked_ = linked;
}

ObliqueView SliceViews::oblique(const Camera& gaze) const {
    const glm::dvec3 right = glm::cross(gaze.forward, gaze.up);
    const double placeMm = shown_ ? glm::dot(shown_->placeMm - gaze.positionMm, gaze.forward) : 0.0;
    const Across& across = shown_ ? shown_->across : across_;
    return {gaze.positionMm + (placeMm + across.aheadMm) * gaze.forward - across.panMm.x * right +
                across.panMm.y * gaze.up,
            gaze.forward,
            gaze.up,
            heightMm_,
            window_,
            scan(),
            slab_};
}

void SliceViews::scrollOblique(double mm) {
    double& aheadMm = across().aheadMm;
    aheadMm = std::clamp(aheadMm + mm, -50.0, 200.0);
}

void SliceViews::panOblique(glm::dvec2 mm) {
    across().panMm = withinReach(across().panMm + mm);
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

void SliceViews::setSlab(Slab slab) {
    slab_ = slab;
    slab_.thicknessMm = std::clamp(slab.thicknessMm, 0.0, maxSlabMm);
}

}  // namespace haustra::reader
