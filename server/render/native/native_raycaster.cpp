#include "render/native/native_raycaster.h"

#include "render/scene/ray_setup.h"

#include <chrono>
#include <utility>

namespace haustra::render {

NativeRaycaster::NativeRaycaster(std::shared_ptr<NativeScene> scene)
    : scene_(std::move(scene)), packets_(cameraPackets()) {}

std::unique_ptr<NativeRaycaster> NativeRaycaster::create(std::shared_ptr<const Scene> scene,
                                                         int threads) {
    return std::make_unique<NativeRaycaster>(
        std::make_shared<NativeScene>(std::move(scene), threads));
}

Result<void> NativeRaycaster::render(const CameraView& view, const Band& band, Image& picture) {
    const auto start = std::chrono::steady_clock::now();
    TRY(checkBand(band, picture));
    TRY(checkCameraView(view, band.pictureSize));
    const auto classified = TRY(scene_->classification(view.optics, view.march));
    const Scene& scene = scene_->scene();
    const PacketScene packets = scene_->packetScene(
        marchUniforms(view, scene.grid(), classified->table, scene.ranges.size, band.pictureSize),
        *classified);
    const PacketPicture target{band.firstRow, band.firstRow + band.rows, picture.rgb.data(),
                               view.backdrop ? view.backdrop->pixels.data() : nullptr};
    // Tiles lie on the whole picture's lattice: packets are the same in any band.
    const int columns = (band.pictureSize.x + packets_.tileWidth - 1) / packets_.tileWidth;
    const int firstRow = target.firstRow / packets_.tileHeight;
    const int rows = (target.endRow - 1) / packets_.tileHeight - firstRow + 1;
    scene_->pool().run(columns * rows, [&](int tile) {
        packets_.cast(packets, target, tile % columns, firstRow + tile / columns);
    });
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    passes_ = {{"cast", took.count()}};
    return {};
}

}  // namespace haustra::render
