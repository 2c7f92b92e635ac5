// Between the client's types and the protocol's messages. What the server sends is checked here:
// beyond this file a case has a sound grid, a centerline with finite, ordered samples, and a strip
// whose rows are finite and in order.
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
/// Of View::flattened the window is ignored.
protocol::ClientMessage flatMessage(std::uint64_t sequence, int viewport, const FlatWindow& window,
                                    bool moving);
protocol::ClientMessage obliqueMessage(std::uint64_t sequence, int viewport, const Oblique& oblique,
                                       bool moving);
protocol::ClientMessage overviewMessage(std::uint64_t sequence, int viewport,
                                        const Overview& overview, bool moving);
protocol::ClientMessage windowMessage(std::uint64_t sequence, int viewport,
                                      const WindowLevel& window);
protocol::ClientMessage transferMessage(std::uint64_t sequence, int viewport,
                                        const TransferFunction& function);
protocol::ClientMessage bookmarkMessage(std::uint64_t request, const Bookmark& bookmark);
protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec2 flat);
protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec3 positionMm);
protocol::ClientMessage measureMessage(std::uint64_t request, const std::vector<glm::dvec2>& points,
                                       bool closed);

/// Fails, naming the field, where the server's description of the case is not sound.
Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message);
Bookmark bookmarkFrom(const protocol::Bookmark& message);
/// Fail where a number is not finite.
Result<WallPlace> placeFrom(const protocol::WallPlace& message);
Result<FlatMeasure> measureFrom(const protocol::FlatMeasure& message);

}  // namespace haustra::panels
