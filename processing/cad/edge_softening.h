// Takes off what a sharp kernel adds to edges.
#pragma once

#include "cad/wall_edges.h"

#include <optional>

namespace haustra::cad {

/// A scan without its kernel's enhancement of edges.
struct SoftenedScan {
    Volume<std::int16_t> ct, cleansed;
};

/// A kernel that enhances edges within the slices is taken to make v = u + a (u − G u) of the scan
/// u that a soft one would have made, with G a Gaussian of one pixel. Its inverse damps what it
/// enhances, and is a series that converges for any a ≥ 0:
///
///   u = (1 + a (1 − G))⁻¹ v = 1 / (1 + a) · Σₖ (a / (1 + a))ᵏ Gᵏ v.
///
/// a is the least by which the wall's edges (`peak` of wallEdges) come down to those that detection
/// has learnt from; noise, which the kernel enhanced alike, comes down with them. The volumes are
/// whole, and differ from the colon's in the box around its wall alone, as far as biopsy rays
/// reach; what cleansing has taken out stays the same. `edges` are the colon's. None where these
/// are no sharper than what has been learnt from. The same for any number of threads.
std::optional<SoftenedScan> softened(const PreparedColon& colon, const WallEvidence& evidence,
                                     const WallEdges& edges, int threads);

}  // namespace haustra::cad
