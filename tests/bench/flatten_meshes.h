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
/// colon is, and punched at both ends. 0.6 mm gives about a million triangles.
Result<Tube> generatedTube(double voxelMm);

/// A tube as it is, or a closed surface of genus 0 punched at the two vertices that are farthest
/// apart along its edges.
Result<Tube> tubeOfFile(const std::string& file);

/// The finest surface of a case, contoured from its cleansed HU (else its CT) or, `simplified`, its
/// product `surface`; punched at the ends of its centerline.
Result<Tube> tubeOfCase(const std::string& storeFolder, const std::string& caseName,
                        bool simplified);

}  // namespace haustra::bench
