// The bowel's contents cut at their necks into pieces, and what joins or parts the pieces.
#pragma once

#include "core/colon_record.h"
#include "core/ct_scan.h"
#include "segmentation/air_fluid_levels.h"

#include <cstdint>
#include <vector>

namespace haustra::segmentation {

/// Voxels around one maximum of the distance from the boundary.
struct TubePiece {
    std::size_t voxels = 0, gasVoxels = 0, taggedVoxels = 0, untaggedVoxels = 0;
    double volumeMl = 0.0;
    double radiusMm = 0.0;  ///< of the largest ball inside
    glm::ivec3 center{0};   ///< that ball's voxel
    glm::dvec3 centerMm{0.0};
    double meanHu = 0.0;      ///< of gas where it is mostly gas, of tagged material elsewhere
    double coreHu = 0.0;      ///< of its tagged voxels more than 2.5 mm deep
    double coreSdHu = 0.0;    ///< … about a line that rises downwards, as settled tagging does
    double surfaceMm2 = 0.0;  ///< faces towards anything else than the piece
    double excludedAirMm2 = 0.0;  ///< … towards the room's air and lung
    bool mostlyGas() const { return gasVoxels >= taggedVoxels + untaggedVoxels; }
    BodyContent content() const {
        if (mostlyGas()) return BodyContent::gas;
        return untaggedVoxels > gasVoxels + taggedVoxels ? BodyContent::untagged
                                                         : BodyContent::tagged;
    }
};

/// One connected patch of faces over which two pieces touch.
struct Orifice {
    std::int32_t a = 0, b = 0;   ///< pieces, a < b
    double openMm2 = 0.0;        ///< faces with no thin wall on either side
    double openTaggedMm2 = 0.0;  ///< … between voxels of tagged material
    double wallMm2 = 0.0;        ///< faces with a thin wall
    double radiusMm = 0.0;       ///< of the largest ball that passes where it is open
    glm::ivec3 place{0};         ///< the ball's voxel; where nothing is open, the contact's middle
    glm::dvec3 placeMm{0.0};
    double barrierHu = 0.0;             ///< mean over the wall's faces of the higher HU
    std::vector<std::uint32_t> voxels;  ///< of piece a or b, one side of each face; ascending
};

struct TubePieces {
    Volume<std::int32_t> pieceAt;  ///< −1: none
    Volume<float> distanceMm;      ///< from the boundary and from thin walls
    std::vector<TubePiece> pieces;
    std::vector<Orifice> orifices;  ///< by a, then b, then place
};

struct TubePieceOptions {
    double neck = 0.75;  ///< a ball that passes is smaller than this part of the lesser piece's
    double lengthMm = 110.0;  ///< a piece half as long again is cut, by the way from face to face
    double softHu = 40.0;     ///< what walls are made of
    GravityAxis down;
    int threads = 0;
};

/// Watershed of the distance from the boundary in what is gas, tagged or their interface and no
/// thin wall: the voxels by falling distance, each joins the piece that it touches; where two meet,
/// they become one unless the ball that passes is smaller than `neck` times the lesser piece's
/// (persistence). Four that lie side by side, each open to at least two others that are open to
/// each other, all over more than one and a half cross-sections of the smaller, are one body with
/// folds in it. A tube without necks is cut into lengths, so that no piece spans several parts of
/// the colon. Thin walls are then given to the piece beside them, but for tagged voxels under 0.45
/// of its fluid's height over soft tissue, which lie beyond its wall and go to another piece or,
/// more than 1.5 mm off, to none. The same for any number of threads. O(voxels).
TubePieces cutIntoPieces(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                         const Volume<std::uint8_t>& thinWalls, const TubePieceOptions& options);

}  // namespace haustra::segmentation
