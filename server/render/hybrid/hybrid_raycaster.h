// The hybrid raycaster: the CPU finds where rays begin and end, the GPU integrates between
// (dissertation §5.3).
#pragma once

#include "render/gl/gl_scene.h"
#include "render/hybrid/balance.h"
#include "render/scene/raycaster.h"

#include <memory>
#include <optional>

namespace haustra::render {

struct HybridOptions {
    int threads = 0;  ///< of the CPU's half (≤ 0: all cores); changes no pixel
    /// Always these; none: balanced by the measured times.
    std::optional<HybridControls> controls = std::nullopt;
};

/// What a picture has cost.
struct HybridStats {
    double cpuMs = 0.0;   ///< in which rays were determined and followed
    double gpuMs = 0.0;   ///< in which slabs were cast and holes filled, by the GPU's clock
    int passes = 0;       ///< over slabs
    int quads = 0;        ///< of the picture
    int quadsCast = 0;    ///< summed over all passes
    int quadsFilled = 0;  ///< that were left to the filling of holes
    HybridControls controls;
};

/// Rays are grouped into tiles, and in them into quads of two by two. On the CPU, all cores find
/// where each ray begins and ends in the min-max octree, a strip of tiles at a time; the GPU casts
/// the first slab of a strip while the CPU is at the next. Then, pass by pass, the GPU casts a slab
/// of the quads that go on, and meanwhile the CPU finds which of them end in it. Quads of which
/// some rays have ended, and tiles of which few quads go on, wait for the last pass, which casts
/// their rays to the end. The CPU waits for the GPU once, for the picture.
///
/// The estimate never ends a ray too early, the slabs hand on what they have gathered as it is, and
/// what the CPU skips is what the leap map skips: pixels are the single pass's to the bit, whatever
/// the controls.
class HybridRaycaster final : public Raycaster {
public:
    static Result<std::unique_ptr<HybridRaycaster>> create(std::shared_ptr<GlScene> scene,
                                                           HybridOptions options = {});
    ~HybridRaycaster() override;

    RaycasterKind kind() const override { return RaycasterKind::hybrid; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    std::size_t gpuBytes() const override;  ///< without the scene's
    std::vector<PassTime> passTimes() const override;
    /// Of the last band.
    const HybridStats& stats() const;
    /// How often the octree was classified anew: once for each transfer function, as long as no
    /// more than four take turns.
    int classifications() const;

private:
    struct Impl;
    explicit HybridRaycaster(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::render
