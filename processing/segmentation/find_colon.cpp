#include "segmentation/find_colon.h"

#include "core/printed_text.h"
#include "core/slice_steps.h"
#include "core/voxel_sweep.h"
#include "segmentation/body_frame.h"
#include "segmentation/bowel_contents.h"
#include "segmentation/chain_graph.h"
#include "segmentation/colon_labels.h"
#include "segmentation/edge_overshoot.h"
#include "segmentation/field_of_view.h"
#include "segmentation/haustral_folds.h"
#include "segmentation/metal.h"
#include "segmentation/record_colon.h"
#include "segmentation/thin_walls.h"
#include "segmentation/told_places.h"
#include "segmentation/tube_pieces.h"
#include "segmentation/untagged_levels.h"
#include "segmentation/untagged_pools.h"
#include "segmentation/working_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

namespace haustra::segmentation {
namespace {

template <class Visit>
void visitBalls(const Grid& grid, const std::vector<CutBall>& balls, const Visit& visit) {
    for (const CutBall& ball : balls) {
        const glm::dvec3 center = grid.voxelFromPatientPoint(ball.centerMm);
        const glm::ivec3 reach = glm::ivec3(ball.radiusMm / grid.spacingMm()) + 1;
        const glm::ivec3 lo = glm::max(glm::ivec3(center) - reach, glm::ivec3(0)),
                         hi = glm::min(glm::ivec3(center) + reach + 1, grid.size - 1);
        visitBox(lo, hi, [&](glm::ivec3 v) {
            if (glm::distance(grid.patientFromVoxelPoint(glm::dvec3(v)), ball.centerMm) <=
                ball.radiusMm)
                visit(grid.index(v));
        });
    }
}

void cutBalls(BowelContents& contents, const std::vector<CutBall>& balls) {
    const auto voxels = contents.content.writable();
    visitBalls(contents.content.grid(), balls, [&](std::size_t n) {
        if (Content(voxels[n]) != Content::beyond) voxels[n] = std::uint8_t(Content::tissue);
    });
}

// The scan with walls where a person cuts, so that what a cut parts from the room's air is none.
Volume<std::int16_t> walledOff(const Volume<std::int16_t>& hu, const std::vector<CutBall>& balls,
                               double wallHu) {
    if (balls.empty()) return hu.share();
    Volume<std::int16_t> walled = hu.clone();
    const auto voxels = walled.writable();
    visitBalls(hu.grid(), balls,
               [&](std::size_t n) { voxels[n] = std::int16_t(std::lround(wallHu)); });
    return walled;
}

// The piece at a patient point, or within 3 mm of it.
Result<std::int32_t> pieceAt(const TubePieces& cut, glm::dvec3 pointMm) {
    constexpr double reachMm = 3.0;
    const Grid& grid = cut.pieceAt.grid();
    const glm::ivec3 center(glm::round(grid.voxelFromPatientPoint(pointMm)));
    const glm::ivec3 reach(glm::ceil(reachMm / grid.spacingMm()));
    std::int32_t piece = -1;
    double nearest = std::numeric_limits<double>::max();
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                const glm::ivec3 v = center + glm::ivec3(i, j, k);
                if (!grid.contains(v) || cut.pieceAt.at(v) < 0) continue;
                const double d = glm::distance(grid.patientFromVoxelPoint(glm::dvec3(v)), pointMm);
                if (d <= reachMm && d < nearest) nearest = d, piece = cut.pieceAt.at(v);
            }
        }
    }
    if (piece < 0) {
        return fail(ErrorKind::badInput,
                    "there is no air or fluid of a lumen within 3 mm of this point",
                    printed("%.1f,%.1f,%.1f", pointMm.x, pointMm.y, pointMm.z));
    }
    return piece;
}

