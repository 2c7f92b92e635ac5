// Volume-based topological denoising (dissertation §3.3.2.2): from a lumen with handles to a ball.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "core/result.h"

#include <string>
#include <vector>

namespace haustra::topology {

/// What the (6, 18) pair makes of a mask.
struct DigitalTopology {
    long components = 0;           ///< 6-connected, of the object
    long cavities = 0;             ///< 18-connected components of the background but the outer one
    long eulerCharacteristic = 0;  ///< of the solid: components − handles + cavities
    long handles() const { return components + cavities - eulerCharacteristic; }
    bool isBall() const { return components == 1 && cavities == 0 && eulerCharacteristic == 1; }
};

/// Labels other than 0 are the object; beyond the grid is background. Linear; any thread count.
DigitalTopology digitalTopology(const Volume<std::uint8_t>& labels, int threads = 0);

struct HandleCuttingOptions {
    double priorityStep = 0.1;       ///< δ: what a non-simple voxel's priority falls by
    double priorityThreshold = 0.8;  ///< T_th: below it the voxel is left out
    double bridgeRadiusMm = 1.5;     ///< of the tube that joins segments across a collapse
    int threads = 0;
    Progress progress;
};

struct CutLumen {
    Volume<std::uint8_t> labels;  ///< LumenLabel; its topology is a ball's
    long handlesCut = 0, cavitiesFilled = 0;
    std::size_t voxelsRemoved = 0, voxelsAdded = 0;  ///< against the labels that came in
    std::vector<std::string> notes;
};

/// The largest-distance-first region growing of §3.3.2.2 from a path through the lumen, adding
/// simple points alone, so that each handle is cut where it is thinnest. Segments that the path
/// joins across a gap are joined by a thin bridge; segments off the path are left out. Fails where
/// the lumen is empty (noResult). The same bytes for any number of threads.
Result<CutLumen> cutHandles(const Volume<std::uint8_t>& labels,
                            const HandleCuttingOptions& options = {});

}  // namespace haustra::topology
