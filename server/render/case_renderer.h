// Pictures of one case, drawn on the GPU.
#pragma once

#include "gpu/context.h"
#include "render/scene/picture.h"
#include "render/scene/prepared_case.h"
#include "render/scene/raycaster.h"
#include "render/wall/wall_paint.h"

#include <memory>

namespace haustra::render {

/// How a case is drawn.
struct RendererOptions {
    /// Which raycaster draws camera views.
    RaycasterKind raycaster = RaycasterKind::singlePass;
    std::size_t gpuBudgetBytes = 0;  ///< for the volume's cells of objectOrder; 0: what there is
    /// Gradients are kept on the GPU where 8 bytes a voxel are within it (GlScene::hasGradients).
    std::size_t gradientBudgetBytes = std::size_t(1) << 30;
    int threads = 0;  ///< ≤ 0: all cores; changes no pixel
};

/// What a case comes to hold of the GPU's memory, as far as it grows with the case; targets of
/// pictures and tables of transfer functions come on top.
struct CaseGpuBytes {
    std::size_t volumes = 0;  ///< of a raycaster that needs the whole volume there
    std::size_t rest = 0;     ///< of any: leap maps, the wall, the flat map
    std::size_t whole() const { return volumes + rest; }
};

/// Draws one case's volumes: the scan, for slices, and the cleansed scan, for the endoscopic view.
/// The native raycaster reads them where they are, and so do slices and flattened views while it or
/// the object-order one is used; the others have them copied to the GPU when first used. Belongs to
/// the thread that owns `context`; the context must be current there and outlive it. Equal inputs
/// give equal pixels, whatever was drawn before.
class CaseRenderer {
public:
    /// Takes what prepareCase made, and what `options.raycaster` needs on the GPU: nothing
    /// (native), its budget (object-order), or 2 bytes a voxel, 4 where cleansing has changed the
    /// scan. Fails where a side is longer than the device's 3-D textures allow (2048 in general) or
    /// its memory is short, (badInput) where the flat map is not sound. Holds handles on the
    /// volumes, and 1/2 byte a voxel of main memory.
    static Result<std::unique_ptr<CaseRenderer>> upload(gpu::Context& context,
                                                        PreparedCase prepared,
                                                        RendererOptions options = {});
    /// Prepares the case (prepareCase; `cleansed` may be empty) and uploads it.
    static Result<std::unique_ptr<CaseRenderer>> create(gpu::Context& context,
                                                        const Volume<std::int16_t>& ct,
                                                        const Volume<std::int16_t>& cleansed,
                                                        RendererOptions options = {});
    ~CaseRenderer();
    CaseRenderer(const CaseRenderer&) = delete;
    CaseRenderer& operator=(const CaseRenderer&) = delete;

    // Each draws the band's rows into `picture`, which has the whole picture's size; the pixels are
    // the same whatever the bands. Fails on a bad view or band (badInput) or where the driver
    // reports an error (device).

    /// Ray-cast picture of the cleansed scan, or of the scan where there is none; sRGB, over black.
    /// A new transfer function costs some 0.1 s for the leap map of a 512³ scan; the last four are
    /// kept, so that readers with different ones do not disturb each other.
    Result<void> render(const CameraView& view, const Band& band, Image& picture);
    /// Slice of the scan that the view names, linearly interpolated; black outside it. Of a slab,
    /// what slabSamples places inside the scan, by its mean or greatest value: as many slices' work
    /// as there are samples. Fail (badInput) where there is no cleansed scan.
    Result<void> render(const SliceView& view, const Band& band, Image& picture);
    Result<void> render(const ObliqueView& view, const Band& band, Image& picture);
    /// The flattened wall. Fail (badInput) where the case has no flat map.
    Result<void> render(const FlatView& view, const Band& band, Image& picture);
    Result<void> render(const FlatOverview& view, const Band& band, Image& picture);
    /// The colon from outside; the body is drawn by raycaster(). What the case has not (its wall,
    /// its path) is left out. Bands come from the top down: the last one marks all of the picture.
    Result<void> render(const OverviewView& view, const Band& band, Image& picture);

    /// The whole picture of any of these views.
    template <class View>
    Result<Image> render(const View& view, int width, int height) {
        TRY(checkPictureSize({width, height}));
        Image picture = blankImage({width, height});
        TRY(render(view, Band::whole(width, height), picture));
        return picture;
    }

    /// Which place of the wall each of the band's pixels sees first, rows from the top. Fails
    /// (badInput) on a bad camera or band, or where the case has no flat map.
    Result<std::vector<WallPixel>> wallSeen(const Camera& camera, const Band& band);

    /// The raycaster that draws camera views, and another in its place: made when it is first
    /// asked for, and kept. Fails where it cannot be made here.
    RaycasterKind raycaster() const;
    Result<void> use(RaycasterKind kind);
    /// Lets go of the raycasters that are not used, and of what only they needed.
    void keepOnlyUsed();
    /// Of the last camera view.
    std::vector<PassTime> passTimes() const;

    /// Of a case that is to be drawn.
    static CaseGpuBytes gpuBytesFor(const PreparedCase& prepared);
    /// Bytes of GPU memory held: textures, meshes, tables, targets. Not counted are uniform blocks
    /// of some hundred bytes, and mapped memory, which is the CPU's (gpu::MappedBuffer).
    std::size_t gpuBytes() const;

private:
    struct Impl;
    explicit CaseRenderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::render
