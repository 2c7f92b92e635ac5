#include "segmentation/course_doubts.h"

#include "core/printed_text.h"
#include "segmentation/colon_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace haustra::segmentation {
namespace {

constexpr double twoWallsMm = 4.0;  // what lies between any two loops that touch

double wrongCollapse(double lengthMm, double calibreRatio) {
    constexpr double evenMm = 75.0, spreadMm = 10.0, otherCalibre = 0.5;
    const double longWay = 1.0 / (1.0 + std::exp((evenMm - lengthMm) / spreadMm));
    const double mismatch = std::abs(std::log(calibreRatio)) > otherCalibre ? 0.4 : 0.0;
    const double touching = lengthMm > 0.0 && lengthMm < twoWallsMm ? 0.15 : 0.02;
    return 1.0 - (1.0 - touching) * (1.0 - longWay) * (1.0 - mismatch);
}

}  // namespace

std::vector<Doubt> doubtsOf(const ColonRecord& record) {
    std::vector<Doubt> doubts;
    const auto doubt = [&](double probability, std::string about) {
        if (probability > 0.0) doubts.push_back({std::move(about), probability});
    };
    std::array<double, colonParts> tubeMm{};
    for (const ColonPiece& piece : record.pieces)
        tubeMm[std::size_t(piece.part)] += piece.tubeMm;
    for (std::size_t n = 0; n < record.junctions.size(); ++n) {
        const ColonJunction& junction = record.junctions[n];
        const ColonPiece &a = record.pieces[n], &b = record.pieces[n + 1];
        if (junction.kind == JunctionKind::collapse) {
            tubeMm[std::size_t(a.part)] += junction.lengthMm;
            doubt(
                wrongCollapse(junction.lengthMm, a.radiusMm / b.radiusMm),
                junction.lengthMm < twoWallsMm
                    ? printed("two loops may only touch where %.0f mm were crossed from the %s on",
                              junction.lengthMm, toString(a.part))
                    : printed("a loop may lie in the %.0f mm that were crossed from the %s on",
                              junction.lengthMm, toString(a.part)));
        } else if (junction.kind == JunctionKind::thinWall) {
            doubt(0.12,
                  printed("what was taken for open in the %s may be a wall", toString(a.part)));
        }
    }
    constexpr std::array<std::pair<ColonPart, double>, 4> leastMm{{{ColonPart::sigmoid, 130.0},
                                                                   {ColonPart::descending, 80.0},
                                                                   {ColonPart::transverse, 150.0},
                                                                   {ColonPart::ascending, 60.0}}};
    for (const auto& [part, least] : leastMm) {
        const double mm = tubeMm[std::size_t(part)];
        if (mm < least)
            doubt(0.4 * (1.0 - mm / least),
                  printed("no more than %.0f mm of %s%s were found", mm, toString(part),
                          part == ColonPart::sigmoid ? "" : " in all"));
    }
    constexpr double farLeft = 0.2, high = 0.6;  // of a cecum's lowest place
    // Of forty small phantoms two began in the sigmoid, and both had lost a rectum full of fluid.
    if (!record.pieces.empty() && record.pieces.front().part != ColonPart::rectum)
        doubt(0.7, "the rectum was not found");
    if (!record.pieces.empty() && record.pieces.back().part < ColonPart::ascending)
        doubt(0.7, "the cecum was not found");
    else if (record.endsAt && (record.endsAt->x > farLeft || record.endsAt->z > high))
        doubt(0.4, "the course may end before the cecum");
    std::set<ColonPart> cut;  // a part that is cut at two places is still one part
    for (const CutEnd& end : record.cutEnds) {
        if (cut.insert(end.part).second)
            doubt(0.5, printed("the %s goes on beyond the edge of the scan", toString(end.part)));
    }
    if (record.strandedMl >= leastPartedMl)
        doubt(0.9, printed("%.0f ml of the colon are joined to nothing, and were left out",
                           record.strandedMl));
    if (isAnothersMask(record))
        doubt(record.maskInSoftTissue,
              printed("%.0f %% of the mask lie in soft tissue", 100.0 * record.maskInSoftTissue));
    // Of six wild courses that left out gas like colon four had lost colon, of two that left out
    // fluid like it none had.
    for (const bool gas : {true, false}) {
        const auto like = std::ranges::find_if(record.leftOut, [&](const LeftOutBody& body) {
            return body.likeColon && (body.content == BodyContent::gas) == gas;
        });
        if (like == record.leftOut.end()) continue;
        doubt(gas ? 0.6 : 0.25,
              printed("%.0f ml of %s as wide as colon, and where it may lie, "
                      "were left out near the %s",
                      like->volumeMl, gas ? "gas" : "fluid", toString(like->nearest)));
    }
    for (const LeftOutBody& body : record.leftOut) {
        constexpr double tellMl = 5.0, muchMl = 25.0;
        if (body.content != BodyContent::gas || !body.isNear() || body.volumeMl < tellMl) continue;
        doubt(0.03 * std::min(1.0, body.volumeMl / muchMl) + (body.opens ? 0.05 : 0.0),
              printed("%.0f ml of gas near the %s may be colon", body.volumeMl,
                      toString(body.nearest)));
    }
    for (const LeftOutBody& body : record.leftOut) {
        constexpr double tellMl = 5.0, muchMl = 100.0;
        if (body.content == BodyContent::gas || !body.opens || body.volumeMl < tellMl) continue;
        doubt(0.3 * std::min(1.0, body.volumeMl / muchMl),
              printed("%.0f ml of fluid that lie open to the %s may be colon", body.volumeMl,
                      toString(body.nearest)));
    }
    for (const RebuiltWallRecord& wall : record.walls) {
        constexpr double tellMm2 = 20.0;
        constexpr double flatLoopMm2 = 3000.0;  // a loop of 40 mm pressed flat along 75
        if (!wall.betweenLoops && wall.areaMm2 > flatLoopMm2)
            doubt(0.4,
                  printed("a wall of %.0f mm2 that was set up is wider than bowel that touches",
                          wall.areaMm2));
        if (wall.betweenLoops && wall.areaMm2 > tellMm2)
            doubt(wall.areaMm2 > flatLoopMm2 ? 0.4 : 0.02,
                  printed("a rebuilt wall of %.0f mm2 may be none", wall.areaMm2));
    }
    double untaggedMl = 0.0;
    for (const ColonPiece& piece : record.pieces)
        untaggedMl += piece.untaggedMl;
    if (untaggedMl > 0.0)
        doubt(0.1 * std::min(1.0, untaggedMl / 50.0),
              printed("%.0f ml of untagged fluid may be other than lumen", untaggedMl));
    for (const UntaggedPool& pool : record.untaggedPools)
        doubt(0.1 * std::min(1.0, pool.areaMm2 / 1000.0),
              printed("untagged fluid in the %s may hide lumen", toString(pool.part)));
    std::stable_sort(doubts.begin(), doubts.end(),
                     [](const Doubt& a, const Doubt& b) { return a.probability > b.probability; });
    return doubts;
}

bool isAnothersMask(const ColonRecord& record) {
    constexpr double leastShare = 0.1;
    return record.maskInSoftTissue >= leastShare;
}

double courseConfidence(double chainConfidence, const std::vector<Doubt>& doubts) {
    for (const Doubt& doubt : doubts)
        chainConfidence *= 1.0 - doubt.probability;
    return chainConfidence;
}

}  // namespace haustra::segmentation
