// Wall that is thick all around, as by a cancer that encircles the lumen and leaves a channel.
#pragma once

#include "cad/wall_evidence.h"
#include "core/findings.h"
#include "core/segments_along.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace haustra::cad {

/// What such a finding's score is, unless a model's operating point is higher. A rule tells it,
/// which has not learnt; how often it was right is known of planted ones alone: METHODS §24.6 "How
/// well".
inline constexpr double annularScore = 0.9;

/// A stretch of the colon whose wall is thick all around.
struct AnnularWall {
    double fromMm = 0.0, toMm = 0.0;          ///< arcs along the centerline
    double thicknessMm = 0.0;                 ///< of its wall, median
    double middleHu = 0.0;                    ///< median of the smoothed scan half-way through it
    double channelMm = 0.0;                   ///< twice the path's least distance from it
    bool isBesideLoops = false;               ///< thick as far as other loops' gas alone
    std::vector<std::uint32_t> samples = {};  ///< its wall, ascending
    double lengthMm() const { return toMm - fromMm; }
};

/// How deep tissue reaches behind a sample, mm, along the ray into the wall: to where the smoothed
/// scan is nearer to fat than to tissue. 0 of a wall that is too thin for the scan to show; none
/// where tissue goes on for `deepestWallMm`, or ends at gas, so that something else lies against
/// the colon: an organ, or another loop, whose wall is part of what was measured.
std::optional<double> wallThicknessMm(const WallEvidence& evidence, std::uint32_t sample);

/// From the rectum to the cecum. Thick is what has 6 mm and more: a distended colon's wall has 1 to
/// 3 mm, a collapsed one's 5 (Macari and Balthazar, AJR 2001; 176: 1105). The colon is looked at in
/// twelfths around over 12 mm along, each by its median; all around is five sixths of those in
/// which fat ends the wall, which must be half of them: what touches other organs on more is not
/// judged. Where it holds three times at least, 4 mm from one to the next, a stretch is told, as a
/// fold that goes all around is thinner; one time in between may be passed over. Stretches that
/// hold where the ends at other loops' gas count, too, and touch none of the others, are
/// isBesideLoops: other bowel's wall may be part of what is thick. The last 40 mm, the anal
/// canal's, thick by its sphincters, are left out. None without a flat map. The same for any number
/// of threads. O(samples).
std::vector<AnnularWall> annularWalls(const PreparedColon& colon, const WallEvidence& evidence,
                                      int threads);

/// Whether what is thick is darker than half-way from water to the wall's tissue: fluid around the
/// colon (ascites has up to some 20 HU), or a wall that is swollen with it, and no tumour.
bool isFluid(const AnnularWall& wall, const WallStatistics& statistics);

/// Longer ones are segments that are inflamed or contracted rather than a tumour: of cancers that
/// thicken the wall 87 % are shorter than 50 mm (Lee et al., Korean J Gastroenterol 2012; 60: 300).
inline constexpr double longestTumourMm = 100.0;

/// A wider lumen than this is not narrowed: a distended colon's is 26 to 46 mm wide in the mean, by
/// part (chain_graph's calibres), and cancers all around leave less. There, what lies against the
/// colon on all sides is other bowel, or the wall is inflamed.
inline constexpr double widestChannelMm = 25.0;

/// As a finding of annularKind, without features. Its voxels are its tissue, of which the outermost
/// is left out where it has more runs than a list of findings has room for, and all where even the
/// wall's surface has. Of one with samples.
Finding findingOf(const AnnularWall& wall, const PreparedColon& colon, const WallEvidence& evidence,
                  const std::vector<SegmentStart>& segments);

}  // namespace haustra::cad
