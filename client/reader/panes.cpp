#include "reader/panes.h"

#include "protocol/limits.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {
namespace {

using std::chrono::milliseconds;

constexpr std::size_t at(View view) {
    return std::size_t(view);
}

glm::ivec2 scaled(glm::ivec2 size, double scale) {
    return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * scale)),
                    glm::ivec2(int(protocol::minViewportPixels)));
}

// Slices change less than the eye follows in flight: a few a second leave the server's time to the
// endoscopic view. The still is asked for before the server, which waits for 150 ms, makes one of
// its own at the size of moving pictures.
ViewPacer pacerOf(View view) {
    switch (view) {
        case View::endoscopic:
            return {milliseconds(15), milliseconds(110)};
        case View::axial:
            return {milliseconds(115), milliseconds(125)};
        case View::coronal:
            return {milliseconds(115), milliseconds(130)};
        case View::sagittal:
            return {milliseconds(115), milliseconds(135)};
        case View::flattened:  // changes with its pane and colours alone
            return {milliseconds(250), milliseconds(250)};
        case View::flattenedZoom:
            return {milliseconds(15), milliseconds(120)};
        case View::oblique:
            return {milliseconds(115), milliseconds(140)};
        case View::overview:
        default:
            return {milliseconds(60), milliseconds(145)};
    }
}

template <std::size_t... n>
std::array<ViewPacer, viewCount> allPacers(std::index_sequence<n...>) {
    return {pacerOf(allViews[n])...};
}

}  // namespace

Panes::Panes(Session& session)
    : session_(session), pacers_(allPacers(std::make_index_sequence<viewCount>())) {}

bool Panes::setSize(View view, glm::ivec2 pixels) {
    if (pixels == glm::ivec2(0)) return close(view);
    // A picture of the same shape within the protocol's bound; the window enlarges it.
    const double limit = double(protocol::maxViewportPixels) / std::max({pixels.x, pixels.y, 1});
    const glm::ivec2 size = scaled(pixels, std::min(1.0, limit));
    if (size == sizes_[at(view)]) return false;
    sizes_[at(view)] = size;
    touch(view);
    return true;
}

bool Panes::close(View view) {
    if (sizes_[at(view)] == glm::ivec2(0)) return false;
    sizes_[at(view)] = glm::ivec2(0);
    if (openSizes_[at(view)] != glm::ivec2(0)) session_.setViewport(int(view), view, 0, 0);
    openSizes_[at(view)] = glm::ivec2(0);
    return true;
}

void Panes::clear() {
    pictures_.clear();
    openSizes_ = {};
    for (const View view : allViews)
        touch(view);
}

// The window has a pane for it, and the case what it shows.
bool Panes::inUse(View view) const {
    return sizes_[at(view)] != glm::ivec2(0) && (!isFlat(view) || session_.caseInfo()->flat);
}

void Panes::open(View view, bool moving) {
    const bool scales = !isGrey(view) && view != View::flattened;
    const glm::ivec2 size =
        scaled(sizes_[at(view)], moving && scales ? pictures_.movingScale(view) : 1.0);
    if (size == openSizes_[at(view)]) return;
    openSizes_[at(view)] = size;
    session_.setViewport(int(view), view, size.x, size.y);
}

// The state in the picture's pixels. While the hand turns the colon it is alone: where there is no
// GPU, the body takes a second.
ViewState Panes::toSend(View view, ViewState state, bool moving) const {
    if (auto* window = std::get_if<FlatWindow>(&state))
        window->pixelsPerUnit *= double(openSizes_[at(view)].x) / sizes_[at(view)].x;
    if (auto* overview = std::get_if<Overview>(&state)) overview->body &= !moving;
    return state;
}

void Panes::askForViews(const std::function<ViewState(View)>& stateOf, Clock::time_point now) {
    for (const View view : allViews) {
        const std::size_t n = at(view);
        if (!inUse(view)) continue;
        const ViewState state = stateOf(view);
        const auto due = pacers_[n].next(state != asked_[n], now);
        if (due == ViewPacer::Ask::nothing) continue;
        const bool moving = due == ViewPacer::Ask::moving;
        asked_[n] = state;
        if (moving && view == View::flattened) continue;  // its still follows at once
        open(view, moving);
        const auto sequence = session_.look(int(view), toSend(view, state, moving), moving);
        pictures_.asked(view, {sequence, now, state, sizes_[n], moving});
    }
}

bool Panes::owes(View view) const {
    return inUse(view) && pacers_[at(view)].owes();
}

bool Panes::owe() const {
    return std::any_of(allViews.begin(), allViews.end(), [&](View view) { return owes(view); });
}

}  // namespace haustra::reader
