#include "core/colon_record.h"

#include "core/printed_text.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace haustra {
namespace {

using Json = nlohmann::ordered_json;

// To a hundredth: the figures are no better, and the text stays the same on every machine.
double rounded(double value) {
    return std::round(value * 100.0) / 100.0;
}
Json place(glm::dvec3 p) {
    return {rounded(p.x), rounded(p.y), rounded(p.z)};
}

}  // namespace

const char* toString(BodyContent content) {
    constexpr const char* names[] = {"gas", "tagged material", "fluid without tagging"};
    return names[int(content)];
}

const char* toString(ColonPart part) {
    static const char* const names[colonParts] = {
        "rectum",           "sigmoid",         "descending colon", "splenic flexure",
        "transverse colon", "hepatic flexure", "ascending colon",  "cecum"};
    return names[std::size_t(part)];
}

const char* toString(JunctionKind kind) {
    static const char* const names[] = {"open lumen", "thin wall", "collapse"};
    return names[std::size_t(kind)];
}

const char* toString(ColonSegment segment) {
    static const char* const names[colonSegments] = {"rectum",     "sigmoid",   "descending",
                                                     "transverse", "ascending", "cecum"};
    return names[std::size_t(segment)];
}

ColonSegment segmentOf(ColonPart part) {
    using enum ColonSegment;
    static constexpr std::array<ColonSegment, colonParts> segments{
        rectum, sigmoid, descending, descending, transverse, ascending, ascending, cecum};
    return segments[std::size_t(part)];
}

double ColonRecord::lengthMm() const {
    double sum = 0.0;
    for (const ColonPiece& piece : pieces)
        sum += piece.lengthMm;
    for (const ColonJunction& junction : junctions)
        sum += junction.lengthMm;
    return sum;
}

std::vector<std::string> piecesPassedBy(const Centerline& path,
                                        const std::vector<ColonPiece>& pieces) {
    std::vector<std::string> lines;
    double missedMm = 0.0;
    for (std::size_t n = 0; n <= pieces.size(); ++n) {
        bool missed = false;
        if (n < pieces.size()) {
            // The path keeps to the middle of what it passes.
            double nearest = 1e30;
            for (const CenterlinePoint& p : path.points)
                nearest = std::min(nearest, glm::distance(p.positionMm, pieces[n].centerMm));
            missed = nearest > pieces[n].radiusMm + 5.0;
        }
        if (missed) {
            missedMm += pieces[n].lengthMm;
        } else if (missedMm > 0.0) {
            const ColonPiece& last = pieces[n - 1];
            lines.push_back(
                printed("about %.0f mm of the colon have no centerline, up to the %s at %s",
                        missedMm, toString(last.part), placeText(last.centerMm).c_str()));
            missedMm = 0.0;
        }
    }
    return lines;
}

std::array<SegmentDistension, colonSegments> distensionOf(const ColonRecord& record) {
    std::array<SegmentDistension, colonSegments> all{};
    for (const ColonPiece& piece : record.pieces) {
        SegmentDistension& segment = all[std::size_t(segmentOf(piece.part))];
        segment.lengthMm += piece.lengthMm;
        segment.diameterMm += 2.0 * piece.radiusMm * piece.lengthMm;
        segment.gasMl += piece.gasMl, segment.taggedMl += piece.taggedMl,
            segment.untaggedMl += piece.untaggedMl;
    }
    for (std::size_t n = 0; n < record.junctions.size(); ++n) {
        if (record.junctions[n].kind == JunctionKind::collapse) {
            all[std::size_t(segmentOf(record.pieces[n].part))].collapsedMm +=
                record.junctions[n].lengthMm;
        }
    }
    for (SegmentDistension& segment : all) {
        if (segment.lengthMm > 0.0) segment.diameterMm /= segment.lengthMm;
    }
    return all;
}

