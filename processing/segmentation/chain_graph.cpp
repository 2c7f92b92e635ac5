#include "segmentation/chain_graph.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::segmentation {
namespace {

bool isGasBowel(const TubePiece& piece) {
    constexpr double leastMl = 0.3, leastRadiusMm = 2.0, mostAir = 0.08;
    return piece.mostlyGas() && piece.volumeMl >= leastMl && piece.radiusMm >= leastRadiusMm &&
           piece.excludedAirMm2 < mostAir * piece.surfaceMm2;
}

/// How bright fluid can be: as under the levels, or somewhat brighter; twice as far over soft
/// tissue where nothing else can be so wide and even.
struct BrightestFluid {
    double hu = 3000.0, wideAndEvenHu = 3000.0;
};

/// How uneven a piece's core is but for noise, in parts of its height over soft tissue.
double unevenness(const TubePiece& piece, double softHu, double noiseSdHu) {
    const double sd =
        std::sqrt(std::max(0.0, piece.coreSdHu * piece.coreSdHu - noiseSdHu * noiseSdHu));
    return sd / (piece.coreHu - softHu);
}

// What no bone is: no compact bone is 10 mm thick, and what is spongy is uneven.
bool isWideAndEven(const TubePiece& piece, double softHu, double noiseSdHu) {
    constexpr double leastRadiusMm = 5.0, mostUneven = 0.1;
    return piece.radiusMm >= leastRadiusMm && unevenness(piece, softHu, noiseSdHu) < mostUneven;
}

bool isDense(const TubePiece& piece, double softHu) {
    constexpr double leastMl = 0.5, leastRadiusMm = 3.5, leastContrastHu = 60.0;
    return !piece.mostlyGas() && piece.volumeMl >= leastMl && piece.radiusMm >= leastRadiusMm &&
           piece.coreHu - softHu > leastContrastHu;
}

// Fluid is even, and no brighter than the fluid under levels; bone is neither.
bool isTaggedBowel(const TubePiece& piece, double softHu, const BrightestFluid& brightest,
                   double noiseSdHu) {
    constexpr double mostUneven = 0.22;
    if (!isDense(piece, softHu) || piece.coreHu > brightest.wideAndEvenHu) return false;
    if (piece.coreHu > brightest.hu) return isWideAndEven(piece, softHu, noiseSdHu);
    return unevenness(piece, softHu, noiseSdHu) < mostUneven;
}

// Nothing but its HU speaks against fluid, and metal is brighter.
bool isTooBright(const TubePiece& piece, double softHu, const BrightestFluid& brightest,
                 double noiseSdHu) {
    constexpr double metalHu = 2500.0;
    return isDense(piece, softHu) && piece.coreHu > brightest.wideAndEvenHu &&
           piece.coreHu < metalHu && isWideAndEven(piece, softHu, noiseSdHu);
}

bool isUntaggedBowel(const TubePiece& piece) {
    constexpr double leastMl = 0.5, leastRadiusMm = 3.5;
    return !piece.mostlyGas() && piece.gasVoxels + piece.untaggedVoxels > piece.taggedVoxels &&
           piece.volumeMl >= leastMl && piece.radiusMm >= leastRadiusMm;
}

/// Where a part of the colon lies in the body's frame: mean and standard deviation.
struct Region {
    glm::dvec3 mean, sd;
};
constexpr double background = 1.0 / (1.6 * 1.4);  // of any place in the abdomen

const std::array<Region, colonParts>& regions() {
    static const std::array<Region, colonParts> all{{
        {{0.0, 0.35, 0.08}, {0.15, 0.28, 0.08}},     // rectum
        {{0.05, -0.10, 0.28}, {0.38, 0.38, 0.18}},   // sigmoid
        {{0.65, 0.15, 0.55}, {0.16, 0.35, 0.25}},    // descending
        {{0.60, 0.05, 0.88}, {0.22, 0.42, 0.14}},    // splenic flexure
        {{0.0, -0.40, 0.62}, {0.45, 0.32, 0.25}},    // transverse
        {{-0.55, -0.05, 0.75}, {0.22, 0.40, 0.16}},  // hepatic flexure
        {{-0.62, 0.05, 0.50}, {0.16, 0.35, 0.20}},   // ascending
        {{-0.50, -0.15, 0.30}, {0.22, 0.35, 0.16}},  // cecum
    }};
    return all;
}

double logDensity(const Region& region, glm::dvec3 place) {
    const glm::dvec3 z = (place - region.mean) / region.sd;
    return -0.5 * glm::dot(z, z) -
           std::log(std::pow(2.0 * M_PI, 1.5) * region.sd.x * region.sd.y * region.sd.z);
}

double exponential(double x, double mean) {
    return std::exp(-x / mean) / mean;
}

/// ln P(folds | that part of the colon) / P(folds | small bowel), of folds' volume over wall, mm.
/// The share of each part that is smooth: haustra are deepest in the cecum, the ascending and the
/// transverse colon, shallow in the descending and rectosigmoid (Standring, Gray's Anatomy, 41st
/// ed., ch. 66). What else is gas-filled and folded is a stomach with its rugae, or jejunum.
double foldLogOddsOf(double foldMm, int part) {
    constexpr std::array<double, colonParts> smooth{0.7, 0.4, 0.4, 0.3, 0.2, 0.2, 0.2, 0.3};
    constexpr double smoothMm = 0.010, foldedMm = 0.08, ileumMm = 0.012;
    constexpr double otherShare = 0.1, otherMostMm = 0.5;
    const double share = smooth[std::size_t(part)];
    const double colon =
        share * exponential(foldMm, smoothMm) + (1.0 - share) * exponential(foldMm, foldedMm);
    const double other =
        (1.0 - otherShare) * exponential(foldMm, ileumMm) + otherShare / otherMostMm;
    return std::clamp(std::log(colon / other), -2.0, 2.5);
}

/// How far folds are seen in this scan, 0 to 1, by the pieces that are wider than small bowel gets:
/// thick slices and soft kernels blur them.
double foldsSeen(const std::vector<ChainNode>& nodes, std::span<const double> nodeFoldMm) {
    constexpr double widestIleumMm = 30.0, wellSeenMm = 0.03;
    double sum = 0.0, lengthMm = 0.0;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (nodeFoldMm[n] < 0.0 || 2.0 * nodes[n].radiusMm < widestIleumMm) continue;
        sum += nodes[n].lengthMm * nodeFoldMm[n], lengthMm += nodes[n].lengthMm;
    }
    return lengthMm > 0.0 ? std::min(1.0, sum / lengthMm / wellSeenMm) : 1.0;
}

