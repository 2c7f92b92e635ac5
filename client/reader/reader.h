// A reader at work: one case, a flight through it, the views that follow. The window draws this
// and turns the hand's movements into its calls; it holds no window itself.
#pragma once

#include "reader/optics_editor.h"
#include "reader/pacing.h"
#include "reader/picture_log.h"
#include "reader/session.h"
#include "reader/strip_tour.h"
#include "reader/wall_questions.h"

#include <memory>

namespace haustra::reader {

/// Belongs to one thread. Viewport numbers are those of View: 0 endoscopic, 1 axial, 2 coronal,
/// 3 sagittal, 4 flattened, 5 flattened zoom, 6 oblique, 7 overview; 4 and 5 only where the case
/// has been flattened.
class Reader {
public:
    Reader(link::ConnectionOptions options, std::string caseName);

    /// One step of the loop: takes in what the server sent, moves the flight on by `seconds`, asks
    /// for the views that changed. Never blocks.
    void update(double seconds);

    Session& session() { return session_; }
    const Session& session() const { return session_; }
    Flight& flight() { return flight_; }
    const Flight& flight() const { return flight_; }
    bool isOpen() const { return case_ != nullptr; }

    /// The pane's size in pixels; the server draws at this size, at most 2048 a side.
    void setPaneSize(View view, glm::ivec2 pixels);
    glm::ivec2 paneSize(View view) const { return paneSizes_[std::size_t(view)]; }

    /// What the three slice views show now, each its plane through the point. They follow the
    /// camera; scrolling leaves it until it moves.
    Slice slice() const;
    void scrollSlice(View view, double mm);
    void zoomSlices(double factor);
    /// Whether slices show the cleansed scan; stays false where the case has none.
    bool slicesCleansed() const { return slicesCleansed_; }
    void setSlicesCleansed(bool cleansed);
    /// Flies to the point of the centerline nearest to `patientMm`.
    void goNear(glm::dvec3 patientMm);

    /// The slice across the gaze, so far ahead of the camera as it was scrolled to.
    Oblique oblique() const;
    void scrollOblique(double mm);
    void zoomOblique(double factor);

    /// The colon from outside: turned by degrees, enlarged, or from the front again.
    const Orbit& orbit() const { return orbit_; }
    void turnOverview(double azimuthDegrees, double elevationDegrees);
    void zoomOverview(double factor);
    void resetOverview();
    bool showsBody() const { return showsBody_; }
    void setShowsBody(bool shows);

    /// What colours the wall; refused (false) where the case has not been flattened.
    bool setWallPaint(const WallPaint& paint);
    const WallPaint& wallPaint() const { return session_.wallPaint(); }
    void forgetSeen();

    bool hasStrip() const { return case_ && case_->flat; }
    /// The window of the zoom view. It follows the camera along the colon; moving it leaves the
    /// camera, but for the fly-over, which the camera follows.
    StripTour& tour() { return tour_; }
    const StripTour& tour() const { return tour_; }
    /// Where the camera is along the path; in free flight, the nearest place of it.
    double placeArcMm() const;
    /// Goes to a place of the flattened wall: once the server has said where it is, the camera
    /// looks at it, slices show it, and with `center` the zoom view has it in its middle.
    void goToFlat(glm::dvec2 flat, bool center);
    /// The place that was gone to last, until the camera moves on.
    const std::optional<WallPlace>& pickedPlace() const { return picked_; }
    WallQuestions& wall() { return wall_; }
    const WallQuestions& wall() const { return wall_; }

    /// Of the fly-over where it is on, else of the flight.
    Motion motion() const;
    void setMotion(Motion motion);
    void setFlyingOver(bool on);

    const WindowLevel& window() const { return window_; }
    void setWindow(WindowLevel window);
    /// How the wall is drawn: what is made of it is shown in the endoscopic view while it changes,
    /// and in the flattened ones when it rests.
    OpticsEditor& optics() { return optics_; }
    const OpticsEditor& optics() const { return optics_; }

    void addBookmark(std::string note);
    void goTo(const Bookmark& bookmark) { flight_.goTo(bookmark.camera, bookmark.arcMm); }
    /// The next (or, with −1, previous) bookmark along the centerline, if any.
    void goToBookmark(int step);

    /// The newest picture of a view, and how many there were; nothing shown: count 0.
    const tiles::Picture& picture(View view) const { return pictures_.picture(view); }
    std::uint64_t pictureCount(View view) const { return pictures_.count(view); }
    /// What the newest pictures show; they lag behind slice(), oblique(), orbit() and the tour's
    /// window. The window is in pixels of its pane.
    const Slice& shownSlice(View view) const { return pictures_.shown(view).slice; }
    const Oblique& shownOblique() const { return pictures_.shown(View::oblique).oblique; }
    const Orbit& shownOrbit() const { return pictures_.shown(View::overview).orbit; }
    const FlatWindow& shownWindow() const { return pictures_.shown(View::flattenedZoom).window; }

    /// See PictureLog.
    Summary latencyMs() const { return pictures_.latencyMs(); }
    double picturesPerSecond() const { return double(pictures_.picturesPerSecond()); }
    /// Whether the picture will change soon by itself: draw at full rate.
    bool restless() const;

private:
    void caseOpened();
    void travel(double seconds);
    void takePicked();
    Sight sight() const;
    bool changed(View view, bool cameraMoved) const;
    bool inUse(View view) const;
    void askForViews(Clock::time_point now);
    std::uint64_t ask(View view, bool moving);
    void openPane(View view, bool moving);
    void sendOptics(Clock::time_point now);

    Session session_;
    std::shared_ptr<const CaseInfo> case_;
    Flight flight_{Centerline{}};
    StripTour tour_;
    WallQuestions wall_{session_};
    std::optional<WallPlace> picked_;
    bool centerPicked_ = false;
    double followedArcMm_ = 0.0, followedY_ = 0.0;  // of camera and tour, when last one led
    Camera lastCamera_;
    glm::dvec3 sliceFocusMm_{0.0};
    double sliceZoom_ = 1.0;
    bool slicesCleansed_ = false;
    WindowLevel window_;
    OpticsEditor optics_;
    std::uint64_t sentOptics_ = 0, seenOptics_ = 0;                    // revisions
    std::optional<Clock::time_point> opticsChangedAt_, opticsSentAt_;  // until shown everywhere

    double obliqueAheadMm_ = 0.0, obliqueHeightMm_ = Oblique{}.heightMm;
    Orbit orbit_;
    bool orbitIsOwn_ = false, showsBody_ = true;  // own: turned by the reader

    std::array<glm::ivec2, viewCount> paneSizes_{};
    std::array<glm::ivec2, viewCount> openSizes_{};
    std::array<ViewPacer, viewCount> pacers_;
    std::array<Sight, viewCount> asked_;  // last, of each view
    PictureLog pictures_;
};

}  // namespace haustra::reader
