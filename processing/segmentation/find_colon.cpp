#include "segmentation/find_colon.h"

#include "segmentation/bowel_contents.h"
#include "segmentation/chain_graph.h"
#include "segmentation/colon_labels.h"
#include "segmentation/course_doubts.h"
#include "segmentation/thin_walls.h"
#include "segmentation/tube_pieces.h"
#include "segmentation/untagged_levels.h"
#include "segmentation/working_scan.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <set>

namespace haustra::segmentation {
namespace {

template <class... Numbers>
std::string text(const char* format, Numbers... numbers) {
    char line[300];
    std::snprintf(line, sizeof line, format, numbers...);
    return line;
}

std::string placeText(glm::dvec3 p) {
    return text("(%.0f, %.0f, %.0f) mm", p.x, p.y, p.z);
}

void cutBalls(BowelContents& contents, const std::vector<CutBall>& balls) {
    const Grid& grid = contents.content.grid();
    const auto voxels = contents.content.writable();
    for (const CutBall& ball : balls) {
        const glm::dvec3 centre = grid.voxelFromPatientPoint(ball.centreMm);
        const glm::ivec3 reach = glm::ivec3(ball.radiusMm / grid.spacingMm()) + 1;
        const glm::ivec3 lo = glm::max(glm::ivec3(centre) - reach, glm::ivec3(0)),
                         hi = glm::min(glm::ivec3(centre) + reach + 1, grid.size - 1);
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                for (int i = lo.x; i <= hi.x; ++i) {
                    if (glm::distance(grid.patientFromVoxelPoint(glm::dvec3(i, j, k)),
                                      ball.centreMm) <= ball.radiusMm)
                        voxels[grid.index(i, j, k)] = std::uint8_t(Content::tissue);
                }
            }
        }
    }
}

// The piece at a patient point, or within 3 mm of it.
Result<std::int32_t> pieceAt(const TubePieces& cut, glm::dvec3 pointMm) {
    constexpr double reachMm = 3.0;
    const Grid& grid = cut.pieceAt.grid();
    const glm::ivec3 centre(glm::round(grid.voxelFromPatientPoint(pointMm)));
    const glm::ivec3 reach(glm::ceil(reachMm / grid.spacingMm()));
    std::int32_t piece = -1;
    double nearest = std::numeric_limits<double>::max();
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                const glm::ivec3 v = centre + glm::ivec3(i, j, k);
                if (!grid.contains(v) || cut.pieceAt.at(v) < 0) continue;
                const double d = glm::distance(grid.patientFromVoxelPoint(glm::dvec3(v)), pointMm);
                if (d <= reachMm && d < nearest) nearest = d, piece = cut.pieceAt.at(v);
            }
        }
    }
    if (piece < 0) {
        return fail(ErrorKind::badInput,
                    "there is no air or tagged fluid within 3 mm of this point",
                    text("%.1f,%.1f,%.1f", pointMm.x, pointMm.y, pointMm.z));
    }
    return piece;
}

Result<GivenPieces> givenPieces(const TubePieces& cut, const ColonEdits& edits) {
    GivenPieces given;
    for (const auto& [points, pieces] :
         {std::pair(&edits.seedsMm, &given.colon), std::pair(&edits.excludesMm, &given.notColon)}) {
        for (const glm::dvec3 p : *points) {
            const auto piece = pieceAt(cut, p);
            if (!piece) return tl::make_unexpected(piece.error());
            pieces->push_back(*piece);
        }
    }
    for (const auto& [a, b] : edits.joins) {
        const auto from = pieceAt(cut, a), to = pieceAt(cut, b);
        if (!from) return tl::make_unexpected(from.error());
        if (!to) return tl::make_unexpected(to.error());
        given.joins.push_back({*from, *to, a, b});
    }
    return given;
}

