#include "reader/screen_time.h"

#include <algorithm>

namespace haustra::reader {

void ScreenTime::count(Shown& shown, Clock::time_point now) {
    waiting_[shown.picture] += now - shown.since;
    shown.since = now;
}

void ScreenTime::show(int viewport, std::uint32_t picture, Clock::time_point now) {
    if (const auto before = shown_.find(viewport); before != shown_.end()) {
        if (before->second.picture == picture) return;
        count(before->second, now);
    }
    shown_[viewport] = {picture, now};
}

void ScreenTime::hide(int viewport, Clock::time_point now) {
    const auto shown = shown_.find(viewport);
    if (shown == shown_.end()) return;
    count(shown->second, now);
    shown_.erase(shown);
}

std::vector<ShownTime> ScreenTime::take(Clock::time_point now, std::size_t most) {
    for (auto& [viewport, shown] : shown_)
        count(shown, now);
    const auto isOn = [&](std::uint32_t picture) {
        return std::any_of(shown_.begin(), shown_.end(),
                           [&](const auto& shown) { return shown.second.picture == picture; });
    };
    std::vector<ShownTime> taken;
    for (auto each = waiting_.begin(); each != waiting_.end() && taken.size() < most;) {
        auto& [picture, time] = *each;
        constexpr std::chrono::milliseconds longest{60'000};  // in one message
        const auto whole =
            std::min(std::chrono::duration_cast<std::chrono::milliseconds>(time), longest);
        if (whole.count() > 0) taken.push_back({picture, int(whole.count())});
        time -= whole;
        // Of one that has left the screen, less than a millisecond is nothing.
        each = isOn(picture) || time >= std::chrono::milliseconds(1) ? std::next(each)
                                                                     : waiting_.erase(each);
    }
    return taken;
}

void ScreenTime::reset() {
    shown_.clear();
    waiting_.clear();
}

}  // namespace haustra::reader
