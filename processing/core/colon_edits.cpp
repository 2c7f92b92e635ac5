#include "core/colon_edits.h"

#include "core/patient_point.h"
#include "core/printed_text.h"

#include <nlohmann/json.hpp>

namespace haustra {
namespace {

using Json = nlohmann::ordered_json;

Json point(glm::dvec3 p) {
    return {p.x, p.y, p.z};
}
Json points(const std::vector<glm::dvec3>& all) {
    Json array = Json::array();
    for (const glm::dvec3 p : all)
        array.push_back(point(p));
    return array;
}
glm::dvec3 pointFrom(const Json& json) {
    const glm::dvec3 p{json.at(0).get<double>(), json.at(1).get<double>(),
                       json.at(2).get<double>()};
    if (!isPatientPoint(p)) throw std::invalid_argument("a point is nowhere");
    return p;
}
CutBall ballFrom(const Json& json) {
    const CutBall ball{pointFrom(json.at("center_mm")), json.at("radius_mm").get<double>()};
    if (!isCutRadius(ball.radiusMm)) throw std::invalid_argument("a ball's radius is none");
    return ball;
}

}  // namespace

std::string editsJson(const ColonEdits& edits) {
    Json cuts = Json::array(), joins = Json::array();
    for (const CutBall& cut : edits.cuts)
        cuts.push_back({{"center_mm", point(cut.centerMm)}, {"radius_mm", cut.radiusMm}});
    for (const auto& [a, b] : edits.joins)
        joins.push_back({point(a), point(b)});
    return Json{{"seeds_mm", points(edits.seedsMm)},
                {"excludes_mm", points(edits.excludesMm)},
                {"cuts", cuts},
                {"joins_mm", joins}}
               .dump(2) +
           "\n";
}

Result<ColonEdits> editsFromJson(const std::string& text) {
    try {
        const Json json = Json::parse(text);
        ColonEdits edits;
        for (const Json& p : json.at("seeds_mm"))
            edits.seedsMm.push_back(pointFrom(p));
        for (const Json& p : json.at("excludes_mm"))
            edits.excludesMm.push_back(pointFrom(p));
        for (const Json& cut : json.at("cuts"))
            edits.cuts.push_back(ballFrom(cut));
        for (const Json& join : json.at("joins_mm"))
            edits.joins.emplace_back(pointFrom(join.at(0)), pointFrom(join.at(1)));
        return edits;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "these are no edits: " + reasonOf(error), "edits");
    }
}

}  // namespace haustra
