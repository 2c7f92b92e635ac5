// A picture that a session has asked for.
#pragma once

#include "core/result.h"
#include "protocol/framing.h"
#include "render/scene/picture.h"
#include "session/open_case.h"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <variant>

namespace haustra::session {

using Clock = std::chrono::steady_clock;
using SessionId = std::uint64_t;

using AnyView = std::variant<render::CameraView, SliceView, ObliqueView, render::OverviewView,
                             render::FlatView, render::FlatOverview>;

/// One picture to draw. Immutable once it waits.
struct PictureJob {
    SessionId session = 0;
    std::shared_ptr<const OpenCase> of;
    AnyView view;
    int width = 0, height = 0;
    bool moving = false;  ///< the hand moves: soon there will be a newer one
    bool coarse = false;  ///< the client takes it smaller than width × height
    /// What the picture answers: viewport, codec, exact and sequence are set.
    protocol::TileHeader header;
    Clock::time_point inputAt;  ///< when its newest input arrived
    /// Called on the render thread with the job's own header, filled in.
    std::function<void(const protocol::TileHeader&, Result<Image>)> done;
};

/// What, beside the place, decides how long a picture takes to draw.
struct DrawingKind {
    std::size_t view = 0;  ///< which of AnyView's
    Slab slab{};           ///< of views that can have one
    Optics optics{};       ///< of views that have them
    bool body = false;     ///< of an overview
    bool beneathWall = false;
    bool operator==(const DrawingKind&) const = default;
};
DrawingKind kindOf(const AnyView& view);

/// Whether a smaller picture of this view shows the same, coarser, and saves time: slices that are
/// no slabs are drawn in no time, and the whole strip never moves.
bool canBeCoarse(const AnyView& view);
/// The view as it is to be drawn into a picture of another width, which shows the same.
AnyView scaledView(AnyView view, int fromWidth, int toWidth);
/// Colours the wall, in views that show it; null: it has its own colours.
void setPaint(AnyView& view, std::shared_ptr<const render::WallPaint> paint);

}  // namespace haustra::session
