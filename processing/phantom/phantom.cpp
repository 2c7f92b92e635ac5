#include "phantom/phantom.h"

#include "core/voxel_sweep.h"
#include "phantom/anatomy.h"
#include "phantom/colon_skeleton.h"
#include "phantom/contacts.h"
#include "phantom/filled_colon.h"
#include "phantom/growth_truth.h"
#include "phantom/growths.h"
#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/rectal_tube.h"
#include "phantom/scanner.h"
#include "phantom/streaks.h"
#include "phantom/truth.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

namespace haustra::phantom {
namespace {

constexpr double lumenAirHu = -990.0;
constexpr double wallHu = 42.0;
constexpr double bowelGasHu = -985.0;
constexpr double cecumMm = 60.0;  ///< its length where there is no ileocecal valve to begin it

/// Some slices of a scan on its way through the scanner: those that are wanted, and as many on
/// either side as their blur draws on.
struct Slab {
    int first = 0;           ///< of the whole's slices, the slab's first
    int begin = 0, end = 0;  ///< of the slab's slices, those that are wanted
    Volume<float> tagged, untagged;
    std::vector<std::uint8_t> lumen, sites;

    const Grid& grid() const { return tagged.grid(); }
};

/// Paints the colon's wall and growths over the anatomy, and its contents into two volumes.
class ColonPainter {
public:
    ColonPainter(const FilledColon& colon, const PhantomOptions& options)
        : shape_(colon.shape),
          field_(colon.field),
          fluid_(colon.fluid),
          films_(colon.films),
          growths_(options.growths),
          seed_(mixBits(options.seed + 31)) {
        const glm::dvec3 spacing = field_.grid().spacingMm();
        width_ = std::cbrt(spacing.x * spacing.y * spacing.z);
        levelWidth_ = glm::dot(glm::abs(fluid_.up), spacing);
        for (const Growth& growth : shape_.growths()) {
            if (growth.kind == Growth::Kind::taggedStool) stool_.push_back(&growth);
        }
    }

    /// `fieldOffset` is the field's slice at the slab's first.
    void paintBlock(int block, int fieldOffset, Slab& slab) const {
        const Grid& grid = slab.grid();
        const auto& samples = field_.block(block);
        const glm::ivec3 origin = field_.blockOrigin(block);
        constexpr int n = ColonField::blockSize;
        if (origin.z + n <= fieldOffset || origin.z >= fieldOffset + grid.size.z) return;
        const auto tagged = slab.tagged.writable(), untagged = slab.untagged.writable();
        std::vector<const Growth*> stool;
        const glm::dvec3 center =
            field_.grid().patientFromVoxelPoint(glm::dvec3(origin) + 0.5 * (n - 1.0));
        for (const Growth* ball : stool_) {
            if (glm::distance(ball->center, center) <
                ball->reachMm() + 2.0 + n * glm::length(grid.spacingMm())) {
                stool.push_back(ball);
            }
        }
        std::vector<const Film*> films;
        for (const Film& film : films_) {
            if (glm::distance(film.center, center) <
                film.reachMm() + n * glm::length(grid.spacingMm()))
                films.push_back(&film);
        }
        for (int v = 0; v < ColonField::blockVoxels; ++v) {
            const ColonField::Sample& s = samples[v];
            if (std::min(s.outerMm, s.lumenMm) > width_) continue;
            const glm::ivec3 inField = origin + glm::ivec3(v % n, v / n % n, v / (n * n));
            const glm::ivec3 voxel = inField - glm::ivec3(0, 0, fieldOffset);
            if (voxel.z < 0 || voxel.z >= grid.size.z) continue;
            const std::size_t at = grid.index(voxel);
            const glm::dvec3 p = field_.grid().patientFromVoxelPoint(inField);
            const double around = untagged[at];
            const double solid =
                glm::mix(around, solidHu(s, p), coverage(std::min(s.outerMm, s.lumenMm), width_));
            const double share = coverage(s.lumenMm, width_);
            Contents inside = contents(s, p, stool);
            for (const Film* film : films)
                coat(*film, s, p, inside);
            const double rest = glm::mix(lumenAirHu, inside.untaggedHu, inside.untaggedShare);
            untagged[at] = float(glm::mix(solid, rest, share));
            tagged[at] =
                float(glm::mix(solid, glm::mix(lumenAirHu, inside.hu, inside.share), share));
            if (s.lumenMm < 0.0f && !besideAnotherLoop(s, inField)) {
                slab.lumen[at] = std::uint8_t(inside.tagged ? LumenLabel::tagged : LumenLabel::air);
                slab.sites[at] =
                    std::uint8_t(inside.tagged && inside.untaggedShare > 0.5 ? Site::untaggedFluid
                                                                             : Site::elsewhere);
            } else if (std::min(s.outerMm, s.lumenMm) < 0.0f) {
                slab.sites[at] = std::uint8_t(Site::colonWall);
            }
        }
    }

private:
    struct Contents {
        double hu = 0.0, share = 0.0;  ///< of what is not gas
        bool tagged = false;           ///< at the voxel's centre
        /// Of what stays where the tagging is taken out.
        double untaggedHu = 0.0, untaggedShare = 0.0;
    };

