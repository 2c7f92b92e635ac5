#include "render/native/native_pictures.h"

#include "render/flat/flat_coverage.h"
#include "render/scene/ray_setup.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::render {

namespace {

// Drawn by one thread at a time.
constexpr int sliceStripeRows = 16, flatStripeRows = 8;

}  // namespace

Result<std::unique_ptr<NativePictures>> NativePictures::create(
    std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct,
    std::shared_ptr<const FlatGeometry> geometry) {
    const std::size_t most = (std::size_t(1) << 31) - 1;
    if (geometry && (geometry->vertices().size() * sizeof(shaders::FlatVertex) > most ||
                     geometry->triangles().size() * sizeof(glm::ivec3) > most))
        return fail(ErrorKind::badInput, "has too many vertices to be drawn", "flat map");
    return std::unique_ptr<NativePictures>(
        new NativePictures(std::move(scene), std::move(ct), std::move(geometry)));
}

NativePictures::NativePictures(std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct,
                               std::shared_ptr<const FlatGeometry> geometry)
    : scene_(std::move(scene)),
      ct_(std::move(ct)),
      geometry_(std::move(geometry)),
      drawSlice_(slicePackets()),
      castFlat_(flatPackets()) {}

Result<Image> NativePictures::slice(const SlicePicture& picture, const Band& band) {
    const auto& [placement, window, scan, slab] = picture;
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    PacketScene packets;
    (scan == Scan::cleansed ? scene_->volume() : ct_).describe(packets);
    const Grid& grid = ct_.volume().grid();
    const glm::dmat3 linear(grid.voxelFromPatient());
    const SlabSamples samples = slabSamples(slab, placement.normal(), grid);
    const PacketSlice slice{grid.voxelFromPatientPoint(placement.topLeftMm),
                            linear * placement.rightMm,
                            linear * placement.downMm,
                            linear * samples.stepMm,
                            samples.aside,
                            slab.projection == Projection::maximum,
                            float(1.0 / window.widthHu),
                            float(0.5 - window.centerHu / window.widthHu),
                            size.x,
                            band.firstRow};
    Image image = blankImage(size);
    scene_->pool().run((size.y + sliceStripeRows - 1) / sliceStripeRows, [&](int stripe) {
        const int first = stripe * sliceStripeRows;
        drawSlice_(packets, slice, first, std::min(first + sliceStripeRows, size.y),
                   image.rgb.data());
    });
    return image;
}

Result<Image> NativePictures::flat(const FlatView& view, const Band& band) {
    if (!geometry_) return fail(ErrorKind::badInput, "the case has no flat map", "flattened view");
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
        castFlat_(packets, wall, {first, rows, pixels.data(), image.rgb.data()});
    });
    return image;
}

}  // namespace haustra::render
