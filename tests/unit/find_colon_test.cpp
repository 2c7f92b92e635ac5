// The colon in a drawn abdomen: a tube from the rectum to the cecum with gas over fluid, with
// lungs, stomach, small bowel and bone beside it.
#include "segmentation/find_colon.h"

#include "cleansing/tissue_mixture.h"
#include "core/connected_labels.h"
#include "core/crop.h"
#include "phantom/phantom.h"
#include "phantom/score.h"
#include "segmentation/bowel_contents.h"
#include "segmentation/course_doubts.h"
#include "segmentation/enclosed_gas.h"
#include "segmentation/metal.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>

#include <gtest/gtest.h>

using namespace haustra;
using segmentation::ColonOptions;
using segmentation::FoundColon;

namespace {

constexpr double levelMm = 150.0;  // the fluid's surface
constexpr glm::dvec2 fieldsMiddleMm{161.25, 123.75};

struct Capsule {
    glm::dvec3 a, b;
    double radiusMm;
};

double outsideMm(const Capsule& c, glm::dvec3 p) {
    const double t =
        std::clamp(glm::dot(p - c.a, c.b - c.a) / glm::dot(c.b - c.a, c.b - c.a), 0.0, 1.0);
    return glm::distance(p, glm::mix(c.a, c.b, t)) - c.radiusMm;
}

// From the anus up the left side, across, and down the right side: about 78 cm.
const std::vector<Capsule>& colon() {
    static const std::vector<Capsule> all{
        {{160, 175, 25}, {160, 150, 80}, 19},   {{160, 150, 80}, {205, 125, 105}, 15},
        {{205, 125, 105}, {260, 145, 125}, 15}, {{260, 145, 125}, {268, 150, 290}, 16},
        {{268, 150, 290}, {250, 120, 312}, 17}, {{250, 120, 312}, {160, 75, 265}, 18},
        {{160, 75, 265}, {75, 110, 305}, 18},   {{75, 110, 305}, {58, 140, 130}, 20},
        {{58, 140, 130}, {62, 135, 105}, 23}};
    return all;
}
bool inColon(glm::dvec3 p) {
    for (const Capsule& c : colon()) {
        if (outsideMm(c, p) < 0.0) return true;
    }
    return false;
}
bool inLung(glm::dvec3 p) {
    return p.z > 345 && p.y > 70 && p.y < 200 && std::abs(p.x - 162) > 25 &&
           std::abs(p.x - 162) < 110;
}
bool inStomach(glm::dvec3 p) {
    return glm::length((p - glm::dvec3(175, 120, 335)) / glm::dvec3(26, 22, 14)) < 1;
}
bool inTaggedIleum(glm::dvec3 p) {
    return glm::length((p - glm::dvec3(165, 150, 190)) / glm::dvec3(18, 16, 40)) < 1;
}
const Capsule gasIleum{{110, 110, 150}, {200, 90, 165}, 8};
bool inGasIleum(glm::dvec3 p) {
    return outsideMm(gasIleum, p) < 0.0;
}

struct Drawing {
    Volume<std::int16_t> hu{axisAlignedGrid({130, 100, 152}, {2.5, 2.5, 2.5})};

    Drawing() {
        std::mt19937 random(3);
        std::normal_distribution<double> noise(0.0, 12.0);
        eachVoxel([&](std::size_t n, glm::dvec3 p) {
            const double body = glm::length(glm::dvec2((p.x - 162) / 152, (p.y - 125) / 112));
            const double value = body > 1.0 ? -990 : body > 0.93 ? -95 : 45;
            hu.writable()[n] = std::int16_t(std::lround(value + noise(random)));
        });
        paint(-860, inLung);
        paint(-985, inStomach);
        paint(30, [](glm::dvec3 p) { return inStomach(p) && p.y > 125; });
        paint(400, inTaggedIleum);
        paint(-988, inGasIleum);
    }
    void eachVoxel(const std::function<void(std::size_t, glm::dvec3)>& visit) const {
        for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n)
            visit(n, hu.grid().patientFromVoxelPoint(hu.grid().voxelAt(n)));
    }
    void paint(double value, const std::function<bool(glm::dvec3)>& inside) {
        eachVoxel([&](std::size_t n, glm::dvec3 p) {
            if (inside(p)) hu.writable()[n] = std::int16_t(value + int(n % 7) - 3);
        });
    }
    void paintColon(const std::function<bool(glm::dvec3)>& fluid) {
        paint(-988, inColon);
        paint(620, [=](glm::dvec3 p) { return inColon(p) && fluid(p); });
    }
    CtScan scan(PatientPosition position = PatientPosition::supine) const {
        return {hu.share(), position};
    }

    static Drawing supine() {
        Drawing drawing;
        drawing.paintColon([](glm::dvec3 p) { return p.y >= levelMm; });
        return drawing;
    }
};

Result<FoundColon> find(const CtScan& scan, const ColonOptions& options = {}) {
    const auto tissue = cleansing::fitTissueModel(scan);
    EXPECT_TRUE(tissue);
    return segmentation::findColon(scan, *tissue, options);
}

double labelledMl(const FoundColon& found, const std::function<bool(glm::dvec3)>& where) {
    double ml = 0.0;
    const Grid& grid = found.labels.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (found.labels[n] != 0 && where(grid.patientFromVoxelPoint(grid.voxelAt(n))))
            ml += grid.voxelVolumeMm3() / 1000.0;
    }
    return ml;
}

double diceWithDrawing(const FoundColon& found,
                       const std::function<bool(glm::dvec3)>& truth = inColon) {
    std::size_t both = 0, sum = 0;
    const Grid& grid = found.labels.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const bool is = truth(grid.patientFromVoxelPoint(grid.voxelAt(n))),
                   labelled = found.labels[n] != 0;
        both += is && labelled, sum += std::size_t(is) + std::size_t(labelled);
    }
    return 2.0 * double(both) / double(sum);
}

bool isOnePiece(const FoundColon& found) {
    Volume<std::uint8_t> labels = found.labels.clone();
    return joinBodies(
               labels, [](std::size_t) { return false; },
               [](std::size_t) { return std::uint8_t(0); }) == 0.0;
}