    /// Whether a neighbour lies deeper in the lumen of another loop: where the septum is thinner
    /// than a voxel, the shallower of the two voxels is the septum's.
    bool besideAnotherLoop(const ColonField::Sample& s, glm::ivec3 voxel) const {
        const Grid& grid = field_.grid();
        const double spacing = grid.spacingMm().x;
        if (shape_.septumMm() >= 3.0 || s.lumenMm < -2.0 * spacing) return false;
        const double radius = shape_.path().at(s.arcMm).radiusMm;
        for (int n = 0; n < 27; ++n) {
            const glm::ivec3 w = voxel + cornerStep(n);
            if (n == 13 || !grid.contains(w)) continue;
            const ColonField::Sample& other = field_.at(w.x, w.y, w.z);
            if (other.lumenMm >= 0.0f) continue;
            if (std::abs(other.arcMm - s.arcMm) <
                loopSeparationMm(radius, shape_.path().at(other.arcMm).radiusMm))
                continue;
            if (other.lumenMm < s.lumenMm || (other.lumenMm == s.lumenMm && n < 13)) return true;
        }
        return false;
    }

    double solidHu(const ColonField::Sample& s, glm::dvec3 p) const {
        if (s.growth < 0) return wallHu + 6.0 * valueNoise(seed_, p, 6.0);
        const Growth& growth = shape_.growths()[std::size_t(s.growth)];
        if (growth.kind == Growth::Kind::untaggedStool) {
            // Crumbs with bubbles of gas between.
            const double crumb = valueNoise(growth.seed, p, 3.0);
            return crumb > 0.35 ? -350.0 : growth.hu + 40.0 * crumb;
        }
        if (growth.kind == Growth::Kind::hyperplastic) return wallHu + 3.0;
        // Adenomas are a little denser inside, unevenly.
        const double hu = wallHu + densityOf(growth, growths_);
        if (isPlain(growth, growths_)) return hu + 6.0 * valueNoise(seed_, p, 6.0);
        const double core = 1.0 - smoothstep(-2.0, -0.5, growth.distance(p));
        return hu + core * (22.0 + 18.0 * valueNoise(growth.seed + 9, p, 3.5));
    }

    Contents contents(const ColonField::Sample& s, glm::dvec3 p,
                      const std::vector<const Growth*>& stool) const {
        Contents inside;
        const Pool& pool = fluid_.poolAt(s.arcMm);
        const double height = fluid_.heightMm(p), level = pool.levelAt(s.lumenMm);
        inside.share = coverage(height - level, levelWidth_);
        inside.tagged = height < level;
        if (inside.share > 0.0) inside.hu = pool.huAt(p, height);
        if (inside.share > 0.0 && (!pool.tagged || pool.waterMm > 0.0)) {
            inside.untaggedHu = pool.tagged ? waterHu : inside.hu;
            inside.untaggedShare = inside.share * (1.0 - pool.taggedShareAt(height));
        }
        for (const Growth* ball : stool) {
            const double d = ball->distance(p), share = coverage(d, width_);
            if (share <= inside.share && d >= 0.0) continue;
            inside.hu = ball->hu * (1.0 + 0.15 * valueNoise(ball->seed, p, 4.0));
            inside.share = std::max(share, inside.share);
            inside.tagged = inside.tagged || d < 0.0;
            inside.untaggedShare = std::min(inside.untaggedShare, 1.0 - share);
        }
        return inside;
    }

