#include "session/picture_job.h"

#include <algorithm>
#include <type_traits>

namespace haustra::session {

DrawingKind kindOf(const AnyView& view) {
    DrawingKind kind{.view = view.index()};
    std::visit(
        [&](const auto& any) {
            if constexpr (requires { any.slab; }) kind.slab = any.slab;
            if constexpr (requires { any.optics; }) kind.optics = any.optics;
            if constexpr (requires { any.body; }) kind.body = any.body;
            if constexpr (requires { any.beneathWallMm; })
                kind.beneathWall = any.beneathWallMm > 0.0;
        },
        view);
    return kind;
}

bool canBeCoarse(const AnyView& view) {
    return std::visit(
        [](const auto& any) {
            if constexpr (requires { any.slab; })
                return any.slab.thicknessMm > 0.0;
            else if constexpr (requires { any.optics; })
                return !std::is_same_v<decltype(any), const render::FlatOverview&>;
            else
                return false;
        },
        view);
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
