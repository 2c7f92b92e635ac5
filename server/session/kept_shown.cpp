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
    std::erase_if(steps_,
                  [&](const Step& step) { return step.hasFailed && step.of.get() != read_; });
    read_ = nullptr;
    raise();
}

void KeptShown::given(std::shared_ptr<SeenLedger> ledger, std::uint64_t step,
                      std::uint64_t number) {
    if (ledger->isRecorded()) steps_.push_back({std::move(ledger), step, number});
}

// In the order in which they were told of, whichever ledger had them.
void KeptShown::raise() {
    for (; !steps_.empty() && steps_.front().isKept; steps_.pop_front())
        number_ = steps_.front().number;
}

void KeptShown::heard(const SeenLedger& of, const SeenLedger::Told& told) {
    const auto waits = [&](const Step& step) { return step.of.get() == &of && !step.isKept; };
    if (std::ranges::none_of(steps_, waits)) return;
    for (Step& step : steps_) {
        if (!waits(step)) continue;
        step.hasFailed = told.error.has_value();
        step.isKept = told.recorded && step.step <= told.step;
    }
    // Whoever told that has told why.
    if (!told.recorded) std::erase_if(steps_, waits);
    const std::uint64_t before = number_;
    raise();
    if (&of == read_) return;
    if (told.error)
        outlet_.notWritten(*told.error);
    else if (number_ != before)
        outlet_.rose();
}

}  // namespace haustra::session
