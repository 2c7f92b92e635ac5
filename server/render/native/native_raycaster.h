// The image-order raycaster on the CPU's vector units.
#pragma once

#include "render/native/native_scene.h"
#include "render/scene/raycaster.h"

#include <memory>

namespace haustra::render {

/// Packets of rays, one in each lane of the widest vectors that the machine has, over all cores. It
/// reads the volume where the scene has it, and uses no GL. Rays leap over empty blocks, and those
/// of a tile share the way through the empty space around the eye.
class NativeRaycaster final : public Raycaster {
public:
    explicit NativeRaycaster(std::shared_ptr<NativeScene> scene);
    static std::unique_ptr<NativeRaycaster> create(std::shared_ptr<const Scene> scene,
                                                   int threads = 0);

    RaycasterKind kind() const override { return RaycasterKind::native; }
    Result<void> render(const CameraView& view, const Band& band, Image& picture) override;
    std::vector<PassTime> passTimes() const override { return passes_; }

private:
    std::shared_ptr<NativeScene> scene_;
    CameraPackets packets_;
    std::vector<PassTime> passes_;
};

}  // namespace haustra::render
