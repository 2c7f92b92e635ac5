// Colours of the wall in pictures of a case: a given picture, its findings, and its bridges.
#pragma once

#include "core/flat_map.h"
#include "core/result.h"
#include "render/wall/wall_paint.h"
#include "store/case_store.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace haustra::cli {

/// A picture of the strip, `height` circumferences long (pictures::readColorPicture). Fails naming
/// the file where it is of another shape than the strip, too.
Result<std::shared_ptr<const render::WallPaint>> readWallPaint(const std::filesystem::path& file,
                                                               double height);

/// Whether the case's lumen has a bridge, on its path or off it. False where it has no lumen.
Result<bool> hasBridges(const store::Case& source);

/// A case's findings on its wall.
struct PaintedFindings {
    struct Place {
        int number = 0;  ///< in the case, from 1, as a reading station tells it
        glm::dvec3 wallMm{0.0};
        glm::dvec2 flat{0.0};  ///< the same on the map; x in [0, 1)
        glm::u8vec3 color{0};  ///< that the wall is mixed with there
    };
    std::shared_ptr<const render::WallPaint> paint;
    std::vector<Place> places;  ///< of those that are painted
};

/// The case's findings, coloured as the server does, and its hatched bridges; with
/// `leastProbability` its candidates from that on, too. Fails where the case has no findings, or
/// they are not of its scan.
Result<PaintedFindings> paintFindings(const store::Case& source, std::shared_ptr<const FlatMap> map,
                                      std::optional<double> leastProbability);

/// The hatched bridges of the case's flat map over `below`, which may be missing; `below` itself
/// where there is none. Fails where the case has no sound lumen.
Result<std::shared_ptr<const render::WallPaint>> paintBridges(
    const store::Case& source, std::shared_ptr<const FlatMap> map,
    std::shared_ptr<const render::WallPaint> below);

}  // namespace haustra::cli
