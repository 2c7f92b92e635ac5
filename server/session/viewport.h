// One viewport of a session: what it is to show.
#pragma once

#include "core/result.h"
#include "core/view.h"
#include "protocol/haustra.pb.h"
#include "render/optics/optics_presets.h"
#include "session/picture_job.h"

#include <optional>

namespace haustra::session {

/// The preset that an overview shows the body with, where the server has one of this name.
inline constexpr char bodyPreset[] = "body";

/// Through a lens one sees so far beneath the wall: as far as detection does (§6.2.4).
inline constexpr double lensDepthMm = 20.0;

/// A plain value. Sequence, viewport number and whether the case has what the viewport shows are
/// the caller's.
class Viewport {
public:
    /// Takes an input of one viewport: checks it against PROTOCOL.md §4 and changes this, or fails
    /// (badInput) and leaves it as it was. Width or height 0 closes; a change of view forgets all
    /// else.
    Result<void> apply(const protocol::ClientMessage& message,
                       const render::PresetLibrary& presets);

    bool isOpen() const { return width_ > 0; }
    /// Open, and it has been told where to look.
    bool isDrawable() const { return isOpen() && state_; }
    View kind() const { return view_; }
    /// Where it looks, if it has been told.
    const std::optional<ViewState>& state() const { return state_; }
    /// The newest camera, slice or place said that more would follow, and rest() has not been
    /// called.
    bool moving() const { return moving_; }
    void rest() { moving_ = false; }
    /// Its pictures have the wall's paint; those of what lies beneath the wall have none.
    bool isPainted() const { return showsWall(view_) && !lens_; }
    int width() const { return width_; }
    int height() const { return height_; }
    /// Only of one that is drawable. `presets`: what it is shown by where it was told nothing.
    AnyView view(const render::PresetLibrary& presets) const;

private:
    Result<void> open(const protocol::SetViewport& message);

    View view_ = haustra::View::endoscopic;
    bool lens_ = false;
    int width_ = 0, height_ = 0;
    std::optional<ViewState> state_;
    WindowLevel window_;            ///< of views in grey
    std::optional<Optics> optics_;  ///< of all others; none: a preset
    bool moving_ = false;
};

}  // namespace haustra::session