TEST(FindColon, IsTheColonWithItsFluidAndNothingElse) {
    const auto found = find(Drawing::supine().scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_GT(diceWithDrawing(*found), 0.99);
    EXPECT_EQ(labelledMl(*found, inLung), 0.0);
    EXPECT_EQ(labelledMl(*found, inStomach), 0.0);
    EXPECT_EQ(labelledMl(*found, inTaggedIleum), 0.0);
    EXPECT_EQ(labelledMl(*found, inGasIleum), 0.0);
    EXPECT_TRUE(isOnePiece(*found));
    EXPECT_EQ(found->gravity, glm::dvec3(0, 1, 0));
    EXPECT_EQ(found->record.pieces.size(), found->record.junctions.size() + 1);
    for (const ColonJunction& junction : found->record.junctions)
        EXPECT_EQ(junction.kind, JunctionKind::openLumen);
    EXPECT_LT(found->record.pieces.front().centerMm.z, 150.0);
    EXPECT_LT(found->record.pieces.back().centerMm.x, 110.0) << "the cecum lies on the right";
    double axisMm = colon().front().radiusMm + colon().back().radiusMm;
    for (const Capsule& c : colon())
        axisMm += glm::distance(c.a, c.b);
    EXPECT_NEAR(found->record.lengthMm() / axisMm, 1.0, 0.1);
}

// Scatter in a large body brightens gas as much as emphysema darkens lung; but lungs come from the
// scan's top.
TEST(FindColon, GasThatScatterBrightensIsNoLung) {
    const auto fluid = [](glm::dvec3 p) { return p.y >= levelMm; };
    Drawing drawing;
    drawing.paintColon(fluid);
    drawing.paint(-885, [&](glm::dvec3 p) { return inColon(p) && !fluid(p); });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_GT(diceWithDrawing(*found), 0.98);
    EXPECT_EQ(labelledMl(*found, inLung), 0.0);
}

// The drawing between two heights, in a scan that ends there.
CtScan between(double lowMm, double highMm) {
    const Drawing drawing = Drawing::supine();
    const Grid& grid = drawing.hu.grid();
    VoxelBox box{glm::ivec3(0), grid.size};
    box.lo.z = int(lowMm / grid.spacingMm().z);
    box.size.z = int(highMm / grid.spacingMm().z) - box.lo.z;
    return {cropped(drawing.hu, box, 1), PatientPosition::supine};
}
bool tells(const FoundColon& found, const std::string& of) {
    return std::any_of(found.record.warnings.begin(), found.record.warnings.end(),
                       [&](const std::string& line) { return line.find(of) != std::string::npos; });
}

// The places that a line names.
std::vector<glm::dvec3> placesIn(const std::string& line) {
    std::vector<glm::dvec3> places;
    for (std::size_t at = 0; (at = line.find('(', at)) != std::string::npos; ++at) {
        glm::dvec3 p;
        if (std::sscanf(&line[at], "(%lf, %lf, %lf) mm", &p.x, &p.y, &p.z) == 3)
            places.push_back(p);
    }
    return places;
}

// A field so narrow that its side cuts the descending colon: what a side cuts is no room's air,
// which goes by the patient from end to end, or around a corner of the slices.
TEST(FindColon, IsFoundWhereTheFieldsSideCutsIt) {
    const Drawing drawing = Drawing::supine();
    const Grid& grid = drawing.hu.grid();
    for (const bool left : {true, false}) {
        VoxelBox box{glm::ivec3(0), grid.size};
        if (left)
            box.size.x = int(268.0 / grid.spacingMm().x);  // the descending colon's axis
        else
            box.lo.x = int(58.0 / grid.spacingMm().x), box.size.x -= box.lo.x;  // the ascending's
        const CtScan scan{cropped(drawing.hu, box, 1), PatientPosition::supine};
        const auto found = find(scan);
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_GT(diceWithDrawing(*found), 0.98);
        ASSERT_FALSE(found->record.cutEnds.empty());
        const glm::dvec3 at = found->record.cutEnds[0].placeMm;
        EXPECT_NEAR(at.x, left ? 268.0 : 58.0, 5.0);
        EXPECT_TRUE(inColon(at));
        EXPECT_TRUE(tells(*found, "the scan ends within"));
    }
}

// The scan as one of a round field, with padding around it.
CtScan withinCircle(const Drawing& drawing, double radiusMm, std::int16_t padding) {
    CtScan scan = drawing.scan();
    scan.hu = drawing.hu.clone();
    drawing.eachVoxel([&](std::size_t n, glm::dvec3 p) {
        if (glm::length(glm::dvec2(p) - fieldsMiddleMm) > radiusMm) scan.hu.writable()[n] = padding;
    });
    return scan;
}

// A circle that cuts the descending and the ascending colon lengthwise: padding is no room's air,
// whatever its value.
TEST(FindColon, IsFoundWhereTheFieldsCircleCutsIt) {
    constexpr double radiusMm = 110.0;
    const Drawing drawing = Drawing::supine();
    for (const std::int16_t padding : {-1024, 0}) {
        const auto found = find(withinCircle(drawing, radiusMm, padding));
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_GT(diceWithDrawing(*found,
                                  [](glm::dvec3 p) {
                                      return inColon(p) &&
                                             glm::length(glm::dvec2(p) - fieldsMiddleMm) < radiusMm;
                                  }),
                  0.96);
        bool left = false, right = false;
        for (const CutEnd& end : found->record.cutEnds) {
            left = left || end.placeMm.x > fieldsMiddleMm.x;
            right = right || end.placeMm.x < fieldsMiddleMm.x;
            EXPECT_NEAR(glm::length(glm::dvec2(end.placeMm) - fieldsMiddleMm), radiusMm, 6.0);
        }
        EXPECT_TRUE(left && right);
        EXPECT_TRUE(tells(*found, "the scan ends within"));
    }
}

// Before and behind the body this one leaves some of the room's air, and cuts off the flanks alone.
TEST(FindColon, IsWholeWithinAWiderCircle) {
    const auto found = find(withinCircle(Drawing::supine(), 136.0, -1024));
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_GT(diceWithDrawing(*found), 0.98);
    EXPECT_TRUE(found->record.cutEnds.empty());
}

// A wall that a person sets up at the field's border is none of the border's padding.
TEST(FindColon, ACutAcrossTheFieldsCircleChangesNothingAwayFromIt) {
    const CutBall ball{{fieldsMiddleMm.x, 14.0, 60.0}, 15.0};
    for (const std::int16_t padding : {-1024, 0}) {
        const CtScan scan = withinCircle(Drawing::supine(), 110.0, padding);
        ColonOptions options;
        options.edits.cuts = {ball};
        const auto without = find(scan), with = find(scan, options);
        ASSERT_TRUE(without && with);
        EXPECT_TRUE(std::ranges::equal(without->labels.voxels(), with->labels.voxels()));
        EXPECT_EQ(without->record.warnings, with->record.warnings);
        EXPECT_FALSE(with->record.cutEnds.empty());
    }
}

TEST(FindColon, TellsWhereTheScanEndsWithinTheColon) {
    const auto whole = find(between(0, 380));
    ASSERT_TRUE(whole) << describe(whole.error());
    EXPECT_TRUE(whole->record.cutEnds.empty());
    EXPECT_FALSE(tells(*whole, "the scan ends within"));

    // Below, through the rectum, of 19 mm radius; its axis is all but upright.
    const auto below = find(between(50, 380));
    ASSERT_TRUE(below) << describe(below.error());
    ASSERT_EQ(below->record.cutEnds.size(), 1u);
    EXPECT_EQ(below->record.cutEnds[0].part, ColonPart::rectum);
    EXPECT_NEAR(below->record.cutEnds[0].areaMm2, M_PI * 19 * 19, 0.15 * M_PI * 19 * 19);
    EXPECT_TRUE(inColon(below->record.cutEnds[0].placeMm));
    EXPECT_TRUE(tells(*below, "the scan ends within the rectum"));
    EXPECT_LT(below->record.confidence, 0.6 * whole->record.confidence);

    // Above, through both flexures: four limbs, or two where limbs meet.
    const auto above = find(between(0, 285));
    ASSERT_TRUE(above) << describe(above.error());
    EXPECT_GE(above->record.cutEnds.size(), 2u);
    for (const CutEnd& end : above->record.cutEnds) {
        EXPECT_NEAR(end.placeMm.z, 285, 5.0);
        EXPECT_TRUE(inColon(end.placeMm)) << end.placeMm.x << " " << end.placeMm.y;
    }
    EXPECT_TRUE(tells(*above, "the scan ends within"));
}

// A hip of metal, cut at the scanner's highest value.
TEST(FindColon, TellsMetal) {
    const auto without = find(Drawing::supine().scan());
    ASSERT_TRUE(without) << describe(without.error());
    EXPECT_FALSE(tells(*without, "brighter than bone"));
    Drawing drawing = Drawing::supine();
    const CutBall hip{{60, 180, 40}, 15.0};
    drawing.paint(3071,
                  [&](glm::dvec3 p) { return glm::distance(p, hip.centerMm) < hip.radiusMm; });
    ColonOptions options;
    for (const bool cut : {false, true}) {
        if (cut) options.edits.cuts = {hip};
        const auto found = find(drawing.scan(), options);
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_TRUE(tells(*found, "14.0 ml are brighter than bone"));  // of a ball's 14.1
        EXPECT_TRUE(tells(*found, "at (60, 180, 40) mm"));
    }
}

// The wires of a stent are thinner than voxels, and so no brighter than compact bone, which is told
// nowhere: it lies on the lumen's wall.
TEST(FindColon, TellsAStentsMeshAtTheLumenAndNoBone) {
    const Capsule& descending = colon()[3];
    for (const double offMm : {0.0, 14.0}) {
        Drawing drawing = Drawing::supine();
        drawing.paint(1700, [&](glm::dvec3 p) {
            const bool wire = int(std::floor(p.z / 5.0) + std::floor(p.y / 5.0)) % 2 == 0;
            return wire && p.z > 180 && p.z < 240 &&
                   std::abs(outsideMm(descending, p) - offMm) < 1.5;
        });
        const auto found = find(drawing.scan());
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_EQ(tells(*found, "are as bright as metal"), offMm == 0.0);
        for (const std::string& warning : found->record.warnings) {
            if (warning.find("are as bright as metal") == std::string::npos) continue;
            const auto places = placesIn(warning);
            ASSERT_EQ(places.size(), 1u) << warning;
            EXPECT_LT(glm::distance(places[0], glm::dvec3(264, 146, 210)), 6.0) << "its middle";
        }
        EXPECT_FALSE(tells(*found, "brighter than bone"));
    }
}

// A wire along a lumen as thin as it, in slices of any thickness.
TEST(MetalAtLumen, IsWhatLiesWithinThreeMillimetresOrInTheNextSlice) {
    for (const double sliceMm : {0.7, 1.0, 4.0}) {
        const Grid grid = axisAlignedGrid({450, 11, 11}, {1.0, 1.0, sliceMm});
        for (int n = 1; n < 25; ++n) {
            const glm::ivec3 off(0, n % 5, n / 5);
            Volume<std::int16_t> hu(grid, std::int16_t(40));
            Volume<std::uint8_t> labels(grid, std::uint8_t(LumenLabel::outside));
            for (glm::ivec3 v(0, 5, 5); v.x < grid.size.x; ++v.x) {
                labels.writable()[grid.index(v)] = std::uint8_t(LumenLabel::air);
                hu.writable()[grid.index(v + off)] = 2000;
            }
            const bool isAtLumen = glm::length(glm::dvec3(off) * grid.spacingMm()) <= 3.0 ||
                                   off == glm::ivec3(0, 0, 1);
            EXPECT_EQ(segmentation::metalAtLumen(hu, labels, 1).size(), std::size_t(isAtLumen))
                << sliceMm << " mm, " << off.y << " " << off.z;
        }
    }
}

TEST(FindColon, NamesAFewPlacesOfMuchMetal) {
    const Capsule& descending = colon()[3];
    Drawing drawing = Drawing::supine();
    drawing.paint(1700, [&](glm::dvec3 p) {
        return std::abs(outsideMm(descending, p)) < 2.0 && p.z > 140 && p.z < 280 &&
               std::fmod(p.z, 15.0) < 7.0;
    });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    const auto line = std::ranges::find_if(found->record.warnings, [](const std::string& warning) {
        return warning.find("are as bright as metal") != std::string::npos;
    });
    ASSERT_NE(line, found->record.warnings.end());
    EXPECT_EQ(placesIn(*line).size(), 6u) << *line;
    EXPECT_TRUE(line->ends_with("and elsewhere"));
}

// 300 to 900 HU are the best; little of it may not be told from tissue at all.
TEST(FindColon, TellsHowWeakTheTaggingIs) {
    for (const double hu : {620.0, 150.0}) {
        Drawing drawing;
        drawing.paint(-988, inColon);
        drawing.paint(hu, [](glm::dvec3 p) { return inColon(p) && p.y >= levelMm; });
        const auto found = find(drawing.scan());
        ASSERT_TRUE(found) << describe(found.error());
        ASSERT_TRUE(found->record.taggingHu);
        EXPECT_NEAR(*found->record.taggingHu, hu, 10.0);
        EXPECT_EQ(tells(*found, "the tagging is weak"), hu < 200.0);
    }
    Drawing dry;
    dry.paint(-988, inColon);
    const auto found = find(dry.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_FALSE(found->record.taggingHu);
    EXPECT_FALSE(tells(*found, "the tagging is weak"));
}

Volume<std::uint8_t> maskOf(const Grid& grid, const std::function<bool(glm::dvec3)>& inside) {
    Volume<std::uint8_t> mask(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        mask.writable()[n] = inside(grid.patientFromVoxelPoint(grid.voxelAt(n)));
    return mask;
}

TEST(FindColonInMask, TheScanSaysWhatIsTaggedAndWhereDownIs) {
    const CtScan scan = Drawing::supine().scan(PatientPosition::unknown);
    const auto tissue = cleansing::fitTissueModel(scan);
    ASSERT_TRUE(tissue);
    const Volume<std::uint8_t> mask =
        maskOf(scan.hu.grid(), [](glm::dvec3 p) { return inColon(p) || inGasIleum(p); });
    const auto found = segmentation::findColonInMask(mask, &scan, *tissue);
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(found->gravity, glm::dvec3(0, 1, 0));
    EXPECT_GT(diceWithDrawing(*found), 0.995);
    EXPECT_EQ(labelledMl(*found, inGasIleum), 0.0) << "what the mask holds beside the colon";
    EXPECT_TRUE(isOnePiece(*found));
    bool told = false;
    for (const std::string& note : found->notes)
        told = told || note.find("ml of the mask are no part of the colon") != std::string::npos;
    EXPECT_TRUE(told);
    for (std::size_t n = 0; n < mask.voxels().size(); ++n) {
        const glm::dvec3 p = mask.grid().patientFromVoxelPoint(mask.grid().voxelAt(n));
        if (found->labels[n] == 0) continue;
        ASSERT_NE(mask[n], 0) << "nothing is added";
        if (std::abs(p.y - levelMm) > 6.0) {
            ASSERT_EQ(LumenLabel(found->labels[n]),
                      p.y > levelMm ? LumenLabel::tagged : LumenLabel::air);
        }
    }
}

TEST(FindColonInMask, DoubtsAMaskThatLiesInTheScansSoftTissue) {
    const CtScan scan = Drawing::supine().scan();
    const auto tissue = cleansing::fitTissueModel(scan);
    ASSERT_TRUE(tissue);
    const auto movedBy = [&](double mm) {
        const auto mask =
            maskOf(scan.hu.grid(), [&](glm::dvec3 p) { return inColon(p - glm::dvec3(mm, 0, 0)); });
        return segmentation::findColonInMask(mask, &scan, *tissue);
    };
    const auto own = movedBy(0.0), another = movedBy(12.5);
    ASSERT_TRUE(own) << describe(own.error());
    ASSERT_TRUE(another) << describe(another.error());
    EXPECT_FALSE(tells(*own, "it may be another scan's"));
    EXPECT_TRUE(tells(*another, "it may be another scan's"));
    EXPECT_LT(another->record.confidence, 0.9 * own->record.confidence);
    // What is said of the course is said with that doubt.
    if (another->record.confidence < 0.8) {
        EXPECT_TRUE(tells(*another, "the course is right with no more than"));
    }
    EXPECT_EQ(another->record.confidence,
              segmentation::courseConfidence(another->record.chainConfidence,
                                             segmentation::doubtsOf(another->record)));
}

// As other programs write masks, cropped to what they hold: where they end, no scan ends.
TEST(FindColonInMask, WithoutAScanMayEndAnywhere) {
    const Volume<std::uint8_t> whole = maskOf(Drawing().hu.grid(), inColon);
    const CtScan scan = Drawing::supine().scan();
    const auto tissue = cleansing::fitTissueModel(scan);
    ASSERT_TRUE(tissue);
    const VoxelBox box{{14, 0, 20}, {104, 100, 132}};  // through the cecum, and the rectum
    const auto found = segmentation::findColonInMask(cropped(whole, box, 1), nullptr, *tissue);
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_TRUE(found->record.cutEnds.empty());
    // On the scan's own grid it does.
    const CtScan part{cropped(scan.hu, box, 1), scan.position};
    const auto onScan = segmentation::findColonInMask(cropped(whole, box, 1), &part, *tissue);
    ASSERT_TRUE(onScan) << describe(onScan.error());
    EXPECT_FALSE(onScan->record.cutEnds.empty());
}

TEST(FindColonInMask, NeedsNoScan) {
    const CtScan scan = Drawing::supine().scan();
    const auto tissue = cleansing::fitTissueModel(scan);
    ASSERT_TRUE(tissue);
    const Volume<std::uint8_t> mask = maskOf(scan.hu.grid(), inColon);
    const auto found = segmentation::findColonInMask(mask, nullptr, *tissue);
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_GT(diceWithDrawing(*found), 0.995);
    EXPECT_EQ(found->gravity, glm::dvec3(0.0));
    EXPECT_EQ(found->record.pieces.front().part, ColonPart::rectum);
    EXPECT_LT(found->record.pieces.back().centerMm.x, 110.0) << "the cecum lies on the right";
}

TEST(FindColonInMask, RefusesWhatIsNoColonAndWhatIsElsewhere) {
    const CtScan scan = Drawing::supine().scan();
    const auto tissue = cleansing::fitTissueModel(scan);
    ASSERT_TRUE(tissue);
    const auto ball =
        segmentation::findColonInMask(maskOf(scan.hu.grid(), inStomach), nullptr, *tissue);
    ASSERT_FALSE(ball);
    EXPECT_EQ(ball.error().kind, ErrorKind::noResult);
    const auto elsewhere = segmentation::findColonInMask(
        maskOf(axisAlignedGrid({130, 100, 152}, glm::dvec3(2.4)), inColon), &scan, *tissue);
    ASSERT_FALSE(elsewhere);
    EXPECT_EQ(elsewhere.error().kind, ErrorKind::badInput);
}

TEST(FindColon, EachVoxelIsLabelledByWhatItHolds) {
    const CtScan scan = Drawing::supine().scan();
    const auto found = find(scan);
    ASSERT_TRUE(found);
    for (std::size_t n = 0; n < scan.hu.grid().voxelCount(); ++n) {
        const auto label = LumenLabel(found->labels[n]);
        if (label == LumenLabel::air) {
            ASSERT_LT(scan.hu[n], -400);
        }
        if (label == LumenLabel::tagged) {
            ASSERT_GT(scan.hu.grid().patientFromVoxelPoint(scan.hu.grid().voxelAt(n)).y,
                      levelMm - 6.0);
        }
        ASSERT_NE(label, LumenLabel::bridge);
    }
}

TEST(FindColon, GravityIsAsTheLevelsShowIt) {
    const auto upwards = [](glm::dvec3 p) { return p.y <= 110.0; };
    const auto leftwards = [](glm::dvec3 p) { return p.x >= 250.0; };
    struct Case {
        PatientPosition told;
        std::function<bool(glm::dvec3)> fluid;
        glm::dvec3 down;
        std::size_t notes, warnings;
    };
    const Case cases[] = {{PatientPosition::prone, upwards, {0, -1, 0}, 0, 0},
                          {PatientPosition::supine, upwards, {0, -1, 0}, 0, 1},
                          {PatientPosition::unknown, leftwards, {1, 0, 0}, 1, 0}};
    for (const Case& one : cases) {
        Drawing drawing;
        drawing.paintColon(one.fluid);
        const auto found = find(drawing.scan(one.told));
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_EQ(found->gravity, one.down);
        EXPECT_EQ(found->notes.size(), one.notes);
        EXPECT_EQ(std::size_t(tells(*found, "the levels are believed")), one.warnings);
        EXPECT_GT(diceWithDrawing(*found), 0.985);
    }
}

double untaggedMl(const segmentation::FoundColon& found) {
    double sum = 0.0;
    for (const ColonPiece& piece : found.record.pieces)
        sum += piece.untaggedMl;
    return sum;
}

TEST(FindColon, FluidOfLittleOrNoTaggingIsLumenUnderItsLevel) {
    const auto water = [](glm::dvec3 p) { return inColon(p) && p.y >= 140.0 && p.x < 120; };
    // The same place with soft tissue is no fluid, however flat its border.
    constexpr int softHu = 45;
    for (const int hu : {8, softHu, 90, 140}) {
        SCOPED_TRACE(hu);
        const bool isWater = hu != softHu;
        Drawing drawing;
        drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
        drawing.paint(hu, water);
        const auto found = find(drawing.scan());
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_TRUE(found->record.untaggedPools.empty());
        EXPECT_EQ(tells(*found, "of little or no tagging were taken out"), isWater);
        if (!isWater) {
            EXPECT_EQ(untaggedMl(*found), 0.0);
            continue;
        }
        EXPECT_GT(diceWithDrawing(*found), 0.97);
        EXPECT_TRUE(isOnePiece(*found));
        const Grid& grid = found->labels.grid();
        double drawnMl = 0.0, labelledMl = 0.0;
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
            drawnMl += water(p) ? grid.voxelVolumeMm3() / 1000.0 : 0.0;
            if (LumenLabel(found->labels[n]) == LumenLabel::untagged) {
                labelledMl += grid.voxelVolumeMm3() / 1000.0;
                ASSERT_TRUE(inColon(p) && p.y > 136.0 && p.x < 122.0);
            }
        }
        EXPECT_NEAR(untaggedMl(*found), drawnMl, 0.3 * drawnMl);  // a millimetre is the wall's
        EXPECT_NEAR(untaggedMl(*found), labelledMl, 0.1 * labelledMl);
        EXPECT_LT(found->record.confidence, found->record.chainConfidence);
    }
}

// What is heavier sinks: the top of a pool has little or no tagging, whatever HU that gives it, and
// what lies deeper more and more.
TEST(FindColon, FluidThatRisesToItsSedimentIsLumen) {
    struct Profile {
        double topHu, middleMm, widthMm;  ///< of a logistic rise with the depth
        double
            leastShare;  ///< in voxels of 2.5 mm; beside its level what is like a wall is not seen
    };
    const auto pool = [](glm::dvec3 p) { return inColon(p) && p.y >= 128.0 && p.x < 120; };
    for (const Profile profile : {Profile{15.0, 14.0, 1.8, 0.8}, Profile{45.0, 8.0, 1.5, 0.7},
                                  Profile{100.0, 6.0, 1.5, 0.8}, Profile{15.0, 8.0, 1.5, 0.8}}) {
        SCOPED_TRACE(testing::Message() << profile.topHu << " to " << profile.middleMm);
        Drawing drawing;
        drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
        drawing.eachVoxel([&](std::size_t n, glm::dvec3 p) {
            if (!pool(p)) return;
            const double deep = (p.y - 128.0 - profile.middleMm) / profile.widthMm;
            drawing.hu.writable()[n] = std::int16_t(
                profile.topHu + (520.0 - profile.topHu) / (1.0 + std::exp(-deep)) + int(n % 7) - 3);
        });
        const auto found = find(drawing.scan());
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_GT(diceWithDrawing(*found), 0.97);
        EXPECT_TRUE(isOnePiece(*found));
        double poolMl = 0.0;
        drawing.eachVoxel([&](std::size_t, glm::dvec3 p) {
            poolMl += pool(p) ? drawing.hu.grid().voxelVolumeMm3() / 1000.0 : 0.0;
        });
        EXPECT_GT(labelledMl(*found, pool), profile.leastShare * poolMl);
    }
}

// From a wall to bone, or to another bowel's tagging, behind it HU rise at once, however flat the
// wall is, under gas and under water; what lies flat within 3 mm of water is sediment.
TEST(FindColon, WhatIsBrightBehindAFlatWallIsLeftOut) {
    constexpr double floorMm = 150.0;
    for (const bool holdsWater : {false, true}) {
        for (const int hu : {300, 600}) {
            for (const double wallMm : {holdsWater ? 7.5 : 2.5, holdsWater ? 10.0 : 5.0}) {
                SCOPED_TRACE(testing::Message()
                             << wallMm << " mm, " << hu << " HU, " << holdsWater);
                const auto below = [](glm::dvec3 p, double mm) {
                    return inColon(p) && p.x < 120 && p.y >= mm;
                };
                const auto bright = [&](glm::dvec3 p) {
                    return p.x > 30 && p.x < 110 && p.y >= floorMm + wallMm && p.y < 185 &&
                           p.z > 110 && p.z < 290;
                };
                Drawing drawing;
                drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
                if (holdsWater) drawing.paint(8, [&](glm::dvec3 p) { return below(p, 144.0); });
                drawing.paint(45, [&](glm::dvec3 p) { return below(p, floorMm); });
                drawing.paint(hu, bright);
                const auto found = find(drawing.scan());
                ASSERT_TRUE(found) << describe(found.error());
                double brightMl = 0.0;
                drawing.eachVoxel([&](std::size_t, glm::dvec3 p) {
                    brightMl += bright(p) ? drawing.hu.grid().voxelVolumeMm3() / 1000.0 : 0.0;
                });
                // Of its edge a voxel may go to either side.
                EXPECT_LT(labelledMl(*found, bright), 0.05 * brightMl);
            }
        }
    }
}

// From the ascending colon's middle down the roof lies below the fluid's surface, as far as the
// cecum: full, and as much of the pool as what stands under the gas.
TEST(FindColon, ASectionFullOfFluidToItsRoofBelongsToThePool) {
    const auto water = [](glm::dvec3 p) { return inColon(p) && p.y >= 105.0 && p.x < 100; };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
    drawing.paint(8, water);
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    double drawnMl = 0.0;
    const Grid& grid = found->labels.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        drawnMl += water(grid.patientFromVoxelPoint(grid.voxelAt(n)))
                       ? grid.voxelVolumeMm3() / 1000.0
                       : 0.0;
    EXPECT_NEAR(untaggedMl(*found), drawnMl, 0.3 * drawnMl);  // a millimetre is the wall's
    EXPECT_GT(diceWithDrawing(*found), 0.96);
    EXPECT_TRUE(isOnePiece(*found));
    EXPECT_NEAR(found->record.pieces.back().centerMm.z, 120.0, 40.0)
        << "the course ends at the cecum";
}

// Sediment lies flat under the water; a bone that the water comes near to does not.
TEST(FindColon, FlatSedimentUnderAPoolIsLumenAndBoneUnderItIsNot) {
    const auto pool = [](glm::dvec3 p) { return inColon(p) && p.y >= 120.0 && p.x < 100; };
    const auto sediment = [&](glm::dvec3 p) { return pool(p) && p.y >= 145.0 && p.z < 160.0; };
    const auto bone = [](glm::dvec3 p) {
        const bool behindAWall = std::all_of(colon().begin(), colon().end(), [&](const Capsule& c) {
            return outsideMm(c, p) > 2.0;
        });
        return behindAWall && std::abs(p.z - 205.0) < 40.0 &&
               glm::distance(glm::dvec2(p), glm::dvec2(66.0, 162.0)) < 17.0;
    };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
    drawing.paint(8, pool);
    drawing.paint(620, sediment);
    drawing.paint(450, bone);
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    double sedimentMl = 0.0;
    const Grid& grid = found->labels.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        sedimentMl += sediment(grid.patientFromVoxelPoint(grid.voxelAt(n)))
                          ? grid.voxelVolumeMm3() / 1000.0
                          : 0.0;
    EXPECT_GT(labelledMl(*found, sediment), 0.85 * sedimentMl);
    EXPECT_LT(labelledMl(*found, bone), 1.0);
}

// Down is towards the front in a prone scan.
TEST(FindColon, FluidWithoutTaggingIsFoundInAProneScan) {
    const auto water = [](glm::dvec3 p) {
        return inColon(p) && p.y <= 128.0 && p.x < 78 && p.z < 270;
    };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y <= 110.0 && p.x >= 120; });
    drawing.paint(8, water);
    const auto found = find(drawing.scan(PatientPosition::prone));
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(found->gravity, glm::dvec3(0, -1, 0));
    EXPECT_GT(untaggedMl(*found), 10.0);
    for (std::size_t n = 0; n < found->labels.grid().voxelCount(); ++n) {
        if (LumenLabel(found->labels[n]) != LumenLabel::untagged) continue;
        const glm::dvec3 p =
            found->labels.grid().patientFromVoxelPoint(found->labels.grid().voxelAt(n));
        ASSERT_TRUE(inColon(p) && p.y < 132.0 && p.x < 80.0);
    }
}

