#include "render/raycaster_choice.h"

#include "core/printed_text.h"

#include <algorithm>

namespace haustra::render {

double RaycasterTrial::medianMs() const {
    auto sorted = ms;
    const auto middle = sorted.begin() + std::ptrdiff_t((sorted.size() - 1) / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

RaycasterChoice::RaycasterChoice(const std::vector<RaycasterKind>& candidates, ChoiceLimits limits)
    : warm_(candidates.size()), limits_(limits) {
    for (const RaycasterKind kind : candidates)
        trials_.push_back({kind, {}, {}});
}

bool RaycasterChoice::hopeless(const RaycasterTrial& trial) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const RaycasterTrial& other) {
        return !other.ms.empty() && !trial.ms.empty() &&
               trial.medianMs() > limits_.hopeless * other.medianMs();
    });
}

// First every candidate gets one timed picture, in order; then rounds.
std::optional<std::size_t> RaycasterChoice::due() const {
    const bool late = timedMs_ >= limits_.timedMs;
    std::optional<std::size_t> least;
    for (std::size_t n = 0; n < trials_.size(); ++n) {
        const RaycasterTrial& trial = trials_[n];
        if (!trial.failure.empty()) continue;
        if (trial.ms.empty()) {
            // Late, nobody new is tried, unless nobody has been timed.
            if (warm_[n] || !fastest() || (!late && makingMs_ < limits_.makingMs)) return n;
            continue;
        }
        if (late || int(trial.ms.size()) >= limits_.rounds || hopeless(trial)) continue;
        if (!least || trial.ms.size() < trials_[*least].ms.size()) least = n;
    }
    return least;
}

std::optional<RaycasterChoice::Next> RaycasterChoice::next() const {
    const auto n = due();
    if (!n) return std::nullopt;
    return Next{trials_[*n].kind, int(trials_[*n].ms.size()), bool(warm_[*n])};
}

void RaycasterChoice::took(double ms) {
    const auto n = due();
    if (!n) return;
    (warm_[*n] ? timedMs_ : makingMs_) += ms;
    if (warm_[*n])
        trials_[*n].ms.push_back(ms);
    else
        warm_[*n] = true;
}

void RaycasterChoice::failed(std::string why) {
    const auto n = due();
    if (!n) return;
    trials_[*n].failure = why.empty() ? "it cannot draw here" : std::move(why);
    trials_[*n].ms.clear();
}

std::optional<RaycasterKind> RaycasterChoice::fastest() const {
    const RaycasterTrial* best = nullptr;
    for (const RaycasterTrial& trial : trials_)
        if (!trial.ms.empty() && (!best || trial.medianMs() < best->medianMs())) best = &trial;
    if (!best) return std::nullopt;
    return best->kind;
}

std::vector<RaycasterKind> raycasterCandidates(bool softwareDevice) {
    std::vector<RaycasterEntry> entries(raycasters().begin(), raycasters().end());
    // Cells that come and go are for volumes that do not fit; the CPU is better at what a device
    // draws in software.
    const auto cost = [&](const RaycasterEntry& entry) {
        const bool onCpu = entry.processor == Processor::cpu;
        return onCpu ? (softwareDevice ? 0 : 3) : entry.needsWholeVolume() ? 1 : 2;
    };
    std::stable_sort(entries.begin(), entries.end(),
                     [&](const auto& a, const auto& b) { return cost(a) < cost(b); });
    std::vector<RaycasterKind> kinds;
    for (const RaycasterEntry& entry : entries)
        kinds.push_back(entry.kind);
    return kinds;
}

std::string describe(const std::vector<RaycasterTrial>& trials) {
    std::string text;
    for (const RaycasterTrial& trial : trials) {
        if (!text.empty()) text += ", ";
        text += toString(trial.kind);
        if (trial.ms.empty()) {
            text += trial.failure.empty() ? ": not tried, the time for trials was up"
                                          : ": " + trial.failure;
            continue;
        }
        const std::size_t pictures = trial.ms.size();
        text += printed(" %.1f ms (%zu picture%s)", trial.medianMs(), pictures,
                        pictures == 1 ? "" : "s");
    }
    return text;
}

}  // namespace haustra::render
