// Between the client's types and the protocol's messages. What the server sends is checked here:
// beyond this file a case has a sound grid and a centerline with finite, ordered samples.
#pragma once

#include "panels/case_info.h"
#include "protocol/haustra.pb.h"

namespace haustra::panels {

protocol::ClientMessage viewportMessage(std::uint64_t sequence, int viewport, View view, int width,
                                        int height);
protocol::ClientMessage cameraMessage(std::uint64_t sequence, int viewport, const Camera& camera,
                                      bool moving);
protocol::ClientMessage sliceMessage(std::uint64_t sequence, int viewport, const Slice& slice,
                                     bool moving);
protocol::ClientMessage windowMessage(std::uint64_t sequence, int viewport,
                                      const WindowLevel& window);
protocol::ClientMessage transferMessage(std::uint64_t sequence, int viewport,
                                        const std::string& preset);
protocol::ClientMessage bookmarkMessage(std::uint64_t request, const Bookmark& bookmark);

/// Fails, naming the field, where the server's description of the case is not sound.
Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message);
Bookmark bookmarkFrom(const protocol::Bookmark& message);

}  // namespace haustra::panels