// A rectal catheter's balloon holds gas within the lumen, behind a wall of its own.
TEST(FindColon, ABalloonInTheRectumIsLumen) {
    const Capsule balloon{{160, 170, 48}, {160, 166, 54}, 10};
    Drawing drawing = Drawing::supine();
    drawing.paint(45, [&](glm::dvec3 p) { return outsideMm(balloon, p) < 2.5; });
    drawing.paint(-988, [&](glm::dvec3 p) { return outsideMm(balloon, p) < 0.0; });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    const auto inBalloon = [&](glm::dvec3 p) { return outsideMm(balloon, p) < 2.5; };
    double balloonMl = 0.0;
    drawing.eachVoxel([&](std::size_t, glm::dvec3 p) {
        balloonMl += inBalloon(p) ? drawing.hu.grid().voxelVolumeMm3() / 1000.0 : 0.0;
    });
    EXPECT_GT(labelledMl(*found, inBalloon), 0.85 * balloonMl);  // of voxels as wide as its wall
    EXPECT_GT(diceWithDrawing(*found), 0.97);
    EXPECT_TRUE(isOnePiece(*found));
    EXPECT_TRUE(tells(*found, "a catheter's balloon"));
    for (const auto& body : found->record.leftOut)
        EXPECT_GT(glm::distance(body.centerMm, balloon.a), 20.0);
}

