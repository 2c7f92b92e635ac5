#include "session/viewport.h"

#include "protocol/framing.h"
#include "session/inputs.h"

#include <cmath>

namespace haustra::session {
namespace {

tl::unexpected<Error> refuse(std::string message) {
    return fail(ErrorKind::badInput, std::move(message), "viewport");
}

}  // namespace

Result<void> Viewport::apply(const protocol::SetViewport& message) {
    if (message.width() == 0 || message.height() == 0) {
        *this = Viewport{};
        return {};
    }
    const auto view = viewFrom(message.view());
    if (!view) return tl::make_unexpected(view.error());
    constexpr std::uint32_t low = minViewportPixels, high = protocol::maxViewportPixels;
    if (message.width() < low || message.height() < low || message.width() > high ||
        message.height() > high)
        return refuse("a side is not within " + std::to_string(low) + " to " +
                      std::to_string(high) + " pixels");
    if (*view != view_) *this = Viewport{};
    view_ = *view;
    width_ = int(message.width());
    height_ = int(message.height());
    return {};
}

Result<void> Viewport::apply(const protocol::SetCamera& message) {
    if (view_ != render::View::endoscopic) return refuse("a slice takes no camera");
    const auto camera = cameraFrom(message);
    if (!camera) return tl::make_unexpected(camera.error());
    camera_ = *camera;
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetSlice& message) {
    if (view_ == render::View::endoscopic) return refuse("an endoscopic view takes no slice");
    const auto position = positionFrom(message.position_mm());
    if (!position) return tl::make_unexpected(position.error());
    if (!(message.zoom() >= 1.0 && message.zoom() <= 64.0))
        return refuse("the zoom is not within 1 to 64");
    slicePositionMm_ = *position;
    zoom_ = message.zoom();
    scan_ = message.cleansed() ? render::Scan::cleansed : render::Scan::original;
    moving_ = message.moving();
    return {};
}

Result<void> Viewport::apply(const protocol::SetWindowLevel& message) {
    if (view_ == render::View::endoscopic) return refuse("an endoscopic view takes no window");
    const protocol::WindowLevel& window = message.window();
    if (!(std::abs(window.center_hu()) <= 65536.0) ||
        !(window.width_hu() >= 1.0 && window.width_hu() <= 65536.0))
        return refuse("the window is not of 1 to 65536 HU around -65536 to 65536 HU");
    window_ = {window.center_hu(), window.width_hu()};
    return {};
}

Result<void> Viewport::apply(const protocol::SetTransferFunction& message) {
    if (view_ != render::View::endoscopic) return refuse("a slice takes no transfer function");
    auto function = transferFunctionFrom(message);
    if (!function) return tl::make_unexpected(function.error());
    transferFunction_ = std::move(*function);
    return {};
}

std::variant<render::EndoscopicView, render::SliceView> Viewport::view() const {
    if (view_ != render::View::endoscopic)
        return render::SliceView{view_, *slicePositionMm_, zoom_, window_, scan_};
    render::EndoscopicView view;
    view.camera = *camera_;
    view.transferFunction =
        transferFunction_
            ? *transferFunction_
            : *render::transferFunctionPreset(render::transferFunctionPresets().front());
    return view;
}

}  // namespace haustra::session
