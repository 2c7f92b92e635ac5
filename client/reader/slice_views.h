// The views in grey: three slices through one point, and the slice across the gaze.
#pragma once

#include "reader/case_info.h"

#include <array>
#include <memory>
#include <optional>

namespace haustra::reader {

/// Unit normal of a slice: the direction in which scrolling goes (towards the head, the front's
/// opposite, the patient's left).
glm::dvec3 sliceNormal(View view);

/// Belongs to one thread. Linked slices show one point and are enlarged alike; they follow the
/// camera, and scrolling leaves it until it moves. Each slice that is not linked stays where it is
/// put.
class SliceViews {
public:
    static constexpr double maxZoom = 32.0;

    /// Another case is open, and the camera stands there. Window, slab and linking stay. `canPan`:
    /// the server moves pictures (protocol::capability::slabs); else they stay centred.
    void open(std::shared_ptr<const CaseInfo> info, glm::dvec3 cameraMm, bool canPan = true);
    void follow(glm::dvec3 cameraMm);
    /// Shows a place until the camera leaves `cameraMm`. The picture of `plane`, where the place
    /// was clicked, stays where it is; the others are moved to it. Of slices that are not linked,
    /// only `plane` shows it, if any is given. Where they are linked, the slice across the gaze
    /// goes through it, too.
    void show(glm::dvec3 placeMm, glm::dvec3 cameraMm, std::optional<View> plane = {});

    /// The places that `other` shows; how large, and by which window, slab and scan, stays.
    void showAs(const SliceViews& other);

    /// All that `other`, of the same scan, shows and how.
    void reopenAs(const SliceViews& other);

    SliceView slice(View plane) const;
    void scroll(View plane, double mm);
    /// What is at `pixel` of a picture of `size` stays there.
    void zoom(View plane, double factor, glm::dvec2 pixel, glm::ivec2 size);
    /// Moves what the picture shows, patient mm to the right and down.
    void pan(View plane, glm::dvec2 mm);
    /// Whole and centred again.
    void showWhole(View plane);

    bool linked() const { return linked_; }
    /// Slices that are linked again show the camera's place.
    void setLinked(bool linked);

    /// Across the gaze, through the place that is shown, or else the camera, and so far ahead of
    /// that as it was scrolled to. How it was scrolled and moved at the one is forgotten once the
    /// camera leaves; how at the other is not.
    ObliqueView oblique(const Camera& gaze) const;
    void scrollOblique(double mm);
    /// As pan(), right and down of the gaze.
    void panOblique(glm::dvec2 mm);
    void centerOblique() { across().panMm = glm::dvec2(0.0); }
    void zoomOblique(double factor);

    /// Whether all four show the cleansed scan; stays false where the case has none.
    bool cleansed() const { return cleansed_; }
    void setCleansed(bool cleansed);
    Scan scan() const { return cleansed_ ? Scan::cleansed : Scan::original; }
    const WindowLevel& window() const { return window_; }
    void setWindow(WindowLevel window);
    const Slab& slab() const { return slab_; }
    void setSlab(Slab slab);

private:
    struct Plane {
        glm::dvec3 focusMm{0.0};
        double zoom = 1.0;
        glm::dvec2 panMm{0.0};
    };
    // How the slice across the gaze has been scrolled and moved, right and down of the gaze.
    struct Across {
        double aheadMm = 0.0;
        glm::dvec2 panMm{0.0};
    };
    struct Shown {
        glm::dvec3 placeMm;
        Across across;
    };
    Across& across() { return shown_ ? shown_->across : across_; }
    Plane& of(View plane);
    const Plane& of(View plane) const { return const_cast<SliceViews*>(this)->of(plane); }
    glm::dvec3 withinScan(glm::dvec3 mm) const;
    void showWithoutMoving(View plane, glm::dvec3 placeMm);

    std::shared_ptr<const CaseInfo> case_;
    std::array<Plane, 3> planes_;
    glm::dvec3 followedMm_{0.0};
    std::optional<Shown> shown_;  // until the camera leaves followedMm_
    Across across_;               // where nothing else is shown
    double heightMm_ = ObliqueView{}.heightMm;
    bool cleansed_ = false, linked_ = true, canPan_ = true;
    WindowLevel window_;
    Slab slab_;
};

}  // namespace haustra::reader