    void coat(const Film& film, const ColonField::Sample& s, glm::dvec3 p, Contents& inside) const {
        inside.tagged = inside.tagged || s.lumenMm > -film.thicknessAt(p);
        const double share = film.share(p, s.lumenMm, width_);
        if (share <= inside.share) return;
        inside.hu = film.hu * (1.0 + 0.15 * valueNoise(film.seed + 2, p, 4.0));
        inside.share = share;
        inside.untaggedShare = std::min(inside.untaggedShare, 1.0 - share);
    }

    const ColonShape& shape_;
    const ColonField& field_;
    const Fluid& fluid_;
    const std::vector<Film>& films_;
    GrowthOptions growths_;
    std::uint64_t seed_;
    double width_ = 1.0, levelWidth_ = 1.0;
    std::vector<const Growth*> stool_;
};

/// Paints the ileum's contents over what the anatomy and the colon left.
void paintIleum(const Ileum& ileum, glm::dvec3 up, const ColonField& field, int fieldOffset,
                Slab& slab, int threads) {
    const Grid& grid = slab.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    const double width = std::cbrt(spacing.x * spacing.y * spacing.z);
    const double levelWidth = glm::dot(glm::abs(up), spacing);
    const auto tagged = slab.tagged.writable(), untagged = slab.untagged.writable();
    parallelFor(std::size_t(grid.size.z), 1, threads, [&](std::size_t from, std::size_t to) {
        for (int k = int(from); k < int(to); ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                for (int i = 0; i < grid.size.x; ++i) {
                    const glm::dvec3 p = grid.patientFromVoxelPoint({i, j, k});
                    const double d = ileum.lumenMm(p, field.at(i, j, k + fieldOffset).lumenMm);
                    const double share = coverage(d, width);
                    if (share <= 0.0) continue;
                    const double fluid = coverage(glm::dot(up, p) - ileum.levelMm, levelWidth);
                    const double hu = glm::mix(bowelGasHu, ileum.fluidHu, fluid);
                    const std::size_t at = grid.index(i, j, k);
                    tagged[at] = float(glm::mix(double(tagged[at]), hu, share));
                    untagged[at] = float(glm::mix(double(untagged[at]), hu, share));
                    if (d < 0.0 && !slab.lumen[at]) slab.sites[at] = std::uint8_t(Site::ileum);
                }
            }
        }
    });
}

/// The ileum's wall, which the anatomy's painter paints.
Solid wallOf(const Ileum& ileum) {
    Solid solid;
    solid.lowMm = glm::dvec3(1e9), solid.highMm = glm::dvec3(-1e9);
    for (const Tube::Node& node : ileum.tube().nodes()) {
        const double reach = node.radiusMm + Ileum::wallMm + 3.0;
        solid.lowMm = glm::min(solid.lowMm, node.position - reach);
        solid.highMm = glm::max(solid.highMm, node.position + reach);
    }
    solid.distance = [&ileum](glm::dvec3 p) { return ileum.outerMm(p); };
    solid.hu = tissue(45.0, 0.0, 0);
    return solid;
}

void paintRectalTube(const RectalTube& tube, const ColonField& field, int fieldOffset, Slab& slab) {
    const Grid& grid = slab.grid();
    const double width = std::cbrt(grid.voxelVolumeMm3());
    const glm::dvec3 low = grid.voxelFromPatientPoint(tube.lowMm()),
                     high = grid.voxelFromPatientPoint(tube.highMm());
    const glm::ivec3 lo = glm::max(glm::ivec3(glm::floor(low)), glm::ivec3(0)),
                     hi = glm::min(glm::ivec3(glm::ceil(high)), grid.size - 1);
    const auto tagged = slab.tagged.writable(), untagged = slab.untagged.writable();
    visitBox(lo, hi, [&](glm::ivec3 v) {
        const RectalTube::Point point = tube.at(grid.patientFromVoxelPoint(glm::dvec3(v)),
                                                field.at(v.x, v.y, v.z + fieldOffset).lumenMm);
        const double share = coverage(point.outerMm, width);
        if (share <= 0.0) return;
        const std::size_t at = grid.index(v);
        tagged[at] = float(glm::mix(double(tagged[at]), point.hu, share));
        untagged[at] = float(glm::mix(double(untagged[at]), point.hu, share));
        if (point.outerMm >= 0.0) return;
        slab.sites[at] = std::uint8_t(Site::device);
        // What the device fills holds no fluid.
        if (slab.lumen[at]) slab.lumen[at] = std::uint8_t(LumenLabel::air);
    });
}

Result<void> check(const PhantomOptions& options) {
    const BowelOptions& bowel = options.bowel;
    const auto bad = [](const std::string& what) {
        return fail(ErrorKind::badInput, what, "phantom");
    };
    const auto share = [](double s) { return s >= 0.0 && s <= 1.0; };
    if (options.position == PatientPosition::unknown)
        return bad("a phantom lies supine, prone or on a side");
    const ScanOptions& scan = options.scan;
    const auto given = [](double value, double low, double high) {
        return value == 0.0 || (value >= low && value <= high);
    };
    if (!given(scan.fieldOfViewMm, 250.0, 500.0)) return bad("a field of view is 250 to 500 mm");
    for (int axis = 0; axis < 3; ++axis) {
        if (!given(scan.blurMm[axis], 0.3, 6.0)) return bad("a point spread is 0.3 to 6 mm wide");
    }
    if (!(scan.overshoot >= 0.0 && scan.overshoot <= 0.6))
        return bad("a kernel's overshoot is 0 to 0.6");
    if (!(scan.noiseSdHu >= 0.0 && scan.noiseSdHu <= 100.0)) return bad("noise is 0 to 100 HU");
    if (!(scan.grainMm >= 0.5 && scan.grainMm <= 4.0)) return bad("grain is 0.5 to 4 mm");
    if (!(scan.pseudoEnhancementHu >= 0.0 && scan.pseudoEnhancementHu <= 100.0))
        return bad("pseudo-enhancement is 0 to 100 HU");
    if (!(scan.streakHu >= 0.0 && scan.streakHu <= 100.0)) return bad("streaks are 0 to 100 HU");
    const GrowthOptions& growths = options.growths;
    if (!share(growths.plainCores) || !share(growths.coated))
        return bad("a share of polyps is 0 to 1");
    if (!(std::abs(growths.polypHu) <= 60.0 && growths.polypSdHu >= 0.0 &&
          growths.polypSdHu <= 30.0))
        return bad("polyps are denser than the wall by −60 to 60 HU, with a deviation of 0 to 30");
    if (growths.morePolyps < 0 || growths.morePolyps > 40 || growths.moreUntaggedStool < 0 ||
        growths.moreUntaggedStool > 40 || growths.moreFlat < 0 || growths.moreFlat > 40 ||
        growths.films < 0 || growths.films > 40)
        return bad("there may be 0 to 40 more growths of a kind");
    if (!(bowel.ileumMm >= 0.0 && bowel.ileumMm <= 2000.0))
        return bad("an ileum is 0 to 2000 mm long");
    if (!(bowel.ileumCalibreMm >= 12.0 && bowel.ileumCalibreMm <= 30.0))
        return bad("an ileum is 12 to 30 mm wide");
    if (!(bowel.septumMm >= 0.5 && bowel.septumMm <= 5.0))
        return bad("a septum is 0.5 to 5 mm thick");
    for (const double length : bowel.collapsesMm) {
        if (!(length >= 5.0 && length <= 60.0)) return bad("a collapse is 5 to 60 mm long");
    }
    if (!(bowel.redundantSigmoidMm >= 0.0 && bowel.redundantSigmoidMm <= 400.0))
        return bad("a sigmoid is at most 400 mm longer");
    if (!share(bowel.untagged) || !share(bowel.layered) || !share(bowel.full))
        return bad("shares of the fluid are 0 to 1");
    if (bowel.diverticula < 0 || bowel.diverticula > 500)
        return bad("a colon has 0 to 500 diverticula");
    return {};
}

Structure structureOf(const FilledColon& colon, const PhantomOptions& options,
                      const Phantom& phantom) {
    Structure structure;
    const ColonShape& shape = colon.shape;
    const ColonPath& path = shape.path();
    const auto& points = phantom.centerline.points;
    for (std::size_t n = 0; n < points.size(); ++n) {
        if (!points[n].gap || (n > 0 && points[n - 1].gap)) continue;
        std::size_t last = n;
        while (last + 1 < points.size() && points[last + 1].gap)
            ++last;
        structure.collapses.push_back(
            {points[n].arcMm, points[last].arcMm, points[n].positionMm, points[last].positionMm});
    }
    if (const auto& valve = shape.valve())
        structure.valve = {valve->at, valve->inward, valve->arcMm, valve->open};
    if (options.bowel.rectalTube) structure.rectalTube = RectalTube(path, options.seed).structure();
    for (const Diverticulum& pouch : shape.diverticula())
        structure.diverticula.push_back({pouch.center, 2.0 * pouch.sacRadiusMm});
    structure.segmentEndsMm = {path.rectumEndMm,
                               path.sigmoidEndMm,
                               path.descendingEndMm,
                               path.transverseEndMm,
                               shape.valve() ? shape.valve()->arcMm : path.lengthMm() - cecumMm,
                               path.lengthMm()};
    if (colon.ileum) structure.ileumMm = colon.ileum->tube().lengthMm();
    const double ml = phantom.lumen.grid().voxelVolumeMm3() * 1e-3;
    std::size_t air = 0, tagged = 0, untagged = 0, ileum = 0;
    for (std::size_t n = 0; n < phantom.lumen.grid().voxelCount(); ++n) {
        const bool water = phantom.sites[n] == std::uint8_t(Site::untaggedFluid);
        air += phantom.lumen[n] == 1, untagged += water, tagged += phantom.lumen[n] == 2 && !water;
        ileum += phantom.sites[n] == std::uint8_t(Site::ileum);
    }
    structure.airMl = ml * double(air), structure.taggedMl = ml * double(tagged);
    structure.untaggedMl = ml * double(untagged), structure.ileumMl = ml * double(ileum);
    return structure;
}

/// Slices begin…end − 1 of a grid.
Grid slicesOf(const Grid& grid, int begin, int end) {
    Grid some = grid;
    some.size.z = end - begin;
    some.patientFromVoxel[3] += double(begin) * grid.patientFromVoxel[2];
    return some;
}

constexpr int slabSlices = 64;

/// The slab of slices from…to − 1, empty.
Slab slabOf(const Grid& grid, int from, int to, int halo) {
    Slab slab;
    slab.first = std::max(0, from - halo);
    slab.begin = from - slab.first, slab.end = to - slab.first;
    const Grid some = slicesOf(grid, slab.first, std::min(grid.size.z, to + halo));
    slab.untagged = Volume<float>(some, -1000.0f);
    slab.sites.assign(some.voxelCount(), std::uint8_t(Site::outsideBody));
    slab.lumen.assign(some.voxelCount(), 0);
    return slab;
}

/// What all of the body measures before a scanner blurs it.
class Painter {
public:
    Painter(const PhantomOptions& options, const BodyPlan& body, const FilledColon& filled)
        : filled_(filled),
          colon_(filled, options),
          solids_(makeAnatomy(options.seed, body)),
          threads_(options.threads) {
        if (options.scan.metalHip) add(makeMetalHip(options.seed));
        add(makeOtherBowel(options.seed, options.preset, body));
        if (filled.ileum) solids_.push_back(wallOf(*filled.ileum));
        if (options.bowel.rectalTube) rectalTube_.emplace(filled.shape.path(), options.seed);
    }

