// What the client says to the server, from its own types.
#pragma once

#include "protocol/haustra.pb.h"
#include "reader/case_info.h"

namespace haustra::reader {

/// What every input of a viewport says first.
struct InputHeader {
    std::uint64_t sequence;  ///< that the answering picture will reach
    int viewport;
    bool moving = false;  ///< the hand is not at rest; window level and colours do not tell
};

protocol::ClientMessage viewportMessage(InputHeader header, View view, int width, int height);
protocol::ClientMessage inputMessage(InputHeader header, const Camera& camera);
protocol::ClientMessage inputMessage(InputHeader header, const Slice& slice);
/// Of View::flattened the window is ignored.
protocol::ClientMessage inputMessage(InputHeader header, const FlatWindow& window);
protocol::ClientMessage inputMessage(InputHeader header, const Oblique& oblique);
protocol::ClientMessage inputMessage(InputHeader header, const Overview& overview);
protocol::ClientMessage inputMessage(InputHeader header, const WindowLevel& window);
protocol::ClientMessage inputMessage(InputHeader header, const OpticsChoice& optics);

protocol::ClientMessage paintMessage(std::uint64_t sequence, const WallPaint& paint);

protocol::ClientMessage bookmarkMessage(std::uint64_t request, const Bookmark& bookmark);
protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec2 flat);
protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec3 positionMm);
protocol::ClientMessage measureMessage(std::uint64_t request, const std::vector<glm::dvec2>& points,
                                       bool closed);

}  // namespace haustra::reader
