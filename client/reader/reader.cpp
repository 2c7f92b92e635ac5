#include "reader/reader.h"

#include "reader/overview_map.h"
#include "reader/slice_map.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {
namespace {

using std::chrono::milliseconds;

// What hands do to the optics reaches the server so often.
constexpr auto opticsInterval = milliseconds(50);
// The flattened views take long: they show optics that rest.
constexpr auto opticsRest = milliseconds(350);
constexpr std::size_t at(View view) {
    return std::size_t(view);
}

glm::ivec2 scaled(glm::ivec2 size, double scale) {
    return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * scale)),
                    glm::ivec2(minViewportPixels));
}

}  // namespace

Reader::Reader(link::ConnectionOptions options, std::string caseName)
    : session_(std::move(options), std::move(caseName)),
      // Slices change less than the eye follows in flight: a few a second leave the server's time
      // to the endoscopic view. The still is asked for before the server, which waits for 150 ms,
      // makes one of its own at the size of moving pictures.
      pacers_{ViewPacer(milliseconds(15), milliseconds(110)),
              ViewPacer(milliseconds(115), milliseconds(125)),
              ViewPacer(milliseconds(115), milliseconds(130)),
              ViewPacer(milliseconds(115), milliseconds(135)),
              // The strip changes with its pane and colours alone.
              ViewPacer(milliseconds(250), milliseconds(250)),
              ViewPacer(milliseconds(15), milliseconds(120)),
              ViewPacer(milliseconds(115), milliseconds(140)),
              ViewPacer(milliseconds(60), milliseconds(145))} {}

void Reader::update(double seconds) {
    session_.poll(milliseconds(0));
    if (session_.caseInfo() && session_.caseInfo() != case_) caseOpened();
    pictures_.take(session_.takePictures(), Clock::now());
    if (!case_) return;
    wall_.update(*case_);
    takePicked();
    travel(seconds);
    sendOptics(Clock::now());
    askForViews(Clock::now());
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
    tour_ = case_->flat ? StripTour(*case_->flat) : StripTour();
    tour_.setPaneSize(paneSizes_[at(View::flattenedZoom)]);
    tour_.showWholeCircumference();
    followedArcMm_ = flight_.arcMm();
    if (case_->flat) tour_.follow(followedArcMm_);
    wall_.reset();
    picked_.reset();
    sliceFocusMm_ = flight_.camera().positionMm;
    sliceZoom_ = 1.0;
    slicesCleansed_ = false;
    obliqueAheadMm_ = 0.0;
    obliqueHeightMm_ = Oblique{}.heightMm;
    resetOverview();
    pictures_.clear();
    openSizes_ = {};
    optics_.offer(case_->presets);
    sentOptics_ = seenOptics_ = optics_.revision();
    opticsChangedAt_.reset();
    for (const View view : {View::axial, View::coronal, View::sagittal, View::oblique})
        session_.setWindowLevel(int(view), window_);
    for (ViewPacer& pacer : pacers_)
        pacer.touch();
}

void Reader::setPaneSize(View view, glm::ivec2 pixels) {
    // A picture of the same shape within the protocol's bound; the window stretches it.
    const double limit = double(protocol::maxViewportPixels) / std::max({pixels.x, pixels.y, 1});
    const glm::ivec2 size = scaled(pixels, std::min(1.0, limit));
    if (size == paneSizes_[at(view)]) return;
    paneSizes_[at(view)] = size;
    if (view == View::flattenedZoom) tour_.setPaneSize(size);
    if (view == View::overview && !orbitIsOwn_) resetOverview();
    pacers_[at(view)].touch();
}

// The window has a pane for it, and the case what it shows.
bool Reader::inUse(View view) const {
    return paneSizes_[at(view)] != glm::ivec2(0) && (!isFlat(view) || hasStrip());
}

void Reader::openPane(View view, bool moving) {
    const bool scales =
        view == View::endoscopic || view == View::flattenedZoom || view == View::overview;
    const glm::ivec2 size =
        scaled(paneSizes_[at(view)], moving && scales ? pictures_.movingScale(view) : 1.0);
    if (size == openSizes_[at(view)]) return;
    openSizes_[at(view)] = size;
    session_.setViewport(int(view), view, size.x, size.y);
}

Sight Reader::sight() const {
    return {slice(), tour_.window(), oblique(), orbit_};
}

bool Reader::changed(View view, bool cameraMoved) const {
    const Sight& asked = asked_[at(view)];
    switch (view) {
        case View::endoscopic:
            return cameraMoved;
        case View::flattened:
            return false;
        case View::flattenedZoom:
            return tour_.window().center != asked.window.center ||
                   tour_.window().pixelsPerUnit != asked.window.pixelsPerUnit;
        case View::oblique:
            return !(oblique() == asked.oblique);
        case View::overview:
            return !(orbit_ == asked.orbit);
        default:
            return !(slice() == asked.slice);
    }
}

void Reader::askForViews(Clock::time_point now) {
    const Camera camera = flight_.camera();
    const bool moved = !(camera == lastCamera_);
    if (camera.positionMm != lastCamera_.positionMm) sliceFocusMm_ = camera.positionMm;
    lastCamera_ = camera;
    for (const View view : allViews) {
        const std::size_t n = at(view);
        if (!inUse(view)) continue;
        const auto due = pacers_[n].next(changed(view, moved), now);
        if (due == ViewPacer::Ask::nothing) continue;
        const bool moving = due == ViewPacer::Ask::moving;
        if (moving && view == View::flattened) continue;  // its still follows at once
        openPane(view, moving);
        asked_[n] = sight();
        pictures_.asked(view, {ask(view, moving), now, asked_[n], moving});
    }
}

