// Bridges as pictures of a case show them.
#pragma once

#include "core/flat_map.h"
#include "core/result.h"
#include "render/wall/wall_paint.h"
#include "store/case_store.h"

#include <memory>

namespace haustra::cli {

/// Whether the case's lumen has a bridge, on its path or off it. False where it has no lumen.
Result<bool> hasBridges(const store::Case& source);

/// The hatched bridges of the case's flat map over `below`, which may be missing; `below` itself
/// where there is none. Fails where the case has no sound lumen.
Result<std::shared_ptr<const render::WallPaint>> paintBridges(
    const store::Case& source, std::shared_ptr<const FlatMap> map,
    std::shared_ptr<const render::WallPaint> below);

}  // namespace haustra::cli