// One lumen holds one fluid: where tagged material of quite another HU begins, there is a wall too
// thin to show beside the brighter side's blur. |ln| of the ratio of both heights over soft tissue,
// where mostly fluid meets fluid; else 0.
double fluidMismatch(const Orifice& orifice, const TubePieces& cut, double softHu) {
    const TubePiece &a = cut.pieces[std::size_t(orifice.a)],
                    &b = cut.pieces[std::size_t(orifice.b)];
    if (orifice.openTaggedMm2 < 0.7 * orifice.openMm2 || a.coreHu <= softHu || b.coreHu <= softHu)
        return 0.0;
    return std::abs(std::log((a.coreHu - softHu) / (b.coreHu - softHu)));
}

double orificeLogOdds(const Orifice& orifice, const TubePieces& cut, double softHu) {
    const double wallShare = orifice.wallMm2 / (orifice.wallMm2 + orifice.openMm2);
    return std::clamp(
        2.5 * (orifice.radiusMm - 2.5) - 6.0 * (wallShare - 0.35) -
            std::min(10.0, 20.0 * std::max(0.0, fluidMismatch(orifice, cut, softHu) - 0.2)),
        -8.0, 20.0);
}

constexpr double certain = 60.0;  ///< log odds of what a person said

/// From the fluids under the levels, by area.
BrightestFluid brightestFluid(const std::vector<Level>& levels, double softHu) {
    std::vector<std::pair<double, double>> fluids;  // HU, area
    double area = 0.0;
    for (const Level& level : levels)
        fluids.emplace_back(level.fluidHu, level.areaMm2), area += level.areaMm2;
    std::sort(fluids.begin(), fluids.end());
    double sum = 0.0;
    for (const auto& [fluidHu, mm2] : fluids) {
        sum += mm2;
        if (sum < 0.95 * area) continue;
        const double hu = softHu + 1.5 * (fluidHu - softHu) + 100.0;
        return {hu, std::max(hu, softHu + 2.0 * (fluidHu - softHu))};
    }
    return {};
}