// The weights of chains by their scores, the best one's first; they sum to 1.
std::vector<double> posterior(const std::vector<ColonChain>& chains) {
    std::vector<double> weights;
    double sum = 0.0;
    for (const ColonChain& chain : chains)
        weights.push_back(std::exp(chain.score - chains.front().score)), sum += weights.back();
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

bool joins(const ColonChain& chain, int a, int b) {
    for (std::size_t n = 0; n + 1 < chain.nodes.size(); ++n) {
        if ((chain.nodes[n] == a && chain.nodes[n + 1] == b) ||
            (chain.nodes[n] == b && chain.nodes[n + 1] == a))
            return true;
    }
    return false;
}

std::set<int> nodesOf(const ColonChain& chain) {
    std::set<int> all(chain.nodes.begin(), chain.nodes.end());
    all.insert(chain.sacs.begin(), chain.sacs.end());
    return all;
}

// The most likely chain that differs in more than crumbs.
std::vector<RunnerUp> runnersUp(const PieceGraph& graph, const std::vector<ColonChain>& chains,
                                const std::vector<double>& weights) {
    constexpr double crumbMl = 3.0;
    const std::set<int> best = nodesOf(chains.front());
    for (std::size_t c = 1; c < chains.size(); ++c) {
        const std::set<int> other = nodesOf(chains[c]);
        RunnerUp up;
        up.probability = weights[c];
        double largest = -1.0;
        const auto differs = [&](int n, double& sumMl) {
            const ChainNode& node = graph.graph.nodes[std::size_t(n)];
            sumMl += node.volumeMl;
            if (node.volumeMl > largest) largest = node.volumeMl, up.placeMm = node.centreMm;
        };
        for (const int n : other) {
            if (!best.count(n)) differs(n, up.addsMl);
        }
        for (const int n : best) {
            if (!other.count(n)) differs(n, up.dropsMl);
        }
        if (up.addsMl + up.dropsMl > crumbMl) return {up};
    }
    return {};
}

class Recorder {
public:
    Recorder(const BowelContents& contents, const TubePieces& cut, const PieceGraph& graph,
             const std::vector<ColonChain>& chains, const ColonLabels& labels,
             const std::vector<UntaggedLevel>& untagged)
        : contents_(contents),
          cut_(cut),
          graph_(graph),
          chains_(chains),
          chain_(chains.front()),
          labels_(labels),
          untagged_(untagged) {}

    ColonRecord record() {
        const std::vector<double> weights = posterior(chains_);
        made_.noiseSdHu = contents_.gasSdHu;
        for (std::size_t n = 0; n < chain_.nodes.size(); ++n) {
            const ChainNode& node = graph_.graph.nodes[std::size_t(chain_.nodes[n])];
            const TubePiece& piece = pieceOf(chain_.nodes[n]);
            const double voxelMl = piece.volumeMl / double(piece.voxels);
            const double gasMl = double(piece.gasVoxels) * voxelMl;
            made_.pieces.push_back({ColonPart(chain_.states[n]), node.centreMm, node.radiusMm,
                                    node.lengthMm, gasMl, piece.volumeMl - gasMl});
        }
        for (std::size_t n = 0; n < chain_.junctions.size(); ++n) {
            const ChainJunction& junction =
                graph_.graph.junctions[std::size_t(chain_.junctions[n])];
            double confidence = 0.0;
            for (std::size_t c = 0; c < chains_.size(); ++c) {
                if (joins(chains_[c], junction.a, junction.b)) confidence += weights[c];
            }
            made_.junctions.push_back({junction.kind, junction.placeMm, labels_.bridgeMm[n],
                                       junction.radiusMm, confidence});
        }
        made_.runnersUp = runnersUp(graph_, chains_, weights);
        made_.chainConfidence = made_.runnersUp.empty()
                                    ? 1.0
                                    : weights[0] / (weights[0] + made_.runnersUp[0].probability);
        if (!made_.runnersUp.empty()) made_.runnersUp[0].probability = 1.0 - made_.chainConfidence;
        for (const RebuiltWall& wall : labels_.walls)
            made_.walls.push_back({wall.placeMm, wall.areaMm2, wall.betweenLoops});
        findLeftOut();
        for (const UntaggedLevel& level : untagged_)
            made_.untaggedPools.push_back(
                {partAt(level.placeMm), level.placeMm, level.areaMm2, level.fluidHu});
        made_.doubts = doubtsOf(made_);
        made_.confidence = courseConfidence(made_.chainConfidence, made_.doubts);
        warn();
        return std::move(made_);
    }

private:
    const TubePiece& pieceOf(int node) const {
        return cut_.pieces[std::size_t(graph_.pieceOf[std::size_t(node)])];
    }

    // Of the piece that is nearest, as far as its ball reaches.
    ColonPart partAt(glm::dvec3 placeMm) const {
        ColonPart part = ColonPart::rectum;
        double nearest = 1e9;
        for (const ColonPiece& piece : made_.pieces) {
            const double mm = glm::distance(piece.centreMm, placeMm) - piece.radiusMm;
            if (mm < nearest) nearest = mm, part = piece.part;
        }
        return part;
    }

    void findLeftOut() {
        constexpr double leastMl = 2.0, nearMm = 20.0;
        const std::set<int> taken = nodesOf(chain_);
        std::set<int> opened;
        for (const int j : chain_.cuts) {
            opened.insert(graph_.graph.junctions[std::size_t(j)].a);
            opened.insert(graph_.graph.junctions[std::size_t(j)].b);
        }
        for (std::size_t n = 0; n < graph_.graph.nodes.size(); ++n) {
            const ChainNode& node = graph_.graph.nodes[n];
            if (taken.count(int(n)) || node.volumeMl < leastMl) continue;
            LeftOutBody body{node.centreMm,     node.volumeMl, pieceOf(int(n)).mostlyGas(),
                             ColonPart::rectum, 1e9,           opened.count(int(n)) > 0};
            for (std::size_t c = 0; c < chain_.nodes.size(); ++c) {
                const ChainNode& home = graph_.graph.nodes[std::size_t(chain_.nodes[c])];
                const double mm =
                    glm::distance(home.centreMm, node.centreMm) - home.radiusMm - node.radiusMm;
                if (mm < body.distanceMm)
                    body.distanceMm = mm, body.nearest = ColonPart(chain_.states[c]);
            }
            body.distanceMm = std::max(0.0, body.distanceMm);
            if (body.opens || body.distanceMm < nearMm) made_.leftOut.push_back(body);
        }
        std::stable_sort(
            made_.leftOut.begin(), made_.leftOut.end(),
            [](const LeftOutBody& a, const LeftOutBody& b) { return a.volumeMl > b.volumeMl; });
    }

    void warn() {
        constexpr double sure = 0.95, doubtful = 0.8;
        const auto say = [&](std::string line) { made_.warnings.push_back(std::move(line)); };
        for (std::size_t n = 0; n < made_.junctions.size(); ++n) {
            const ColonJunction& junction = made_.junctions[n];
            const char* const part = toString(made_.pieces[n].part);
            if (junction.kind == JunctionKind::collapse) {
                say(text("the %s is collapsed over %.0f mm, at %s", part, junction.lengthMm,
                         placeText(junction.placeMm).c_str()));
            } else if (junction.kind == JunctionKind::thinWall) {
                say(text("what looks like a thin wall in the %s was taken for open lumen, at %s",
                         part, placeText(junction.placeMm).c_str()));
            }
            if (junction.confidence < sure)
                say(text("the way on from the %s is not sure (%.0f %%), at %s", part,
                         100.0 * junction.confidence, placeText(junction.placeMm).c_str()));
        }
        for (const LeftOutBody& body : made_.leftOut) {
            constexpr double tellMl = 5.0;
            if (!body.opens && body.volumeMl < tellMl) continue;
            say(text("%.0f ml of %s near the %s %s, at %s", body.volumeMl,
                     body.gas ? "gas" : "tagged material", toString(body.nearest),
                     body.opens ? "lies open to the colon and was taken for small bowel"
                                : "was taken for other than colon",
                     placeText(body.centreMm).c_str()));
        }
        for (const RebuiltWallRecord& wall : made_.walls) {
            constexpr double tellMm2 = 20.0;
            if (wall.betweenLoops && wall.areaMm2 > tellMm2)
                say(text("a wall of %.0f mm2 between two loops was rebuilt, at %s", wall.areaMm2,
                         placeText(wall.placeMm).c_str()));
        }
        for (const UntaggedPool& pool : made_.untaggedPools)
            say(text(
                "fluid without tagging stands under the gas in the %s, its surface %.0f mm2; what "
                "lies in it and beneath is not seen, at %s",
                toString(pool.part), pool.areaMm2, placeText(pool.placeMm).c_str()));
        if (made_.chainConfidence < doubtful && !made_.runnersUp.empty()) {
            const RunnerUp& up = made_.runnersUp.front();
            say(
                text("another course is nearly as likely (%.0f %%): it adds %.0f ml and drops %.0f "
                     "ml, at %s",
                     100.0 * up.probability, up.addsMl, up.dropsMl, placeText(up.placeMm).c_str()));
        }
        if (made_.confidence < doubtful && !made_.doubts.empty() &&
            made_.doubts.front().probability > 1.0 - made_.chainConfidence) {
            say(text("the course is right with no more than %.0f %%; gravest: %s",
                     100.0 * made_.confidence, made_.doubts.front().about.c_str()));
        }
        // Places of neighbouring parts overlap: only what lies farther off is told.
        if (made_.pieces.front().part > ColonPart::sigmoid)
            say(text("the rectum was not found: the colon begins in the %s",
                     toString(made_.pieces.front().part)));
        if (made_.pieces.back().part < ColonPart::ascending)
            say(text("the cecum was not found: the colon ends in the %s",
                     toString(made_.pieces.back().part)));
        if (labels_.strandedMl >= 0.5)
            say(text("%.1f ml that nothing joins to the lumen were left out", labels_.strandedMl));
    }

    const BowelContents& contents_;
    const TubePieces& cut_;
    const PieceGraph& graph_;
    const std::vector<ColonChain>& chains_;
    const ColonChain& chain_;
    const ColonLabels& labels_;
    const std::vector<UntaggedLevel>& untagged_;
    ColonRecord made_;
};

// What a person said of the scan, as places.
std::vector<glm::dvec3> placesOf(const ColonEdits& edits) {
    std::vector<glm::dvec3> places = edits.seedsMm;
    places.insert(places.end(), edits.excludesMm.begin(), edits.excludesMm.end());
    for (const CutBall& ball : edits.cuts)
        places.push_back(ball.centreMm);
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
            if (Content(voxels[n]) == Content::interface) continue;  // of a level
            voxels[n] = std::uint8_t(hu[n] < tissue.airBelowHu      ? Content::gas
                                     : hu[n] > tissue.taggedAboveHu ? Content::tagged
                                                                    : Content::interface);
        } else if (Content(voxels[n]) != Content::tissue) {
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
        bool byTagged = false;
        for (int k = lo.z; k <= hi.z && !byTagged; ++k) {
            for (int j = lo.y; j <= hi.y && !byTagged; ++j) {
                for (int i = lo.x; i <= hi.x && !byTagged; ++i)
                    byTagged = Content(voxels[grid.index(i, j, k)]) == Content::tagged;
            }
        }
        if (!byTagged) walls.push_back(n);
    }
    for (const std::size_t n : walls)
        voxels[n] = std::uint8_t(Content::gas);
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
    std::vector<glm::vec3> softTissueMm;
    bool given = false;  ///< the contents are a mask's, which ends where it ends
};

