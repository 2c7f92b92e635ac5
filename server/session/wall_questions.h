// Questions about the wall from the network, checked against PROTOCOL.md §4, and their answers.
#pragma once

#include "protocol/haustra.pb.h"
#include "protocol/limits.h"
#include "session/wall.h"

namespace haustra::session {

/// Each fails (badInput), naming the field, on a value out of its bounds.
Result<WallQuestion> questionFrom(const protocol::LocateFlat& message, const Wall& wall);
Result<WallQuestion> questionFrom(const protocol::LocatePoint& message, const Wall& wall);
Result<WallQuestion> questionFrom(const protocol::MeasureFlat& message, const Wall& wall);

/// How much of a session's share of unanswered requests a question takes.
inline int weightOf(const protocol::LocateFlat&) {
    return 1;
}
inline int weightOf(const protocol::LocatePoint&) {
    return 1;
}
inline int weightOf(const protocol::MeasureFlat&) {
    return protocol::measurementWeight;
}

protocol::ServerMessage messageOf(const WallAnswer& answer, std::uint64_t request);

}  // namespace haustra::session
