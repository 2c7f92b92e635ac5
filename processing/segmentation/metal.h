// Metal in the body, whose streaks a reader must allow for.
#pragma once

#include "segmentation/bowel_contents.h"

#include <optional>
#include <string>

namespace haustra::segmentation {

/// A warning for readers of a scan (HU; `content` is Content, on the same grid) with 0.3 ml or more
/// in one piece that is brighter than any bone (2500 HU): implants, or barium that has thickened.
/// It names the largest places. The same for any number of threads.
std::optional<std::string> metalIn(const Volume<std::int16_t>& hu,
                                   const Volume<std::uint8_t>& content, int threads);

}  // namespace haustra::segmentation
