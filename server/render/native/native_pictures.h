// Slices and flattened views, drawn on the CPU's vector units.
#pragma once

#include "render/native/native_flat_painter.h"
#include "render/native/native_scene.h"
#include "render/native/slice_packets.h"
#include "render/scene/case_pictures.h"

#include <memory>
#include <optional>

namespace haustra::render {

class NativePictures final : public CasePictures {
public:
    /// `ct` is the scan before cleansing; `geometry` is null where the case has no flat map. Fails
    /// as NativeFlatPainter::create does.
    static Result<std::unique_ptr<NativePictures>> create(
        std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct,
        std::shared_ptr<const FlatGeometry> geometry);

    Result<Image> slice(const SlicePlacement& placement, const WindowLevel& window, Scan scan,
                        const Band& band) override;
    Result<Image> flat(const FlatView& view, const Band& band) override;

private:
    NativePictures(std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct);
    std::shared_ptr<NativeScene> scene_;
    PacketVolume ct_;
    DrawSlice drawSlice_;
    std::optional<NativeFlatPainter> flat_;
};

}  // namespace haustra::render
