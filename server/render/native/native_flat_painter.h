// Draws windows onto the flattened wall on the CPU's vector units.
#pragma once

#include "render/flat/flat_geometry.h"
#include "render/native/flat_packets.h"
#include "render/native/native_scene.h"
#include "render/scene/raycaster.h"

#include <memory>

namespace haustra::render {

/// Each pixel's triangle is found by scan lines, then its ray cast; the same pictures as
/// FlatPainter's. Belongs to one thread.
class NativeFlatPainter {
public:
    /// Fails (badInput) where the map has over 2³¹ bytes of vertices or triangles.
    static Result<NativeFlatPainter> create(std::shared_ptr<NativeScene> scene,
                                            std::shared_ptr<const FlatGeometry> geometry);

    /// The band's rows alone. The window must have passed its check, the band too. Fails (badInput)
    /// on bad optics or sampling.
    Result<Image> draw(const FlatView& view, const Band& band);

private:
    NativeFlatPainter(std::shared_ptr<NativeScene> scene,
                      std::shared_ptr<const FlatGeometry> geometry);
    std::shared_ptr<NativeScene> scene_;
    std::shared_ptr<const FlatGeometry> geometry_;
    CastFlat cast_;
};

}  // namespace haustra::render