// Filled with water it closes the rectum, and what lies below is told.
TEST(FindColon, ABalloonThatClosesTheRectumIsTold) {
    const auto drawn = [](bool balloon) {
        Drawing drawing;
        drawing.paintColon([](glm::dvec3 p) { return p.y >= levelMm && p.z > 100.0; });
        if (balloon)
            drawing.paint(
                45, [](glm::dvec3 p) { return glm::distance(p, glm::dvec3(160, 167, 43)) < 20.5; });
        return drawing;
    };
    const auto open = find(drawn(false).scan()), closed = find(drawn(true).scan());
    ASSERT_TRUE(open && closed);
    constexpr auto told = "below where the rectum begins";
    EXPECT_FALSE(tells(*open, told));
    EXPECT_TRUE(tells(*closed, told));
    EXPECT_TRUE(isOnePiece(*closed));
}

// Three slabs of lumen along x, 2 mm of wall between each and the next.
TEST(TakeInBalloons, TheWallTowardsTheRectumAloneIsTakenIn) {
    const Grid grid = axisAlignedGrid({24, 12, 12}, glm::dvec3(1.0));
    Volume<std::uint8_t> content(grid, std::uint8_t(segmentation::Content::tissue)),
        labels(grid, std::uint8_t(LumenLabel::outside));
    segmentation::TubePieces cut;
    cut.pieceAt = Volume<std::int32_t>(grid, -1);
    cut.distanceMm = Volume<float>(grid, 0.0f);
    cut.pieces.resize(3);  // rectum, balloon, another loop
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const int x = grid.voxelAt(n).x;
        if (x % 8 >= 6) continue;
        cut.pieceAt.writable()[n] = x / 8;
        content.writable()[n] = std::uint8_t(segmentation::Content::gas);
        labels.writable()[n] = std::uint8_t(LumenLabel::air);
    }
    segmentation::takeInBalloons({1}, {0, 1}, content, cut, labels, 1);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const int x = grid.voxelAt(n).x;
        if (x == 6 || x == 7) {
            EXPECT_EQ(LumenLabel(labels[n]), LumenLabel::untagged);
        }
        if (x == 14 || x == 15) {
            EXPECT_EQ(LumenLabel(labels[n]), LumenLabel::outside);
        }
    }
}

