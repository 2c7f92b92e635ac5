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

// Fluid is even, and no brighter than the fluid under levels; bone is neither.
bool isTaggedBowel(const TubePiece& piece, double softHu, double brightestHu, double noiseSdHu) {
    constexpr double leastMl = 0.5, leastRadiusMm = 3.5, mostUneven = 0.22;
    if (piece.mostlyGas() || piece.volumeMl < leastMl || piece.radiusMm < leastRadiusMm)
        return false;
    const double contrast = piece.coreHu - softHu;
    if (!(contrast > 60.0) || piece.coreHu > brightestHu) return false;
    const double sd =
        std::sqrt(std::max(0.0, piece.coreSdHu * piece.coreSdHu - noiseSdHu * noiseSdHu));
    return sd < mostUneven * contrast;
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

}  // namespace

PieceGraph makePieceGraph(const Volume<std::int16_t>& hu, const BowelContents& contents,
                          const TissueModel& tissue, const TubePieces& cut,
                          std::span<const double> foldMm, std::span<const glm::vec3> softTissueMm,
                          const GivenPieces& given, int threads) {
    const double softHu = tissue.meanHu[int(Tissue::soft)];
    double brightestHu = 3000.0;
    {
        std::vector<std::pair<double, double>> fluids;  // HU, area
        double area = 0.0;
        for (const Level& level : contents.levels)
            fluids.emplace_back(level.fluidHu, level.areaMm2), area += level.areaMm2;
        std::sort(fluids.begin(), fluids.end());
        double sum = 0.0;
        for (const auto& [fluidHu, mm2] : fluids) {
            sum += mm2;
            if (sum >= 0.95 * area) {
                brightestHu = softHu + 1.5 * (fluidHu - softHu) + 100.0;
                break;
            }
        }
    }
    PieceGraph made;
    made.nodeOf.assign(cut.pieces.size(), -1);
    double low = 1e9, high = -1e9;
    std::vector<char> named(cut.pieces.size(), 0);
    for (const std::int32_t p : given.colon)
        named[std::size_t(p)] = 1;
    for (const GivenPieces::Join& join : given.joins)
        named[std::size_t(join.a)] = named[std::size_t(join.b)] = 1;
    for (const std::int32_t p : given.notColon)
        named[std::size_t(p)] = 2;
    for (std::size_t p = 0; p < cut.pieces.size(); ++p) {
        const TubePiece& piece = cut.pieces[p];
        const bool bowel = named[p] != 0 || isGasBowel(piece) || isUntaggedBowel(piece) ||
                           isTaggedBowel(piece, softHu, brightestHu, contents.gasSdHu);
        if (!bowel) continue;
        if (made.pieceOf.size() >= 400) break;
        made.nodeOf[p] = std::int32_t(made.pieceOf.size());
        made.pieceOf.push_back(std::int32_t(p));
        if (piece.radiusMm > 8.0 && piece.volumeMl > 10.0)
            low = std::min(low, piece.centreMm.z - piece.radiusMm),
            high = std::max(high, piece.centreMm.z + piece.radiusMm);
    }
    // Samples of each piece: where its voxels lie, and its lowest end.
    const Grid& grid = hu.grid();
    std::vector<std::vector<glm::dvec3>> samples(made.pieceOf.size());
    std::vector<glm::dvec3> lowest(made.pieceOf.size(), glm::dvec3(0.0, 0.0, 1e9));
    std::vector<glm::dvec3> lowCorner(made.pieceOf.size(), glm::dvec3(1e9)),
        highCorner(made.pieceOf.size(), glm::dvec3(-1e9));
    for (std::size_t n = 0; n < cut.pieceAt.voxels().size(); ++n) {
        const std::int32_t p = cut.pieceAt[n];
        if (p < 0 || made.nodeOf[std::size_t(p)] < 0) continue;
        const std::size_t node = std::size_t(made.nodeOf[std::size_t(p)]);
        const glm::dvec3 at = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (n % 61 == 0) samples[node].push_back(at);
        if (at.z < lowest[node].z) lowest[node] = at;
        lowCorner[node] = glm::min(lowCorner[node], at),
        highCorner[node] = glm::max(highCorner[node], at);
    }
    for (std::size_t n = 0; n < made.pieceOf.size(); ++n) {
        const TubePiece& piece = cut.pieces[std::size_t(made.pieceOf[n])];
        if (piece.radiusMm > 8.0 && piece.volumeMl > 10.0) low = std::min(low, lowest[n].z);
    }
    made.frame = findBodyFrame(softTissueMm, low, high);
    made.lowestMm = lowest;
    for (std::size_t n = 0; n < made.pieceOf.size(); ++n) {
        const TubePiece& piece = cut.pieces[std::size_t(made.pieceOf[n])];
        ChainNode node;
        node.radiusMm = piece.radiusMm;
        node.volumeMl = piece.volumeMl;
        // As a tube of that calibre, but no longer than it reaches: bone is plates.
        node.lengthMm = std::min(1000.0 * piece.volumeMl / (M_PI * piece.radiusMm * piece.radiusMm),
                                 1.5 * glm::distance(lowCorner[n], highCorner[n]));
        node.centreMm = piece.centreMm;
        if (samples[n].empty()) samples[n].push_back(piece.centreMm);
        for (std::size_t part = 0; part < colonParts; ++part) {
            for (const glm::dvec3& at : samples[n]) {
                node.placeLogOdds[part] +=
                    std::clamp(
                        logDensity(regions()[part], made.frame.place(at)) - std::log(background),
                        -4.0, 1.2) /
                    double(samples[n].size());
            }
        }
        const Region anus{{0.0, 0.3, 0.02}, {0.15, 0.3, 0.06}};
        const glm::dvec3 z = (made.frame.place(lowest[n]) - anus.mean) / anus.sd;
        node.rectumLogOdds = -std::min(15.0, 0.5 * glm::dot(z, z));
        constexpr double certain = 60.0;
        if (named[std::size_t(made.pieceOf[n])] == 2) node.given = -certain;
        made.graph.nodes.push_back(node);
    }
    std::vector<double> nodeFoldMm;
    for (const std::int32_t p : made.pieceOf)
        nodeFoldMm.push_back(foldMm[std::size_t(p)]);
    const double seen = foldsSeen(made.graph.nodes, nodeFoldMm);
    for (std::size_t n = 0; n < nodeFoldMm.size(); ++n) {
        for (int part = 0; part < colonParts && nodeFoldMm[n] >= 0.0; ++part)
            made.graph.nodes[n].foldLogOdds[std::size_t(part)] =
                seen * foldLogOddsOf(nodeFoldMm[n], part);
    }
    for (const std::int32_t p : given.colon)
        made.graph.nodes[std::size_t(made.nodeOf[std::size_t(p)])].given = 60.0;
    for (std::size_t o = 0; o < cut.orifices.size(); ++o) {
        const Orifice& orifice = cut.orifices[o];
        const int a = made.nodeOf[std::size_t(orifice.a)], b = made.nodeOf[std::size_t(orifice.b)];
        if (a < 0 || b < 0) continue;
        ChainJunction junction;
        junction.path = int(o);
        junction.mismatch = fluidMismatch(orifice, cut, softHu);
        junction.a = a, junction.b = b;
        junction.logOdds = named[std::size_t(orifice.a)] == 2 || named[std::size_t(orifice.b)] == 2
                               ? -60.0
                               : orificeLogOdds(orifice, cut, softHu);
        junction.kind = junction.logOdds < 0.0 ? JunctionKind::thinWall : JunctionKind::openLumen;
        junction.radiusMm = orifice.radiusMm, junction.openMm2 = orifice.openMm2,
        junction.wallMm2 = orifice.wallMm2;
        junction.placeMm = orifice.placeMm;
        made.graph.junctions.push_back(junction);
    }
    // What is crossed where the colon is collapsed.
    std::vector<std::vector<glm::ivec3>> doors(made.pieceOf.size());
    for (const Orifice& orifice : cut.orifices) {
        const int a = made.nodeOf[std::size_t(orifice.a)], b = made.nodeOf[std::size_t(orifice.b)];
        if (a < 0 || b < 0 || orificeLogOdds(orifice, cut, softHu) < 1.0) continue;
        doors[std::size_t(a)].push_back(orifice.place);
        doors[std::size_t(b)].push_back(orifice.place);
    }
    CollapseOptions collapse;
    collapse.threads = threads;
    made.collapses = findCollapsePaths(hu, contents, cut, made.pieceOf, doors, collapse);
    for (std::size_t n = 0; n < made.collapses.size(); ++n) {
        const CollapsePath& path = made.collapses[n];
        ChainJunction junction;
        junction.a = made.nodeOf[std::size_t(path.from)],
        junction.b = made.nodeOf[std::size_t(path.to)];
        junction.kind = JunctionKind::collapse;
        junction.logOdds = -3.0 - 0.04 * path.costMm - path.turn - (path.toTip ? 0.0 : 3.0);
        junction.lengthMm = path.lengthMm;
        junction.placeMm = path.pointsMm[path.pointsMm.size() / 2];
        junction.path = int(n);
        made.graph.junctions.push_back(junction);
    }
    for (const GivenPieces::Join& join : given.joins) {
        ChainJunction junction;
        junction.a = made.nodeOf[std::size_t(join.a)],
        junction.b = made.nodeOf[std::size_t(join.b)];
        if (junction.a == junction.b) continue;
        junction.kind = JunctionKind::collapse;
        junction.logOdds = 60.0;
        junction.lengthMm = glm::distance(join.aMm, join.bMm);
        junction.placeMm = 0.5 * (join.aMm + join.bMm);
        junction.path = int(made.collapses.size());
        made.graph.junctions.push_back(junction);
        made.collapses.push_back({join.a,
                                  join.b,
                                  junction.lengthMm,
                                  junction.lengthMm,
                                  true,
                                  0.0,
                                  {join.aMm, join.bMm}});
    }
    return made;
}

}  // namespace haustra::segmentation
