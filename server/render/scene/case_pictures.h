// Slices and flattened views of a case, whoever draws them.
#pragma once

#include "core/slice_placement.h"
#include "render/scene/raycaster.h"

#include <cstddef>

namespace haustra::render {

/// A slice that has its place. Of a slab, what lies outside the scan does not count.
struct SlicePicture {
    SlicePlacement placement;
    WindowLevel window;
    Scan scan = Scan::original;
    Slab slab;
};

/// Belongs to one thread. Equal views give equal pixels; two implementations give the same to
/// within a level or so.
class CasePictures {
public:
    virtual ~CasePictures() = default;
    CasePictures() = default;
    CasePictures(const CasePictures&) = delete;
    CasePictures& operator=(const CasePictures&) = delete;

    /// The band's rows, as an image of their own. What is asked for must have passed its checks:
    /// bands, windows, that the case has a cleansed scan or a flat map. Fail (badInput) on bad
    /// optics or sampling, (device) where a driver reports an error.
    virtual Result<Image> slice(const SlicePicture& picture, const Band& band) = 0;
    virtual Result<Image> flat(const FlatView& view, const Band& band) = 0;
    virtual std::size_t gpuBytes() const { return 0; }
};

}  // namespace haustra::render