// Lying on the left side, down is towards the patient's left.
TEST(FindColon, FluidWithoutTaggingIsFoundInALateralScan) {
    const auto water = [](glm::dvec3 p) {
        return inColon(p) && p.x >= 262.0 && p.z > 140.0 && p.z < 280.0;
    };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.x >= 165.0 && p.z < 100.0; });
    drawing.paint(8, water);
    const auto found = find(drawing.scan(PatientPosition::leftDecubitus));
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(found->gravity, glm::dvec3(1, 0, 0));
    EXPECT_GT(untaggedMl(*found), 10.0);
    for (std::size_t n = 0; n < found->labels.grid().voxelCount(); ++n) {
        if (LumenLabel(found->labels[n]) != LumenLabel::untagged) continue;
        const glm::dvec3 p =
            found->labels.grid().patientFromVoxelPoint(found->labels.grid().voxelAt(n));
        ASSERT_TRUE(inColon(p) && p.x > 258.0);
    }
}

// Gas that a fold or foam holds under water.
TEST(FindColon, ABubbleInAPoolBelongsToTheLumen) {
    const auto water = [](glm::dvec3 p) { return inColon(p) && p.y >= 135.0 && p.x < 120; };
    const auto bubble = [](glm::dvec3 p) {
        return glm::distance(p, glm::dvec3(59.0, 146.0, 170.0)) < 7.0;
    };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
    drawing.paint(8, water);
    drawing.paint(-988, bubble);
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_GT(diceWithDrawing(*found), 0.97);
    EXPECT_GT(labelledMl(*found, bubble), 0.9 * 4.0 / 3.0 * M_PI * std::pow(0.7, 3));
    EXPECT_TRUE(isOnePiece(*found));
}