std::uint64_t Reader::ask(View view, bool moving) {
    if (view == View::endoscopic) return session_.setCamera(int(view), lastCamera_, moving);
    if (isSlice(view)) return session_.setSlice(int(view), slice(), moving);
    if (view == View::oblique) return session_.setOblique(int(view), oblique(), moving);
    // The window itself marks reader and bookmarks: they move without a new picture. While the
    // hand turns the colon it is alone: where there is no GPU, the body takes a second.
    if (view == View::overview)
        return session_.setOverview(int(view), {orbit_, {}, {}, showsBody_ && !moving}, moving);
    FlatWindow window = tour_.window();
    window.pixelsPerUnit *= double(openSizes_[at(view)].x) / paneSizes_[at(view)].x;
    return session_.setFlat(int(view), window, moving);
}

Slice Reader::slice() const {
    return {sliceFocusMm_, sliceZoom_, slicesCleansed_};
}

void Reader::scrollSlice(View view, double mm) {
    if (!case_) return;
    sliceFocusMm_ += mm * sliceNormal(view);
    // Kept within the scan: a slice outside it is black, and the way back hard to find.
    const Grid& grid = case_->grid;
    const glm::dvec3 voxel = glm::clamp(grid.voxelFromPatientPoint(sliceFocusMm_), glm::dvec3(0.0),
                                        glm::dvec3(grid.size - 1));
    sliceFocusMm_ = grid.patientFromVoxelPoint(voxel);
}

void Reader::zoomSlices(double factor) {
    sliceZoom_ = std::clamp(sliceZoom_ * factor, 1.0, 32.0);
}

void Reader::setSlicesCleansed(bool cleansed) {
    slicesCleansed_ = cleansed && case_ && case_->cleansed;
}

Oblique Reader::oblique() const {
    const Camera camera = flight_.camera();
    return {camera.positionMm + obliqueAheadMm_ * camera.forward, camera.forward, camera.up,
            obliqueHeightMm_, slicesCleansed_};
}

void Reader::scrollOblique(double mm) {
    obliqueAheadMm_ = std::clamp(obliqueAheadMm_ + mm, -50.0, 200.0);
}

void Reader::zoomOblique(double factor) {
    obliqueHeightMm_ = std::clamp(obliqueHeightMm_ / factor, 10.0, 400.0);
}

void Reader::turnOverview(double azimuthDegrees, double elevationDegrees) {
    orbit_.azimuthDegrees = std::remainder(orbit_.azimuthDegrees + azimuthDegrees, 360.0);
    orbit_.elevationDegrees = std::clamp(orbit_.elevationDegrees + elevationDegrees, -90.0, 90.0);
    orbitIsOwn_ = true;
}

void Reader::zoomOverview(double factor) {
    orbit_.heightMm = std::clamp(orbit_.heightMm / factor, 20.0, 1500.0);
    orbitIsOwn_ = true;
}

void Reader::resetOverview() {
    orbitIsOwn_ = false;
    if (!case_) return;
    const glm::dvec2 size = glm::max(paneSizes_[at(View::overview)], glm::ivec2(1));
    orbit_ = orbitOf(case_->centerline, size.x / size.y);
    if (!case_->centerline.points.empty()) return;
    // Without a path, all of the scan.
    const Grid& grid = case_->grid;
    const glm::dvec3 a = grid.patientFromVoxelPoint(glm::dvec3(0.0)),
                     b = grid.patientFromVoxelPoint(glm::dvec3(grid.size - 1));
    orbit_ = orbitAround(glm::min(a, b), glm::max(a, b), size.x / size.y);
}

bool Reader::setWallPaint(const WallPaint& paint) {
    if (!hasStrip()) return false;
    session_.setWallPaint(paint);
    return true;
}

void Reader::forgetSeen() {
    if (hasStrip()) session_.askSeen(true);
}

void Reader::setShowsBody(bool shows) {
    showsBody_ = shows;
    pacers_[at(View::overview)].touch();
}

void Reader::setWindow(WindowLevel window) {
    window.widthHu = std::clamp(window.widthHu, 1.0, 6000.0);
    window.centerHu = std::clamp(window.centerHu, -2000.0, 4000.0);
    if (window == window_) return;
    window_ = window;
    for (const View view : {View::axial, View::coronal, View::sagittal, View::oblique}) {
        session_.setWindowLevel(int(view), window_);
        pacers_[at(view)].touch();
    }
}

void Reader::sendOptics(Clock::time_point now) {
    const auto show = [&](View view) {
        session_.setTransferFunction(int(view), optics_.choice());
        pacers_[at(view)].touch();
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
    if (hasStrip())
        for (const View view : {View::flattened, View::flattenedZoom})
            show(view);
}

bool Reader::restless() const {
    if (!case_ || session_.phase() != Phase::open) return false;
    if (motion() != Motion::paused || wall_.waits() || opticsChangedAt_ ||
        optics_.revision() != sentOptics_)
        return true;
    return std::any_of(allViews.begin(), allViews.end(),
                       [&](View view) { return inUse(view) && pacers_[at(view)].owes(); });
}

}  // namespace haustra::reader
