// VTK's volume mappers, given the same view as ours; for comparison only.
#pragma once

#include "core/volume.h"
#include "render/scene/picture.h"

#include <memory>

namespace haustra::bench {

enum class VtkMapper { gpu, fixedPoint };

/// One window and one volume. What VTK does differently: it adds up displayed colours, its lamp
/// knows no distance, and it ends rays at an opacity of its own (0.99 and more).
class VtkRaycaster {
public:
    VtkRaycaster(VtkMapper mapper, const Volume<std::int16_t>& volume, int threads);
    ~VtkRaycaster();
    VtkRaycaster(const VtkRaycaster&) = delete;
    VtkRaycaster& operator=(const VtkRaycaster&) = delete;

    /// Draws until the pixels are in main memory. Perspective lenses, 1-D transfer functions,
    /// emission and absorption.
    Image render(const render::CameraView& view, int width, int height);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::bench
