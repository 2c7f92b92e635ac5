// How much of the wall a simulated colonoscopy covered (dissertation §2.5): the product `coverage`.
#pragma once

#include "core/colon_record.h"
#include "core/flat_map.h"
#include "core/result.h"
#include "core/segments_along.h"
#include "core/wall_visibility.h"
#include "coverage/missed_review.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace haustra::coverage {

/// Sums over triangles that are wall (no bridges).
struct Share {
    double areaMm2 = 0.0, seenMm2 = 0.0, fullyMm2 = 0.0;
    long triangles = 0, seen = 0, fully = 0;
    double areaPercent() const { return areaMm2 > 0.0 ? 100.0 * seenMm2 / areaMm2 : 0.0; }
    double trianglePercent() const {
        return triangles > 0 ? 100.0 * double(seen) / double(triangles) : 0.0;
    }
};
Share shareOf(const CoverageWall& wall, const std::vector<Visibility>& seen);

/// Of each triangle its place along the centerline, mm from the rectum: where the flat map has its
/// source (`sourceTriangle`, of each triangle), as findings have it; where that lacks it, or there
/// is none, of the nearest sample, which may be another loop's. The centerline has a sample.
std::vector<double> arcsOf(const CoverageWall& wall,
                           const std::vector<std::int32_t>& sourceTriangle, const FlatMap* map,
                           int threads = 0);

/// The segment of each arc; empty without starts.
std::vector<ColonSegment> segmentsOf(const std::vector<double>& arcsMm,
                                     const std::vector<SegmentStart>& starts);
std::array<Share, colonSegments> sharesBySegment(const CoverageWall& wall,
                                                 const std::vector<Visibility>& seen,
                                                 const std::vector<ColonSegment>& segments);

/// Patches that are smaller are counted together: a polyp of 1 mm is none.
inline constexpr double leastListedMm2 = 1.0;
/// Patches from this size on are reviewed (Kreeger et al.).
inline constexpr double leastReviewedMm2 = 300.0;

/// What was simulated, and what came of it.
struct CoverageReport {
    std::string mode;        ///< "oc", "vc" or "planned"
    std::string direction;   ///< "antegrade", "retrograde" or "both"; empty where it is planned
    int cameras = 0;         ///< asked for: places on the path, or of a plan
    int pictures = 0;        ///< taken
    std::string lens;        ///< for a person: "Olympus CF-Q160L", "pinhole 90°, 512 x 512"
    std::string visibility;  ///< "rays" or "gpu"
    double nearestMm = 0.0, farthestMm = 0.0;
    double pathMm = 0.0, narrowMm = 0.0, clearanceMm = 0.0;  ///< the last two of a colonoscope's
    double bridgedMm2 = 0.0;
    bool tellsFully = false;
    Share share;
    std::optional<std::array<Share, colonSegments>> segments;
    std::vector<MissedPatch> missed;              ///< all, the largest first
    std::vector<ColonSegment> segmentOfTriangle;  ///< empty where no segments are known
    std::optional<Review> review;                 ///< and what has been seen after it
    Share reviewed;
    std::optional<double> flattenedPercent;  ///< of the wall's area that the flat map has
    std::optional<Share> centerlineShare;    ///< of a plan: as many pictures on the centerline
};

/// JSON, lengths in mm, places in LPS mm, percentages of what is wall:
///   {"software", "mode", "direction", "cameras", "pictures", "lens", "visibility",
///    "depth_of_field_mm": [nearest, farthest], "path": {"length_mm", "clearance_mm", "narrow_mm"},
///    "area_percent", "triangle_percent", "fully_area_percent", "fully_triangle_percent",
///    "wall": {"area_mm2", "triangles", "bridged_mm2"},
///    "segments": [{"segment", "area_mm2", "area_percent", "triangle_percent"}, …],
///    "missed": [{"area_mm2", "center_mm", "arc_mm", "segment"}, …],    from leastListedMm2 on
///    "missed_smaller": {"patches", "area_mm2"},
///    "review": {"least_mm2", "patches", "rounds", "area_percent", "triangle_percent"},
///    "flattened": {"area_percent"},
///    "centerline": {"area_percent", "triangle_percent"}}
/// What is not known is left out. The product has in addition
///    "wall_triangles": {"most_edge_mm", "count", "visibility"}
/// where `seen` is given: of each triangle of fineWall(surface) two bits, 0 unseen, 1 partly, 2
/// fully, 3 a bridge; three triangles to a character of base64's alphabet, the first in the lowest
/// bits. The same input gives the same bytes. Ends with a new line.
std::string coverageJson(const CoverageReport& report);
std::string coverageJson(const CoverageReport& report, const CoverageWall& wall,
                         const std::vector<Visibility>& seen);

/// Per triangle of the fine wall of what coverageJson wrote with `seen`: 0 … 3 as above. Fails
/// (badInput) where the text is none, or speaks of another number of triangles.
Result<std::vector<std::uint8_t>> triangleFlagsOf(const std::string& text, std::size_t triangles);

}  // namespace haustra::coverage
