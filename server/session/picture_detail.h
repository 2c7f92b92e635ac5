// How large the pictures of a moving viewport are drawn. Pure arithmetic; no clock, no threads.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::session {

/// Moving pictures shall take no longer than this, from the start of drawing to its end.
inline constexpr double movingPictureMs = 50.0;
/// Sides of a coarse picture, as shares of the viewport's.
inline constexpr std::array<double, 5> detailSteps{1.0, 0.75, 0.5, 0.375, 0.25};
/// Coarsening takes no side under so many pixels.
inline constexpr int leastSide = 16;

/// The size of a picture that shows the same as one of `full` pixels, its shorter side `scale`
/// (0…1) of that one's to the nearest pixel, but not under leastSide by it. The longer side follows
/// to the nearest pixel: of the view's edge it shows at most half a pixel more or less.
glm::ivec2 coarseSize(glm::ivec2 full, double scale);

/// What drawing one viewport has cost lately, and from that how much detail it can have.
class PictureDetail {
public:
    /// A picture of so many pixels has taken `ms` of the GPU.
    void drawn(double ms, glm::ivec2 size);
    /// Median of the last three pictures, so that one slow one (a new transfer function's tables)
    /// changes nothing; 0 where none has been drawn.
    double msPerPixel() const;

    /// The size of the next moving picture of a viewport of `full` pixels, where the viewport gets
    /// `share` (over 0, at most 1) of the GPU's time: the finest of detailSteps that is expected to
    /// be ready within movingPictureMs, else the coarsest. Finer than the picture before only
    /// where it is expected to be ready in 4/5 of that, so that sizes do not flicker. Full where
    /// nothing has been measured.
    glm::ivec2 nextSize(glm::ivec2 full, double share);

private:
    std::array<double, 3> recent_{};  // ms a pixel, the newest first
    std::size_t count_ = 0;
    std::size_t step_ = 0;  // of detailSteps
};

}  // namespace haustra::session
