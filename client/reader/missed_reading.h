// The review of what of the wall has been missed: patch by patch, the largest first (Kreeger et al.
// 2002).
#pragma once

#include "reader/session.h"

#include <optional>
#include <vector>

namespace haustra::reader {

/// The server's list of patches, kept up to date while somebody looks at it, and where in it the
/// reader is. Patches that have been seen leave it. Belongs to the session's thread; the session
/// must outlive it.
class MissedReading {
public:
    explicit MissedReading(Session& session) : session_(session) {}
    /// Another case is open.
    void open();

    /// Whether the case has been flattened, and the server keeps a ledger.
    bool has() const;
    /// Whether the list is kept up to date by itself; else it is once a patch is asked for.
    void setWatched(bool watched) { watched_ = watched; }
    /// One step of the loop: asks for the list again where more has been seen since.
    void update(Clock::time_point now);

    /// Null before the server has told.
    const MissedList* list() const;
    /// The patch that the reader is at; none where it has been seen since.
    std::optional<std::size_t> current() const;
    /// The reader is at this one, by a click in the list: the last of the way from now on.
    void setCurrent(std::size_t patch);

    /// A patch is to be gone to, once the list is there: the largest that has not been visited in
    /// this round, and after the last of them the largest that is left; −1: the one before, of
    /// those that were visited and are still there. After −1, onward goes the same way again first.
    void want(int step) { wanted_ = step; }
    /// The one that is to be gone to now, which becomes the current one. Once; where there is none,
    /// `none` is set instead.
    std::optional<MissedPlace> takeWanted(bool& none);

private:
    std::optional<std::size_t> patchAt(glm::dvec3 placeMm) const;
    std::optional<std::size_t> firstUnvisited() const;

    Session& session_;
    bool watched_ = false;
    std::optional<int> wanted_;
    std::vector<glm::dvec3> visited_;     // middles of those that were gone to in this round
    std::size_t at_ = 0;                  // which of them the reader is at
    std::optional<double> askedAtShare_;  // what had been seen when the list was asked for
    std::uint64_t asked_ = 0;
    Clock::time_point askAfter_{};
};

}  // namespace haustra::reader