// As bright as soft tissue, fluid is not told from the wall beneath it.
TEST(FindColon, FluidAsBrightAsAWallIsLeftOut) {
    const auto fluid = [](glm::dvec3 p) { return inColon(p) && p.y >= 140.0 && p.x < 120; };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
    drawing.paint(65, fluid);
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(untaggedMl(*found), 0.0);
    EXPECT_LT(labelledMl(*found, [&](glm::dvec3 p) { return fluid(p) && p.y > 143.0; }), 0.5);
}

// Where the ascending colon holds nothing and lies in fat, the course cannot go on; what lies
// beyond is told however far off it is.
TEST(FindColon, ColonThatTheCourseDoesNotReachIsTold) {
    Drawing drawing = Drawing::supine();
    drawing.paint(-100, [](glm::dvec3 p) {
        return p.z > 195 && p.z < 275 && p.x < 120 &&
               glm::length(glm::dvec2((p.x - 162) / 152, (p.y - 125) / 112)) < 0.9;
    });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    ASSERT_LT(labelledMl(*found, [](glm::dvec3 p) { return inColon(p) && p.x < 90 && p.z < 195; }),
              1.0);
    EXPECT_TRUE(tells(*found, "were taken for other than colon"));
    double toldMl = 0.0;
    for (const auto& body : found->record.leftOut)
        toldMl += body.centerMm.x < 90 && body.centerMm.z < 195 ? body.volumeMl : 0.0;
    EXPECT_GT(toldMl, 50.0);
    EXPECT_LT(found->record.confidence, 0.7);
}

// Gas that lies far from the course, and not as colon does, is told where there is much of it; it
// is no reason to doubt the course.
TEST(FindColon, MuchGasFarFromTheCourseIsTold) {
    const Drawing drawing = Drawing::supine();
    const Capsule loop{{150, 150, 190}, {175, 150, 205}, 13};
    const auto inLoop = [&](glm::dvec3 p) { return outsideMm(loop, p) < 0.0; };
    const std::string line = "ml of gas away from the course";
    const auto without = find(drawing.scan());
    ASSERT_TRUE(without) << describe(without.error());
    EXPECT_FALSE(tells(*without, line));
    Drawing withLoop = Drawing::supine();
    withLoop.paint(-988, inLoop);
    ColonOptions options;
    for (const bool excluded : {false, true}) {
        if (excluded) options.edits.excludesMm = {loop.a};
        const auto found = find(withLoop.scan(), options);
        ASSERT_TRUE(found) << describe(found.error());
        EXPECT_EQ(labelledMl(*found, inLoop), 0.0);
        EXPECT_EQ(tells(*found, line), !excluded);
        if (!excluded) {
            EXPECT_NEAR(found->record.confidence, without->record.confidence, 1e-3);
        }
    }
}

// A person's word about a place that is known for fluid only once the pool is found.
TEST(FindColon, AnExcludedOrCutPoolStaysOut) {
    const auto water = [](glm::dvec3 p) { return inColon(p) && p.y >= 140.0 && p.x < 120; };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
    drawing.paint(8, water);
    ColonOptions options;
    options.edits.cuts = {{{58.0, 148.0, 150.0}, 9.0}};
    const auto cut = find(drawing.scan(), options);
    ASSERT_TRUE(cut) << describe(cut.error());
    const Grid& grid = cut->labels.grid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (LumenLabel(cut->labels[n]) != LumenLabel::untagged) continue;
        EXPECT_GT(glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(n)),
                                glm::dvec3(58.0, 148.0, 150.0)),
                  8.9);
    }
    ColonOptions nowhere;
    nowhere.edits.excludesMm = {{160.0, 150.0, 330.0}};
    EXPECT_EQ(find(drawing.scan(), nowhere).has_value(), false);
}

// Fluid ends at its own level. Where what looks like it goes on beside the lumen and rises over the
// level, it is not known where the pool ends: it is told, and left out.
TEST(FindColon, FluidThatLeaksIsToldAndLeftOut) {
    const auto water = [](glm::dvec3 p) { return inColon(p) && p.y >= 140.0 && p.x < 120; };
    Drawing drawing;
    drawing.paintColon([&](glm::dvec3 p) { return p.y >= levelMm && p.x >= 120; });
    drawing.paint(8, [&](glm::dvec3 p) {
        return water(p) ||
               (!inColon(p) && p.x < 125 && p.y > 130 && p.y < 190 && p.z > 120 && p.z < 320);
    });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_EQ(untaggedMl(*found), 0.0);
    ASSERT_FALSE(found->record.untaggedPools.empty());
    const UntaggedPool& pool = found->record.untaggedPools[0];
    EXPECT_NEAR(pool.placeMm.y, 139.0, 2.5);
    EXPECT_NEAR(pool.fluidHu, 8.0, 6.0);
    EXPECT_TRUE(tells(*found, "what lies in it and beneath is not seen"));
    EXPECT_LT(found->record.confidence, found->record.chainConfidence);
}

// A stretch of the descending colon of 20 mm holds nothing; its walls lie against each other in
// fat.
struct CollapsedDrawing {
    Drawing drawing = Drawing::supine();
    double fromMm, toMm;
    CollapsedDrawing(double from, double to) : fromMm(from), toMm(to) {
        drawing.paint(-100, [&](glm::dvec3 p) {
            return std::abs(p.z - 200) < 45 && p.x > 215 && p.x < 300 && p.y < 215 && p.y > 70 &&
                   !inColon(p);
        });
        drawing.paint(
            45, [&](glm::dvec3 p) { return inColon(p) && p.x > 220 && p.z > from && p.z < to; });
        drawing.paint(-100, [&](glm::dvec3 p) {
            return inColon(p) && p.x > 220 && p.z > from + 3 && p.z < to - 3 &&
                   outsideMm({{260, 145, 125}, {268, 150, 290}, 7}, p) > 0.0;
        });
    }
    bool collapsed(glm::dvec3 p) const { return p.x > 220 && p.z > fromMm && p.z < toMm; }
};

