#include "reader/biopsy_lens.h"

#include "protocol/capabilities.h"
#include "protocol/limits.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::reader {
namespace {

constexpr int viewport = int(protocol::lensViewport);
// A lens that grows by little keeps its picture's size.
constexpr int sideStep = 16;

}  // namespace

std::optional<std::string> BiopsyLens::presetOf(const CaseInfo& info) {
    for (const char* name : {scanBiopsyPreset, biopsyPreset})
        if (std::any_of(info.presets.begin(), info.presets.end(),
                        [&](const OpticsPreset& preset) { return preset.name == name; }))
            return name;
    return std::nullopt;
}

void BiopsyLens::open(std::shared_ptr<const CaseInfo> info) {
    case_ = std::move(info);
    preset_ = presetOf(*case_);
    openSide_ = 0;
    forgetPicture();
    owes_ = false;
}

bool BiopsyLens::isAvailable() const {
    return preset_ && session_.serverCan(protocol::capability::lens);
}

void BiopsyLens::setRadius(double heights) {
    place_.radius = std::clamp(heights, leastLensRadius, greatestLensRadius);
}

void BiopsyLens::close() {
    owes_ = false;
    if (std::exchange(openSide_, 0) == 0) return;
    // A link that came back may be to a server that has no lens.
    if (session_.serverCan(protocol::capability::lens))
        session_.setViewport(viewport, View::endoscopic, 0, 0, true);
    forgetPicture();
}

void BiopsyLens::forgetPicture() {
    askedCamera_.reset();
    asked_.clear();
    picture_ = {};
}

void BiopsyLens::take(std::deque<link::PictureDone>& arrivals) {
    for (link::PictureDone& arrival : arrivals) {
        if (arrival.picture.viewport != viewport) continue;
        bool answers = false;  // what was asked for before the lens was closed counts no more
        while (!asked_.empty() && asked_.front().sequence <= arrival.picture.sequence) {
            shown_ = asked_.front().camera;
            answers = true;
            asked_.pop_front();
        }
        if (!answers && picture_.width == 0) continue;
        picture_ = std::move(arrival.picture);
        ++count_;
    }
    std::erase_if(arrivals, [](const link::PictureDone& arrival) {
        return arrival.picture.viewport == viewport;
    });
}

void BiopsyLens::update(const Camera& wanted, const Camera* shown, glm::ivec2 pane,
                        Clock::time_point now) {
    owes_ = false;
    if (!on_ || !isAvailable() || pane.y <= 0) return close();
    // Until the picture beneath stands still, all of the server's time is its own.
    if (!shown || *shown != wanted) return;
    const auto camera = cameraOfLens(wanted, place_);
    if (!camera) return forgetPicture();  // its middle is beyond a fisheye's rim
    const int pixels = int(std::ceil(2.2 * place_.radius * pane.y / sideStep)) * sideStep;
    const int side = std::clamp(pixels, int(protocol::minViewportPixels), mostLensPixels);
    if (side != openSide_) {
        session_.setViewport(viewport, View::endoscopic, side, side, true);
        if (openSide_ == 0) session_.setTransferFunction(viewport, *preset_);
        openSide_ = side;
        pacer_.touch();
    }
    const auto due = pacer_.next(camera != askedCamera_, now);
    owes_ = pacer_.owes();
    askedCamera_ = camera;
    if (due == ViewPacer::Ask::nothing) return;
    const auto sequence = session_.look(viewport, *camera, due == ViewPacer::Ask::moving);
    asked_.push_back({sequence, *camera});
    if (asked_.size() > 256) asked_.pop_front();
}

const tiles::Picture* BiopsyLens::pictureOver(const Camera& beneath) const {
    return on_ && picture_.width > 0 && registers(shown_, beneath) ? &picture_ : nullptr;
}

bool BiopsyLens::isExact() const {
    return picture_.exact && !owes_ && askedCamera_ == shown_ &&
           session_.overdue(viewport) == Clock::duration(0);
}

}  // namespace haustra::reader