namespace {

Json jsonOf(const ColonPiece& piece) {
    return {{"part", toString(piece.part)},
            {"center_mm", place(piece.centerMm)},
            {"radius_mm", rounded(piece.radiusMm)},
            {"length_mm", rounded(piece.lengthMm)},
            {"gas_ml", rounded(piece.gasMl)},
            {"tagged_ml", rounded(piece.taggedMl)},
            {"untagged_ml", rounded(piece.untaggedMl)}};
}

Json jsonOf(const ColonJunction& junction) {
    return {{"kind", toString(junction.kind)},
            {"place_mm", place(junction.placeMm)},
            {"length_mm", rounded(junction.lengthMm)},
            {"radius_mm", rounded(junction.radiusMm)},
            {"confidence", rounded(junction.confidence)}};
}

Json jsonOf(const RunnerUp& up) {
    return {{"probability", rounded(up.probability)},
            {"adds_ml", rounded(up.addsMl)},
            {"drops_ml", rounded(up.dropsMl)},
            {"place_mm", place(up.placeMm)}};
}

const char* nameOf(BodyContent content) {
    constexpr const char* names[] = {"gas", "tagged", "untagged"};
    return names[int(content)];
}

Json jsonOf(const LeftOutBody& body) {
    return {{"center_mm", place(body.centerMm)},
            {"volume_ml", rounded(body.volumeMl)},
            {"content", nameOf(body.content)},
            {"nearest", toString(body.nearest)},
            {"distance_mm", rounded(body.distanceMm)},
            {"opens", body.opens},
            {"like_colon", body.likeColon}};
}

Json jsonOf(const RebuiltWallRecord& wall) {
    return {{"place_mm", place(wall.placeMm)},
            {"area_mm2", rounded(wall.areaMm2)},
            {"between", wall.betweenLoops ? "loops" : "other bowel"}};
}

Json jsonOf(const UntaggedPool& pool) {
    return {{"part", toString(pool.part)},
            {"place_mm", place(pool.placeMm)},
            {"area_mm2", rounded(pool.areaMm2)},
            {"fluid_hu", rounded(pool.fluidHu)}};
}

Json jsonOf(const CutEnd& end) {
    return {{"part", toString(end.part)},
            {"place_mm", place(end.placeMm)},
            {"area_mm2", rounded(end.areaMm2)}};
}

Json jsonOf(const Doubt& doubt) {
    return {{"about", doubt.about}, {"probability", rounded(doubt.probability)}};
}

template <class T>
Json listOf(const std::vector<T>& values) {
    Json list = Json::array();
    for (const T& value : values)
        list.push_back(jsonOf(value));
    return list;
}

Json jsonOf(const std::array<SegmentDistension, colonSegments>& distension) {
    Json list = Json::array();
    for (int n = 0; n < colonSegments; ++n) {
        const SegmentDistension& segment = distension[std::size_t(n)];
        const double residueMl = segment.taggedMl + segment.untaggedMl,
                     ml = segment.gasMl + residueMl;
        list.push_back({{"segment", toString(ColonSegment(n))},
                        {"length_mm", rounded(segment.lengthMm)},
                        {"diameter_mm", rounded(segment.diameterMm)},
                        {"gas_ml", rounded(segment.gasMl)},
                        {"tagged_ml", rounded(segment.taggedMl)},
                        {"untagged_ml", rounded(segment.untaggedMl)},
                        {"residue", rounded(ml > 0.0 ? residueMl / ml : 0.0)},
                        {"collapsed_mm", rounded(segment.collapsedMm)}});
    }
    return list;
}

}  // namespace

std::string qualityJson(const ColonRecord& record) {
    std::array<double, 3> leftOutMl{};  // by BodyContent
    double farGasMl = 0.0;
    for (const LeftOutBody& body : record.leftOut)
        (body.isFarGas() ? farGasMl : leftOutMl[std::size_t(body.content)]) += body.volumeMl;
    const auto& end = record.endsAt;
    return Json{{"confidence", rounded(record.confidence)},
                {"chain_confidence", rounded(record.chainConfidence)},
                {"doubts", listOf(record.doubts)},
                {"length_mm", rounded(record.lengthMm())},
                {"warnings", record.warnings},
                {"segments", jsonOf(distensionOf(record))},
                {"pieces", listOf(record.pieces)},
                {"junctions", listOf(record.junctions)},
                {"runners_up", listOf(record.runnersUp)},
                {"left_out_gas_ml", rounded(leftOutMl[0])},
                {"left_out_far_gas_ml", rounded(farGasMl)},
                {"left_out_tagged_ml", rounded(leftOutMl[1])},
                {"left_out_untagged_ml", rounded(leftOutMl[2])},
                {"left_out", listOf(record.leftOut)},
                {"ends_at", end ? place(*end) : Json()},
                {"rebuilt_walls", listOf(record.walls)},
                {"untagged_fluid", listOf(record.untaggedPools)},
                {"cut_ends", listOf(record.cutEnds)},
                {"mask_in_soft_tissue", rounded(record.maskInSoftTissue)},
                {"noise_sd_hu", rounded(record.noiseSdHu)},
                {"tagging_hu", record.taggingHu ? Json(rounded(*record.taggingHu)) : Json()}}
               .dump(2) +
           "\n";
}

Result<ColonTrust> trustOfQuality(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        ColonTrust trust{json.at("confidence"), json.at("length_mm"), json.at("warnings"), {}};
        for (std::size_t n = 0; n < colonSegments; ++n) {
            const Json& read = json.at("segments").at(n);
            trust.segments[n] = {
                read.at("length_mm"), read.at("diameter_mm"),         read.at("gas_ml"),
                read.at("tagged_ml"), read.value("untagged_ml", 0.0), read.at("collapsed_mm")};
        }
        return trust;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this tells no quality: " + reasonOf(error), "quality");
    }
}

Result<std::vector<ColonPiece>> piecesOfQuality(const std::string& text) {
    try {
        std::vector<ColonPiece> pieces;
        const Json json = Json::parse(text);
        for (const Json& piece : json.at("pieces")) {
            ColonPiece read;
            const std::string part = piece.at("part");
            while (part != toString(read.part)) {
                if (read.part == ColonPart::cecum) throw std::invalid_argument("no part: " + part);
                read.part = ColonPart(int(read.part) + 1);
            }
            const Json& center = piece.at("center_mm");
            read.centerMm = {center.at(0).get<double>(), center.at(1).get<double>(),
                             center.at(2).get<double>()};
            read.radiusMm = piece.at("radius_mm"), read.lengthMm = piece.at("length_mm");
            pieces.push_back(read);
        }
        return pieces;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this tells no quality: " + reasonOf(error), "quality");
    }
}

Result<std::vector<RebuiltWallRecord>> rebuiltWallsOfQuality(const std::string& text) {
    try {
        std::vector<RebuiltWallRecord> walls;
        const Json json = Json::parse(text);
        for (const Json& wall : json.at("rebuilt_walls")) {
            const Json& at = wall.at("place_mm");
            walls.push_back(
                {{at.at(0).get<double>(), at.at(1).get<double>(), at.at(2).get<double>()},
                 wall.at("area_mm2").get<double>(),
                 wall.at("between") == "loops"});
        }
        return walls;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this tells no quality: " + reasonOf(error), "quality");
    }
}

}  // namespace haustra
