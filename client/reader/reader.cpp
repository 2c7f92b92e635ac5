#include "reader/reader.h"

#include "protocol/capabilities.h"

#include <limits>

namespace haustra::reader {
namespace {

using std::chrono::milliseconds;

// What hands do to the optics reaches the server so often.
constexpr auto opticsInterval = milliseconds(50);
// The flattened views take long: they show optics that rest.
constexpr auto opticsRest = milliseconds(350);
// A flight that ran on over a picture that stands would show one place and name another.
constexpr auto longestWait = milliseconds(1500);

}  // namespace

Reader::Reader(link::ConnectionOptions options, std::string caseName,
               std::optional<BookmarkJournal> journal)
    : session_(std::move(options), std::move(caseName), std::move(journal)) {}

void Reader::update(double seconds) {
    session_.poll(milliseconds(0));
    if (session_.caseInfo() && session_.caseInfo() != case_) caseOpened();
    auto arrivals = session_.takePictures();
    lens_.take(arrivals);
    panes_.take(std::move(arrivals), Clock::now());
    if (!case_) return;
    if (session_.phase() != Phase::open) setMotion(Motion::paused);
    if (waitsForPictures()) seconds = 0.0;
    if (const auto picked = flat_.update(seconds))
        slices_.show(picked->positionMm, flight_.camera().positionMm);
    slices_.follow(flight_.camera().positionMm);
    measures_.update();
    rulers_.update();
    updateSeenEnds();
    missed_.update(Clock::now());
    sendWindow();
    sendOptics(Clock::now());
    panes_.askForViews([this](View view) { return stateOf(view); }, Clock::now());
    lens_.update(flight_.camera(), panes_.shown<Camera>(View::endoscopic),
                 panes_.size(View::endoscopic), Clock::now());
}

void Reader::caseOpened() {
    case_ = session_.caseInfo();
    flight_ = Flight(case_->centerline);
    if (case_->centerline.points.empty()) {
        // Without a path the reader starts in the middle of the scan, looking at the head.
        Camera camera;
        camera.positionMm =
            case_->grid.patientFromVoxelPoint(0.5 * glm::dvec3(case_->grid.size - 1));
        flight_.goTo(camera, 0.0);
    }
    flat_.open(case_, panes_.size(View::flattenedZoom));
    slices_.open(case_, flight_.camera().positionMm,
                 session_.serverCan(protocol::capability::slabs));
    outside_.open(case_);
    lens_.open(case_);
    measures_.reset();
    findings_.open();
    missed_.open();
    rulers_.reset();
    seenEnds_.reset();
    panes_.clear();
    optics_.offer(case_->presets);
    sentOptics_ = seenOptics_ = optics_.revision();
    opticsChangedAt_.reset();
    sentWindow_.reset();
}

ViewState Reader::stateOf(View view) const {
    switch (view) {
        case View::endoscopic:
            return flight_.camera();
        case View::axial:
        case View::coronal:
        case View::sagittal:
            return slices_.slice(view);
        case View::flattened:
            return WholeStrip{};
        case View::flattenedZoom:
            return flat_.tour().window();
        case View::oblique:
            return slices_.oblique(flight_.camera());
        case View::overview:
            return outside_.state();
        default:  // the window has no pane for it
            return {};
    }
}

bool Reader::waitsForPictures() const {
    return session_.overdue(int(View::endoscopic)) > longestWait ||
           session_.overdue(int(View::flattenedZoom)) > longestWait;
}

Freshness Reader::freshness(View view) const {
    if (panes_.pictureCount(view) == 0) return Freshness::none;
    if (session_.phase() != Phase::open || session_.overdue(int(view)) > 2 * longestWait)
        return Freshness::old;
    // Of the size and the colours that are wanted now, too.
    const tiles::Picture& picture = panes_.picture(view);
    return picture.exact && !panes_.owes(view) &&
                   session_.overdue(int(view)) == Clock::duration(0) &&
                   glm::ivec2(picture.width, picture.height) == panes_.size(view) &&
                   panes_.shownState(view) == stateOf(view)
               ? Freshness::exact
               : Freshness::moving;
}

void Reader::setPaneSize(View view, glm::ivec2 pixels) {
    const bool wasClosed = panes_.size(view) == glm::ivec2(0);
    if (!panes_.setSize(view, pixels) || pixels == glm::ivec2(0)) return;
    if (wasClosed && case_) {
        // The server knows nothing of a view that comes back.
        sentWindow_.reset();
        if (view == View::endoscopic || isFlat(view))
            session_.setTransferFunction(int(view), optics_.choice());
    }
    if (view == View::flattenedZoom) flat_.tour().setPaneSize(panes_.size(view));
    if (view == View::overview) outside_.setPaneSize(panes_.size(view));
}

void Reader::sendWindow() {
    if (sentWindow_ == slices_.window()) return;
    sentWindow_ = slices_.window();
    for (const View view : allViews) {
        if (isGrey(view)) session_.setWindowLevel(int(view), *sentWindow_);
    }
}

void Reader::sendOptics(Clock::time_point now) {
    const auto show = [&](View view) {
        session_.setTransferFunction(int(view), optics_.choice());
        panes_.touch(view);
    };
    if (optics_.revision() != seenOptics_) {
        seenOptics_ = optics_.revision();
        opticsChangedAt_ = now;
    }
    if (seenOptics_ != sentOptics_ && !(opticsSentAt_ && now < *opticsSentAt_ + opticsInterval)) {
        show(View::endoscopic);
        sentOptics_ = seenOptics_;
        opticsSentAt_ = now;
    }
    if (!opticsChangedAt_ || now < *opticsChangedAt_ + opticsRest) return;
    opticsChangedAt_.reset();
    if (flat_.hasStrip())
        for (const View view : {View::flattened, View::flattenedZoom})
            show(view);
}

bool Reader::restless() const {
    if (!case_ || session_.phase() != Phase::open) return false;
    return motion() != Motion::paused || flat_.wall().waits() || measures_.waits() ||
           rulers_.waits() || seenEnds_.waits() || opticsChangedAt_ ||
           optics_.revision() != sentOptics_ || panes_.owe() || lens_.owes();
}

Motion Reader::motion() const {
    return flat_.tour().flyingOver() ? flat_.tour().motion() : flight_.motion();
}

void Reader::setMotion(Motion motion) {
    if (flat_.tour().flyingOver())
        flat_.tour().setMotion(motion);
    else
        flight_.setMotion(motion);
}

void Reader::goTo(glm::dvec3 placeMm, std::optional<View> plane) {
    if (!case_) return;
    if (slices_.linked()) {
        setMotion(Motion::paused);
        flat_.goTo(placeMm);
    }
    slices_.show(placeMm, flight_.camera().positionMm, plane);
}

std::vector<PlaceRuler> Reader::shownRulers() const {
    std::vector<PlaceRuler> shown = rulers_.rulers();
    std::erase_if(shown, [&](const PlaceRuler& ruler) {
        if (ruler.finding == 0) return false;
        const ListedFinding* finding = findings_.find(ruler.finding);
        return !finding || !ruler.isOf(*finding);
    });
    return shown;
}

void Reader::updateSeenEnds() {
    std::vector<glm::dvec3> ends;
    for (const PlaceRuler& ruler : shownRulers())
        ends.insert(ends.end(), {ruler.from.positionMm, ruler.to.positionMm});
    if (rulers_.begun()) ends.push_back(rulers_.begun()->positionMm);
    const Camera* pictured = panes_.shown<Camera>(View::endoscopic);
    seenEnds_.update(pictured && *pictured == flight_.camera() ? pictured : nullptr, ends);
}

void Reader::goTo(const ListedFinding& finding) {
    if (!case_) return;
    findings_.setCurrent(finding);
    setMotion(Motion::paused);
    flat_.goTo(finding.wall, finding.view);
    slices_.show(finding.wall.positionMm, flight_.camera().positionMm);
}

void Reader::goTo(const MissedPlace& patch) {
    if (!case_) return;
    setMotion(Motion::paused);
    flat_.goTo(patch.place, patch.view);
    slices_.show(patch.place.positionMm, flight_.camera().positionMm);
}

void Reader::restore(const Flight& flight, const SliceViews& slices) {
    flight_.standAs(flight);
    slices_.showAs(slices);
    flat_.forgetPicked();
}

void Reader::reopen(const Flight& flight, const SliceViews& slices) {
    restore(flight, slices);
    slices_.reopenAs(slices);
}

// Of a place that was gone to, the gaze is towards it: the bookmark means it.
void Reader::addBookmark(std::string note) {
    if (!case_) return;
    Camera camera = flight_.camera();
    if (const auto& picked = flat_.picked()) {
        const glm::dvec3 way = picked->positionMm - camera.positionMm;
        const glm::dvec3 right = glm::cross(way, camera.up);
        if (glm::length(right) > 1e-6) {
            camera.forward = glm::normalize(way);
            camera.up = glm::normalize(glm::cross(right, way));
        }
    }
    session_.addBookmark(camera, flight_.placeArcMm(), std::move(note));
}

std::optional<Bookmark> Reader::nextBookmark(int step) const {
    const double here = flight_.placeArcMm();
    double nearest = std::numeric_limits<double>::max();
    std::optional<Bookmark> found;
    for (const Bookmark& bookmark : session_.bookmarks()) {
        const double ahead = step * (bookmark.arcMm - here);
        if (ahead > 0.5 && ahead < nearest) nearest = ahead, found = bookmark;
    }
    return found;
}

}  // namespace haustra::reader