    void paint(Slab& slab) const {
        paintAnatomy(slab);
        slab.tagged = slab.untagged.clone();
        parallelFor(std::size_t(filled_.field.blockCount()), 64, threads_,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t b = begin; b < end; ++b)
                            colon_.paintBlock(int(b), slab.first, slab);
                    });
        if (filled_.ileum)
            paintIleum(*filled_.ileum, filled_.fluid.up, filled_.field, slab.first, slab, threads_);
        if (rectalTube_) paintRectalTube(*rectalTube_, filled_.field, slab.first, slab);
    }

private:
    void add(std::vector<Solid> more) {
        std::move(more.begin(), more.end(), std::back_inserter(solids_));
    }

    void paintAnatomy(Slab& slab) const {
        const Grid& grid = filled_.field.grid();
        const std::size_t slice = std::size_t(grid.size.x) * std::size_t(grid.size.y);
        const auto untagged = slab.untagged.writable();
        parallelFor(std::size_t(slab.untagged.grid().size.z), 1, threads_,
                    [&](std::size_t begin, std::size_t end) {
                        for (std::size_t k = begin; k < end; ++k) {
                            paintSlice(solids_, grid, filled_.field, slab.first + int(k),
                                       slab.first + int(k), untagged.data() + k * slice,
                                       slab.sites.data() + k * slice);
                        }
                    });
    }

    const FilledColon& filled_;
    const ColonPainter colon_;
    std::vector<Solid> solids_;
    std::optional<RectalTube> rectalTube_;
    const int threads_;
};

