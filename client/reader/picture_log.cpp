#include "reader/picture_log.h"

#include <utility>

namespace haustra::reader {

void PictureLog::clear() {
    for (ViewLog& view : views_) {
        view.asked.clear();
        view.shown.reset();
        view.shownPaneSize = glm::ivec2(0);
        view.picture = {};
        view.count = 0;
    }
    latencies_.clear();
}

void PictureLog::asked(View view, const Asked& asked) {
    std::deque<Asked>& all = views_[std::size_t(view)].asked;
    all.push_back(asked);
    if (all.size() > 256) all.pop_front();
}

void PictureLog::take(std::deque<link::PictureDone> arrivals, Clock::time_point now) {
    for (link::PictureDone& arrival : arrivals) {
        const auto viewport = std::size_t(arrival.picture.viewport);
        if (viewport >= viewCount) continue;
        const bool endoscopic = View(viewport) == View::endoscopic;
        ViewLog& view = views_[viewport];
        std::optional<Asked> answered;
        while (!view.asked.empty() && view.asked.front().sequence <= arrival.picture.sequence) {
            answered = view.asked.front();
            view.asked.pop_front();
        }
        if (answered) view.shown = answered->state, view.shownPaneSize = answered->paneSize;
        if (endoscopic) decodedAt_.push_back(arrival.decodedAt);
        if (answered && answered->moving) {
            const double ms =
                std::chrono::duration<double, std::milli>(arrival.decodedAt - answered->at).count();
            view.detail.add(ms);
            if (endoscopic) latencies_.add(ms);
        }
        view.picture = std::move(arrival.picture);
        ++view.count;
    }
    while (!decodedAt_.empty() && decodedAt_.front() < now - std::chrono::seconds(1))
        decodedAt_.pop_front();
}

}  // namespace haustra::reader
