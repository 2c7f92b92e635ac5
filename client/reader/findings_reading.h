// Reading with detection: when findings are shown, which of them the reader is at.
#pragma once

#include "reader/session.h"

#include <optional>
#include <span>
#include <utility>

namespace haustra::reader {

/// Belongs to the session's thread; the session must outlive it.
class FindingsReading {
public:
    explicit FindingsReading(Session& session) : session_(session) {}
    /// Another case is open.
    void open() { current_.reset(); }

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
    /// The one that was gone to last, while it is shown; none of a list that is made anew.
    const ListedFinding* current() const;
    void setCurrent(std::optional<ListedFinding> finding) { current_ = std::move(finding); }
    /// The next (or, with −1, previous) along the colon: after the current one, so that none is
    /// passed over, while the reader is within besideMm of its arc, as who looks around at it is;
    /// else from the arc on. Null where there is none.
    const ListedFinding* next(int step, double arcMm) const;
    static constexpr double besideMm = 40.0;

private:
    bool isLeft() const;

    Session& session_;
    std::optional<ListedFinding> current_;
};

}  // namespace haustra::reader
