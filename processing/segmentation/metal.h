// Metal in the body, whose streaks a reader must allow for, and metal in the colon's wall.
#pragma once

#include "segmentation/bowel_contents.h"

#include <optional>
#include <string>
#include <vector>

namespace haustra::segmentation {

/// A warning for readers of a scan (HU; `content` is Content, on the same grid) with 0.3 ml or more
/// in one piece that is brighter than any bone (2500 HU): implants, or barium that has thickened.
/// It names the largest places. The same for any number of threads.
std::optional<std::string> metalIn(const Volume<std::int16_t>& hu,
                                   const Volume<std::uint8_t>& content, int threads);

struct BrightBody {
    glm::dvec3 placeMm;  ///< patient, LPS: its middle
    double ml = 0.0;
};

/// What is brighter than 1500 HU within 3 mm of the lumen (LumenLabel, on the same grid), or one
/// voxel along an axis where voxels are longer, 0.3 ml or more in one piece, the largest first: a
/// stent's mesh, clips, or barium that has thickened. Blurred wires are no brighter than compact
/// bone, but bone does not lie there. The same for any number of threads.
std::vector<BrightBody> metalAtLumen(const Volume<std::int16_t>& hu,
                                     const Volume<std::uint8_t>& labels, int threads);

}  // namespace haustra::segmentation
