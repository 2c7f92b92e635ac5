// A reader at work: one case, a flight through it, the views that follow. The window draws this
// and turns the hand's movements into calls of its parts; it holds no window itself.
#pragma once

#include "reader/biopsy_lens.h"
#include "reader/findings_reading.h"
#include "reader/flat_reading.h"
#include "reader/missed_reading.h"
#include "reader/optics_editor.h"
#include "reader/outside_view.h"
#include "reader/panes.h"
#include "reader/place_rulers.h"
#include "reader/scan_measures.h"
#include "reader/seen_ends.h"
#include "reader/slice_views.h"

#include <memory>

namespace haustra::reader {

/// How the picture in a pane stands to what its view is to show now.
enum class Freshness {
    none,    ///< there is no picture yet
    exact,   ///< the lossless still of it
    moving,  ///< a newer picture will come
    old,     ///< none has come for long, or none will: the link is down, the case not open yet
};

/// Belongs to one thread.
class Reader {
public:
    /// As Session's.
    Reader(link::ConnectionOptions options, std::string caseName,
           std::optional<BookmarkJournal> journal = {});

    /// One step of the loop: takes in what the server sent, moves the flight on by `seconds`, asks
    /// for the views that changed. While the case is not open over a link nothing moves by
    /// itself: the pictures would not follow. Never blocks.
    void update(double seconds);
    bool isOpen() const { return case_ != nullptr; }
    /// The server has owed the picture that leads for a second and a half: flights stand still
    /// until it comes.
    bool waitsForPictures() const;
    /// Whether the picture will change soon by itself: draw at full rate.
    bool restless() const;

    Session& session() { return session_; }
    const Session& session() const { return session_; }

    // The views, each with what the hand can do to it.
    Flight& flight() { return flight_; }
    const Flight& flight() const { return flight_; }
    SliceViews& slices() { return slices_; }
    const SliceViews& slices() const { return slices_; }
    FlatReading& flat() { return flat_; }
    const FlatReading& flat() const { return flat_; }
    OutsideView& outside() { return outside_; }
    const OutsideView& outside() const { return outside_; }
    BiopsyLens& lens() { return lens_; }
    const BiopsyLens& lens() const { return lens_; }
    ScanMeasures& measures() { return measures_; }
    const ScanMeasures& measures() const { return measures_; }
    FindingsReading& findings() { return findings_; }
    const FindingsReading& findings() const { return findings_; }
    MissedReading& missed() { return missed_; }
    const MissedReading& missed() const { return missed_; }
    /// Lengths between two clicked places, and findings' diameters.
    PlaceRulers& rulers() { return rulers_; }
    const PlaceRulers& rulers() const { return rulers_; }
    /// Rulers without those of findings that the mode of detection hides.
    std::vector<PlaceRuler> shownRulers() const;
    /// Which of their ends, and of the one that is begun, no wall hides in the endoscopic view.
    const SeenEnds& seenEnds() const { return seenEnds_; }
    /// How the wall is drawn: what is made of it is shown in the endoscopic view while it changes,
    /// and in the flattened ones when it rests.
    OpticsEditor& optics() { return optics_; }
    const OpticsEditor& optics() const { return optics_; }
    /// What each view shows now.
    ViewState stateOf(View view) const;

    /// Where they are drawn.
    const Panes& panes() const { return panes_; }
    Freshness freshness(View view) const;
    /// 0 × 0: the view is not in sight, and nothing is asked for it.
    void setPaneSize(View view, glm::ivec2 pixels);

    /// Of the fly-over where it is on, else of the flight.
    Motion motion() const;
    void setMotion(Motion motion);
    /// A click in a slice: every view shows that place. Where slices are not linked, `plane` shows
    /// it and nothing else moves.
    void goTo(glm::dvec3 placeMm, std::optional<View> plane);
    /// Back where flight and slices were. What has been set since stays: lens, speed and direction,
    /// zoom, window, slab, scan. A place that the server is still asked about is gone to no more.
    void restore(const Flight& flight, const SliceViews& slices);

    /// As restore(), and all that slices show: for a reader whose session begins anew.
    void reopen(const Flight& flight, const SliceViews& slices);

    /// Of the place that was gone to last (FlatReading::picked), else of the gaze.
    void addBookmark(std::string note);
    void goTo(const Bookmark& bookmark) { flight_.goTo(bookmark.camera, bookmark.arcMm); }
    /// To its top: the camera looks at it, slices and zoom view show it. It is the current one.
    void goTo(const ListedFinding& finding);
    /// To where a patch is seen from that has been missed; slices and zoom view show its middle.
    void goTo(const MissedPlace& patch);
    /// The next (or, with −1, previous) bookmark along the centerline, if any.
    std::optional<Bookmark> nextBookmark(int step) const;

private:
    void caseOpened();
    void updateSeenEnds();
    void sendWindow();
    void sendOptics(Clock::time_point now);

    Session session_;
    std::shared_ptr<const CaseInfo> case_;
    Flight flight_{Centerline{}};
    SliceViews slices_;
    FlatReading flat_{session_, flight_};
    OutsideView outside_;
    BiopsyLens lens_{session_};
    ScanMeasures measures_{session_};
    FindingsReading findings_{session_};
    MissedReading missed_{session_};
    PlaceRulers rulers_{session_, flat_.wall()};
    SeenEnds seenEnds_{session_, flat_.wall()};
    OpticsEditor optics_;
    Panes panes_{session_};

    std::optional<WindowLevel> sentWindow_;
    std::uint64_t sentOptics_ = 0, seenOptics_ = 0;                    // revisions
    std::optional<Clock::time_point> opticsChangedAt_, opticsSentAt_;  // until shown everywhere
};

}  // namespace haustra::reader
