#include "session/picture_job.h"

namespace haustra::session {

bool inBands(const AnyView& view) {
    return std::holds_alternative<render::CameraView>(view) ||
           std::holds_alternative<render::OverviewView>(view);
}

bool canBeCoarse(const AnyView& view) {
    return std::holds_alternative<render::CameraView>(view) ||
           std::holds_alternative<render::OverviewView>(view) ||
           std::holds_alternative<render::FlatView>(view);
}

AnyView scaledView(AnyView view, int fromWidth, int toWidth) {
    if (auto* flat = std::get_if<render::FlatView>(&view))
        flat->window.pixelsPerUnit *= double(toWidth) / fromWidth;
    return view;
}

}  // namespace haustra::session