// Of the points that have a piece; `missing` is the first of the others' error.
GivenPieces givenPieces(const TubePieces& cut, const ColonEdits& edits,
                        std::optional<Error>& missing) {
    GivenPieces given;
    for (const glm::dvec3 p : edits.seedsMm) {
        const auto piece = pieceAt(cut, p);
        if (piece) {
            given.colon.push_back(*piece);
        } else if (!missing) {
            missing = piece.error();
            missing->message +=
                ", or its gas is open to the air around the patient: where it opens, as at a "
                "stoma, set up a wall (--cut)";
        }
    }
    for (const glm::dvec3 p : edits.excludesMm) {
        const auto piece = pieceAt(cut, p);
        if (piece)
            given.notColon.push_back(*piece);
        else if (!missing)
            missing = piece.error();
    }
    for (const auto& [a, b] : edits.joins) {
        const auto from = pieceAt(cut, a), to = pieceAt(cut, b);
        if (from && to)
            given.joins.push_back({*from, *to, a, b});
        else if (!missing)
            missing = from ? to.error() : from.error();
    }
    return given;
}

// What a person said of the scan, as places.
std::vector<glm::dvec3> placesOf(const ColonEdits& edits) {
    std::vector<glm::dvec3> places = edits.seedsMm;
    places.insert(places.end(), edits.excludesMm.begin(), edits.excludesMm.end());
    for (const CutBall& ball : edits.cuts)
        places.push_back(ball.centerMm);
    for (const auto& [a, b] : edits.joins)
        places.push_back(a), places.push_back(b);
    return places;
}

// Labels of the bowel's box, of the binned scan, as labels of the scan.
Volume<std::uint8_t> onTheScan(const Volume<std::int16_t>& hu, Volume<std::uint8_t> labels,
                               const Volume<std::uint8_t>& content, glm::ivec3 by,
                               const VoxelBox& box, double airBelowHu, int threads) {
    const Grid& grid = hu.grid();
    if (labels.grid().size == grid.size) return labels;
    VoxelBox fine = box;
    if (by != glm::ivec3(1)) {
        Volume<std::uint8_t> barred(labels.grid());
        const auto out = barred.writable();
        for (std::size_t n = 0; n < out.size(); ++n) {
            out[n] = LumenLabel(labels[n]) == LumenLabel::outside &&
                     Content(content[n]) != Content::tissue;
        }
        fine.lo = box.lo * by;
        fine.size = glm::min(box.size * by, grid.size - fine.lo);
        labels =
            atFullResolution(labels, barred, cropped(hu, fine, threads), by, airBelowHu, threads);
    }
    Volume<std::uint8_t> whole(grid, std::uint8_t(LumenLabel::outside));
    paste(labels, fine, whole, threads);
    return whole;
}

// HU of a mask that has no scan: gas in soft tissue, as where its levels are is not known.
Volume<std::int16_t> drawnHu(const Volume<std::uint8_t>& mask, const TissueModel& tissue) {
    Volume<std::int16_t> hu(mask.grid());
    const auto out = hu.writable();
    for (std::size_t n = 0; n < out.size(); ++n) {
        const Tissue is = mask[n] == 0 ? Tissue::soft : Tissue::air;
        out[n] = std::int16_t(std::lround(tissue.meanHu[std::size_t(is)]));
    }
    return hu;
}

// The outline of the trunk in which a colon's mask may lie, as places: the flexures and the cecum
// come within a fifth of its sides, the transverse colon within a fifth of its front, and the
// rectum lies in the middle of its back half.
std::vector<glm::vec3> trunkAround(const Volume<std::uint8_t>& mask) {
    glm::dvec3 lo(1e9), hi(-1e9);
    for (std::size_t n = 0; n < mask.voxels().size(); ++n) {
        if (mask[n] == 0) continue;
        const glm::dvec3 p = mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n));
        lo = glm::min(lo, p), hi = glm::max(hi, p);
    }
    const glm::dvec2 half = glm::dvec2(hi - lo) * glm::dvec2(0.5 / 0.8, 1.0 / 1.3);
    const glm::dvec2 middle(0.5 * (lo.x + hi.x), lo.y + 0.8 * half.y);
    std::vector<glm::vec3> places;
    for (int n = 0; n < 400; ++n) {
        const double angle = 2.0 * M_PI * n / 400.0;
        const glm::dvec2 p = middle + half * glm::dvec2(std::cos(angle), std::sin(angle));
        places.emplace_back(p.x, p.y, 0.5 * (lo.z + hi.z));
    }
    return places;
}

