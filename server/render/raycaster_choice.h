// Which raycaster draws a case fastest on this machine, found by trying them.
#pragma once

#include "render/scene/raycaster.h"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace haustra::render {

/// How long a choice may take, and how sure it shall be.
struct ChoiceLimits {
    double timedMs = 500.0;    ///< of all timed pictures; the one under way is finished
    double makingMs = 2000.0;  ///< of those that do not count, with which candidates are made
    int rounds = 4;            ///< timed pictures of a candidate
    double hopeless = 3.0;     ///< a candidate so many times slower than the best is tried no more
};

/// One candidate, and what trying it has shown.
struct RaycasterTrial {
    RaycasterKind kind = RaycasterKind::native;
    std::vector<double> ms;   ///< of each timed picture
    std::string failure;      ///< why it cannot draw here; empty where it can
    double medianMs() const;  ///< of an even number the lower of the middle two; ms is not empty
};

/// Says what to try next and judges by the medians. It draws nothing and has no clock: the caller
/// draws picture after picture, at its own time, and tells what each took.
///
///     while (const auto next = choice.next()) draw… choice.took(ms) or choice.failed(why);
///
/// Each candidate draws one picture that does not count (its tables and programs are made), then
/// one of each round, in turn with the others, so that what else the machine does meanwhile
/// disturbs all alike; equal rounds show equal views. When the time is up, those that have been
/// timed are judged, and the first of the candidates always has been.
class RaycasterChoice {
public:
    /// Candidates in the order of preference, which settles ties; at least one.
    RaycasterChoice(const std::vector<RaycasterKind>& candidates, ChoiceLimits limits);

    struct Next {
        RaycasterKind kind;
        int round;   ///< 0… of this candidate
        bool timed;  ///< else the picture that does not count
    };
    /// Empty where the choice is made.
    std::optional<Next> next() const;
    void took(double ms);
    void failed(std::string why);

    /// The candidate with the least median; none where all have failed.
    std::optional<RaycasterKind> fastest() const;
    const std::vector<RaycasterTrial>& trials() const { return trials_; }

private:
    bool hopeless(const RaycasterTrial& trial) const;
    std::optional<std::size_t> due() const;

    std::vector<RaycasterTrial> trials_;
    std::vector<bool> warm_;  // has drawn the picture that does not count
    ChoiceLimits limits_;
    double timedMs_ = 0.0, makingMs_ = 0.0;
};

/// The raycasters to try, the preferred first: the native one on a device that draws in software,
/// the single-pass one on a GPU.
std::vector<RaycasterKind> raycasterCandidates(bool softwareDevice);

/// "native 21.4 ms (4 pictures), single-pass 95.0 ms (1 picture), hybrid: not tried, the time for
/// trials was up": medians, of one picture where that was hopelessly slow or the time was up.
std::string describe(const std::vector<RaycasterTrial>& trials);

}  // namespace haustra::render
