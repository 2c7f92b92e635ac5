#include "reader/findings_reading.h"

#include "protocol/capabilities.h"

#include <algorithm>
#include <cmath>

namespace haustra::reader {

bool FindingsReading::isLeft() const {
    const std::string& wanted = session_.wantedCase();
    return session_.caseInfo() && !wanted.empty() && wanted != session_.caseInfo()->name;
}

bool FindingsReading::has() const {
    return session_.caseInfo() && session_.caseInfo()->detection == Detection::there && !isLeft() &&
           session_.serverCan(protocol::capability::findings);
}

Result<void> FindingsReading::choose(const DetectionChoice& choice) {
    const auto refuse = [](const char* why) { return fail(ErrorKind::unsupported, why, ""); };
    if (!session_.caseInfo()) return refuse("no case is open");
    if (isLeft()) return refuse("another case is being opened");
    if (!session_.serverCan(protocol::capability::findings))
        return refuse("this server cannot show findings");
    if (session_.caseInfo()->detection == Detection::damaged)
        return refuse("the findings of this case cannot be read");
    if (!has()) return refuse("no polyps have been looked for in this case");
    session_.setDetection(choice);
    return {};
}

Result<void> FindingsReading::choose(DetectionMode mode) {
    DetectionChoice next = choice();
    if (next.mode == mode) return {};
    next.mode = mode;
    next.firstPassDone = false;
    return choose(next);
}

Result<void> FindingsReading::finishFirstPass() {
    DetectionChoice next = choice();
    if (next.mode != DetectionMode::secondReader)
        return fail(ErrorKind::wrongState, "only a second reader waits for the first reading", "");
    next.firstPassDone = true;
    return choose(next);
}

std::span<const ListedFinding> FindingsReading::shown() const {
    const auto& list = session_.findings();
    if (!list || !has() || !choice().shows()) return {};
    return list->findings;
}

const ListedFinding* FindingsReading::find(int number) const {
    for (const ListedFinding& one : shown())
        if (one.number == number) return &one;
    return nullptr;
}

const ListedFinding* FindingsReading::current() const {
    const ListedFinding* now = current_ ? find(current_->number) : nullptr;
    return now && isSame(*now, *current_) ? now : nullptr;
}

const ListedFinding* FindingsReading::next(int step, double arcMm) const {
    const auto all = shown();
    if (const ListedFinding* here = current();
        here && std::abs(here->wall.arcMm - arcMm) <= besideMm) {
        const std::ptrdiff_t n = (here - all.data()) + step;
        return n >= 0 && n < std::ptrdiff_t(all.size()) ? &all[std::size_t(n)] : nullptr;
    }
    const ListedFinding* found = nullptr;
    constexpr double sameArcMm = 0.5;
    double nearest = INFINITY;
    for (const ListedFinding& one : all) {
        // One right here has not been gone to: it comes first, of several the first on the way.
        const double ahead = step * (one.wall.arcMm - arcMm);
        const bool nearer = step > 0 ? ahead < nearest : ahead <= nearest;
        if (ahead > -sameArcMm && nearer) nearest = ahead, found = &one;
    }
    return found;
}

}  // namespace haustra::reader