/// The area of the levels that stand on each piece, mm².
std::vector<double> levelsOn(const TubePieces& cut, const BowelContents& contents) {
    std::vector<double> mm2(cut.pieces.size(), 0.0);
    const Grid& grid = cut.pieceAt.grid();
    const double columnMm2 = grid.voxelVolumeMm3() / grid.spacingMm()[contents.down.axis];
    for (const Level& level : contents.levels) {
        for (const LevelColumn& column : level.columns) {
            glm::ivec3 v = column.below;
            v[contents.down.axis] += contents.down.sign;  // beneath what is blurred
            const std::int32_t p = grid.contains(v) ? cut.pieceAt.at(v) : -1;
            if (p >= 0) mm2[std::size_t(p)] += columnMm2;
        }
    }
    return mm2;
}

/// What was said of each piece.
enum class Said : char { nothing, bowel, notColon };

std::vector<Said> saidOf(const GivenPieces& given, std::size_t pieces) {
    std::vector<Said> said(pieces, Said::nothing);
    for (const std::int32_t p : given.colon)
        said[std::size_t(p)] = Said::bowel;
    for (const GivenPieces::Join& join : given.joins)
        said[std::size_t(join.a)] = said[std::size_t(join.b)] = Said::bowel;
    for (const std::int32_t p : given.notColon)
        said[std::size_t(p)] = Said::notColon;
    return said;
}

/// By which the height of the abdomen is told.
bool isWide(const TubePiece& piece) {
    return piece.radiusMm > 8.0 && piece.volumeMl > 10.0;
}

/// Where the voxels of one node lie.
struct NodePlaces {
    std::vector<glm::dvec3> samplesMm;
    glm::dvec3 lowestMm{0.0, 0.0, 1e9}, lowCornerMm{1e9}, highCornerMm{-1e9};
};

std::vector<NodePlaces> placesOf(const PieceGraph& graph, const TubePieces& cut, const Grid& grid) {
    constexpr std::size_t sampleEvery = 61;
    std::vector<NodePlaces> places(graph.pieceOf.size());
    for (std::size_t n = 0; n < cut.pieceAt.voxels().size(); ++n) {
        const std::int32_t p = cut.pieceAt[n];
        if (p < 0 || graph.nodeOf[std::size_t(p)] < 0) continue;
        NodePlaces& node = places[std::size_t(graph.nodeOf[std::size_t(p)])];
        const glm::dvec3 at = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (n % sampleEvery == 0) node.samplesMm.push_back(at);
        if (at.z < node.lowestMm.z) node.lowestMm = at;
        node.lowCornerMm = glm::min(node.lowCornerMm, at);
        node.highCornerMm = glm::max(node.highCornerMm, at);
    }
    for (std::size_t n = 0; n < places.size(); ++n) {
        if (places[n].samplesMm.empty())
            places[n].samplesMm.push_back(cut.pieces[std::size_t(graph.pieceOf[n])].centerMm);
    }
    return places;
}

/// The body's frame between the lowest and the highest wide piece.
BodyFrame frameOf(const PieceGraph& graph, const TubePieces& cut,
                  const std::vector<NodePlaces>& places, std::span<const glm::vec3> softTissueMm) {
    double low = 1e9, high = -1e9;
    for (std::size_t n = 0; n < places.size(); ++n) {
        const TubePiece& piece = cut.pieces[std::size_t(graph.pieceOf[n])];
        if (!isWide(piece)) continue;
        low = std::min({low, piece.centerMm.z - piece.radiusMm, places[n].lowestMm.z});
        high = std::max(high, piece.centerMm.z + piece.radiusMm);
    }
    return findBodyFrame(softTissueMm, low, high);
}

