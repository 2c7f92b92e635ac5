// Segmented colour volumes, organ by organ (dissertation §5.2.3).
#pragma once

#include "gpu/context.h"
#include "render/object_order/labelled_color.h"
#include "render/object_order/object_order_raycaster.h"
#include "render/scene/raycaster.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace haustra::render {

/// Draws a colour volume by its own colours and opacities, front to back, or of some labels alone:
/// then only cells that hold one of them are brought to the GPU. Voxels of other labels are clear.
/// Of a view's optics, shading and light are used: shading lights what the opacity's gradient
/// makes a surface. Belongs to the thread of the context.
class LabelledRaycaster final : public Raycaster {
public:
    /// Reads the volume for the cells' label lists; fails as ObjectOrderRaycaster::create does.
    /// Shows everything.
    static Result<std::unique_ptr<LabelledRaycaster>> create(
        gpu::Context& context, std::shared_ptr<const LabelledColorVolume> volume,
        ObjectOrderOptions options = {});
    ~LabelledRaycaster() override;

    /// Shows these labels; none given: everything. Reads the volume's opacities and labels once.
    /// Fails (noResult) where no voxel has one of them.
    Result<void> choose(std::vector<std::int16_t> labels);

    RaycasterKind kind() const override { return RaycasterKind::objectOrder; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    std::size_t gpuBytes() const override;
    std::vector<PassTime> passTimes() const override;
    const ResidencyStats& residency() const;  ///< of the last band

private:
    class ColorCells;
    struct Impl;
    explicit LabelledRaycaster(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::render
