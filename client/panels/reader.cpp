#include "panels/reader.h"

#include "panels/slice_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haustra::panels {
namespace {

using std::chrono::milliseconds;

constexpr std::array<View, viewCount> views = {View::endoscopic, View::axial, View::coronal,
                                               View::sagittal};
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
              ViewPacer(milliseconds(115), milliseconds(135))} {}

void Reader::update(double seconds) {
    session_.poll(milliseconds(0));
    if (session_.caseInfo() && session_.caseInfo() != case_) caseOpened();
    takePictures();
    if (!case_) return;
    flight_.advance(seconds);
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
    sliceFocusMm_ = flight_.camera().positionMm;
    sliceZoom_ = 1.0;
    slicesCleansed_ = false;
    pictures_ = {};
    pictureCounts_ = {};
    openSizes_ = {};
    for (auto& asked : asked_)
        asked.clear();
    latencies_.clear();
    transferFunction_ = case_->transferFunctions.empty() ? "" : case_->transferFunctions.front();
    for (const View view : {View::axial, View::coronal, View::sagittal})
        session_.setWindowLevel(int(view), window_);
    for (ViewPacer& pacer : pacers_)
        pacer.touch();
}

void Reader::takePictures() {
    for (Arrival& arrival : session_.takePictures()) {
        const std::size_t n = std::size_t(arrival.picture.viewport);
        if (n >= viewCount) continue;
        std::deque<Asked>& asked = asked_[n];
        std::optional<Asked> answered;
        while (!asked.empty() && asked.front().sequence <= arrival.picture.sequence) {
            answered = asked.front();
            asked.pop_front();
        }
        if (answered) shownSlices_[n] = answered->slice;
        if (n == at(View::endoscopic)) {
            pictureTimes_.push_back(arrival.decodedAt);
            if (answered && answered->moving) {
                const double ms =
                    std::chrono::duration<double, std::milli>(arrival.decodedAt - answered->at)
                        .count();
                latencies_.add(ms);
                detail_.add(ms);
            }
        }
        pictures_[n] = std::move(arrival.picture);
        ++pictureCounts_[n];
    }
    const auto secondAgo = Clock::now() - std::chrono::seconds(1);
    while (!pictureTimes_.empty() && pictureTimes_.front() < secondAgo)
        pictureTimes_.pop_front();
}

void Reader::setPaneSize(View view, glm::ivec2 pixels) {
    // A picture of the same shape within the protocol's bound; the window stretches it.
    const double limit = double(protocol::maxViewportPixels) / std::max({pixels.x, pixels.y, 1});
    const glm::ivec2 size = scaled(pixels, std::min(1.0, limit));
    if (size == paneSizes_[at(view)]) return;
    paneSizes_[at(view)] = size;
    pacers_[at(view)].touch();
}

void Reader::openPane(View view, bool moving) {
    const glm::ivec2 size =
        scaled(paneSizes_[at(view)], moving && view == View::endoscopic ? detail_.scale() : 1.0);
    if (size == openSizes_[at(view)]) return;
    openSizes_[at(view)] = size;
    session_.setViewport(int(view), view, size.x, size.y);
}

void Reader::askForViews(Clock::time_point now) {
    const Camera camera = flight_.camera();
    const bool moved = !(camera == lastCamera_);
    if (camera.positionMm != lastCamera_.positionMm) sliceFocusMm_ = camera.positionMm;
    lastCamera_ = camera;
    for (const View view : views) {
        const std::size_t n = at(view);
        if (paneSizes_[n] == glm::ivec2(0)) continue;
        const Slice wanted = slice(view);
        const bool changed = view == View::endoscopic ? moved : !(wanted == askedSlices_[n]);
        const auto ask = pacers_[n].next(changed, now);
        if (ask == ViewPacer::Ask::nothing) continue;
        const bool moving = ask == ViewPacer::Ask::moving;
        openPane(view, moving);
        askedSlices_[n] = wanted;
        const auto sequence = view == View::endoscopic ? session_.setCamera(int(n), camera, moving)
                                                       : session_.setSlice(int(n), wanted, moving);
        asked_[n].push_back({sequence, now, wanted, moving});
        if (asked_[n].size() > 256) asked_[n].pop_front();
    }
}

Slice Reader::slice(View) const {
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

void Reader::goNear(glm::dvec3 patientMm) {
    if (!case_ || case_->centerline.points.empty()) return;
    flight_.setMotion(Motion::paused);
    flight_.goTo(nearestArc(case_->centerline, patientMm));
}

void Reader::setWindow(WindowLevel window) {
    window.widthHu = std::clamp(window.widthHu, 1.0, 6000.0);
    window.centerHu = std::clamp(window.centerHu, -2000.0, 4000.0);
    if (window == window_) return;
    window_ = window;
    for (const View view : {View::axial, View::coronal, View::sagittal}) {
        session_.setWindowLevel(int(view), window_);
        pacers_[at(view)].touch();
    }
}

void Reader::setTransferFunction(const std::string& preset) {
    transferFunction_ = preset;
    session_.setTransferFunction(int(View::endoscopic), preset);
    pacers_[at(View::endoscopic)].touch();
}

void Reader::addBookmark(std::string note) {
    if (case_) session_.addBookmark(flight_.camera(), flight_.arcMm(), std::move(note));
}

void Reader::goToBookmark(int step) {
    const double here = flight_.arcMm();
    double nearest = std::numeric_limits<double>::max();
    std::optional<Bookmark> found;
    for (const Bookmark& bookmark : session_.bookmarks()) {
        const double ahead = step * (bookmark.arcMm - here);
        if (ahead > 0.5 && ahead < nearest) nearest = ahead, found = bookmark;
    }
    if (found) goTo(*found);
}

double Reader::picturesPerSecond() const {
    return double(pictureTimes_.size());
}

bool Reader::restless() const {
    if (!case_ || session_.phase() != Phase::open) return false;
    if (flight_.motion() != Motion::paused) return true;
    return std::any_of(pacers_.begin(), pacers_.end(),
                       [](const ViewPacer& pacer) { return pacer.owes(); });
}

}  // namespace haustra::panels
