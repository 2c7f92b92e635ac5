// Up to which TellShown of a session all is kept, whatever cases it was of.
#pragma once

#include "session/seen_ledger.h"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>

namespace haustra::session {

/// Outlives a session's readings: the ledger of a case that was left lives here until all that it
/// was given is on the disk. Belongs to the io thread.
class KeptShown : public std::enable_shared_from_this<KeptShown> {
public:
    /// Of ledgers that the session does not read any more; whoever reads one listens to it.
    struct Outlet {
        std::function<void()> rose;                          ///< number() has
        std::function<void(const Error& error)> notWritten;  ///< or not yet
    };
    explicit KeptShown(Outlet outlet) : outlet_(std::move(outlet)) {}

    /// From now on this is the one that is read. Who listens to it after this learns what is new
    /// after this has.
    void read(SeenLedger& ledger);
    /// The case is left, and its ledger not read any more. One that was left before, and could not
    /// be written, is given up: a disk that fails shall not hold one case after the other.
    void caseLeft();
    /// The ledger has taken in as `step` what the TellShown of this number, which grows, has told.
    void given(std::shared_ptr<SeenLedger> ledger, std::uint64_t step, std::uint64_t number);

    /// What the TellShown of this number and all before it has told is kept, but for what the
    /// client has been told cannot be.
    std::uint64_t number() const { return number_; }

private:
    struct Step {
        std::shared_ptr<SeenLedger> of;
        std::uint64_t step, number;
        bool isKept = false, hasFailed = false;
    };
    void heard(const SeenLedger& of, const SeenLedger::Told& told);
    void raise();

    Outlet outlet_;
    const SeenLedger* read_ = nullptr;
    std::deque<Step> steps_;  // in the order of their numbers, the first is not kept yet
    std::uint64_t number_ = 0;
};

}  // namespace haustra::session
