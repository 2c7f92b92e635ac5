// Pictures of one case, drawn on the GPU.
#pragma once

#include <memory>

#include "core/ct_scan.h"
#include "gpu/context.h"
#include "render/view.h"

namespace haustra::render {

/// Holds one case's volume on the GPU. Belongs to the thread that owns `context`; the context
/// must outlive it. Equal inputs give equal pixels.
class CaseRenderer {
public:
    /// `ct` is the scan; `lumen` (LumenLabel, may be empty) tells which tagged voxels the
    /// endoscopic view shows as air. Both are only read here.
    static Result<std::unique_ptr<CaseRenderer>> create(gpu::Context& context, const Volume<std::int16_t>& ct,
                                                        const Volume<std::uint8_t>& lumen);
    ~CaseRenderer();

    Result<Image> render(const EndoscopicView& view, int width, int height);
    Result<Image> render(const SliceView& view, int width, int height);

    /// Bytes of GPU memory held.
    std::size_t gpuBytes() const;

private:
    struct Impl;
    explicit CaseRenderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::render
