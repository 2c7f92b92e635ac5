// How far rays look that shall see what lies beneath the wall, and no more.
#pragma once

#include "render/scene/picture.h"
#include "render/scene/raycaster.h"
#include "render/scene/scene.h"

#include <memory>
#include <span>

namespace haustra::render {

/// Below this value, HU, a ray has left tissue: as detection's rays take it (cad::BiopsyScan).
inline constexpr double gasBelowHu = -400.0;

/// The ends of a camera's rays in the rows of a band, as detection's electronic biopsy has them
/// (§6.2.4): `deepMm` behind the place where the pixel first sees the wall, or where the ray comes
/// out of tissue into gas again before that. Behind the ends it is black; other rows have none.
/// `wallMm`: of each pixel of the band, rows from the top, the depth of that place, as of a
/// backdrop; negative where it sees no wall: such a ray goes on. Samples the scan each half
/// millimetre behind the wall, 40 times to 20 mm, on so many threads (≤ 0: all cores), and gives
/// the same for any number. The camera must have passed its check.
std::shared_ptr<const Backdrop> endsBeneathWall(const Scene& scene, const Camera& camera,
                                                const Band& band, std::span<const float> wallMm,
                                                double deepMm, int threads);

}  // namespace haustra::render
