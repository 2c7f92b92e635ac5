#include "segmentation/record_colon.h"

#include "core/printed_text.h"
#include "segmentation/course_doubts.h"
#include "segmentation/told_places.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

namespace haustra::segmentation {
namespace {

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
            if (node.volumeMl > largest) largest = node.volumeMl, up.placeMm = node.centerMm;
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
             const std::vector<UntaggedLevel>& untagged, const std::vector<BrightBody>& metal,
             const Source& source)
        : contents_(contents),
          cut_(cut),
          graph_(graph),
          chains_(chains),
          chain_(chains.front()),
          labels_(labels),
          untagged_(untagged),
          metal_(metal),
          source_(source) {}

    ColonRecord record() {
        const std::vector<double> weights = posterior(chains_);
        made_.noiseSdHu = contents_.gasSdHu;
        made_.maskInSoftTissue = source_.maskInSoftTissue;
        for (std::size_t n = 0; n < chain_.nodes.size(); ++n) {
            const ChainNode& node = graph_.graph.nodes[std::size_t(chain_.nodes[n])];
            const TubePiece& piece = pieceOf(chain_.nodes[n]);
            const double voxelMl = piece.volumeMl / double(piece.voxels);
            const double gasMl = double(piece.gasVoxels) * voxelMl,
                         untaggedMl = double(piece.untaggedVoxels) * voxelMl;
            made_.pieces.push_back({ColonPart(chain_.states[n]), node.centerMm, node.radiusMm,
                                    wayThrough(n), gasMl, piece.volumeMl - gasMl - untaggedMl,
                                    untaggedMl, node.lengthMm});
        }
        addSacsFluid();
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
            if (!wall.openedAgain)
                made_.walls.push_back({wall.placeMm, wall.areaMm2, wall.betweenLoops});
        made_.strandedMl = labels_.strandedMl;
        findLeftOut();
        for (const UntaggedLevel& level : untagged_)
            made_.untaggedPools.push_back(
                {partAt(level.placeMm), level.placeMm, level.areaMm2, level.fluidHu});
        findCutEnds();
        measureTagging();
        made_.endsAt =
            graph_.frame.place(graph_.graph.nodes[std::size_t(chain_.nodes.back())].lowestMm);
        made_.doubts = doubtsOf(made_);
        made_.confidence = courseConfidence(made_.chainConfidence, made_.doubts);
        warn();
        return std::move(made_);
    }

private:
    // Where the course leaves the n-th node of the chain into its n-th junction, or comes from it
    // into the next one.
    glm::dvec3 mouthMm(std::size_t n, bool intoNext) const {
        const ChainJunction& junction = graph_.graph.junctions[std::size_t(chain_.junctions[n])];
        if (junction.kind != JunctionKind::collapse) return junction.placeMm;
        const CollapsePath& path = graph_.collapses[std::size_t(junction.path)];
        const bool leadsOn = junction.a == chain_.nodes[n];
        return leadsOn == intoNext ? path.pointsMm.back() : path.pointsMm.front();
    }