// Contents of the mask alone. Its voxels between gas and tagged material in HU are the wall's, or
// the level's where tagged material lies near. What else a scan shows to be no soft tissue is no
// way for a collapse, but for what the mask falls short of at its own border.
void restrictToMask(BowelContents& contents, const Volume<std::int16_t>& hu,
                    const Volume<std::uint8_t>& mask, const TissueModel& tissue) {
    const Grid& grid = mask.grid();
    const auto voxels = contents.content.writable();
    for (std::size_t n = 0; n < voxels.size(); ++n) {
        if (mask[n] != 0) {
            if (LumenLabel(mask[n]) == LumenLabel::untagged) {
                voxels[n] = std::uint8_t(Content::untagged);
                continue;
            }
            if (Content(voxels[n]) == Content::interface) continue;  // of a level
            voxels[n] = std::uint8_t(hu[n] < tissue.airBelowHu      ? Content::gas
                                     : hu[n] > tissue.taggedAboveHu ? Content::tagged
                                                                    : Content::interface);
        } else if (Content(voxels[n]) != Content::tissue && Content(voxels[n]) != Content::beyond) {
            bool atMask = false;
            visitFaces(grid, n, [&](std::size_t m, int) { atMask = atMask || mask[m] != 0; });
            voxels[n] = std::uint8_t(atMask ? Content::tissue : Content::outside);
        }
    }
    // Of the voxels in between, those far from tagged material belong to the gas.
    constexpr int reach = 2;
    std::vector<std::size_t> walls;
    for (std::size_t n = 0; n < voxels.size(); ++n) {
        if (Content(voxels[n]) != Content::interface || mask[n] == 0 || hu[n] < tissue.airBelowHu ||
            hu[n] > tissue.taggedAboveHu)
            continue;
        const glm::ivec3 v = grid.voxelAt(n);
        const glm::ivec3 lo = glm::max(v - reach, glm::ivec3(0)),
                         hi = glm::min(v + reach, grid.size - 1);
        const bool byTagged = anyInBox(lo, hi, [&](glm::ivec3 w) {
            return Content(voxels[grid.index(w)]) == Content::tagged;
        });
        if (!byTagged) walls.push_back(n);
    }
    for (const std::size_t n : walls)
        voxels[n] = std::uint8_t(Content::gas);
}

// The share of the mask's inside, what it calls untagged apart, that is as bright as soft tissue.
double softShare(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& mask,
                 const TissueModel& tissue) {
    std::size_t inside = 0, soft = 0;
    for (std::size_t n = 0; n < mask.voxels().size(); ++n) {
        if (mask[n] == 0 || LumenLabel(mask[n]) == LumenLabel::untagged) continue;
        bool within = true;
        visitFaces(mask.grid(), n, [&](std::size_t m, int) { within = within && mask[m] != 0; });
        if (!within) continue;
        ++inside;
        soft += hu[n] >= tissue.airBelowHu && hu[n] <= tissue.taggedAboveHu;
    }
    return inside > 0 ? double(soft) / double(inside) : 0.0;
}

// Half of the shortest adult colon, distended (Khashab et al., Endoscopy 2009: 120 to 250 cm at CT
// colonography).
constexpr double leastDistendedMm = 500.0, distendedRadiusMm = 8.0;

