#include "reader/seen_lists_json.h"

#include <nlohmann/json.hpp>

namespace haustra::reader {
namespace {

using nlohmann::ordered_json;

ordered_json listOf(glm::dvec3 v) {
    return ordered_json::array({v.x, v.y, v.z});
}

ordered_json viewOf(const Camera& camera) {
    return {{"position_mm", listOf(camera.positionMm)},
            {"forward", listOf(camera.forward)},
            {"up", listOf(camera.up)},
            {"fov_deg", camera.fovDegrees}};
}

ordered_json jsonOf(const MissedList& missed) {
    ordered_json out = {{"seen_share", missed.share},
                        {"least_mm2", missed.leastMm2},
                        {"count", missed.count},
                        {"area_mm2", missed.areaMm2},
                        {"missed", ordered_json::array()}};
    for (const MissedPlace& patch : missed.patches) {
        ordered_json one = {{"area_mm2", patch.areaMm2},
                            {"center_mm", listOf(patch.place.positionMm)},
                            {"arc_mm", patch.place.arcMm}};
        if (patch.place.flat)
            one["flat"] = ordered_json::array({patch.place.flat->x, patch.place.flat->y});
        if (patch.view) one["view"] = viewOf(*patch.view);
        out["missed"].push_back(std::move(one));
    }
    return out;
}

ordered_json jsonOf(const SeenReport& report, const std::string& caseName) {
    ordered_json out;
    if (!caseName.empty()) out["case"] = caseName;
    out["wall"] = report.wall;
    out["readers"] = ordered_json::array();
    for (const ReaderSeen& reader : report.readers) {
        ordered_json one = {
            {"reader", reader.reader},
            {"changed_utc", reader.changedUtc},
            {"limits",
             {{"pixels_per_mm", reader.limits.pixelsPerMm}, {"least_ms", reader.limits.leastMs}}}};
        one.update(jsonOf(reader.missed));
        out["readers"].push_back(std::move(one));
    }
    return out;
}

}  // namespace

std::string toJson(const MissedList& missed) {
    return jsonOf(missed).dump(2) + "\n";
}

std::string toJson(const SeenReport& report, const std::string& caseName) {
    return jsonOf(report, caseName).dump(2, ' ', false, ordered_json::error_handler_t::replace) +
           "\n";
}

}  // namespace haustra::reader