    // The place of a node's piece that lies farthest from a point.
    glm::dvec3 farthestMm(int node, glm::dvec3 fromMm) const {
        const Grid& grid = cut_.pieceAt.grid();
        const auto piece = graph_.pieceOf[std::size_t(node)];
        glm::dvec3 farthest = fromMm;
        for (std::size_t v = 0; v < grid.voxelCount(); ++v) {
            if (cut_.pieceAt[v] != piece) continue;
            const glm::dvec3 mm = grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(v)));
            if (glm::distance(mm, fromMm) > glm::distance(farthest, fromMm)) farthest = mm;
        }
        return farthest;
    }

    // From mouth to mouth by the middle of its ball; of the first and the last node, to where it is
    // farthest from its one mouth.
    double wayThrough(std::size_t n) const {
        const int node = chain_.nodes[n];
        const ChainNode& at = graph_.graph.nodes[std::size_t(node)];
        const bool isFirst = n == 0, isLast = n + 1 == chain_.nodes.size();
        if (isFirst && isLast) return 2.0 * at.radiusMm;
        const glm::dvec3 from =
                             isFirst ? farthestMm(node, mouthMm(n, false)) : mouthMm(n - 1, true),
                         to = isLast ? farthestMm(node, from) : mouthMm(n, false);
        return glm::distance(from, at.centerMm) + glm::distance(at.centerMm, to);
    }

    const TubePiece& pieceOf(int node) const {
        return cut_.pieces[std::size_t(graph_.pieceOf[std::size_t(node)])];
    }

    // Fluid without tagging in sacs counts with the piece whose ball is nearest.
    void addSacsFluid() {
        for (const int sac : chain_.sacs) {
            const TubePiece& piece = pieceOf(sac);
            const auto nearest =
                std::min_element(made_.pieces.begin(), made_.pieces.end(),
                                 [&](const ColonPiece& a, const ColonPiece& b) {
                                     return glm::distance(a.centerMm, piece.centerMm) - a.radiusMm <
                                            glm::distance(b.centerMm, piece.centerMm) - b.radiusMm;
                                 });
            nearest->untaggedMl +=
                piece.volumeMl * double(piece.untaggedVoxels) / double(piece.voxels);
        }
    }

    // Of the piece that is nearest, as far as its ball reaches.
    ColonPart partAt(glm::dvec3 placeMm) const {
        ColonPart part = ColonPart::rectum;
        double nearest = 1e9;
        for (const ColonPiece& piece : made_.pieces) {
            const double mm = glm::distance(piece.centerMm, placeMm) - piece.radiusMm;
            if (mm < nearest) nearest = mm, part = piece.part;
        }
        return part;
    }

    /// Of 16 mm and 10 ml and more, and likely by place and folds, as the chain weighs them: told
    /// wherever it lies, as a part of the colon that was passed by may lie far from the course.
    /// Place alone does not tell it.
    static bool looksLikeColon(const ChainNode& node) {
        constexpr double leastRadiusMm = 8.0, leastMl = 10.0, likely = 1.3;
        if (node.radiusMm < leastRadiusMm || node.volumeMl < leastMl || node.given < 0.0)
            return false;
        double most = -1e9;
        for (std::size_t part = 0; part < colonParts; ++part)
            most = std::max(most, node.placeLogOdds[part] + node.foldLogOdds[part]);
        return most > likely;
    }

    // Gas of a balloon, or a ball of stool; a bridge may cross what was left out.
    bool isTakenIn(const TubePiece& piece) const {
        const auto label = LumenLabel(labels_.labels.at(piece.center));
        return label != LumenLabel::outside && label != LumenLabel::bridge;
    }

    LeftOutBody leftOut(const TubePiece& piece, bool opens) const {
        LeftOutBody body{piece.centerMm, piece.volumeMl, piece.content(), ColonPart::rectum, 1e9,
                         opens};
        for (std::size_t c = 0; c < chain_.nodes.size(); ++c) {
            const ChainNode& kept = graph_.graph.nodes[std::size_t(chain_.nodes[c])];
            const double mm =
                glm::distance(kept.centerMm, piece.centerMm) - kept.radiusMm - piece.radiusMm;
            if (mm < body.distanceMm)
                body.distanceMm = mm, body.nearest = ColonPart(chain_.states[c]);
        }
        body.distanceMm = std::max(0.0, body.distanceMm);
        return body;
    }

    // Far from the course fluid may be a bladder, and what is bright bone. Wide gas in the trunk is
    // the stomach's, bowel's or free, and nothing but a person's word tells which.
    bool isMuchGas(const LeftOutBody& body, const ChainNode& node) const {
        constexpr double leastMl = 25.0, leastRadiusMm = 8.0, mostAside = 1.1;
        const glm::dvec3 at = glm::abs(graph_.frame.place(body.centerMm));
        return body.content == BodyContent::gas && node.given >= 0.0 && body.volumeMl >= leastMl &&
               node.radiusMm >= leastRadiusMm && at.x <= mostAside && at.y <= mostAside;
    }

    void findLeftOut() {
        constexpr double leastMl = 2.0;
        const std::set<int> taken = nodesOf(chain_);
        std::set<int> opened;
        for (const int j : chain_.cuts) {
            opened.insert(graph_.graph.junctions[std::size_t(j)].a);
            opened.insert(graph_.graph.junctions[std::size_t(j)].b);
        }
        for (std::size_t n = 0; n < graph_.graph.nodes.size(); ++n) {
            const ChainNode& node = graph_.graph.nodes[n];
            if (taken.count(int(n)) || node.volumeMl < leastMl) continue;
            if (isTakenIn(pieceOf(int(n)))) continue;
            LeftOutBody body = leftOut(pieceOf(int(n)), opened.count(int(n)) > 0);
            body.likeColon = looksLikeColon(node);
            if (body.isNear() || isMuchGas(body, node)) made_.leftOut.push_back(body);
        }
        // Whatever it is, it may be the way on.
        for (const std::int32_t p : graph_.doubtful) {
            const TubePiece& piece = cut_.pieces[std::size_t(p)];
            if (piece.volumeMl >= leastMl && !isTakenIn(piece))
                made_.leftOut.push_back(leftOut(piece, false));
        }
        std::stable_sort(
            made_.leftOut.begin(), made_.leftOut.end(),
            [](const LeftOutBody& a, const LeftOutBody& b) { return a.volumeMl > b.volumeMl; });
    }

    // The lumen is cut where it reaches a face of the scan or the padding around its field, but for
    // what is no wider than a rectal catheter, which leaves the scan with the patient.
    void findCutEnds() {
        constexpr double leastMm2 = 100.0;
        if (!source_.scanGrid) return;
        for (CutEnd& end : openings()) {
            if (end.areaMm2 < leastMm2) continue;
            end.part = partAt(end.placeMm);
            made_.cutEnds.push_back(end);
        }
        std::stable_sort(made_.cutEnds.begin(), made_.cutEnds.end(),
                         [](const CutEnd& a, const CutEnd& b) { return a.areaMm2 > b.areaMm2; });
    }

    // The open faces of a voxel of lumen: those towards what is not in the scan, as a vector of
    // their area along each of the grid's axes.
    glm::dvec3 openFacesMm2(std::size_t n) const {
        const Grid &grid = labels_.labels.grid(), &scan = *source_.scanGrid;
        const glm::dvec3 faceMm2 = grid.voxelVolumeMm3() / grid.spacingMm();
        const glm::ivec3 v = grid.voxelAt(n);
        glm::dvec3 open(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                glm::ivec3 next = v;
                next[axis] += step;
                const bool isOpen =
                    grid.contains(next)
                        ? Content(contents_.content.at(next)) == Content::beyond
                        : !scan.contains(glm::ivec3(glm::round(scan.voxelFromPatientPoint(
                              grid.patientFromVoxelPoint(glm::dvec3(next))))));
                if (isOpen) open[axis] += step * faceMm2[axis];
            }
        }
        return open;
    }

    // Where the lumen is open, in connected pieces. A piece's area is its flat one, along its mean
    // direction, as voxels step along a circle.
    std::vector<CutEnd> openings() const {
        const Volume<std::uint8_t>& labels = labels_.labels;
        const Grid& grid = labels.grid();
        std::map<std::size_t, glm::dvec3> open;
        for (std::size_t n = 0; n < labels.voxels().size(); ++n) {
            if (LumenLabel(labels[n]) == LumenLabel::outside ||
                LumenLabel(labels[n]) == LumenLabel::bridge)
                continue;
            if (const glm::dvec3 mm2 = openFacesMm2(n); mm2 != glm::dvec3(0.0)) open[n] = mm2;
        }
        std::vector<CutEnd> openings;
        while (!open.empty()) {
            std::vector<std::size_t> body{open.begin()->first};
            glm::dvec3 sum(0.0), areaMm2 = open.begin()->second;
            open.erase(open.begin());
            for (std::size_t m = 0; m < body.size(); ++m) {
                const glm::ivec3 v = grid.voxelAt(body[m]);
                sum += glm::dvec3(v);
                visitBox(glm::max(v - 1, glm::ivec3(0)), glm::min(v + 1, grid.size - 1),
                         [&](glm::ivec3 beside) {
                             const auto found = open.find(grid.index(beside));
                             if (found == open.end()) return;
                             body.push_back(found->first);
                             areaMm2 += found->second;
                             open.erase(found);
                         });
            }
            openings.push_back({ColonPart::rectum,
                                grid.patientFromVoxelPoint(sum / double(body.size())),
                                glm::length(areaMm2)});
        }
        return openings;
    }

    // Water has less than 30 HU, and soft tissue's own HU may be fluid of any kind.
    static constexpr double denserThanWaterHu = 60.0;

    void measureTagging() {
        std::vector<std::pair<double, double>> huAndMm2;
        double sumMm2 = 0.0;
        const auto count = [&](double hu, double mm2) {
            if (hu < denserThanWaterHu || mm2 <= 0.0) return;
            huAndMm2.emplace_back(hu, mm2), sumMm2 += mm2;
        };
        const Grid& grid = contents_.content.grid();
        const double columnMm2 = grid.voxelVolumeMm3() / grid.spacingMm()[contents_.down.axis];
        for (const Level& level : contents_.levels) {
            const auto inColon =
                std::ranges::count_if(level.columns, [&](const LevelColumn& column) {
                    return LumenLabel(labels_.labels.at(column.above)) != LumenLabel::outside;
                });
            count(level.fluidHu, columnMm2 * double(inColon));
        }
        for (const UntaggedPool& pool : made_.untaggedPools)
            count(pool.fluidHu, pool.areaMm2);
        std::ranges::sort(huAndMm2);
        double belowMm2 = 0.0;
        for (const auto& [hu, mm2] : huAndMm2) {
            belowMm2 += mm2;
            if (belowMm2 < 0.5 * sumMm2) continue;
            made_.taggingHu = hu;
            break;
        }
    }

    void sayFarGas() {
        double sumMl = 0.0;
        ToldPlaces places;
        for (const LeftOutBody& body : made_.leftOut) {
            if (!body.isFarGas() || isToldAsRectum(body)) continue;
            sumMl += body.volumeMl;
            places.add(body.centerMm);
        }
        if (places.none()) return;
        made_.warnings.push_back(
            printed("%.0f ml of gas away from the course were taken for the stomach's, other "
                    "bowel's or free, at ",
                    sumMl) +
            places.text());
    }

    bool isToldAsRectum(const LeftOutBody& body) const {
        return std::ranges::count(missingEndMm_, body.centerMm) > 0;
    }

    // A balloon that fills the rectum closes it; one of water looks like its wall.
    void sayRectalEnd() {
        constexpr double tellMl = 2.0;
        if (!chain_.rectalEnd.empty()) {
            double takenMl = 0.0;
            ToldPlaces ends;
            for (const int n : chain_.rectalEnd) {
                takenMl += pieceOf(n).volumeMl;
                ends.add(pieceOf(n).centerMm);
            }
            made_.warnings.push_back(
                printed("%.0f ml behind what looks like a thin wall, as of a catheter's balloon, "
                        "were taken for the rectum's end, at ",
                        takenMl) +
                ends.text());
        }
        if (made_.pieces.front().part != ColonPart::rectum) return;  // told as such
        const std::set<int> taken = nodesOf(chain_);
        const ChainNode& first = graph_.graph.nodes[std::size_t(chain_.nodes.front())];
        double sumMl = 0.0;
        ToldPlaces places;
        for (std::size_t n = 0; n < graph_.graph.nodes.size(); ++n) {
            const TubePiece& piece = pieceOf(int(n));
            const ChainNode& node = graph_.graph.nodes[n];
            if (taken.count(int(n)) || node.given < 0.0 || !piece.mostlyGas() || isTakenIn(piece) ||
                !isBelowRectum(node, first))
                continue;
            sumMl += piece.volumeMl;
            places.add(piece.centerMm);
            missingEndMm_.push_back(piece.centerMm);
        }
        if (sumMl < tellMl) return missingEndMm_.clear();
        made_.warnings.push_back(
            printed("%.0f ml of gas lie below where the rectum begins: its end may be missing, as "
                    "where a catheter's balloon fills it, at ",
                    sumMl) +
            places.text());
    }

    // Bodies of one kind near one part in one line, the largest first.
    void sayLeftOut() {
        constexpr double tellMl = 5.0;
        std::vector<bool> said(made_.leftOut.size(), false);
        for (std::size_t n = 0; n < said.size(); ++n) {
            const LeftOutBody& first = made_.leftOut[n];
            double sumMl = 0.0;
            ToldPlaces places;
            for (std::size_t m = n; m < said.size(); ++m) {
                const LeftOutBody& body = made_.leftOut[m];
                if (said[m] || body.content != first.content || body.nearest != first.nearest ||
                    body.opens != first.opens || body.likeColon != first.likeColon ||
                    (!body.opens && body.volumeMl < tellMl) || body.isFarGas() ||
                    isToldAsRectum(body))
                    continue;
                said[m] = true;
                sumMl += body.volumeMl;
                places.add(body.centerMm);
            }
            if (places.none()) continue;
            made_.warnings.push_back(
                printed("%.0f ml of %s nearest to the %s%s, at ", sumMl, toString(first.content),
                        toString(first.nearest),
                        first.opens ? " lie open to the colon and were taken for small bowel"
                        : first.likeColon
                            ? ", as wide as colon and where it may lie, were taken for "
                              "other than colon"
                            : " were taken for other than colon") +
                places.text());
        }
    }

    void sayMetal() {
        std::map<ColonPart, std::pair<double, ToldPlaces>> told;
        for (const BrightBody& body : metal_) {
            auto& [sumMl, places] = told[partAt(body.placeMm)];
            sumMl += body.ml;
            places.add(body.placeMm);
        }
        for (const auto& [part, what] : told)
            made_.warnings.push_back(
                printed("%.1f ml at the wall of the %s are as bright as metal, as of a stent, or "
                        "thick barium: what lies there is not seen, at ",
                        what.first, toString(part)) +
                what.second.text());
    }

    // Tagged fluid that stands nowhere under gas in the whole scan may be bone beside a pool.
    void sayUnseenTagging() {
        constexpr double tellMl = 2.0;
        if (!contents_.levels.empty()) return;
        for (const ColonPiece& piece : made_.pieces) {
            if (piece.taggedMl < tellMl) continue;
            made_.warnings.push_back(printed(
                "%.0f ml in the %s are as bright as tagged material, which shows no level in "
                "this scan; they may be bone, at %s",
                piece.taggedMl, toString(piece.part), placeText(piece.centerMm).c_str()));
        }
    }

    void warn() {
        constexpr double sure = 0.95, doubtful = 0.8;
        // 300 to 900 HU count as best (Bannas et al., Clin Radiol 2014; 69: 1171).
        constexpr double weakTaggingHu = 200.0;
        const auto say = [&](std::string line) { made_.warnings.push_back(std::move(line)); };
        if (isAnothersMask(made_))
            say(
                printed("%.0f %% of the mask are as bright as soft tissue in the scan: it may be "
                        "another scan's, or hold stool or fluid without tagging",
                        100.0 * made_.maskInSoftTissue));
        for (const CutEnd& end : made_.cutEnds)
            say(
                printed("the scan ends within the %s, which it cuts open over %.0f mm2; what lies "
                        "beyond is not in it, at %s",
                        toString(end.part), end.areaMm2, placeText(end.placeMm).c_str()));
        for (std::size_t n = 0; n < made_.junctions.size(); ++n) {
            const ColonJunction& junction = made_.junctions[n];
            const char* const part = toString(made_.pieces[n].part);
            if (junction.kind == JunctionKind::collapse) {
                // Which of the two nobody can tell from where the lumen ends.
                constexpr double leastToldMm = 0.5;
                const std::string over = junction.lengthMm < leastToldMm
                                             ? std::string()
                                             : printed(" over %.0f mm", junction.lengthMm);
                say(printed("the %s is collapsed%s, or a mass closes it, at %s", part, over.c_str(),
                            placeText(junction.placeMm).c_str()));
            } else if (junction.kind == JunctionKind::thinWall) {
                say(printed("what looks like a thin wall in the %s was taken for open lumen, at %s",
                            part, placeText(junction.placeMm).c_str()));
            }
            if (junction.confidence < sure)
                say(printed("the way on from the %s is not sure (%.0f %%), at %s", part,
                            100.0 * junction.confidence, placeText(junction.placeMm).c_str()));
        }
        // Who lay otherwise than the series says, how sharp the kernel is, slices that do not
        // follow each other, and metal.
        for (const std::string& warning : contents_.warnings)
            say(warning);
        sayMetal();
        sayRectalEnd();
        sayLeftOut();
        sayFarGas();
        sayUnseenTagging();
        for (const RebuiltWallRecord& wall : made_.walls) {
            constexpr double tellMm2 = 20.0;
            constexpr double wideMm2 = 400.0;  // as wide as a colon
            if (wall.betweenLoops && wall.areaMm2 > tellMm2)
                say(printed("a wall of %.0f mm2 between two loops was rebuilt, at %s", wall.areaMm2,
                            placeText(wall.placeMm).c_str()));
            else if (!wall.betweenLoops && wall.areaMm2 > wideMm2)
                say(
                    printed("a wall of %.0f mm2 was set up, beyond which gas and fluid were taken "
                            "for other bowel; they may be the colon's, at %s",
                            wall.areaMm2, placeText(wall.placeMm).c_str()));
        }
        for (const RebuiltWall& wall : labels_.walls)
            if (wall.openedAgain)
                say(
                    printed("an opening of %.0f mm2 was kept, as without it the colon is parted: "
                            "a polyp or a fold may stand in the way, or two loops touch, at %s",
                            wall.areaMm2, placeText(wall.placeMm).c_str()));
        std::map<ColonPart, double> untaggedMl;
        for (const ColonPiece& piece : made_.pieces)
            untaggedMl[piece.part] += piece.untaggedMl;
        for (const auto& [part, ml] : untaggedMl) {
            constexpr double tellMl = 1.0;
            if (ml > tellMl)
                say(
                    printed("%.0f ml of fluid of little or no tagging were taken out of the %s; "
                            "its wall shows little contrast and may lie elsewhere by millimetres",
                            ml, toString(part)));
        }
        for (const EnclosedGas& gas : labels_.enclosed)
            say(printed(
                "%.0f ml of gas stand in the lumen of the %s behind a wall of their own, as in "
                "a catheter's balloon; both were taken out, at %s",
                gas.volumeMl, toString(partAt(gas.placeMm)), placeText(gas.placeMm).c_str()));
        for (const UntaggedPool& pool : made_.untaggedPools)
            say(printed(
                "fluid %s (%.0f HU) stands under the gas in the %s, its surface %.0f mm2; what "
                "lies in it and beneath is not seen, at %s",
                pool.fluidHu < denserThanWaterHu ? "without tagging" : "of too little tagging",
                pool.fluidHu, toString(pool.part), pool.areaMm2, placeText(pool.placeMm).c_str()));
        if (made_.taggingHu && *made_.taggingHu < weakTaggingHu)
            say(
                printed("the tagging is weak: what stands under the gas has %.0f HU in the median, "
                        "where 300 to 900 are best; residue may hide polyps, and be taken for them",
                        *made_.taggingHu));
        if (made_.chainConfidence < doubtful && !made_.runnersUp.empty()) {
            const RunnerUp& up = made_.runnersUp.front();
            say(printed(
                "another course is nearly as likely (%.0f %%): it adds %.0f ml and drops %.0f "
                "ml, at %s",
                100.0 * up.probability, up.addsMl, up.dropsMl, placeText(up.placeMm).c_str()));
        }
        if (made_.confidence < doubtful && !made_.doubts.empty() &&
            made_.doubts.front().probability > 1.0 - made_.chainConfidence) {
            say(printed("the course is right with no more than %.0f %%; gravest: %s",
                        100.0 * made_.confidence, made_.doubts.front().about.c_str()));
        }
        if (made_.pieces.front().part != ColonPart::rectum)
            say(printed("the rectum was not found: the colon begins in the %s",
                        toString(made_.pieces.front().part)));
        // The cecum's places and the ascending colon's overlap: only what ends farther off is told.
        if (made_.pieces.back().part < ColonPart::ascending)
            say(printed("the cecum was not found: the colon ends in the %s",
                        toString(made_.pieces.back().part)));
        if (labels_.strandedMl >= 0.5)
            say(printed("%.1f ml that nothing joins to the lumen were left out",
                        labels_.strandedMl));
    }

    const BowelContents& contents_;
    const TubePieces& cut_;
    const PieceGraph& graph_;
    const std::vector<ColonChain>& chains_;
    const ColonChain& chain_;
    const ColonLabels& labels_;
    const std::vector<UntaggedLevel>& untagged_;
    const std::vector<BrightBody>& metal_;
    const Source& source_;
    ColonRecord made_;
    std::vector<glm::dvec3> missingEndMm_;  ///< told by sayRectalEnd
};

}  // namespace

ColonRecord recordColon(const BowelContents& contents, const TubePieces& cut,
                        const PieceGraph& graph, const std::vector<ColonChain>& chains,
                        const ColonLabels& labels, const std::vector<UntaggedLevel>& untagged,
                        const std::vector<BrightBody>& metal, const Source& source) {
    return Recorder(contents, cut, graph, chains, labels, untagged, metal, source).record();
}

}  // namespace haustra::segmentation