double distendedMm(const PieceGraph& graph, const ColonChain& chain) {
    double sum = 0.0;
    for (const int n : chain.nodes) {
        const ChainNode& node = graph.graph.nodes[std::size_t(n)];
        if (node.radiusMm >= distendedRadiusMm) sum += node.lengthMm;
    }
    return sum;
}

/// What the chain is sought in: HU and contents of one grid, and soft tissue of the whole body.
struct Surroundings {
    Volume<std::int16_t> hu;
    BowelContents contents;
    Source source;
    std::vector<glm::vec3> softTissueMm;
    bool given = false;  ///< the contents are a mask's, which ends where it ends
};

/// The contents cut into pieces, and the chains among them, the best first; its labels.
struct Course {
    TubePieces cut;
    PieceGraph graph;
    std::vector<ColonChain> chains;
    ColonLabels labels;
    std::optional<Error> missing;  ///< of a person's points that has no piece
};

// What may be why nothing was found.
std::string alsoTold(const BowelContents& contents) {
    std::string told;
    for (const std::string& warning : contents.warnings)
        told += "; " + warning;
    return told;
}

// Of the room's air what the trunk encloses but for mouths no wider than bowel, a table's apart.
std::optional<std::string> openBowelIn(const BowelContents& contents,
                                       std::span<const glm::vec3> softTissueMm) {
    constexpr double mostMouthMm2 = 2000.0, mostAside = 0.9;
    const BodyFrame frame = findBodyFrame(softTissueMm, -1e9, 1e9);
    double sumMl = 0.0;
    ToldPlaces mouths;
    for (const EnclosedRoomAir& air : contents.enclosedRoomAir) {
        const glm::dvec3 at = glm::abs(frame.place(air.placeMm));
        const bool isWide = std::ranges::any_of(
            air.mouths,
            [&](const EnclosedRoomAir::Mouth& mouth) { return mouth.areaMm2 > mostMouthMm2; });
        if (isWide || at.x > mostAside || at.y > mostAside) continue;
        sumMl += air.ml;
        for (const EnclosedRoomAir::Mouth& mouth : air.mouths)
            mouths.add(mouth.placeMm);
    }
    if (mouths.none()) return std::nullopt;
    return printed(
               "%.0f ml of air in the body are open to the room's, as through a stoma, and "
               "were taken for it: if they are bowel's, set up a wall (--cut X,Y,Z,R) between the "
               "skin and ",
               sumMl) +
           mouths.text();
}

/// The contents of a scan, with what a reader must know of it: slices that do not follow each
/// other, and metal. `hu` is the scan, or a binned one; a person's cuts are walls in it.
BowelContents contentsOf(const CtScan& scan, const Volume<std::int16_t>& hu,
                         const std::vector<CutBall>& cuts, const TissueModel& tissue, int threads) {
    BowelContents contents = findContents(walledOff(hu, cuts, tissue.meanHu[int(Tissue::soft)]),
                                          fieldOfView(hu, threads), scan.position, tissue, threads);
    if (auto uneven = unevenStepsOf(scan.hu, threads))
        contents.warnings.push_back(*std::move(uneven));
    if (auto metal = metalIn(hu, contents.content, threads))
        contents.warnings.push_back(*std::move(metal));
    return contents;
}

