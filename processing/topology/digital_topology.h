// Components, cavities and handles of a mask under the (6, 18) pair of digital topology: the
// object's voxels are joined through their faces, the background's through faces and edges.
#pragma once

#include "core/volume.h"
#include "topology/bit_mask.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace haustra::topology {

/// What the (6, 18) pair makes of a mask.
struct DigitalTopology {
    long components = 0;           ///< 6-connected, of the object
    long cavities = 0;             ///< 18-connected components of the background but the outer one
    long eulerCharacteristic = 0;  ///< of the solid: components − handles + cavities
    long handles() const { return components + cavities - eulerCharacteristic; }
    bool isBall() const { return components == 1 && cavities == 0 && eulerCharacteristic == 1; }
    friend bool operator==(const DigitalTopology&, const DigitalTopology&) = default;
};

/// Labels other than 0 are the object; beyond the grid is background. Linear, bit-parallel; the
/// same for any thread count. Thread-safe.
DigitalTopology digitalTopology(const Volume<std::uint8_t>& labels, int threads = 0);
DigitalTopology digitalTopology(const BitMask& object, int threads = 0);

/// One bit for each voxel: its label is not 0.
BitMask maskOf(const Volume<std::uint8_t>& labels, int threads = 0);

/// χ of the solid: voxels less faces shared by two, plus edges shared by four, less corners shared
/// by eight, plus the corners where just two opposite voxels of eight are background: there the
/// background is not 18-connected, and the object closes the way between them.
long eulerCharacteristic(const BitMask& object, int threads = 0);

/// Corners where just two opposite voxels of eight are background: there it is joined under the
/// (6, 26) pair alone. Where there are none, that pair counts what the (6, 18) pair does.
long openCorners(const BitMask& object, int threads = 0);

/// Whether the labels are a ball under the (6, 18) and under the (6, 26) pair.
bool isBallEitherWay(const Volume<std::uint8_t>& labels, int threads = 0);

/// Voxels [begin, end) of row (j, k), of one component.
struct MaskRun {
    std::int32_t begin, end, j, k;
    std::int32_t component;
};

/// Components of a mask as runs, in memory order; numbered by their first run.
struct MaskComponents {
    std::vector<MaskRun> runs;
    std::vector<std::size_t> voxels;  ///< of each component
};

/// The object's 6-connected components. Linear in words and runs.
MaskComponents objectComponents(const BitMask& object);
/// The 18-connected components of the background that do not reach past the grid's border.
MaskComponents cavitiesOf(const BitMask& object);

}  // namespace haustra::topology