/// The slices that are wanted of a slab's labels, the first of them at `from`.
void copyLabels(const Slab& slab, int from, Phantom& phantom) {
    const std::size_t slice = slab.grid().index(0, 0, 1), at = std::size_t(from) * slice,
                      skip = std::size_t(slab.begin) * slice,
                      count = std::size_t(slab.end - slab.begin) * slice;
    std::copy_n(slab.lumen.data() + skip, count, phantom.lumen.writable().data() + at);
    std::copy_n(slab.sites.data() + skip, count, phantom.sites.writable().data() + at);
}

/// Blur, noise and artefacts.
class Scanner {
public:
    Scanner(const PhantomOptions& options, const BodyPlan& body, const Grid& grid)
        : options_(options.scan), threads_(options.threads) {
        Random random(options.seed, 7);
        const double inPlaneMm = random.uniform(0.85, 1.15);
        fwhmMm_ = {inPlaneMm, inPlaneMm, 1.2};
        for (int axis = 0; axis < 3; ++axis) {
            if (options_.blurMm[axis] > 0.0) fwhmMm_[axis] = options_.blurMm[axis];
        }
        noise_.seed = mixBits(options.seed * 2 + (body.position == PatientPosition::prone));
        noise_.sdHu = options.preset == Preset::easy       ? random.uniform(10.0, 13.0)
                      : options.preset == Preset::standard ? random.uniform(14.0, 20.0)
                                                           : random.uniform(26.0, 35.0);
        if (options_.noiseSdHu > 0.0) noise_.sdHu = options_.noiseSdHu;
        noise_.correlationMm = options_.grainMm;
        streaks_ = {noise_.seed, options_.streakHu, options_.metalHip};
        haloSlices_ = blurReachSlices(grid, fwhmMm_);
    }

