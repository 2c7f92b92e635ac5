// What the colon was found to be: its pieces in order, what joins them, and how sure that is.
#pragma once

#include "core/centerline.h"
#include "core/result.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// Parts of the colon in the order of travel from the anus.
enum class ColonPart : std::uint8_t {
    rectum,
    sigmoid,
    descending,
    splenicFlexure,
    transverse,
    hepaticFlexure,
    ascending,
    cecum
};
inline constexpr int colonParts = 8;
/// "rectum", "splenic flexure" …
const char* toString(ColonPart part);

/// How the lumen goes on from one piece to the next.
enum class JunctionKind : std::uint8_t {
    openLumen,  ///< gas or fluid goes through
    thinWall,   ///< what looks like a thin wall was taken for a fold or a film
    collapse,   ///< the lumen is closed; a way through soft tissue was taken
};
/// "open lumen", "collapse" …
const char* toString(JunctionKind kind);

struct ColonPiece {
    ColonPart part = ColonPart::rectum;
    glm::dvec3 centerMm{0.0};  ///< patient, LPS: middle of the largest ball inside
    double radiusMm = 0.0;     ///< of that ball
    double lengthMm = 0.0;     ///< of the way through it, from mouth to mouth by that middle
    double gasMl = 0.0, taggedMl = 0.0, untaggedMl = 0.0;
    /// As a tube of that calibre: more than the way, as haustra are wider than what lies between
    /// their folds.
    double tubeMm = 0.0;
};

struct ColonJunction {
    JunctionKind kind = JunctionKind::openLumen;
    glm::dvec3 placeMm{0.0};
    double lengthMm = 0.0;    ///< of what is crossed: 0 where the lumen is open
    double radiusMm = 0.0;    ///< of the largest ball that passes: 0 where it is closed
    double confidence = 1.0;  ///< share of the likely chains that have it
};

/// What most of a body is.
enum class BodyContent : std::uint8_t { gas, tagged, untagged };
const char* toString(BodyContent content);  ///< "gas", "tagged material", "fluid without tagging"

/// Bowel, or what may be, that is not part of the colon that was found.
struct LeftOutBody {
    glm::dvec3 centerMm{0.0};
    double volumeMl = 0.0;
    BodyContent content = BodyContent::gas;
    ColonPart nearest = ColonPart::rectum;
    double distanceMm = 0.0;  ///< from its centre to the nearest piece's centre, less both radii
    bool opens = false;       ///< a door between it and the colon had to be closed
    bool likeColon = false;   ///< as wide as colon, and likely to be by its place and folds
    /// It lies at the course, or something speaks for colon.
    bool isNear() const {
        constexpr double nearMm = 20.0;
        return opens || likeColon || distanceMm < nearMm;
    }
    /// Listed for being much, whatever it is.
    bool isFarGas() const { return content == BodyContent::gas && !isNear(); }
};

/// A wall too thin for the scan to show whole, set up again.
struct RebuiltWallRecord {
    glm::dvec3 placeMm{0.0};
    double areaMm2 = 0.0;
    bool betweenLoops = false;  ///< both sides are the colon's; else other bowel lies behind
};

/// Fluid that took no tagging stands under the colon's gas: its surface is seen, its wall is not,
/// so that it is not in the lumen.
struct UntaggedPool {
    ColonPart part = ColonPart::rectum;
    glm::dvec3 placeMm{0.0};  ///< the middle of its surface
    double areaMm2 = 0.0;     ///< of the surface
    double fluidHu = 0.0;
};

/// Where the colon goes on beyond the scan: the edge of the scan cuts its lumen open.
struct CutEnd {
    ColonPart part = ColonPart::rectum;
    glm::dvec3 placeMm{0.0};  ///< the middle of the opening
    double areaMm2 = 0.0;     ///< of the opening
};

/// Another chain that explains the scan nearly as well.
struct RunnerUp {
    double probability = 0.0;  ///< beside the one that was taken
    double addsMl = 0.0, dropsMl = 0.0;
    glm::dvec3 placeMm{0.0};  ///< middle of the largest piece in which they differ
};

