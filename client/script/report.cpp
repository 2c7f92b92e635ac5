#include "script/report.h"

#include "reader/latency.h"
#include "reader/seen_lists_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

namespace haustra::reader {
namespace {

using nlohmann::ordered_json;

double rounded(double value) {
    return std::round(value * 1000.0) / 1000.0;
}

ordered_json jsonOf(const Summary& summary) {
    return {{"count", summary.count},
            {"mean", rounded(summary.mean)},
            {"p50", rounded(summary.p50)},
            {"p95", rounded(summary.p95)},
            {"max", rounded(summary.max)}};
}

ordered_json jsonOf(glm::dvec3 v) {
    return ordered_json::array({v.x, v.y, v.z});
}

ordered_json jsonOf(const WallPlace& place) {
    return {{"flat", place.flat ? ordered_json::array({place.flat->x, place.flat->y})
                                : ordered_json(nullptr)},
            {"position_mm", jsonOf(place.positionMm)},
            {"triangle", place.triangle},
            {"arc_mm", place.arcMm},
            {"camera_mm", jsonOf(place.cameraMm)}};
}

ordered_json jsonOf(const FlatMeasure& measure) {
    return {{"length_mm", measure.lengthMm},
            {"straight_mm", measure.straightMm},
            {"area_mm2", measure.areaMm2},
            {"largest_diameter_mm", measure.largestDiameterMm}};
}

const char* nameOf(FindingList::State state) {
    switch (state) {
        case FindingList::State::damaged:
            return "damaged";
        case FindingList::State::off:
            return "off";
        case FindingList::State::firstPass:
            return "first-pass";
        case FindingList::State::shown:
            return "shown";
        default:
            return "none";
    }
}

ordered_json jsonOf(const FindingList& list) {
    ordered_json out = {{"state", nameOf(list.state)}, {"operating_point", list.operatingPoint},
                        {"model", list.model},         {"trained_on", list.trainedOn},
                        {"warnings", list.warnings},   {"findings", ordered_json::array()}};
    for (const ListedFinding& one : list.findings) {
        const Finding& finding = one.finding;
        std::int64_t voxels = 0;
        for (const VoxelRun& run : finding.voxels)
            voxels += run.count;
        out["findings"].push_back(
            {{"number", one.number},
             {"candidate", one.candidate},
             {"probability", finding.score},
             {"kind", finding.kind},
             {"arc_mm", finding.arcMm},
             {"segment",
              finding.segment ? ordered_json(toString(*finding.segment)) : ordered_json(nullptr)},
             {"position_mm", jsonOf(finding.positionMm)},
             {"diameter_mm", finding.diameterMm},
             {"diameter_ends_mm",
              {jsonOf(finding.diameterEndsMm.first), jsonOf(finding.diameterEndsMm.second)}},
             {"height_mm", finding.heightMm},
             {"wall", jsonOf(one.wall)},
             {"voxels", voxels}});
    }
    return out;
}

ordered_json jsonOf(const SeenLimits& limits) {
    return {{"pixels_per_mm", limits.pixelsPerMm}, {"least_ms", limits.leastMs}};
}

ordered_json jsonOf(const SeenNow& seen) {
    return {{"share", seen.share}, {"recorded", seen.recorded}, {"limits", jsonOf(seen.limits)}};
}

ordered_json jsonOf(const Camera& camera) {
    static constexpr const char* lenses[] = {"perspective", "fisheye", "orthographic"};
    return {{"position_mm", jsonOf(camera.positionMm)},
            {"forward", jsonOf(camera.forward)},
            {"up", jsonOf(camera.up)},
            {"lens", lenses[int(camera.lens)]},
            {"fov_deg", camera.fovDegrees},
            {"height_mm", camera.heightMm}};
}

// As runs: the first of some that follow each other, and how many.
ordered_json runsOf(const std::vector<std::uint8_t>& flags) {
    auto runs = ordered_json::array();
    for (std::size_t n = 0; n < flags.size();) {
        const std::size_t first = n;
        while (n < flags.size() && flags[n])
            ++n;
        if (n > first)
            runs.push_back({first, n - first});
        else
            ++n;
    }
    return runs;
}

ordered_json jsonOf(const LoggedPicture& picture) {
    ordered_json out = {{"viewport", picture.viewport},
                        {"picture", picture.number},
                        {"size", ordered_json::array({picture.size.x, picture.size.y})},
                        {"ms", picture.ms},
                        {"optics", picture.optics},
                        {"view", toString(viewOf(picture.shown))}};
    if (const auto* camera = std::get_if<Camera>(&picture.shown)) out["camera"] = jsonOf(*camera);
    if (const auto* window = std::get_if<FlatWindow>(&picture.shown)) {
        out["center"] = ordered_json::array({window->center.x, window->center.y});
        out["pixels_per_circumference"] =
            window->pixelsPerUnit * picture.size.x / picture.viewportWidth;
    }
    return out;
}

ordered_json jsonOf(const ActionReport& action) {
    ordered_json out = {
        {"line", action.line}, {"do", action.name}, {"seconds", rounded(action.seconds)}};
    if (!action.file.empty()) out["file"] = action.file;
    if (action.positions > 0) {
        out["positions"] = action.positions;
        out["pipelined"] = action.pipelined;
    }
    if (!action.latencyMs.empty()) out["latency_ms"] = jsonOf(summarize(action.latencyMs));
    if (!action.decodeMs.empty()) {
        const std::size_t pictures = action.decodeMs.size();
        out["pictures"] = pictures;
        if (action.seconds > 0.0) out["fps"] = rounded(double(pictures) / action.seconds);
        out["bytes"] = action.bytes;
        out["bytes_per_picture"] = action.bytes / pictures;
        out["decode_ms"] = jsonOf(summarize(action.decodeMs));
        out["server_median_us"] = {{"queue", summarize(action.queueMicroseconds).p50},
                                   {"render", summarize(action.renderMicroseconds).p50},
                                   {"encode", summarize(action.encodeMicroseconds).p50}};
        if (!action.raycaster.empty()) out["raycaster"] = action.raycaster;
        out["coarse_pictures"] = action.coarse;
        out["latencies_ms"] = ordered_json::array();
        for (const double ms : action.latencyMs)
            out["latencies_ms"].push_back(rounded(ms));
    }
    if (!action.acknowledged.empty()) {
        out["acknowledged"] = ordered_json::array();
        for (const Acknowledgement& a : action.acknowledged)
            out["acknowledged"].push_back({{"id", a.id}, {"client_key", a.clientKey}});
    }
    if (action.bookmarks) out["bookmarks"] = *action.bookmarks;
    if (action.following) out["following"] = *action.following;
    if (action.place) out["place"] = jsonOf(*action.place);
    if (action.measure) out["measure"] = jsonOf(*action.measure);
    if (action.seenShare) out["seen_share"] = *action.seenShare;
    if (action.missed) out["missed"] = ordered_json::parse(toJson(*action.missed));
    if (action.seenReport) out["seen_report"] = ordered_json::parse(toJson(*action.seenReport, ""));
    if (action.findings) out["findings"] = jsonOf(*action.findings);
    return out;
}

}  // namespace

std::string toJson(const WallPlace& place) {
    return jsonOf(place).dump(2) + "\n";
}

std::string toJson(const FlatMeasure& measure) {
    return jsonOf(measure).dump(2) + "\n";
}

// What a server tells as text may be no UTF-8 once it is cut.
std::string toJson(const FindingList& findings) {
    return jsonOf(findings).dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

std::string seenShareJson(double share, const std::optional<SeenNow>& now) {
    ordered_json out = {{"seen_share", share}};
    if (now) {
        out["recorded"] = now->recorded;
        out["limits"] = jsonOf(now->limits);
    }
    return out.dump(2) + "\n";
}

std::string toJson(const LedgerFlags& ledger, const std::vector<LoggedPicture>& log) {
    ordered_json out = {{"wall", ledger.wall},
                        {"limits", jsonOf(ledger.limits)},
                        {"seen_share", ledger.share},
                        {"recorded", ledger.recorded},
                        {"triangles", ledger.seen.size()},
                        {"shown", runsOf(ledger.shown)},
                        {"seen", runsOf(ledger.seen)},
                        {"pictures", ordered_json::array()}};
    for (const LoggedPicture& picture : log)
        if (picture.ms > 0) out["pictures"].push_back(jsonOf(picture));
    return out.dump() + "\n";
}

std::string toJson(const PlayReport& report) {
    ordered_json out = {{"client", report.clientSoftware},
                        {"server", report.serverSoftware},
                        {"renderer", report.renderer},
                        {"fingerprint", report.fingerprint},
                        {"case", report.caseName},
                        {"centerline_mm", rounded(report.centerlineMm)},
                        {"round_trip_ms", rounded(report.roundTripMs)}};
    out["bridges"] = ordered_json::array();
    for (const Bridge& bridge : report.bridges)
        out["bridges"].push_back({{"from_arc_mm", rounded(bridge.fromArcMm)},
                                  {"to_arc_mm", rounded(bridge.toArcMm)},
                                  {"length_mm", rounded(bridge.lengthMm())}});
    if (report.trust) {
        auto segments = ordered_json::object();
        for (int n = 0; n < colonSegments; ++n) {
            const SegmentDistension& segment = report.trust->segments[std::size_t(n)];
            segments[toString(ColonSegment(n))] = {{"length_mm", rounded(segment.lengthMm)},
                                                   {"diameter_mm", rounded(segment.diameterMm)},
                                                   {"collapsed_mm", rounded(segment.collapsedMm)}};
        }
        out["trust"] = {{"confidence", rounded(report.trust->confidence)},
                        {"length_mm", rounded(report.trust->lengthMm)},
                        {"warnings", report.trust->warnings},
                        {"segments", segments}};
    }
    if (report.seen) out["seen"] = jsonOf(*report.seen);
    out["error"] = report.failure ? ordered_json(describe(*report.failure)) : ordered_json();
    out["actions"] = ordered_json::array();
    for (const ActionReport& action : report.actions)
        out["actions"].push_back(jsonOf(action));
    return out.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace haustra::reader
