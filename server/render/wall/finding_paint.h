// Which places of the wall belong to a finding, and what colours them (dissertation §6.3.1).
#pragma once

#include "core/findings.h"
#include "render/wall/strip_painter.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

namespace haustra::render {

/// The tissue of findings, as the wall lies over it. Immutable; any number of threads.
class FindingTissue {
public:
    /// Voxels are of `grid`. What several findings hold is the first one's.
    FindingTissue(const Grid& grid, std::span<const Finding> findings);

    /// The finding that a place of the wall belongs to, −1: to none. `inward`, unit, points into
    /// the lumen. Of a finding's voxels, 1 at their centres and 0 at all others, what linear
    /// interpolation makes of them must reach leastShare on the way from the place into the wall,
    /// reachMm() deep, in steps of a quarter of a voxel; the first that does has the place, the
    /// greater share where two do at once. A finding without voxels has the places within the ball
    /// of diameterMm around its centre. A tenth of a microsecond where no finding is near.
    int at(glm::dvec3 placeMm, glm::dvec3 inward) const;
    /// Half a voxel's diagonal: the centre of the voxel that holds a place of the surface is no
    /// farther from it than this.
    double reachMm() const { return reachMm_; }
    /// Under a half, so that a body one voxel thick has no holes where its voxels meet.
    static constexpr double leastShare = 0.25;

private:
    std::uint64_t cellOf(glm::ivec3 voxel) const;
    int mostOf(glm::dvec3 voxel) const;
    Grid grid_;
    glm::dmat4 voxelFromPatient_{1.0};
    double reachMm_ = 0.0, stepMm_ = 1.0;
    std::unordered_map<std::size_t, int> ofVoxel_;
    std::vector<bool> cells_;  // of so many voxels a side: whether one of them is a finding's
    glm::ivec3 cellCount_{0};
    struct Ball {
        glm::dvec3 centerMm{0.0};
        double radiusMm = 0.0;
        int finding = -1;
    };
    std::vector<Ball> balls_;
};

/// A pixel of a strip's paint that belongs to a finding.
struct FindingPixel {
    std::int32_t pixel = 0;
    std::int32_t finding = -1;
};
/// For each triangle of the wall the finding that its middle belongs to, −1: none, or a bridge's;
/// counted, and shared, as findingPixels has it. Some tens of milliseconds for a colon.
std::vector<std::int32_t> findingTriangles(const WallSight& sight, const Findings& findings);

/// All of a strip, in the order of pixels; `finding` counts findings, and then candidates, as they
/// come. What two of them hold is the more probable one's, which is shown wherever the other is.
/// One that is smaller there than a pixel has those beside its triangles.
/// Some tenths of a second for a colon.
std::vector<FindingPixel> findingPixels(const StripPainter& painter, const Findings& findings);

/// How a finding is painted.
enum class FindingShade : std::uint8_t {
    none,
    candidate,  ///< below the operating point: weaker
    finding,
};
/// What the wall is mixed with.
inline constexpr glm::u8vec3 findingColor(0, 230, 110), candidateColor(205, 160, 255);
/// `shades`: of each finding. Something of the wall's own colour is left.
std::vector<TintedPixel> colorFindings(std::span<const FindingPixel> pixels,
                                       std::span<const FindingShade> shades);

}  // namespace haustra::render