TEST(FindColon, ACollapseIsCrossedByABridgeOfItsLengthAndTold) {
    const CollapsedDrawing made(190.0, 214.0);
    const auto found = find(made.drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_TRUE(isOnePiece(*found));
    EXPECT_GT(
        diceWithDrawing(*found, [&](glm::dvec3 p) { return inColon(p) && !made.collapsed(p); }),
        0.985);
    int collapses = 0;
    for (const ColonJunction& junction : found->record.junctions) {
        if (junction.kind != JunctionKind::collapse) continue;
        ++collapses;
        EXPECT_NEAR(junction.lengthMm, 24.0, 5.0);
        EXPECT_LT(glm::distance(junction.placeMm, glm::dvec3(264, 148, 202)), 10.0);
    }
    EXPECT_EQ(collapses, 1);
    for (std::size_t n = 0; n < found->labels.grid().voxelCount(); ++n) {
        if (LumenLabel(found->labels[n]) != LumenLabel::bridge) continue;
        const glm::dvec3 p =
            found->labels.grid().patientFromVoxelPoint(found->labels.grid().voxelAt(n));
        EXPECT_TRUE(p.x > 240 && p.z > made.fromMm - 3 && p.z < made.toMm + 3)
            << "a bridge lies in the collapse alone";
    }
    EXPECT_TRUE(std::any_of(
        found->record.warnings.begin(), found->record.warnings.end(),
        [](const std::string& line) { return line.find("collapsed over") != std::string::npos; }));
}

// A loop of ileum with gas lies in the gap of the colon: it is no way across.
TEST(FindColon, SmallBowelBesideACollapseIsNotTakenIn) {
    CollapsedDrawing made(185.0, 220.0);
    const Capsule loop{{225, 120, 200}, {150, 120, 215}, 8};
    made.drawing.paint(45, [&](glm::dvec3 p) { return outsideMm(loop, p) < 5.0 && !inColon(p); });
    made.drawing.paint(-985, [&](glm::dvec3 p) { return outsideMm(loop, p) < 0.0 && !inColon(p); });
    const auto found = find(made.drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_LT(
        labelledMl(*found, [&](glm::dvec3 p) { return outsideMm(loop, p) < -3.0 && !inColon(p); }),
        0.1);
    EXPECT_TRUE(isOnePiece(*found));
}

// A second transverse loop touches the ascending colon through a wall that shows as a rise of 300
// HU.
TEST(FindColon, AThinWallBetweenTouchingLoopsIsRebuilt) {
    Drawing drawing = Drawing::supine();
    const Capsule loop{{135, 90, 200},
                       {90, 118, 200},
                       14};  // a side way from the transverse to the ascending colon
    const Capsule link{{135, 90, 200}, {150, 78, 262}, 14};
    const auto inLoop = [&](glm::dvec3 p) {
        return outsideMm(loop, p) < 0.0 || outsideMm(link, p) < 0.0;
    };
    const auto inWall = [&](glm::dvec3 p) {
        return inLoop(p) && outsideMm(colon()[7], p) >= -2.5 && outsideMm(colon()[7], p) < 1.0;
    };
    drawing.paint(-988, [&](glm::dvec3 p) { return inLoop(p) && !inColon(p); });
    drawing.paint(-640, inWall);
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    // Whatever is made of the loop, no lumen goes through the wall.
    const Grid& grid = found->labels.grid();
    Volume<std::uint8_t> cut = found->labels.clone();
    // With the transverse colon closed upstream, the ascending colon is a body of its own.
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
        if (p.z > 230 && std::abs(p.x - 110) < 3) cut.writable()[n] = 0;
    }
    const double partedMl = joinBodies(
        cut, [](std::size_t) { return false; }, [](std::size_t) { return std::uint8_t(0); });
    EXPECT_GT(partedMl, 50.0);
    EXPECT_GT(diceWithDrawing(*found, [&](glm::dvec3 p) { return inColon(p); }), 0.85);
}

TEST(FindColon, APersonsWordIsFinal) {
    const CtScan scan = Drawing::supine().scan();
    ColonOptions options;
    options.edits.excludesMm = {{62, 120, 105}};
    const auto shorter = find(scan, options);
    ASSERT_TRUE(shorter) << describe(shorter.error());
    EXPECT_EQ(
        labelledMl(*shorter,
                   [](glm::dvec3 p) { return glm::distance(p, glm::dvec3(62, 120, 105)) < 3.0; }),
        0.0);

    options.edits = {};
    options.edits.cuts = {{{205, 125, 105}, 24.0}};
    const auto cut = find(scan, options);
    ASSERT_TRUE(cut) << describe(cut.error());
    EXPECT_EQ(
        labelledMl(*cut,
                   [](glm::dvec3 p) { return glm::distance(p, glm::dvec3(205, 115, 105)) < 6.0; }),
        labelledMl(*cut, [](glm::dvec3 p) {
            return glm::distance(p, glm::dvec3(205, 115, 105)) < 6.0 && false;
        }) + [&] {
            // A bridge may cross what was cut, never gas.
            double ml = 0.0;
            const Grid& grid = cut->labels.grid();
            for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
                if (LumenLabel(cut->labels[n]) == LumenLabel::bridge &&
                    glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(n)),
                                  glm::dvec3(205, 115, 105)) < 6.0)
                    ml += grid.voxelVolumeMm3() / 1000.0;
            }
            return ml;
        }());

    // A seed may lie in bowel that is open to the room; any other point is mistyped.
    const glm::dvec3 inTheRoom{5, 5, 5};
    std::array<ColonEdits, 3> missing;
    missing[0].seedsMm = {inTheRoom};
    missing[1].excludesMm = {inTheRoom};
    missing[2].joins = {{inTheRoom, {62, 120, 105}}};
    for (std::size_t n = 0; n < missing.size(); ++n) {
        options.edits = missing[n];
        const auto nowhere = find(scan, options);
        ASSERT_FALSE(nowhere);
        EXPECT_EQ(nowhere.error().kind, ErrorKind::badInput);
        EXPECT_EQ(nowhere.error().place, "5.0,5.0,5.0");
        EXPECT_EQ(nowhere.error().message.find("--cut") != std::string::npos, n == 0);
    }
}

// A slab of bone against the wall, brighter than any fluid.
TEST(FindColon, DenseMaterialThatTouchesTheWallIsNotStool) {
    Drawing drawing = Drawing::supine();
    const auto inBone = [](glm::dvec3 p) {
        return p.x >= 70 && p.x < 130 && p.y > 150 && p.y < 200 && p.z >= 100 && p.z < 140;
    };
    drawing.paint(1200, [&](glm::dvec3 p) {
        return inBone(p) && outsideMm(colon()[7], p) > 3.5 && outsideMm(colon()[8], p) > 3.5;
    });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_LT(labelledMl(*found, [&](glm::dvec3 p) { return inBone(p) && !inColon(p); }), 1.0);
    EXPECT_GT(diceWithDrawing(*found), 0.985);
}

// The cecum and the ascending colon are full, and their fluid is tagged more than what stands under
// the gas: `times` as far over soft tissue.
Drawing tagsTheRightMore(double times) {
    Drawing drawing;
    drawing.paintColon([](glm::dvec3 p) { return p.y >= levelMm || p.x < 100.0; });
    drawing.paint(45.0 + times * (620.0 - 45.0),
                  [](glm::dvec3 p) { return inColon(p) && p.x < 100.0; });
    return drawing;
}

