// Reading with detection: when findings are shown, which of them the reader is at.
#pragma once

#include "reader/session.h"

#include <span>

namespace haustra::reader {

/// Belongs to the session's thread; the session must outlive it.
class FindingsReading {
public:
    explicit FindingsReading(Session& session) : session_(session) {}
    /// Another case is open.
    void open() { current_ = 0; }

    /// Whether the open case has findings that the server can show. Not while another case is being
    /// opened: what is chosen meanwhile would be chosen for that one.
    bool has() const;
    const DetectionChoice& choice() const { return session_.detection(); }
    /// Fails, with a sentence for the reader, where the case has none, or the server cannot show
    /// them.
    Result<void> choose(const DetectionChoice& choice);
    /// Another mode begins with the first reading still to be done.
    Result<void> choose(DetectionMode mode);
    /// Of a second reader: findings may be shown now.
    Result<void> finishFirstPass();

    /// Those that are shown, along the colon; empty while none may be.
    std::span<const ListedFinding> shown() const;
    const ListedFinding* find(int number) const;
    /// The one that was gone to last, while it is shown.
    const ListedFinding* current() const { return find(current_); }
    void setCurrent(int number) { current_ = number; }
    /// The next (or, with −1, previous) along the colon: from the current one, where the reader
    /// is still at its arc, else from the arc. Null where there is none.
    const ListedFinding* next(int step, double arcMm) const;

private:
    bool isLeft() const;

    Session& session_;
    int current_ = 0;
};

}  // namespace haustra::reader
