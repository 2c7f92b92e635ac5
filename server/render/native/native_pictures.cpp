#include "render/native/native_pictures.h"

#include <algorithm>
#include <utility>

namespace haustra::render {

namespace {

constexpr int stripeRows = 16;

}  // namespace

Result<std::unique_ptr<NativePictures>> NativePictures::create(
    std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct,
    std::shared_ptr<const FlatGeometry> geometry) {
    std::unique_ptr<NativePictures> made(new NativePictures(scene, std::move(ct)));
    if (!geometry) return made;
    auto flat = TRY(NativeFlatPainter::create(std::move(scene), std::move(geometry)));
    made->flat_ = std::move(flat);
    return made;
}

NativePictures::NativePictures(std::shared_ptr<NativeScene> scene, Volume<std::int16_t> ct)
    : scene_(std::move(scene)), ct_(std::move(ct)), drawSlice_(slicePackets()) {}

Result<Image> NativePictures::slice(const SlicePlacement& placement, const WindowLevel& window,
                                    Scan scan, const Band& band) {
    const glm::ivec2 size(band.pictureSize.x, band.rows);
    PacketScene packets;
    (scan == Scan::cleansed ? scene_->volume() : ct_).describe(packets);
    const Grid& grid = ct_.volume().grid();
    const glm::dmat3 linear(grid.voxelFromPatient());
    const PacketSlice slice{grid.voxelFromPatientPoint(placement.topLeftMm),
                            linear * placement.rightMm,
                            linear * placement.downMm,
                            float(1.0 / window.widthHu),
                            float(0.5 - window.centerHu / window.widthHu),
                            size.x,
                            band.firstRow};
    Image image = blankImage(size);
    scene_->pool().run((size.y + stripeRows - 1) / stripeRows, [&](int stripe) {
        const int first = stripe * stripeRows;
        drawSlice_(packets, slice, first, std::min(first + stripeRows, size.y), image.rgb.data());
    });
    return image;
}

Result<Image> NativePictures::flat(const FlatView& view, const Band& band) {
    if (!flat_) return fail(ErrorKind::badInput, "the case has no flat map", "flattened view");
    return flat_->draw(view, band);
}

}  // namespace haustra::render
