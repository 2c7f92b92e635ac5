#include "reader/missed_reading.h"

#include "protocol/capabilities.h"

namespace haustra::reader {
namespace {

// The middle of a patch moves while parts of it are seen.
constexpr double samePatchMm = 10.0;
constexpr auto askEvery = std::chrono::milliseconds(1000);

}  // namespace

void MissedReading::open() {
    wanted_.reset();
    currentMm_.reset();
    rank_ = 0;
    askedAtShare_.reset();
    asked_ = 0;
    askAfter_ = {};
}

bool MissedReading::has() const {
    return session_.caseInfo() && session_.caseInfo()->flat &&
           session_.serverCan(protocol::capability::ledger);
}

const MissedList* MissedReading::list() const {
    return session_.missed() ? &*session_.missed() : nullptr;
}

void MissedReading::update(Clock::time_point now) {
    if (!has() || session_.phase() != Phase::open || !session_.seenShare()) return;
    const bool waits = asked_ > session_.answeredLedgerRequest();
    const bool stale = !list() || askedAtShare_ != session_.seenShare();
    if (waits || !stale || now < askAfter_ || (!watched_ && !wanted_ && !currentMm_)) return;
    askedAtShare_ = session_.seenShare();
    asked_ = session_.requestMissed();
    askAfter_ = now + askEvery;
}

std::optional<std::size_t> MissedReading::current() const {
    if (!currentMm_ || !list()) return std::nullopt;
    std::optional<std::size_t> nearest;
    double least = samePatchMm;
    for (std::size_t n = 0; n < list()->patches.size(); ++n) {
        const double apart = glm::distance(list()->patches[n].place.positionMm, *currentMm_);
        if (apart < least) least = apart, nearest = n;
    }
    return nearest;
}

void MissedReading::setCurrent(std::size_t patch) {
    rank_ = patch;
    currentMm_ = list()->patches[patch].place.positionMm;
}

// In the place of one that has been seen stands the one after it.
std::optional<MissedPlace> MissedReading::takeWanted(bool& none) {
    none = false;
    if (!wanted_ || !list()) return std::nullopt;
    const int step = *std::exchange(wanted_, std::nullopt);
    const auto here = current();
    std::ptrdiff_t to = std::ptrdiff_t(here.value_or(rank_));
    if (currentMm_ && (here || step < 0)) to += step;
    none = to < 0 || to >= std::ptrdiff_t(list()->patches.size());
    if (none) return std::nullopt;
    setCurrent(std::size_t(to));
    return list()->patches[std::size_t(to)];
}

}  // namespace haustra::reader
