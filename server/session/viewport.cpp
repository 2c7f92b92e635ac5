#include "session/viewport.h"

#include "protocol/limits.h"
#include "protocol/view_message.h"
#include "session/messages.h"

#include <algorithm>

namespace haustra::session {
namespace {

tl::unexpected<Error> refused(std::string message) {
    return fail(ErrorKind::badInput, std::move(message), "viewport");
}

/// A state becomes what the renderer draws, with the window or the optics that the viewport has.
struct Dressed {
    const WindowLevel& window;
    Optics optics;
    int width;
    bool lens;

    AnyView operator()(const Camera& camera) {
        render::CameraView view{camera, std::move(optics), {}};
        if (lens) view.beneathWallMm = lensDepthMm;
        return view;
    }
    AnyView operator()(SliceView slice) const {
        slice.window = window;
        return slice;
    }
    AnyView operator()(ObliqueView oblique) const {
        oblique.window = window;
        return oblique;
    }
    AnyView operator()(const Overview& overview) {
        return render::OverviewView{overview, std::move(optics)};
    }
    AnyView operator()(FlatWindow flat) {
        flat.pixelsPerUnit =
            std::max(flat.pixelsPerUnit, double(width) / render::maxCircumferences);
        return render::FlatView{flat, std::move(optics), {}};
    }
    AnyView operator()(const WholeStrip&) { return render::FlatOverview{std::move(optics), {}}; }
};

}  // namespace

Result<void> Viewport::open(const protocol::SetViewport& message) {
    if (message.width() == 0 || message.height() == 0) {
        *this = Viewport{};
        return {};
    }
    const auto view = TRY(protocol::viewFrom(message.view()));
    constexpr std::uint32_t low = protocol::minViewportPixels, high = protocol::maxViewportPixels;
    if (message.width() < low || message.height() < low || message.width() > high ||
        message.height() > high)
        return refused("a side is not within " + std::to_string(low) + " to " +
                       std::to_string(high) + " pixels");
    if (message.lens() && view != View::endoscopic)
        return refused("a lens shows the endoscopic view");
    if (view != view_ || message.lens() != lens_) *this = Viewport{};
    view_ = view;
    lens_ = message.lens();
    width_ = int(message.width());
    height_ = int(message.height());
    return {};
}

Result<void> Viewport::apply(const protocol::ClientMessage& message,
                             const render::PresetLibrary& presets) {
    switch (message.body_case()) {
        case protocol::ClientMessage::kSetViewport:
            return open(message.set_viewport());
        case protocol::ClientMessage::kSetWindowLevel:
            if (!isGrey(view_)) return refused("only slices take a window");
            window_ = TRY(protocol::windowFrom(message.set_window_level().window()));
            return {};
        case protocol::ClientMessage::kSetTransferFunction:
            if (isGrey(view_)) return refused("a slice takes no transfer function");
            optics_ = TRY(opticsFrom(message.set_transfer_function(), presets));
            return {};
        default:
            state_ = TRY(protocol::stateFrom(message, view_));
            moving_ = protocol::inputHeader(message)->moving;
            return {};
    }
}

AnyView Viewport::view(const render::PresetLibrary& presets) const {
    Dressed dressed{window_, {}, width_, lens_};
    if (!isGrey(view_)) {
        const OpticsPreset* usual = view_ == View::overview ? presets.find(bodyPreset) : nullptr;
        if (!usual) usual = &presets.presets.front();
        dressed.optics = optics_.value_or(usual->optics);
    }
    return std::visit(dressed, *state_);
}

}  // namespace haustra::session
