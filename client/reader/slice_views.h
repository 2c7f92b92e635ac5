// The views in grey: three slices through one point, and the slice across the gaze.
#pragma once

#include "reader/case_info.h"

#include <memory>

namespace haustra::reader {

/// Unit normal of a slice: the direction in which scrolling goes (towards the head, the front's
/// opposite, the patient's left).
glm::dvec3 sliceNormal(View view);

/// Belongs to one thread. Slices follow the camera; scrolling leaves it until it moves.
class SliceViews {
public:
    /// Another case is open, and the camera stands there. The window stays.
    void open(std::shared_ptr<const CaseInfo> info, glm::dvec3 cameraMm);
    void follow(glm::dvec3 cameraMm);
    /// Shows a place until the camera leaves `cameraMm`.
    void show(glm::dvec3 placeMm, glm::dvec3 cameraMm);

    SliceView slice(View plane) const;
    void scroll(View plane, double mm);
    void zoom(double factor);

    /// Across the gaze, so far ahead of the camera as it was scrolled to.
    ObliqueView oblique(const Camera& gaze) const;
    void scrollOblique(double mm);
    void zoomOblique(double factor);

    /// Whether all four show the cleansed scan; stays false where the case has none.
    bool cleansed() const { return cleansed_; }
    void setCleansed(bool cleansed);
    const WindowLevel& window() const { return window_; }
    void setWindow(WindowLevel window);

private:
    Scan scan() const { return cleansed_ ? Scan::cleansed : Scan::original; }

    std::shared_ptr<const CaseInfo> case_;
    glm::dvec3 focusMm_{0.0}, followedMm_{0.0};
    double zoom_ = 1.0;
    double aheadMm_ = 0.0, heightMm_ = ObliqueView{}.heightMm;
    bool cleansed_ = false;
    WindowLevel window_;
};

}  // namespace haustra::reader
