#include "cad/along_colon.h"

#include <memory>

namespace haustra::cad {

AlongColon::AlongColon(const FlatMap& map, const Centerline& centerline) : centerline_(centerline) {
    if (!map.cameras.empty() && !map.surface.triangles.empty())
        lookup_.emplace(std::shared_ptr<const FlatMap>(std::shared_ptr<void>(), &map));
}

WallPlace AlongColon::at(glm::dvec3 wallMm) const {
    return lookup_ ? lookup_->nearest(wallMm) : placeByCenterline(centerline_, wallMm);
}

}  // namespace haustra::cad
