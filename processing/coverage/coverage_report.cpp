#include "coverage/coverage_report.h"

#include "core/parallel.h"
#include "core/printed_text.h"
#include "core/version.h"
#include "coverage/fine_wall.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace haustra::coverage {
namespace {

using Json = nlohmann::ordered_json;

constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::size_t trianglesPerDigit = 3;
constexpr std::uint8_t bridgeFlag = 3;

double rounded(double value) {
    return std::round(1000.0 * value) / 1000.0;
}

void add(Share& share, double areaMm2, Visibility seen) {
    share.areaMm2 += areaMm2, ++share.triangles;
    if (seen != Visibility::unseen) share.seenMm2 += areaMm2, ++share.seen;
    if (seen == Visibility::fully) share.fullyMm2 += areaMm2, ++share.fully;
}

Json jsonOf(const Share& share) {
    return {{"area_percent", rounded(share.areaPercent())},
            {"triangle_percent", rounded(share.trianglePercent())}};
}

Json objectOf(const CoverageReport& report) {
    Json json{{"software", std::string("Haustra ") + softwareVersion}, {"mode", report.mode}};
    if (!report.direction.empty()) json["direction"] = report.direction;
    json["cameras"] = report.cameras;
    json["pictures"] = report.pictures;
    json["lens"] = report.lens;
    json["visibility"] = report.visibility;
    json["depth_of_field_mm"] = {report.nearestMm, report.farthestMm};
    json["path"] = {{"length_mm", rounded(report.pathMm)}};
    if (report.clearanceMm > 0.0) {
        json["path"]["clearance_mm"] = report.clearanceMm;
        json["path"]["narrow_mm"] = rounded(report.narrowMm);
    }
    json.update(jsonOf(report.share));
    if (report.tellsFully) {
        json["fully_area_percent"] =
            rounded(100.0 * report.share.fullyMm2 / std::max(1e-9, report.share.areaMm2));
        json["fully_triangle_percent"] = rounded(100.0 * double(report.share.fully) /
                                                 double(std::max(1L, report.share.triangles)));
    }
    json["wall"] = {{"area_mm2", rounded(report.share.areaMm2)},
                    {"triangles", report.share.triangles},
                    {"bridged_mm2", rounded(report.bridgedMm2)}};
    if (report.segments) {
        for (int n = 0; n < colonSegments; ++n) {
            const Share& share = (*report.segments)[std::size_t(n)];
            if (share.triangles == 0) continue;
            Json segment{{"segment", toString(ColonSegment(n))},
                         {"area_mm2", rounded(share.areaMm2)}};
            segment.update(jsonOf(share));
            json["segments"].push_back(segment);
        }
    }
    json["missed"] = Json::array();
    long smaller = 0;
    double smallerMm2 = 0.0;
    for (const MissedPatch& patch : report.missed) {
        if (patch.areaMm2 < leastListedMm2) {
            ++smaller, smallerMm2 += patch.areaMm2;
            continue;
        }
        Json one{
            {"area_mm2", rounded(patch.areaMm2)},
            {"center_mm",
             {rounded(patch.centerMm.x), rounded(patch.centerMm.y), rounded(patch.centerMm.z)}},
            {"arc_mm", rounded(patch.arcMm)}};
        if (!report.segmentOfTriangle.empty())
            one["segment"] = toString(report.segmentOfTriangle[std::size_t(patch.centerTriangle)]);
        json["missed"].push_back(one);
    }
    json["missed_smaller"] = {{"patches", smaller}, {"area_mm2", rounded(smallerMm2)}};
    if (report.review) {
        json["review"] = {{"least_mm2", leastReviewedMm2},
                          {"patches", report.review->patches},
                          {"rounds", report.review->rounds}};
        json["review"].update(jsonOf(report.reviewed));
    }
    if (report.flattenedPercent)
        json["flattened"] = {{"area_percent", rounded(*report.flattenedPercent)}};
    if (report.centerlineShare) json["centerline"] = jsonOf(*report.centerlineShare);
    return json;
}

}  // namespace

Share shareOf(const CoverageWall& wall, const std::vector<Visibility>& seen) {
    Share share;
    for (std::size_t n = 0; n < seen.size(); ++n)
        if (!wall.bridged[n]) add(share, wall.areaMm2(n), seen[n]);
    return share;
}

