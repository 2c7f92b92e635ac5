// Pictures of one case, drawn on the GPU.
#pragma once

#include "core/ct_scan.h"
#include "gpu/context.h"
#include "render/prepared_case.h"
#include "render/view.h"

#include <memory>

namespace haustra::render {

/// Longest side of a picture, pixels.
inline constexpr int maxPictureSide = 2048;

/// Holds one case's volume on the GPU. Belongs to the thread that owns `context`; the context
/// must be current there and outlive it. Equal inputs give equal pixels, whatever was drawn before.
class CaseRenderer {
public:
    /// Copies the scan and what prepareCase made of it to the GPU. `threads` (≤ 0: all cores)
    /// changes no pixel. Fails where a side is longer than the device's 3-D textures allow (2048 in
    /// general) or its memory is short. Holds 2 bytes a voxel on the GPU, 4 with a tagged lumen;
    /// 1/2 byte a voxel of main memory, and neither volume.
    static Result<std::unique_ptr<CaseRenderer>> upload(gpu::Context& context,
                                                        const Volume<std::int16_t>& ct,
                                                        PreparedCase prepared, int threads = 0);
    /// Prepares the case (prepareCase) and uploads it.
    static Result<std::unique_ptr<CaseRenderer>> create(gpu::Context& context,
                                                        const Volume<std::int16_t>& ct,
                                                        const Volume<std::uint8_t>& lumen,
                                                        int threads = 0);
    ~CaseRenderer();
    CaseRenderer(const CaseRenderer&) = delete;
    CaseRenderer& operator=(const CaseRenderer&) = delete;

    /// Ray-cast picture, sRGB, over black. A new transfer function costs some 0.1 s for the leap
    /// map of a 512³ scan; the last four are kept, so that readers with different ones do not
    /// disturb each other. Fails on a bad view (badInput) or where the driver reports an error
    /// (device).
    Result<Image> render(const EndoscopicView& view, int width, int height);
    /// Slice of the true CT, linearly interpolated; black outside the scan.
    Result<Image> render(const SliceView& view, int width, int height);

    /// Bytes of GPU memory held.
    std::size_t gpuBytes() const;

private:
    struct Impl;
    explicit CaseRenderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::render
