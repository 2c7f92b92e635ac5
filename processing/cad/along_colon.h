// Where places of the wall are along the colon.
#pragma once

#include "core/centerline.h"
#include "core/flat_lookup.h"

#include <optional>

namespace haustra::cad {

/// Tells where a place of the wall is along the colon: where the flat map says; without a map, by
/// the centerline. Immutable; any number of threads. Map and centerline must outlive it.
class AlongColon {
public:
    AlongColon(const FlatMap& map, const Centerline& centerline);

    WallPlace at(glm::dvec3 wallMm) const;

private:
    std::optional<FlatLookup> lookup_;
    const Centerline& centerline_;
};

}  // namespace haustra::cad
