#include "phantom/phantom.h"

#include "phantom/anatomy.h"
#include "phantom/filled_colon.h"
#include "phantom/growths.h"
#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/scanner.h"
#include "phantom/truth.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {
namespace {

constexpr double kLumenAirHu = -990.0;
constexpr double kWallHu = 42.0;

/// Paints the colon's wall and growths over the anatomy, and its contents into two volumes.
class ColonPainter {
public:
    ColonPainter(const ColonShape& shape, const ColonField& field, const Fluid& fluid,
                 std::uint64_t seed)
        : shape_(shape), field_(field), fluid_(fluid), seed_(mixBits(seed + 31)) {
        const glm::dvec3 spacing = field.grid().spacingMm();
        width_ = std::cbrt(spacing.x * spacing.y * spacing.z);
        levelWidth_ = glm::dot(glm::abs(fluid.up), spacing);
        for (const Growth& growth : shape.growths()) {
            if (growth.kind == Growth::Kind::taggedStool) stool_.push_back(&growth);
        }
    }

    void paintBlock(int block, std::span<float> tagged, std::span<float> untagged,
                    std::span<std::uint8_t> labels) const {
        const Grid& grid = field_.grid();
        const auto& samples = field_.block(block);
        const glm::ivec3 origin = field_.blockOrigin(block);
        constexpr int n = ColonField::blockSize;
        std::vector<const Growth*> stool;
        const glm::dvec3 centre = grid.patientFromVoxelPoint(glm::dvec3(origin) + 0.5 * (n - 1.0));
        for (const Growth* ball : stool_) {
            if (glm::distance(ball->centre, centre) <
                ball->reachMm() + 2.0 + n * glm::length(grid.spacingMm())) {
                stool.push_back(ball);
            }
        }
        for (int v = 0; v < ColonField::blockVoxels; ++v) {
            const ColonField::Sample& s = samples[v];
            if (std::min(s.outerMm, s.lumenMm) > width_) continue;
            const glm::ivec3 voxel = origin + glm::ivec3(v % n, v / n % n, v / (n * n));
            const std::size_t at = grid.index(voxel);
            const glm::dvec3 p = grid.patientFromVoxelPoint(voxel);
            const double around = untagged[at];
            const double solid =
                glm::mix(around, solidHu(s, p), coverage(std::min(s.outerMm, s.lumenMm), width_));
            const double share = coverage(s.lumenMm, width_);
            const Contents inside = contents(s, p, stool);
            untagged[at] = float(glm::mix(solid, kLumenAirHu, share));
            tagged[at] =
                float(glm::mix(solid, glm::mix(kLumenAirHu, inside.hu, inside.share), share));
            if (s.lumenMm < 0.0f) {
                labels[at] = std::uint8_t(inside.tagged ? LumenLabel::tagged : LumenLabel::air);
            }
        }
    }

private:
    struct Contents {
        double hu = 0.0, share = 0.0;  ///< of what is tagged
        bool tagged = false;           ///< at the voxel's centre
    };

    double solidHu(const ColonField::Sample& s, glm::dvec3 p) const {
        if (s.growth < 0) return kWallHu + 6.0 * valueNoise(seed_, p, 6.0);
        const Growth& growth = shape_.growths()[std::size_t(s.growth)];
        if (growth.kind == Growth::Kind::untaggedStool) {
            // Crumbs with bubbles of gas between.
            const double crumb = valueNoise(growth.seed, p, 3.0);
            return crumb > 0.35 ? -350.0 : growth.hu + 40.0 * crumb;
        }
        if (growth.kind == Growth::Kind::hyperplastic) return kWallHu + 3.0;
        // Adenomas are a little denser inside, unevenly.
        const double core = 1.0 - smoothstep(-2.0, -0.5, growth.distance(p));
        return kWallHu + core * (22.0 + 18.0 * valueNoise(growth.seed + 9, p, 3.5));
    }

