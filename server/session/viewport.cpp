#include "session/viewport.h"

#include "protocol/framing.h"
#include "session/inputs.h"

#include <algorithm>
#include <cmath>

namespace haustra::session {
namespace {

tl::unexpected<Error> refuse(std::string message) {
    return fail(ErrorKind::badInput, std::move(message), "viewport");
}

bool isSlice(protocol::View view) {
    return view == protocol::AXIAL || view == protocol::CORONAL || view == protocol::SAGITTAL;
}

render::View planeOf(protocol::View slice) {
    return slice == protocol::AXIAL     ? render::View::axial
           : slice == protocol::CORONAL ? render::View::coronal
                                        : render::View::sagittal;
}

}  // namespace

bool Viewport::showsWall() const {
    return !isSlice(view_) && view_ != protocol::OBLIQUE;
}

Result<void> Viewport::apply(const protocol::SetViewport& message) {
    if (message.width() == 0 || message.height() == 0) {
        *this = Viewport{};
        return {};
    }
    TRY(checkView(message.view()));
    constexpr std::uint32_t low = minViewportPixels, high = protocol::maxViewportPixels;
    if (message.width() < low || message.height() < low || message.width() > high ||
        message.height() > high)
        return refuse("a side is not within " + std::to_string(low) + " to " +
                      std::to_string(high) + " pixels");
    if (message.view() != view_) *this = Viewport{};
    view_ = message.view();
    width_ = int(message.width());
    height_ = int(message.height());
    return {};
}

Result<void> Viewport::apply(const protocol::SetCamera& message) {
    if (view_ != protocol::ENDOSCOPIC) return refuse("only an endoscopic view takes a camera");
    const auto camera = TRY(cameraFrom(message));
    camera_ = camera;
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetSlice& message) {
    if (!isSlice(view_)) return refuse("this view takes no slice");
    const auto position = TRY(positionFrom(message.position_mm()));
    if (!(message.zoom() >= 1.0 && message.zoom() <= 64.0))
        return refuse("the zoom is not within 1 to 64");
    slicePositionMm_ = position;
    zoom_ = message.zoom();
    scan_ = message.cleansed() ? render::Scan::cleansed : render::Scan::original;
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetOblique& message) {
    if (view_ != protocol::OBLIQUE) return refuse("only an oblique view takes an oblique slice");
    auto oblique = TRY(obliqueFrom(message));
    oblique_ = oblique;
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetOverview& message) {
    if (view_ != protocol::OVERVIEW) return refuse("only an overview shows the colon from outside");
    auto overview = TRY(overviewFrom(message));
    overview_ = std::move(overview);
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetFlat& message) {
    if (!isFlat(view_)) return refuse("this view shows no strip");
    if (view_ == protocol::FLATTENED_ZOOM) {
        const auto window = TRY(flatWindowFrom(message));
        flat_ = window;
    } else {
        flat_ = FlatWindow{};
    }
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetWindowLevel& message) {
    if (!isSlice(view_) && view_ != protocol::OBLIQUE) return refuse("only slices take a window");
    const protocol::WindowLevel& window = message.window();
    if (!(std::abs(window.center_hu()) <= 65536.0) ||
        !(window.width_hu() >= 1.0 && window.width_hu() <= 65536.0))
        return refuse("the window is not of 1 to 65536 HU around -65536 to 65536 HU");
    window_ = {window.center_hu(), window.width_hu()};
    return {};
}

Result<void> Viewport::apply(const protocol::SetTransferFunction& message,
                             const render::PresetLibrary& presets) {
    if (isSlice(view_) || view_ == protocol::OBLIQUE)
        return refuse("a slice takes no transfer function");
    auto optics = TRY(opticsFrom(message, presets));
    optics_ = std::move(optics);
    return {};
}

AnyView Viewport::view(const render::PresetLibrary& presets) const {
    if (isSlice(view_))
        return render::SliceView{planeOf(view_), *slicePositionMm_, zoom_, window_, scan_};
    if (view_ == protocol::OBLIQUE) {
        render::ObliqueView oblique = *oblique_;
        oblique.window = window_;
        return oblique;
    }
    const OpticsPreset* usual = view_ == protocol::OVERVIEW ? presets.find(bodyPreset) : nullptr;
    if (!usual) usual = &presets.presets.front();
    auto optics = optics_.value_or(usual->optics);
    if (view_ == protocol::OVERVIEW) {
        render::OverviewView overview = *overview_;
        overview.optics = std::move(optics);
        return overview;
    }
    if (view_ == protocol::FLATTENED) return render::FlatOverview{std::move(optics), {}};
    if (view_ == protocol::FLATTENED_ZOOM) {
        FlatWindow window = *flat_;
        const double least = double(width_) / render::maxCircumferences;
        window.pixelsPerUnit = std::max(window.pixelsPerUnit, least);
        return render::FlatView{window, std::move(optics), {}};
    }
    return render::CameraView{*camera_, std::move(optics), {}};
}

}  // namespace haustra::session