TEST(FindColon, APartThatIsTaggedMoreIsStillColon) {
    const auto found = find(tagsTheRightMore(1.75).scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_GT(diceWithDrawing(*found), 0.985);
    EXPECT_LT(found->record.pieces.back().centerMm.z, 150.0) << "the course ends at the cecum";
}

TEST(FindColon, APartThatIsTooBrightForFluidIsTold) {
    const auto found = find(tagsTheRightMore(2.3).scan());
    ASSERT_TRUE(found) << describe(found.error());
    const auto onTheRight = [](glm::dvec3 p) { return inColon(p) && p.x < 100.0; };
    EXPECT_LT(labelledMl(*found, [&](glm::dvec3 p) { return onTheRight(p) && p.z < 250.0; }), 1.0);
    double toldMl = 0.0;
    for (const auto& body : found->record.leftOut)
        toldMl += onTheRight(body.centerMm) ? body.volumeMl : 0.0;
    EXPECT_GT(toldMl, 100.0);
    EXPECT_TRUE(std::ranges::any_of(found->record.warnings, [](const std::string& warning) {
        return warning.find("tagged material") != std::string::npos;
    }));
}

// A lump of tagged stool, as wide as bowel, stands on the wall in the gas; its rim is partial
// volume.
TEST(FindColon, ALargeBallOfTaggedStoolIsOfTheLumen) {
    Drawing drawing = Drawing::supine();
    const auto fromMiddle = [](glm::dvec3 p) { return glm::distance(p, glm::dvec3(65, 117, 200)); };
    drawing.paint(45, [&](glm::dvec3 p) { return fromMiddle(p) < 11.5 && inColon(p); });
    drawing.paint(620, [&](glm::dvec3 p) { return fromMiddle(p) < 9.0 && inColon(p); });
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    const Grid& grid = found->labels.grid();
    double ballMl = 0.0, taggedMl = 0.0;
    drawing.eachVoxel([&](std::size_t n, glm::dvec3 p) {
        if (fromMiddle(p) >= 9.0 || !inColon(p)) return;
        ballMl += grid.voxelVolumeMm3() / 1000.0;
        if (found->labels[n] == std::uint8_t(LumenLabel::tagged))
            taggedMl += grid.voxelVolumeMm3() / 1000.0;
    });
    EXPECT_GT(ballMl, 2.0);
    EXPECT_GT(taggedMl, 0.98 * ballMl);
    for (const auto& body : found->record.leftOut)
        EXPECT_GT(fromMiddle(body.centerMm), 9.0) << "what is lumen was not left out";
}

// A flat loop of opacified bowel is pressed against the colon, one voxel of wall between: it shows
// the lumen less than half of its surface.
TEST(FindColon, ATaggedLoopThatLiesAgainstTheColonIsNotStool) {
    Drawing drawing = Drawing::supine();
    const auto inLoop = [](glm::dvec3 p) {
        const double off = outsideMm(colon()[7], p);
        return off > 2.5 && off < 12.5 && p.x > 62 && p.y > 118 && p.y < 145 && p.z > 185 &&
               p.z < 215;
    };
    drawing.paint(620, inLoop);
    const auto found = find(drawing.scan());
    ASSERT_TRUE(found) << describe(found.error());
    EXPECT_LT(labelledMl(*found, inLoop), 0.1);
    EXPECT_GT(diceWithDrawing(*found), 0.985);
    const auto& leftOut = found->record.leftOut;
    EXPECT_TRUE(std::any_of(leftOut.begin(), leftOut.end(), [&](const auto& body) {
        return inLoop(body.centerMm);
    })) << "it was searched as bowel";
}

TEST(FindColon, AScanThatIsNoColonographyIsRefusedUnlessAPersonSaysOtherwise) {
    Drawing drawing;  // gas in a loop of ileum and the stomach, and one bubble in the colon
    const Capsule bubble{{262, 146, 160}, {264, 148, 205}, 14};
    drawing.paint(-988, [&](glm::dvec3 p) { return outsideMm(bubble, p) < 0.0; });
    const auto refused = find(drawing.scan());
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::noResult);
    EXPECT_NE(refused.error().message.find("no CT colonography"), std::string::npos);
    ColonOptions options;
    options.edits.seedsMm = {{263, 147, 180}};
    const auto asked = find(drawing.scan(), options);
    ASSERT_TRUE(asked) << describe(asked.error());
    EXPECT_GT(labelledMl(*asked, [&](glm::dvec3 p) { return outsideMm(bubble, p) < 0.0; }), 20.0);
}

// Gas that is open to the room, as through a stoma, is the room's, but for what a cut parts from
// it.
TEST(FindColon, ACutPartsAnOpenStomaFromTheRoom) {
    const Capsule stoma{{264, 147, 200}, {330, 147, 200}, 10};
    Drawing drawing = Drawing::supine();
    drawing.paint(-990, [&](glm::dvec3 p) {
        return outsideMm(stoma, p) < 0.0 && !(inColon(p) && p.y >= levelMm);
    });
    const auto open = find(drawing.scan());
    ASSERT_FALSE(open);
    EXPECT_NE(open.error().message.find("as through a stoma"), std::string::npos);
    EXPECT_NE(open.error().message.find("--cut"), std::string::npos);
    ColonOptions options;
    options.edits.cuts = {{{300, 147, 200}, 12.0}};
    const auto cut = find(drawing.scan(), options);
    ASSERT_TRUE(cut) << describe(cut.error());
    const CutBall& ball = options.edits.cuts[0];
    const auto inside = [&](glm::dvec3 p) {
        return inColon(p) || (outsideMm(stoma, p) < 0.0 && p.x < ball.centerMm.x &&
                              glm::distance(p, ball.centerMm) > ball.radiusMm);
    };
    EXPECT_GT(diceWithDrawing(*cut, inside), 0.98);
    EXPECT_FALSE(tells(*cut, "as through a stoma"));
    EXPECT_EQ(labelledMl(*cut, [&](glm::dvec3 p) { return p.x > ball.centerMm.x; }), 0.0);
}

// Bowel that two stomas open is told by the place of each, not by what lies midway.
TEST(FindColon, EachMouthOfBowelThatIsOpenToTheRoomIsTold) {
    constexpr double lowMm = 150.0, highMm = 280.0, radiusMm = 10.0;
    const Capsule between{{63, 130, 180}, {70, 118, 250}, 26};
    Drawing drawing = Drawing::supine();
    drawing.paint(-990, [&](glm::dvec3 p) {
        return outsideMm(between, p) < 0.0 || (inColon(p) && p.x < 100.0);
    });
    for (const double z : {lowMm, highMm}) {
        const Capsule stoma{{65, 125, z}, {-5, 125, z}, radiusMm};
        drawing.paint(-990, [&](glm::dvec3 p) { return outsideMm(stoma, p) < 0.0; });
    }
    const auto found = find(drawing.scan());
    ASSERT_FALSE(found);
    const std::string& message = found.error().message;
    EXPECT_NE(message.find("between the skin and"), std::string::npos);
    bool low = false, high = false;
    for (const glm::dvec3 p : placesIn(message)) {
        const bool atLow = std::abs(p.z - lowMm) < 2.0 * radiusMm,
                   atHigh = std::abs(p.z - highMm) < 2.0 * radiusMm;
        EXPECT_TRUE(atLow || atHigh) << message;
        EXPECT_TRUE(inColon(p)) << message;
        low = low || (atLow && p.z > lowMm), high = high || (atHigh && p.z < highMm);
    }
    EXPECT_TRUE(low && high) << message;
}

TEST(FindColon, IsTheSameForAnyNumberOfThreads) {
    const CtScan scan = Drawing::supine().scan();
    ColonOptions one, three;
    one.threads = 1, three.threads = 3;
    const auto a = find(scan, one), b = find(scan, three);
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(std::equal(a->labels.voxels().begin(), a->labels.voxels().end(),
                           b->labels.voxels().begin()));
    EXPECT_EQ(a->record.warnings, b->record.warnings);
}

TEST(FindColon, AgreesWithThePhantomsTruth) {
    for (PatientPosition position : {PatientPosition::supine, PatientPosition::prone}) {
        phantom::PhantomOptions options;
        options.size = phantom::Size::small;
        options.position = position;
        const auto made = phantom::makePhantom(options);
        ASSERT_TRUE(made);
        const auto found = find(made->scan);
        ASSERT_TRUE(found) << describe(found.error());
        const auto score =
            phantom::scoreLumen(made->lumen, made->centerline, found->labels, made->centerline);
        ASSERT_TRUE(score);
        EXPECT_GE(score->dice, 0.96);
        EXPECT_LE(score->falseMl, 5.0);
        // Voxels of 1.5 x 1.5 x 2 mm close some narrow places that a clinical scan keeps open.
        EXPECT_LE(score->missedCenterlineShare, 0.05);
    }
}

}  // namespace