/// A node but for its folds and what was said of it.
ChainNode nodeOf(const TubePiece& piece, const NodePlaces& places, const BodyFrame& frame) {
    ChainNode node;
    node.radiusMm = piece.radiusMm;
    node.volumeMl = piece.volumeMl;
    // As a tube of that calibre, but no longer than it reaches: bone is plates.
    node.lengthMm = std::min(1000.0 * piece.volumeMl / (M_PI * piece.radiusMm * piece.radiusMm),
                             1.5 * glm::distance(places.lowCornerMm, places.highCornerMm));
    node.centerMm = piece.centerMm;
    node.lowestMm = places.lowestMm;
    for (std::size_t part = 0; part < colonParts; ++part) {
        for (const glm::dvec3& at : places.samplesMm) {
            node.placeLogOdds[part] +=
                std::clamp(logDensity(regions()[part], frame.place(at)) - std::log(background),
                           -4.0, 1.2) /
                double(places.samplesMm.size());
        }
    }
    const Region anus{{0.0, 0.3, 0.02}, {0.15, 0.3, 0.06}};
    const glm::dvec3 z = (frame.place(places.lowestMm) - anus.mean) / anus.sd;
    node.rectumLogOdds = -std::min(15.0, 0.5 * glm::dot(z, z));
    return node;
}

void addFolds(PieceGraph& graph, std::span<const double> foldMm) {
    std::vector<double> nodeFoldMm;
    for (const std::int32_t p : graph.pieceOf)
        nodeFoldMm.push_back(foldMm[std::size_t(p)]);
    const double seen = foldsSeen(graph.graph.nodes, nodeFoldMm);
    for (std::size_t n = 0; n < nodeFoldMm.size(); ++n) {
        for (int part = 0; part < colonParts && nodeFoldMm[n] >= 0.0; ++part)
            graph.graph.nodes[n].foldLogOdds[std::size_t(part)] =
                seen * foldLogOddsOf(nodeFoldMm[n], part);
    }
}

void addOrifices(PieceGraph& graph, const TubePieces& cut, const std::vector<Said>& said,
                 double softHu) {
    for (std::size_t o = 0; o < cut.orifices.size(); ++o) {
        const Orifice& orifice = cut.orifices[o];
        const int a = graph.nodeOf[std::size_t(orifice.a)],
                  b = graph.nodeOf[std::size_t(orifice.b)];
        if (a < 0 || b < 0) continue;
        const bool barred = said[std::size_t(orifice.a)] == Said::notColon ||
                            said[std::size_t(orifice.b)] == Said::notColon;
        ChainJunction junction;
        junction.path = int(o);
        junction.mismatch = fluidMismatch(orifice, cut, softHu);
        junction.a = a, junction.b = b;
        junction.logOdds = barred ? -certain : orificeLogOdds(orifice, cut, softHu);
        junction.kind = junction.logOdds < 0.0 ? JunctionKind::thinWall : JunctionKind::openLumen;
        junction.radiusMm = orifice.radiusMm, junction.openMm2 = orifice.openMm2,
        junction.wallMm2 = orifice.wallMm2;
        junction.placeMm = orifice.placeMm;
        graph.graph.junctions.push_back(junction);
    }
}

/// The orifices of each node that are open for sure enough.
std::vector<std::vector<glm::ivec3>> doorsOf(const PieceGraph& graph, const TubePieces& cut,
                                             double softHu) {
    std::vector<std::vector<glm::ivec3>> doors(graph.pieceOf.size());
    for (const Orifice& orifice : cut.orifices) {
        const int a = graph.nodeOf[std::size_t(orifice.a)],
                  b = graph.nodeOf[std::size_t(orifice.b)];
        if (a < 0 || b < 0 || orificeLogOdds(orifice, cut, softHu) < 1.0) continue;
        doors[std::size_t(a)].push_back(orifice.place);
        doors[std::size_t(b)].push_back(orifice.place);
    }
    return doors;
}