    Contents contents(const ColonField::Sample& s, glm::dvec3 p,
                      const std::vector<const Growth*>& stool) const {
        Contents inside;
        const Pool& pool = fluid_.poolAt(s.arcMm);
        const double height = fluid_.heightMm(p), level = pool.levelAt(s.lumenMm);
        inside.share = coverage(height - level, levelWidth_);
        inside.tagged = height < level;
        if (inside.share > 0.0) inside.hu = pool.huAt(p, height);
        for (const Growth* ball : stool) {
            const double d = ball->distance(p), share = coverage(d, width_);
            if (share <= inside.share && d >= 0.0) continue;
            inside.hu = ball->hu * (1.0 + 0.15 * valueNoise(ball->seed, p, 4.0));
            inside.share = std::max(share, inside.share);
            inside.tagged = inside.tagged || d < 0.0;
        }
        return inside;
    }

    const ColonShape& shape_;
    const ColonField& field_;
    const Fluid& fluid_;
    std::uint64_t seed_;
    double width_ = 1.0, levelWidth_ = 1.0;
    std::vector<const Growth*> stool_;
};

}  // namespace

Result<Phantom> makePhantom(const PhantomOptions& options) {
    if (options.position != PatientPosition::supine && options.position != PatientPosition::prone) {
        return fail(ErrorKind::badInput, "a phantom lies supine or prone", "phantom");
    }
    auto report = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    const BodyPlan body = bodyOf(options);
    const auto [shape, field, fluid] = makeFilledColon(options);
    const Grid& grid = field.grid();
    report(0.3);

    Phantom phantom;
    phantom.lumen = Volume<std::uint8_t>(grid, 0);
    Volume<float> untagged(grid, -1000.0f);
    auto solids = makeAnatomy(options.seed, body);
    for (Solid& solid : makeOtherBowel(options.seed, options.preset, body))
        solids.push_back(std::move(solid));
    const std::size_t slice = std::size_t(grid.size.x) * grid.size.y;
    parallelFor(
        std::size_t(grid.size.z), 1, options.threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                paintSlice(solids, grid, field, int(k), untagged.writable().data() + k * slice);
            }
        });
    report(0.6);
    Volume<float> tagged = untagged.clone();
    const ColonPainter painter(shape, field, fluid, options.seed);
    const auto taggedOut = tagged.writable(), untaggedOut = untagged.writable();
    const auto labels = phantom.lumen.writable();
    parallelFor(std::size_t(field.blockCount()), 64, options.threads,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t b = begin; b < end; ++b)
                        painter.paintBlock(int(b), taggedOut, untaggedOut, labels);
                });
    report(0.65);

    Random random(options.seed, 7);
    const double inPlaneMm = random.uniform(0.85, 1.15);
    const glm::dvec3 fwhmMm{inPlaneMm, inPlaneMm, 1.2};
    Noise noise;
    noise.seed = mixBits(options.seed * 2 + (body.position == PatientPosition::prone));
    noise.sdHu = options.preset == Preset::easy       ? random.uniform(10.0, 13.0)
                 : options.preset == Preset::standard ? random.uniform(14.0, 20.0)
                                                      : random.uniform(26.0, 35.0);
    blur(untagged, fwhmMm, options.threads);
    phantom.untaggedHu = addNoise(untagged, noise, options.threads);
    untagged = {};
    report(0.8);
    blur(tagged, fwhmMm, options.threads);
    phantom.scan.hu = addNoise(tagged, noise, options.threads);
    phantom.scan.position = options.position;
    tagged = {};
    report(0.95);

    phantom.centerline = trueCenterline(shape, phantom.lumen, options.threads);
    phantom.polyps = polypsOf(shape);
    phantom.polypVoxels = polypVoxels(shape, grid);
    phantom.noiseSdHu = noise.sdHu;
    report(1.0);
    return phantom;
}

}  // namespace haustra::phantom
