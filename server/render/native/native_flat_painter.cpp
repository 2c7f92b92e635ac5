#include "render/native/native_flat_painter.h"

#include "render/scene/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

// Drawn by one thread at a time.
constexpr int flatStripeRows = 8;

}  // namespace

Result<NativeFlatPainter> NativeFlatPainter::create(std::shared_ptr<NativeScene> scene,
                                                    std::shared_ptr<const FlatGeometry> geometry) {
    const std::size_t most = (std::size_t(1) << 31) - 1;
    if (geometry->vertices().size() * sizeof(shaders::FlatVertex) > most ||
        geometry->triangles().size() * sizeof(glm::ivec3) > most)
        return fail(ErrorKind::badInput, "has too many vertices to be drawn", "flat map");
    return NativeFlatPainter(std::move(scene), std::move(geometry));
}

NativeFlatPainter::NativeFlatPainter(std::shared_ptr<NativeScene> scene,
                                     std::shared_ptr<const FlatGeometry> geometry)
    : scene_(std::move(scene)), geometry_(std::move(geometry)), cast_(flatPackets()) {}

Result<Image> NativeFlatPainter::draw(const FlatView& view, const Band& band) {
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    const auto classified = TRY(scene_->classification(view.optics, view.march));
    const Scene& scene = scene_->scene();
    const PacketScene packets =
        scene_->packetScene(marchUniforms(view.optics, view.march, scene.grid(), classified->table,
                                          scene.ranges.size, size),
                            *classified);
    const FlatLattice lattice = geometry_->lattice(view.window, band);
    const double step = stepMm(view.march, scene.grid());
    PacketWall wall{geometry_->vertices().data(), geometry_->triangles().data(),
                    geometry_->cameras().data(), lattice.uniforms};
    wall.u.mostStepsBack = float(std::ceil(flatRay.backMm / step));
    wall.u.riseThatEnds = float(flatRay.riseHu);
    wall.u.mostStepsOn = float(std::ceil(flatRay.depthMm / step));
    Image image = blankImage(size);
    scene_->pool().run((size.y + flatStripeRows - 1) / flatStripeRows, [&](int stripe) {
        const int first = stripe * flatStripeRows, rows = std::min(flatStripeRows, size.y - first);
        std::vector<FlatPixel> pixels;
        coverRows(*geometry_, lattice, first, rows, pixels);
        cast_(packets, wall, {first, rows, pixels.data(), image.rgb.data()});
    });
    return image;
}

}  // namespace haustra::render