/// What is crossed where the colon is collapsed.
void addCollapses(PieceGraph& graph, std::vector<CollapsePath> paths) {
    graph.collapses = std::move(paths);
    for (std::size_t n = 0; n < graph.collapses.size(); ++n) {
        const CollapsePath& path = graph.collapses[n];
        ChainJunction junction;
        junction.a = graph.nodeOf[std::size_t(path.from)],
        junction.b = graph.nodeOf[std::size_t(path.to)];
        junction.kind = JunctionKind::collapse;
        junction.logOdds = -3.0 - 0.04 * path.costMm - path.turn - (path.toTip ? 0.0 : 3.0);
        junction.lengthMm = path.lengthMm;
        junction.placeMm = path.pointsMm[path.pointsMm.size() / 2];
        junction.path = int(n);
        graph.graph.junctions.push_back(junction);
    }
}

void addGivenJoins(PieceGraph& graph, const std::vector<GivenPieces::Join>& joins) {
    for (const GivenPieces::Join& join : joins) {
        ChainJunction junction;
        junction.a = graph.nodeOf[std::size_t(join.a)],
        junction.b = graph.nodeOf[std::size_t(join.b)];
        if (junction.a == junction.b) continue;
        junction.kind = JunctionKind::collapse;
        junction.logOdds = certain;
        junction.lengthMm = glm::distance(join.aMm, join.bMm);
        junction.placeMm = 0.5 * (join.aMm + join.bMm);
        junction.path = int(graph.collapses.size());
        graph.graph.junctions.push_back(junction);
        graph.collapses.push_back({join.a,
                                   join.b,
                                   junction.lengthMm,
                                   junction.lengthMm,
                                   true,
                                   0.0,
                                   {join.aMm, join.bMm}});
    }
}

}  // namespace

PieceGraph makePieceGraph(const Volume<std::int16_t>& hu, const BowelContents& contents,
                          const TissueModel& tissue, const TubePieces& cut,
                          std::span<const double> foldMm, std::span<const glm::vec3> softTissueMm,
                          const GivenPieces& given, int threads) {
    constexpr std::size_t mostNodes = 400;
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    const BrightestFluid brightest = brightestFluid(contents.levels, softHu);
    const std::vector<Said> said = saidOf(given, cut.pieces.size());
    constexpr double leastLevelMm2 = 20.0;
    const std::vector<double> levelMm2 = levelsOn(cut, contents);
    PieceGraph made;
    made.nodeOf.assign(cut.pieces.size(), -1);
    for (std::size_t p = 0; p < cut.pieces.size() && made.pieceOf.size() < mostNodes; ++p) {
        const TubePiece& piece = cut.pieces[p];
        const bool bowel = said[p] != Said::nothing || isGasBowel(piece) ||
                           isUntaggedBowel(piece) ||
                           isTaggedBowel(piece, softHu, brightest, contents.gasSdHu);
        if (!bowel) {
            if (isTooBright(piece, softHu, brightest, contents.gasSdHu) ||
                (isDense(piece, softHu) && levelMm2[p] >= leastLevelMm2))
                made.doubtful.push_back(std::int32_t(p));
            continue;
        }
        made.nodeOf[p] = std::int32_t(made.pieceOf.size());
        made.pieceOf.push_back(std::int32_t(p));
    }
    const std::vector<NodePlaces> places = placesOf(made, cut, hu.grid());
    made.frame = frameOf(made, cut, places, softTissueMm);
    for (std::size_t n = 0; n < places.size(); ++n) {
        const std::size_t p = std::size_t(made.pieceOf[n]);
        made.graph.nodes.push_back(nodeOf(cut.pieces[p], places[n], made.frame));
        if (said[p] == Said::notColon) made.graph.nodes.back().given = -certain;
    }
    addFolds(made, foldMm);
    for (const std::int32_t p : given.colon)
        made.graph.nodes[std::size_t(made.nodeOf[std::size_t(p)])].given = certain;
    addOrifices(made, cut, said, softHu);
    CollapseOptions collapse;
    collapse.threads = threads;
    addCollapses(made, findCollapsePaths(hu, contents, cut, made.pieceOf,
                                         doorsOf(made, cut, softHu), collapse));
    addGivenJoins(made, given.joins);
    return made;
}

}  // namespace haustra::segmentation