std::vector<double> arcsOf(const CoverageWall& wall,
                           const std::vector<std::int32_t>& sourceTriangle, const FlatMap* map,
                           int threads) {
    constexpr double unknown = -1.0;
    std::vector<double> ofSource;
    for (std::size_t t = 0; map && t < map->sourceTriangle.size(); ++t) {
        const auto source = std::size_t(map->sourceTriangle[t]);
        if (source >= ofSource.size()) ofSource.resize(source + 1, unknown);
        const glm::ivec3 corners = map->surface.triangles[t];
        const auto arcAt = [&](int corner) {
            return map->cameras[std::size_t(map->camera[std::size_t(corner)])].arcMm;
        };
        ofSource[source] = (arcAt(corners.x) + arcAt(corners.y) + arcAt(corners.z)) / 3.0;
    }
    std::vector<double> arcsMm(wall.mesh.triangles.size());
    parallelFor(arcsMm.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n) {
            const auto source = std::size_t(sourceTriangle[n]);
            if (source < ofSource.size() && ofSource[source] != unknown) {
                arcsMm[n] = ofSource[source];
                continue;
            }
            const glm::ivec3 t = wall.mesh.triangles[n];
            arcsMm[n] = nearestArc(wall.centerline, (wall.mesh.vertices[std::size_t(t.x)] +
                                                     wall.mesh.vertices[std::size_t(t.y)] +
                                                     wall.mesh.vertices[std::size_t(t.z)]) /
                                                        3.0);
        }
    });
    return arcsMm;
}

std::vector<ColonSegment> segmentsOf(const std::vector<double>& arcsMm,
                                     const std::vector<SegmentStart>& starts) {
    std::vector<ColonSegment> segments;
    for (const double arcMm : arcsMm)
        if (const auto segment = segmentAt(starts, arcMm)) segments.push_back(*segment);
    return segments;
}

std::array<Share, colonSegments> sharesBySegment(const CoverageWall& wall,
                                                 const std::vector<Visibility>& seen,
                                                 const std::vector<ColonSegment>& segments) {
    std::array<Share, colonSegments> shares;
    for (std::size_t n = 0; n < seen.size(); ++n)
        if (!wall.bridged[n]) add(shares[std::size_t(segments[n])], wall.areaMm2(n), seen[n]);
    return shares;
}

std::string coverageJson(const CoverageReport& report) {
    return objectOf(report).dump(2) + "\n";
}

std::string coverageJson(const CoverageReport& report, const CoverageWall& wall,
                         const std::vector<Visibility>& seen) {
    Json json = objectOf(report);
    std::string flags;
    for (std::size_t n = 0; n < seen.size(); n += trianglesPerDigit) {
        unsigned digit = 0;
        for (std::size_t k = 0; k < trianglesPerDigit && n + k < seen.size(); ++k)
            digit |= (wall.bridged[n + k] ? bridgeFlag : unsigned(seen[n + k])) << (2 * k);
        flags += digits[digit];
    }
    json["wall_triangles"] = {
        {"most_edge_mm", mostEdgeMm}, {"count", seen.size()}, {"visibility", flags}};
    return json.dump(2) + "\n";
}

Result<std::vector<std::uint8_t>> triangleFlagsOf(const std::string& text, std::size_t triangles) {
    const auto wrong = [](const std::string& what) {
        return fail(ErrorKind::badInput, "this tells no coverage: " + what, "coverage");
    };
    try {
        const Json json = Json::parse(text);
        const Json& wall = json.at("wall_triangles");
        const std::string flags = wall.at("visibility");
        if (wall.at("count").get<std::size_t>() != triangles ||
            flags.size() != (triangles + trianglesPerDigit - 1) / trianglesPerDigit)
            return wrong("it is of another surface");
        std::vector<std::uint8_t> each(triangles);
        for (std::size_t n = 0; n < triangles; ++n) {
            const char* digit = std::find(digits, digits + 64, flags[n / trianglesPerDigit]);
            if (digit == digits + 64) return wrong("a character that is none of base64's");
            each[n] = std::uint8_t((digit - digits) >> (2 * (n % trianglesPerDigit)) & 3);
        }
        return each;
    } catch (const std::exception& error) {
        return wrong(reasonOf(error));
    }
}

}  // namespace haustra::coverage
