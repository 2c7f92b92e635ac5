// The lens through which a reader sees beneath the wall: electronic biopsy over the endoscopic view
// (dissertation §6.2.4, fig. 6.1).
#pragma once

#include "reader/case_info.h"
#include "reader/lens_view.h"
#include "reader/pacing.h"
#include "reader/session.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace haustra::reader {

/// Of the lens, heights of the picture beneath.
inline constexpr double leastLensRadius = 0.04, greatestLensRadius = 0.5;
/// By so much it grows with a step of the wheel.
inline constexpr double lensGrowth = 1.15;
/// Sides of its picture, pixels: what lies beneath the wall is smooth.
inline constexpr int mostLensPixels = 320;

/// Its pictures come in a viewport of their own, so that the picture beneath stays as it is. They
/// are asked for while that one stands still alone. Belongs to the session's thread; the session
/// must outlive it.
class BiopsyLens {
public:
    explicit BiopsyLens(Session& session) : session_(session) {}

    /// The colours of a case's electronic biopsy: those derived from its scan where it has them,
    /// else the fixed ones, else none.
    static std::optional<std::string> presetOf(const CaseInfo& info);

    /// Another case is open. The lens stays on.
    void open(std::shared_ptr<const CaseInfo> info);
    /// The server has it, and the case colours for it.
    bool isAvailable() const;
    /// Colours derived from this scan are shown; else fixed ones.
    bool showsOwnColors() const { return preset_ == scanBiopsyPreset; }

    bool isOn() const { return on_; }
    void setOn(bool on) { on_ = on; }
    /// It stays where it was put last; at first in the picture's middle.
    const LensPlace& place() const { return place_; }
    void moveTo(glm::dvec2 heightsFromMiddle) { place_.center = heightsFromMiddle; }
    void setRadius(double heights);

    /// Takes its pictures out of what has arrived.
    void take(std::deque<link::PictureDone>& arrivals);
    /// Asks for its picture where another is to be seen. `wanted`: the endoscopic camera; `shown`:
    /// of the newest endoscopic picture, or null; `pane`: its size in pixels, 0 where it is out of
    /// sight.
    void update(const Camera& wanted, const Camera* shown, glm::ivec2 pane, Clock::time_point now);
    /// A later update() will ask, even if nothing changes any more.
    bool owes() const { return owes_; }

    /// The newest picture, which registers with an endoscopic picture of this camera; else null.
    const tiles::Picture* pictureOver(const Camera& beneath) const;
    const Camera& pictureCamera() const { return shown_; }
    /// Grows with each picture.
    std::uint64_t pictureCount() const { return count_; }
    /// The picture is the exact one of where the lens is.
    bool isExact() const;

private:
    void close();
    void forgetPicture();

    struct Asked {
        std::uint64_t sequence;
        Camera camera;
    };
    Session& session_;
    std::shared_ptr<const CaseInfo> case_;
    std::optional<std::string> preset_;
    bool on_ = false, owes_ = false;
    LensPlace place_;
    int openSide_ = 0;  // of its viewport; 0: it is closed
    ViewPacer pacer_{std::chrono::milliseconds(15), std::chrono::milliseconds(110)};
    std::optional<Camera> askedCamera_;
    std::deque<Asked> asked_;  // without an answer, oldest first
    tiles::Picture picture_;
    Camera shown_;
    std::uint64_t count_ = 0;
};

}  // namespace haustra::reader
