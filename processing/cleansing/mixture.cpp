#include "cleansing/mixture.h"

#include "cleansing/interface_layer.h"
#include "cleansing/local_means.h"
#include "cleansing/partial_volume_em.h"
#include "cleansing/tagged_surroundings.h"

#include <algorithm>
#include <cmath>

namespace haustra::cleansing {
namespace {

TissueFractions rounded(double air, double tagged) {
    const int a = int(std::lround(255.0 * std::clamp(air, 0.0, 1.0)));
    const int t = int(std::lround(255.0 * std::clamp(tagged, 0.0, 1.0)));
    return {std::uint8_t(a), std::uint8_t(std::min(t, 255 - a))};
}

/// The fractions of one voxel in or beside the tagged lumen.
class ColonMixture {
public:
    ColonMixture(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                 const LocalMeans& means, const InterfaceLayer& interfaces)
        : hu_(scan.hu), segmentation_(segmentation), means_(means), interfaces_(interfaces) {}

    TissueFractions at(std::size_t index) const {
        const Grid& grid = hu_.grid();
        const glm::ivec3 v = grid.voxelAt(index);
        const double y = hu_[index];
        const double airHu = means_.airHu, softHu = means_.softHu.at(v.x, v.y, v.z);
        const double taggedHu = std::max<double>(means_.taggedHu.at(v.x, v.y, v.z), softHu + 60.0);
        // Two tissues at most, by the side of soft tissue's HU that the voxel lies on.
        double air = std::clamp((softHu - y) / (softHu - airHu), 0.0, 1.0);
        double tagged = std::clamp((y - softHu) / (taggedHu - softHu), 0.0, 1.0);
        const Neighbours around = look(v, softHu, taggedHu);
        if (!around.tagged && y > softHu) return rounded(0.0, 0.0);
        if (around.meanShare > 0.9 && around.leastShare > 0.5) return rounded(0.0, 1.0);
        if (!around.tagged) tagged = 0.0;
        const double bare = interfaces_.bareness(v, taggedHu, softHu);
        if (bare > 0.0) {
            const double share = std::clamp((y - airHu) / (taggedHu - airHu), 0.0, 1.0);
            air = glm::mix(air, 1.0 - share, bare), tagged = glm::mix(tagged, share, bare);
        }
        return rounded(air, tagged);
    }

private:
    struct Neighbours {
        bool tagged = false;     ///< some are more tagged than soft
        double meanShare = 0.0;  ///< of tagged material, over the 27 voxels
        double leastShare = 1.0;
    };

    Neighbours look(glm::ivec3 v, double softHu, double taggedHu) const {
        const Grid& grid = hu_.grid();
        Neighbours around;
        int count = 0;
        const glm::ivec3 lo = glm::max(v - 1, glm::ivec3(0)), hi = glm::min(v + 1, grid.size - 1);
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                for (int i = lo.x; i <= hi.x; ++i) {
                    const std::size_t n = grid.index(i, j, k);
                    const double share = (hu_[n] - softHu) / (taggedHu - softHu);
                    around.meanShare += share, ++count;
                    around.leastShare = std::min(around.leastShare, share);
                    around.tagged |=
                        share > 0.4 && LumenLabel(segmentation_[n]) == LumenLabel::tagged;
                }
            }
        }
        around.meanShare /= count;
        around.tagged |= LumenLabel(segmentation_.at(v)) == LumenLabel::tagged;
        return around;
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& segmentation_;
    const LocalMeans& means_;
    const InterfaceLayer& interfaces_;
};

}  // namespace

Result<Volume<TissueFractions>> estimateMixture(const CtScan& scan, const TissueModel& tissue,
                                                const Volume<std::uint8_t>& segmentation,
                                                glm::dvec3 gravity, const MixtureOptions& options) {
    (void)gravity;
    const Grid& grid = scan.hu.grid();
    if (!sameGrid(grid, segmentation.grid())) {
        return fail(ErrorKind::badInput, "the segmentation is not on the scan's grid", "mixture");
    }
    if (grid.voxelCount() > std::numeric_limits<std::uint32_t>::max()) {
        return fail(ErrorKind::unsupported, "the scan has more than 2^32 voxels", "mixture");
    }
    auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    progress(0.0);
    const PartialVolumeModel model = fitPartialVolume(scan, tissue, options.threads);
    progress(0.1);
    Volume<TissueFractions> mixture(grid);
    const auto out = mixture.writable();
    const auto hu = scan.hu.voxels();
    parallelFor(out.size(), std::size_t(1) << 20, options.threads,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t n = begin; n < end; ++n)
                        out[n] = model.fractionsOf(hu[n]);
                });
    progress(0.2);
    const TaggedSurroundings around = taggedSurroundings(segmentation, options.threads);
    progress(0.3);
    if (around.shells[0].empty()) return mixture;
    const LocalMeans means = measureLocalMeans(scan, tissue, segmentation, around, options.threads);
    progress(0.5);
    const InterfaceLayer interfaces(scan, segmentation, means, options.threads);
    progress(0.6);
    const ColonMixture colon(scan, segmentation, means, interfaces);
    for (const auto& shell : around.shells) {
        parallelFor(shell.size(), 4096, options.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n)
                out[shell[n]] = colon.at(shell[n]);
        });
    }
    progress(1.0);
    return mixture;
}

}  // namespace haustra::cleansing