Result<Course> findCourse(const Surroundings& among, const Volume<std::uint8_t>& thinWalls,
                          const TissueModel& tissue, const ColonOptions& options) {
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    Course course;
    course.cut =
        cutIntoPieces(among.hu, among.contents.content, thinWalls,
                      {.softHu = softHu, .down = among.contents.down, .threads = options.threads});
    const GivenPieces given = givenPieces(course.cut, options.edits, course.missing);
    course.graph = makePieceGraph(among.hu, among.contents, tissue, course.cut,
                                  foldDensityMm(course.cut, thinWalls, options.threads),
                                  among.softTissueMm, given, options.threads);
    course.chains = findChains(course.graph.graph, {.chains = 12});
    const bool asked = !options.edits.seedsMm.empty() || !options.edits.joins.empty();
    if (course.chains.empty())
        return fail(ErrorKind::noResult,
                    "no gas-filled bowel was found in the scan" + alsoTold(among.contents),
                    "segmentation");
    if (const double mm = distendedMm(course.graph, course.chains.front());
        mm < leastDistendedMm && !asked) {
        return fail(ErrorKind::noResult,
                    printed("this is no CT colonography: no more than %.0f mm of distended colon "
                            "were found; name a point in it (--seed) if it is one",
                            mm) +
                        alsoTold(among.contents),
                    "segmentation");
    }
    course.labels =
        layLabels(among.hu, tissue, among.contents, course.cut, course.graph, course.chains.front(),
                  {.asGiven = among.given, .threads = options.threads});
    return course;
}

double lengthMm(const Course& course) {
    double sum = 0.0;
    for (const int n : course.chains.front().nodes)
        sum += course.graph.graph.nodes[std::size_t(n)].lengthMm;
    return sum;
}

void forgetPools(Surroundings& among, const TissueModel& tissue) {
    const auto content = among.contents.content.writable();
    for (std::size_t n = 0; n < content.size(); ++n) {
        if (Content(content[n]) != Content::untagged) continue;
        const bool isTagged = among.hu[n] > tissue.taggedAboveHu;
        content[n] = std::uint8_t(isTagged ? Content::tagged : Content::tissue);
    }
}

/// The colon among the contents, its labels on their grid. Pools of untagged fluid are looked for
/// under the course that was found, so that neither the stomach's nor the bladder's come in, and
/// the course again with them, as it may go on beneath.
Result<FoundColon> findAmong(Surroundings& among, const TissueModel& tissue,
                             const ColonOptions& options) {
    const auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    progress(0.2);
    ThinWallOptions walls;
    walls.softHu = tissue.meanHu[int(Tissue::soft)];
    walls.threads = options.threads;
    const Volume<std::uint8_t> thin = findThinWalls(among.hu, among.contents, walls);
    progress(0.4);
    auto course = TRY(findCourse(among, thin, tissue, options));
    std::vector<UntaggedLevel> untagged;
    if (glm::length(among.contents.gravity) > 0.0) {
        constexpr int mostRounds = 2;
        constexpr double leastOfBefore = 0.9;  // a pool that breaks the course is none
        for (int round = 0;; ++round) {
            untagged = findUntaggedLevels(among.hu, tissue, course.labels.labels,
                                          among.contents.down, options.threads);
            if (among.given || round == mostRounds ||
                !markUntaggedPools(among.hu, tissue, untagged, among.contents, options.threads))
                break;
            cutBalls(among.contents, options.edits.cuts);
            auto next = findCourse(among, thin, tissue, options);
            if (!next || lengthMm(*next) < leastOfBefore * lengthMm(course)) {
                forgetPools(among, tissue);
                break;
            }
            course = std::move(*next);
        }
    }
    // A point in a pool has its piece once the pool is found.
    if (course.missing) return tl::make_unexpected(*course.missing);
    progress(0.9);
    FoundColon found;
    found.record = recordColon(
        among.contents, course.cut, course.graph, course.chains, course.labels, untagged,
        metalAtLumen(among.hu, course.labels.labels, options.threads), among.source);
    found.labels = std::move(course.labels.labels);
    found.gravity = among.contents.gravity;
    found.notes = among.contents.notes;
    return found;
}

}  // namespace

