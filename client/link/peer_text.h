// What a peer says to a person.
#pragma once

#include <cstddef>
#include <string>

namespace haustra::link {

inline constexpr std::size_t maxPeerTextBytes = 400;

/// A sentence of the peer's (UTF-8) as a person may be shown it: on one line, without control
/// characters or those that turn the direction of writing round, at most `mostBytes` and "…" where
/// it was longer. With `keepLines`, line feeds and tabs stay. O(mostBytes).
std::string peerText(const std::string& said, std::size_t mostBytes = maxPeerTextBytes,
                     bool keepLines = false);

}  // namespace haustra::link