    double noiseSdHu() const { return noise_.sdHu; }
    int haloSlices() const { return haloSlices_; }

    /// Scans the slices that are wanted of a slab, the first of them at `from`.
    void expose(Slab& slab, int from, Phantom& phantom) const {
        const int count = slab.end - slab.begin;
        Volume<float> streaks;
        if (streaks_.noiseHu > 0.0 || streaks_.hardening)
            streaks = streaksOf(slab.untagged, slab.begin, count, from, streaks_, threads_);
        const std::size_t slice = slab.grid().index(0, 0, 1);
        const auto scanned = [&](Volume<float>& clean, Volume<std::int16_t>& hu) {
            reconstruct(clean, fwhmMm_, options_.overshoot, threads_);
            for (std::size_t n = 0; n < streaks.grid().voxelCount(); ++n)
                clean.writable()[std::size_t(slab.begin) * slice + n] += streaks[n];
            addNoise(clean, slab.begin, count, from, noise_, threads_,
                     hu.writable().subspan(std::size_t(from) * slice, std::size_t(count) * slice));
        };
        if (options_.pseudoEnhancementHu > 0.0) {
            enhanceBesideTagging(slab.tagged, slab.untagged, options_.pseudoEnhancementHu,
                                 threads_);
        }
        scanned(slab.untagged, phantom.untaggedHu);
        scanned(slab.tagged, phantom.scan.hu);
    }

private:
    const ScanOptions options_;
    const int threads_;
    glm::dvec3 fwhmMm_{1.0};  ///< of the point spread
    Noise noise_;
    Streaks streaks_;
    int haloSlices_ = 0;  ///< on either side of a slab, as its blur draws on them
};

}  // namespace