Result<FoundColon> findColon(const CtScan& scan, const TissueModel& tissue,
                             const ColonOptions& options) {
    if (scan.hu.grid().voxelCount() > std::numeric_limits<std::uint32_t>::max())
        return fail(ErrorKind::unsupported, "the scan has more than 2^32 voxels", "segmentation");
    if (options.progress) options.progress(0.0);
    // Not all of the scan is looked at in full: voxels finer than walls are told by are binned, and
    // only the bowel's surroundings are cut into pieces.
    const glm::ivec3 by = binningOf(scan.hu.grid());
    Surroundings among;
    among.hu = binned(scan.hu, by, options.threads);
    among.contents = contentsOf(scan, among.hu, options.edits.cuts, tissue, options.threads);
    takeOffOvershoot(among.hu, tissue, among.contents, options.threads);
    among.softTissueMm = softTissueSamples(among.hu, among.contents.content);
    if (auto open = openBowelIn(among.contents, among.softTissueMm))
        among.contents.warnings.push_back(*std::move(open));
    const VoxelBox box = bowelBox(among.contents.content, placesOf(options.edits), options.threads);
    among.source.scanGrid = among.hu.grid();
    among.hu = cropped(among.hu, box, options.threads);
    among.contents = cropped(among.contents, box, options.threads);
    cutBalls(among.contents, options.edits.cuts);
    auto found = TRY(findAmong(among, tissue, options));
    found.labels = onTheScan(scan.hu, std::move(found.labels), among.contents.content, by, box,
                             tissue.airBelowHu, options.threads);
    if (options.progress) options.progress(1.0);
    return found;
}

Result<FoundColon> findColonInMask(const Volume<std::uint8_t>& mask, const CtScan* scan,
                                   const TissueModel& tissue, const ColonOptions& options) {
    const Grid& grid = mask.grid();
    if (grid.voxelCount() > std::numeric_limits<std::uint32_t>::max())
        return fail(ErrorKind::unsupported, "the mask has more than 2^32 voxels", "segmentation");
    if (scan && !sameGrid(grid, scan->hu.grid()))
        return fail(ErrorKind::badInput, "the mask is not on the scan's grid", "segmentation");
    Surroundings among;
    among.given = true;
    if (scan) {
        among.hu = scan->hu.share();
        among.contents = contentsOf(*scan, among.hu, {}, tissue, options.threads);
        among.softTissueMm = softTissueSamples(among.hu, among.contents.content);
        among.source = {grid, softShare(scan->hu, mask, tissue)};
    } else {
        among.hu = drawnHu(mask, tissue);
        among.contents.content = Volume<std::uint8_t>(grid, std::uint8_t(Content::tissue));
        among.contents.gasHu = tissue.meanHu[int(Tissue::air)];
        among.softTissueMm = trunkAround(mask);
    }
    restrictToMask(among.contents, among.hu, mask, tissue);
    const VoxelBox box = bowelBox(among.contents.content, {}, options.threads);
    among.hu = cropped(among.hu, box, options.threads);
    among.contents = cropped(among.contents, box, options.threads);
    auto found = TRY(findAmong(among, tissue, options));
    Volume<std::uint8_t> whole(grid, std::uint8_t(LumenLabel::outside));
    paste(found.labels, box, whole, options.threads);
    found.labels = std::move(whole);
    if (!scan) {
        found.gravity = glm::dvec3(0.0);
        const auto labels = found.labels.writable();
        for (std::size_t n = 0; n < labels.size(); ++n) {
            if (LumenLabel(labels[n]) == LumenLabel::air &&
                (LumenLabel(mask[n]) == LumenLabel::tagged ||
                 LumenLabel(mask[n]) == LumenLabel::untagged))
                labels[n] = mask[n];
        }
    }
    double maskMl = 0.0, keptMl = 0.0;
    for (std::size_t n = 0; n < mask.voxels().size(); ++n) {
        maskMl += mask[n] != 0;
        keptMl += mask[n] != 0 && found.labels[n] != 0;
    }
    const double leftMl = (maskMl - keptMl) * grid.voxelVolumeMm3() / 1000.0;
    if (leftMl >= 0.5)
        found.notes.push_back(
            printed("%.1f ml of the mask are no part of the colon that was found in it", leftMl));
    return found;
}

}  // namespace haustra::segmentation