/// A way in which the course may be wrong, though no other explains the scan better.
struct Doubt {
    std::string about;
    double probability = 0.0;  ///< that it is wrong there
};

struct ColonRecord {
    std::vector<ColonPiece> pieces;        ///< from the rectum on
    std::vector<ColonJunction> junctions;  ///< one fewer than pieces
    double confidence = 0.0;  ///< that the course is right: among those weighed, and all doubts
    double chainConfidence = 0.0;      ///< that it is right among those that were weighed
    std::vector<Doubt> doubts;         ///< the gravest first
    std::vector<RunnerUp> runnersUp;   ///< none or one
    std::vector<LeftOutBody> leftOut;  ///< near the chain, like colon or much gas, and no part of
                                       ///< the lumen; the largest first
    /// The lowest place of the last piece, in the trunk: x from −1 (the patient's right side) to 1,
    /// y from −1 (front) to 1, z from 0 (the lowest bowel) to 1 (the highest).
    std::optional<glm::dvec3> endsAt;
    std::vector<RebuiltWallRecord> walls;
    std::vector<UntaggedPool> untaggedPools;  ///< not in the lumen; the largest surface first
    std::vector<CutEnd> cutEnds;              ///< the largest first
    double maskInSoftTissue = 0.0;            ///< share of a given mask's inside; 0 of none
    double strandedMl = 0.0;  ///< of the pieces, left out of the lumen as nothing joins it
    double noiseSdHu = 0.0;   ///< in gas
    /// Of what stands under the colon's gas and is denser than water, however little tagging it
    /// took: the median HU, by area of the surface. None where nothing such stands.
    std::optional<double> taggingHu;
    std::vector<std::string> warnings;  ///< where a reader must look
    double lengthMm() const;            ///< of the pieces and of what is crossed between them
};

/// Pieces of the colon that the path passes by: it went another way there, through a wall that was
/// taken for lumen. A line for each run of them, with its length and its last piece's place.
std::vector<std::string> piecesPassedBy(const Centerline& path,
                                        const std::vector<ColonPiece>& pieces);

/// The six segments in which colonoscopy reports, from the rectum on; the flexures count with the
/// ascending and the descending colon.
enum class ColonSegment : std::uint8_t {
    rectum,
    sigmoid,
    descending,
    transverse,
    ascending,
    cecum
};
inline constexpr int colonSegments = 6;
const char* toString(ColonSegment segment);
ColonSegment segmentOf(ColonPart part);

/// How well one segment is shown.
struct SegmentDistension {
    double lengthMm = 0.0;
    double diameterMm = 0.0;  ///< of the largest balls inside, mean over the length
    double gasMl = 0.0, taggedMl = 0.0, untaggedMl = 0.0;
    double collapsedMm = 0.0;  ///< crossed by bridges that begin in it
};
std::array<SegmentDistension, colonSegments> distensionOf(const ColonRecord& record);

/// The `quality` product: JSON with all of the record, and the segments' distension; lengths in mm,
/// places in LPS mm, shares from 0 to 1. Ends with a new line.
std::string qualityJson(const ColonRecord& record);
/// What such a text says a reader must know before anything is seen.
struct ColonTrust {
    double confidence = 0.0, lengthMm = 0.0;
    std::vector<std::string> warnings;
    std::array<SegmentDistension, colonSegments> segments;
};
/// Fails (badInput) where the text is no quality.
Result<ColonTrust> trustOfQuality(const std::string& text);
/// The pieces of such a text, with part, centre, radius and length. Fails (badInput) where it is
/// none.
Result<std::vector<ColonPiece>> piecesOfQuality(const std::string& text);
/// The walls of such a text that were set up again. Fails (badInput) where it is none.
Result<std::vector<RebuiltWallRecord>> rebuiltWallsOfQuality(const std::string& text);

}  // namespace haustra
