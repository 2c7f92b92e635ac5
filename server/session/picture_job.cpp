#include "session/picture_job.h"

#include <algorithm>

namespace haustra::session {

bool canBeCoarse(const AnyView& view) {
    return std::holds_alternative<render::CameraView>(view) ||
           std::holds_alternative<render::OverviewView>(view) ||
           std::holds_alternative<render::FlatView>(view);
}

void setPaint(AnyView& view, std::shared_ptr<const render::WallPaint> paint) {
    std::visit(
        [&](auto& any) {
            if constexpr (requires { any.paint; }) any.paint = std::move(paint);
        },
        view);
}

AnyView scaledView(AnyView view, int fromWidth, int toWidth) {
    // At the widest, rounding must not make it a hair wider.
    if (auto* flat = std::get_if<render::FlatView>(&view))
        flat->window.pixelsPerUnit = std::max(flat->window.pixelsPerUnit * toWidth / fromWidth,
                                              double(toWidth) / render::maxCircumferences);
    return view;
}

}  // namespace haustra::session
