#include "session/kept_shown.h"

#include <algorithm>
#include <utility>

namespace haustra::session {

void KeptShown::read(SeenLedger& ledger) {
    read_ = &ledger;
    ledger.news().listen(weak_from_this(),
                         [this, of = &ledger](const auto& told) { heard(*of, told); });
}

void KeptShown::caseLeft() {
    giveUpFrom(std::ranges::find_if(
        steps_, [&](const Step& step) { return step.hasFailed && step.of.get() != read_; }));
    read_ = nullptr;
}

void KeptShown::given(std::shared_ptr<SeenLedger> ledger, std::uint64_t step,
                      std::uint64_t number) {
    keeps_ &= ledger->isRecorded();
    if (keeps_) steps_.push_back({std::move(ledger), step, number});
}

void KeptShown::giveUpFrom(std::deque<Step>::iterator first) {
    if (first == steps_.end()) return;
    steps_.erase(first, steps_.end());
    keeps_ = false;
}

void KeptShown::heard(const SeenLedger& of, const SeenLedger::Told& told) {
    const auto waits = [&](const Step& step) { return step.of.get() == &of && !step.isKept; };
    const auto first = std::ranges::find_if(steps_, waits);
    if (first == steps_.end()) return;
    for (Step& step : steps_) {
        if (!waits(step)) continue;
        step.hasFailed = told.error.has_value();
        step.isKept = told.recorded && step.step <= told.step;
    }
    if (!told.recorded) giveUpFrom(first);
    // In the order in which they were told of, whichever ledger had them.
    const std::uint64_t before = number_;
    for (; !steps_.empty() && steps_.front().isKept; steps_.pop_front())
        number_ = steps_.front().number;
    if (&of == read_) return;
    if (told.error)
        outlet_.notWritten(*told.error);
    else if (number_ != before)
        outlet_.rose();
}

}  // namespace haustra::session