/// The colon among the contents, its labels on their grid.
Result<FoundColon> findAmong(const Surroundings& among, const TissueModel& tissue,
                             const ColonOptions& options) {
    const auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    const Volume<std::int16_t>& hu = among.hu;
    const BowelContents& contents = among.contents;
    progress(0.2);
    TubePieces cut;
    {
        ThinWallOptions walls;
        walls.softHu = tissue.meanHu[int(Tissue::soft)];
        walls.threads = options.threads;
        const Volume<std::uint8_t> thin = findThinWalls(hu, contents, walls);
        progress(0.4);
        cut =
            cutIntoPieces(hu, contents.content, thin,
                          {.softHu = tissue.meanHu[int(Tissue::soft)], .threads = options.threads});
    }
    progress(0.65);
    const auto given = givenPieces(cut, options.edits);
    if (!given) return tl::make_unexpected(given.error());
    const PieceGraph graph =
        makePieceGraph(hu, contents, tissue, cut, among.softTissueMm, *given, options.threads);
    progress(0.75);
    const std::vector<ColonChain> chains = findChains(graph.graph, {.chains = 12});
    const bool asked = !options.edits.seedsMm.empty() || !options.edits.joins.empty();
    if (chains.empty())
        return fail(ErrorKind::noResult, "no gas-filled bowel was found in the scan",
                    "segmentation");
    if (const double mm = distendedMm(graph, chains.front()); mm < leastDistendedMm && !asked) {
        return fail(ErrorKind::noResult,
                    text("this is no CT colonography: no more than %.0f mm of distended colon were "
                         "found; name a point in it (--seed) if it is one",
                         mm),
                    "segmentation");
    }
    progress(0.8);
    ColonLabels labels = layLabels(hu, tissue, contents, cut, graph, chains.front(),
                                   {.asGiven = among.given, .threads = options.threads});
    FoundColon found;
    const std::vector<UntaggedLevel> untagged =
        glm::length(contents.gravity) > 0.0
            ? findUntaggedLevels(hu, tissue, labels.labels, contents.down, options.threads)
            : std::vector<UntaggedLevel>();
    found.record = Recorder(contents, cut, graph, chains, labels, untagged).record();
    found.labels = std::move(labels.labels);
    found.gravity = contents.gravity;
    found.notes = contents.notes;
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
    among.contents = findContents(among.hu, scan.position, tissue, options.threads);
    among.softTissueMm = softTissueSamples(among.hu, among.contents.content);
    const VoxelBox box = bowelBox(among.contents.content, placesOf(options.edits), options.threads);
    among.hu = cropped(among.hu, box, options.threads);
    among.contents = cropped(among.contents, box, options.threads);
    cutBalls(among.contents, options.edits.cuts);
    auto found = findAmong(among, tissue, options);
    if (!found) return found;
    found->labels = onTheScan(scan.hu, std::move(found->labels), among.contents.content, by, box,
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
        among.contents = findContents(among.hu, scan->position, tissue, options.threads);
        among.softTissueMm = softTissueSamples(among.hu, among.contents.content);
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
    auto found = findAmong(among, tissue, options);
    if (!found) return found;
    Volume<std::uint8_t> whole(grid, std::uint8_t(LumenLabel::outside));
    paste(found->labels, box, whole, options.threads);
    found->labels = std::move(whole);
    if (!scan) {
        found->gravity = glm::dvec3(0.0);
        const auto labels = found->labels.writable();
        for (std::size_t n = 0; n < labels.size(); ++n) {
            if (LumenLabel(labels[n]) == LumenLabel::air &&
                LumenLabel(mask[n]) == LumenLabel::tagged)
                labels[n] = mask[n];
        }
    }
    double maskMl = 0.0, keptMl = 0.0;
    for (std::size_t n = 0; n < mask.voxels().size(); ++n) {
        maskMl += mask[n] != 0;
        keptMl += mask[n] != 0 && found->labels[n] != 0;
    }
    const double leftMl = (maskMl - keptMl) * grid.voxelVolumeMm3() / 1000.0;
    if (leftMl >= 0.5)
        found->notes.push_back(
            text("%.1f ml of the mask are no part of the colon that was found in it", leftMl));
    return found;
}

}  // namespace haustra::segmentation
