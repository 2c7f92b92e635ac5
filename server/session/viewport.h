// One viewport of a session: what it is to show.
#pragma once

#include "core/result.h"
#include "protocol/haustra.pb.h"
#include "render/optics/optics_presets.h"
#include "session/picture_job.h"

#include <cstdint>
#include <optional>

namespace haustra::session {

inline bool isFlat(protocol::View view) {
    return view == protocol::FLATTENED || view == protocol::FLATTENED_ZOOM;
}

/// The preset that an overview shows the body with, where the server has one of this name.
inline constexpr char bodyPreset[] = "body";

/// A plain value. Each apply() checks a message against PROTOCOL.md §4 and changes the viewport,
/// or fails (badInput) and leaves it as it was. Sequence, viewport number and whether the case has
/// a cleansed scan or has been flattened are the caller's.
class Viewport {
public:
    /// Width or height 0 closes. A change of view forgets all else.
    Result<void> apply(const protocol::SetViewport& message);
    Result<void> apply(const protocol::SetCamera& message);
    Result<void> apply(const protocol::SetSlice& message);
    Result<void> apply(const protocol::SetOblique& message);
    Result<void> apply(const protocol::SetOverview& message);
    Result<void> apply(const protocol::SetFlat& message);
    Result<void> apply(const protocol::SetWindowLevel& message);
    Result<void> apply(const protocol::SetTransferFunction& message,
                       const render::PresetLibrary& presets);

    bool isOpen() const { return width_ > 0; }
    /// Open, and it has been told where to look.
    bool isDrawable() const {
        return isOpen() && (camera_ || slicePositionMm_ || oblique_ || overview_ || flat_);
    }
    /// A view of the wall, which paint colours.
    bool showsWall() const;
    /// The newest camera, slice or place said that more would follow, and rest() has not been
    /// called.
    bool moving() const { return moving_; }
    void rest() { moving_ = false; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Only of one that is drawable. `presets`: what it is shown by where it was told nothing.
    AnyView view(const render::PresetLibrary& presets) const;

private:
    protocol::View view_ = protocol::ENDOSCOPIC;
    int width_ = 0, height_ = 0;
    std::optional<render::Camera> camera_;
    std::optional<glm::dvec3> slicePositionMm_;
    double zoom_ = 1.0;
    render::Scan scan_ = render::Scan::original;
    render::WindowLevel window_;
    std::optional<render::ObliqueView> oblique_;
    std::optional<render::OverviewView> overview_;
    std::optional<FlatWindow> flat_;
    std::optional<Optics> optics_;  ///< none: a preset
    bool moving_ = false;
};

}  // namespace haustra::session