PhantomOptions wildOptions(std::uint64_t seed) {
    PhantomOptions options;
    options.seed = seed;
    Random random(seed, 40);
    options.preset = random.chance(0.5) ? Preset::standard : Preset::hard;
    BowelOptions& bowel = options.bowel;
    if (random.chance(0.85)) bowel.ileumMm = random.uniform(250.0, 900.0);
    bowel.ileumCalibreMm = random.uniform(12.0, 30.0);
    bowel.valveOpen = random.chance(0.5);
    if (random.chance(0.75)) bowel.septumMm = random.uniform(0.5, 1.0);
    for (int left = random.index(4); left > 0; --left)
        bowel.collapsesMm.push_back(random.uniform(5.0, 60.0));
    if (random.chance(0.4)) bowel.redundantSigmoidMm = random.uniform(100.0, 300.0);
    if (random.chance(0.6)) bowel.untagged = random.uniform(0.1, 0.4);
    if (random.chance(0.6)) bowel.layered = random.uniform(0.1, 0.5);
    if (random.chance(0.6)) bowel.full = random.uniform(0.1, 0.5);
    if (random.chance(0.5)) bowel.diverticula = 10 + random.index(91);
    bowel.rectalTube = random.chance(0.5);
    ScanOptions& scan = options.scan;
    Random scanner(seed, 41);
    scan.fieldOfViewMm = scanner.uniform(320.0, 500.0);
    if (scanner.chance(0.5)) {
        const double plane = scanner.uniform(0.6, 1.5);
        scan.blurMm = {plane, plane * scanner.uniform(0.8, 1.25), scanner.uniform(0.8, 3.0)};
    }
    if (scanner.chance(0.5)) scan.overshoot = scanner.uniform(0.1, 0.6);
    scan.grainMm = scanner.uniform(0.8, 2.5);
    if (scanner.chance(0.6)) scan.pseudoEnhancementHu = scanner.uniform(10.0, 80.0);
    Random room(seed, 42);
    if (room.chance(0.5)) scan.streakHu = room.uniform(5.0, 40.0);
    scan.metalHip = room.chance(0.15);
    scan.feetFirst = room.chance(0.3);
    return options;
}

Result<Phantom> makePhantom(const PhantomOptions& options) {
    TRY(check(options));
    auto report = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    const BodyPlan body = bodyOf(options);
    const FilledColon filled = makeFilledColon(options);
    const Grid& grid = filled.field.grid();
    report(0.3);

    const Painter painter(options, body, filled);
    const Scanner scanner(options, body, grid);
    Phantom phantom;
    phantom.lumen = Volume<std::uint8_t>(grid);
    phantom.sites = Volume<std::uint8_t>(grid);
    phantom.scan.hu = Volume<std::int16_t>(grid);
    phantom.untaggedHu = Volume<std::int16_t>(grid);
    phantom.scan.position = options.position;
    phantom.noiseSdHu = scanner.noiseSdHu();
    for (int from = 0; from < grid.size.z; from += slabSlices) {
        const int to = std::min(grid.size.z, from + slabSlices);
        Slab slab = slabOf(grid, from, to, scanner.haloSlices());
        painter.paint(slab);
        copyLabels(slab, from, phantom);
        scanner.expose(slab, from, phantom);
        report(0.3 + 0.65 * double(to) / grid.size.z);
    }

    phantom.centerline = trueCenterline(filled.shape, phantom.lumen, options.threads);
    phantom.polyps = polypsOf(filled.shape);
    phantom.growths = growthTruths(filled, options.growths);
    phantom.polypVoxels = polypVoxels(filled.shape, grid);
    phantom.structure = structureOf(filled, options, phantom);
    ContactFinder contacts(filled.shape);
    contacts.look(phantom.lumen, phantom.sites, filled.field, 0,
                  filled.ileum ? &*filled.ileum : nullptr, 0, grid.size.z, options.threads);
    phantom.structure.contacts = contacts.contacts();
    report(1.0);
    return phantom;
}

}  // namespace haustra::phantom
