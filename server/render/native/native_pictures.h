// Slices and flattened views, drawn on the CPU's vector units.
#pragma once

#include "render/flat/flat_geometry.h"
#include "render/native/native_scene.h"
#include "render/native/packets.h"
#include "render/scene/case_pictures.h"

#include <memory>

namespace haustra::render {

/// Of a flattened view each pixel's triangle is found by scan lines, then its ray cast; the same
/// pictures as GlPictures'. Belongs to one thread.
class NativePictures final : public CasePictures {
public:
    /// `ct` is the scan before cleansing; `geometry` is null where the case has no flat map. Fails
    /// (badInput) where the map has over 2³¹ bytes of vertices or triangles.
    static Result<std::unique_ptr<NativePictures>> create(
        std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct,
        std::shared_ptr<const FlatGeometry> geometry);

    Result<Image> slice(const SlicePicture& picture, const Band& band) override;
    Result<Image> flat(const FlatView& view, const Band& band) override;

private:
    NativePictures(std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct,
                   std::shared_ptr<const FlatGeometry> geometry);
    std::shared_ptr<NativeScene> scene_;
    PacketVolume ct_;
    std::shared_ptr<const FlatGeometry> geometry_;
    DrawSlice drawSlice_;
    CastFlat castFlat_;
};

}  // namespace haustra::render
