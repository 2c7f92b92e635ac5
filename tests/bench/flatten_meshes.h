// Tubes to flatten: generated, from files, and of the cases in a store.
#pragma once

#include "core/result.h"
#include "core/tri_mesh.h"

#include <string>

namespace haustra::bench {

struct Tube {
    std::string name;
    TriMesh mesh;
};

/// Two turns of a coil with haustra and three taeniae, contoured from voxels of `voxelMm` as a
/// colon is, and punched at both ends. 0.6 mm gives about a million triangles. `pouched`: with 150
/// diverticula and a blind ileum of 300 mm, and simplified to 0.1 mm.
Result<Tube> generatedTube(double voxelMm, bool pouched = false);

/// A tube as it is, or a closed surface of genus 0 punched at the two vertices that are farthest
/// apart along its edges.
Result<Tube> tubeOfFile(const std::string& file);

/// Which surface of a case.
struct SurfaceChoice {
    bool product = false;  ///< its product `surface`; else one contoured from its cleansed HU or CT
    double errorMm = 0.0;  ///< and simplified within this distance, where it is above 0
    /// The second end is on the wall beside this share of the centerline: where that is less than
    /// 1, the rest of the colon hangs on the tube as one blind pouch, as it does where a centerline
    /// takes a shortcut.
    double until = 1.0;
};

/// A case's surface punched at the ends of its centerline.
Result<Tube> tubeOfCase(const std::string& storeFolder, const std::string& caseName,
                        const SurfaceChoice& choice);

/// Every triangle becomes four, of halved edges: the same surface, and the same angles.
Tube subdivided(const Tube& tube);

}  // namespace haustra::bench
