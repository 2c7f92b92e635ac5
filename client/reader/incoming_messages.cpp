#include "reader/incoming_messages.h"

#include "core/flat_map.h"
#include "protocol/limits.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace haustra::reader {
namespace {

constexpr double maxBinHu = 1e6;
constexpr std::size_t maxBins = 65536;

Result<Centerline> centerlineFrom(const protocol::CaseOpened& message) {
    const auto refuse = [](const char* what) {
        return fail(ErrorKind::badInput, what, "case opened: centerline");
    };
    constexpr int perSample = 5;  // x, y, z, arc, radius
    if (message.centerline_size() % perSample != 0)
        return refuse("its numbers do not come in fives");
    Centerline centerline;
    centerline.points.resize(std::size_t(message.centerline_size() / perSample));
    double arcBefore = 0.0;
    for (std::size_t n = 0; n < centerline.points.size(); ++n) {
        const double* sample = message.centerline().data() + n * perSample;
        CenterlinePoint& point = centerline.points[n];
        point.positionMm = {sample[0], sample[1], sample[2]};
        point.arcMm = sample[3];
        point.radiusMm = sample[4];
        for (int k = 0; k < perSample; ++k)
            if (!std::isfinite(sample[k])) return refuse("a number is not finite");
        if (point.arcMm < arcBefore) return refuse("its arc does not grow");
        arcBefore = point.arcMm;
    }
    for (const std::uint32_t n : message.gap_samples()) {
        if (n >= centerline.points.size()) return refuse("a gap lies past its end");
        centerline.points[n].gap = true;
    }
    return centerline;
}

Result<FlatStrip> stripFrom(const protocol::FlatStrip& message) {
    const auto refuse = [](const char* what) {
        return fail(ErrorKind::badInput, what, "case opened: flat");
    };
    FlatStrip strip;
    strip.height = message.height();
    strip.circumferenceMm = message.circumference_mm();
    if (!(strip.height > 0.0 && strip.height <= maxFlatHeight))
        return refuse("the strip's height is none");
    if (!(strip.circumferenceMm > 0.0) || !std::isfinite(strip.circumferenceMm))
        return refuse("its circumference is none");
    if (message.rows_size() < 2 || message.rows_size() % 2 != 0)
        return refuse("its rows do not come in pairs");
    FlatStrip::Row before;
    for (int n = 0; n < message.rows_size(); n += 2) {
        const FlatStrip::Row row{message.rows(n), message.rows(n + 1)};
        // Written so that what is not a number fails, too.
        if (!(row.arcMm >= before.arcMm && row.arcMm < INFINITY && row.y >= before.y &&
              row.y <= strip.height))
            return refuse("its rows are not in order within the strip");
        strip.rows.push_back(row);
        before = row;
    }
    return strip;
}

Result<ColonTrust> trustFrom(const protocol::ColonTrust& message) {
    const auto refuse = [](const char* what) {
        return fail(ErrorKind::badInput, what, "case opened: trust");
    };
    ColonTrust trust;
    trust.confidence = message.confidence(), trust.lengthMm = message.length_mm();
    if (!(trust.confidence >= 0.0 && trust.confidence <= 1.0 && trust.lengthMm >= 0.0 &&
          trust.lengthMm < INFINITY))
        return refuse("its confidence or length is none");
    if (message.warnings_size() > protocol::maxWarnings) return refuse("too many warnings");
    for (const std::string& warning : message.warnings()) {
        if (warning.size() > protocol::maxWarningBytes) return refuse("a warning is too long");
        trust.warnings.push_back(warning);
    }
    if (message.segments_size() != colonSegments) return refuse("not six segments");
    for (int n = 0; n < colonSegments; ++n) {
        const protocol::ColonSegment& segment = message.segments(n);
        trust.segments[std::size_t(n)] = {segment.length_mm(), segment.diameter_mm(),
                                          segment.gas_ml(), segment.tagged_ml(),
                                          segment.collapsed_mm()};
        for (const double number : {segment.length_mm(), segment.diameter_mm(), segment.gas_ml(),
                                    segment.tagged_ml(), segment.collapsed_mm()}) {
            if (!(number >= 0.0 && number < INFINITY)) return refuse("a segment's figure is none");
        }
    }
    return trust;
}

}  // namespace

Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message) {
    CaseInfo info;
    info.name = message.name();
    info.scan = message.scan();
    for (const std::uint32_t extent : {message.size_x(), message.size_y(), message.size_z()})
        if (extent > 4096)
            return fail(ErrorKind::badInput, "the volume is too large", "case opened: size");
    info.grid.size = {int(message.size_x()), int(message.size_y()), int(message.size_z())};
    if (message.patient_from_voxel_size() != 12)
        return fail(ErrorKind::badInput, "not 12 numbers", "case opened: patient_from_voxel");
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            info.grid.patientFromVoxel[column][row] = message.patient_from_voxel(4 * row + column);
    TRY(checkGrid(info.grid, "case opened"));
    auto centerline = TRY(centerlineFrom(message));
    info.centerline = std::move(centerline);
    info.position = patientPositionFromString(message.patient_position());
    for (const protocol::OpticsPreset& preset : message.presets()) {
        auto sound = protocol::presetFrom(preset);
        if (!sound)
            return fail(ErrorKind::badInput, describe(sound.error()), "case opened: presets");
        info.presets.push_back(std::move(*sound));
    }
    if (info.presets.empty())
        return fail(ErrorKind::badInput, "there is none", "case opened: presets");
    info.histogram = {message.histogram().first_hu(),
                      message.histogram().hu_per_bin(),
                      {message.histogram().voxels().begin(), message.histogram().voxels().end()}};
    if (!info.histogram.voxels.empty() &&
        !(std::abs(info.histogram.firstHu) <= maxBinHu && info.histogram.huPerBin > 0.0 &&
          info.histogram.huPerBin <= maxBinHu && info.histogram.voxels.size() <= maxBins))
        return fail(ErrorKind::badInput, "its bins are none", "case opened: histogram");
    info.cleansed = message.cleansed();
    if (message.has_trust()) {
        auto trust = TRY(trustFrom(message.trust()));
        info.trust = std::move(trust);
    }
    if (message.has_flat()) {
        auto strip = TRY(stripFrom(message.flat()));
        info.flat = std::move(strip);
    }
    return info;
}

std::vector<CaseEntry> casesFrom(const protocol::CaseList& message) {
    std::map<std::string, const protocol::CaseEntry*> told;
    for (const protocol::CaseEntry& entry : message.entries())
        told[entry.name()] = &entry;
    std::vector<CaseEntry> cases;
    for (const std::string& name : message.names()) {
        CaseEntry& made = cases.emplace_back();
        made.name = name;
        const auto found = told.find(name);
        if (found == told.end()) continue;
        const protocol::CaseEntry& entry = *found->second;
        if (entry.state() == protocol::CaseEntry::READY) made.state = CaseEntry::State::ready;
        if (entry.state() == protocol::CaseEntry::INCOMPLETE)
            made.state = CaseEntry::State::incomplete;
        if (entry.state() == protocol::CaseEntry::DAMAGED) made.state = CaseEntry::State::damaged;
        made.reason = entry.reason();
        made.preparedUtc = entry.prepared_utc();
        const auto count = [](std::uint32_t n) { return int(std::min(n, 1'000'000'000u)); };
        made.size = {count(entry.size_x()), count(entry.size_y()), count(entry.size_z())};
        const glm::dvec3 spacing = protocol::vectorFrom(entry.spacing_mm());
        if (isFinite(spacing)) made.spacingMm = spacing;
        made.cleansed = entry.cleansed();
        made.flattened = entry.flattened();
        if (entry.has_confidence() && entry.confidence() >= 0.0 && entry.confidence() <= 1.0)
            made.confidence = entry.confidence();
        made.warnings = count(entry.warnings());
        made.bookmarks = count(entry.bookmarks());
        made.readers = count(entry.readers());
    }
    return cases;
}

Result<WallPlace> placeFrom(const protocol::WallPlace& message) {
    WallPlace place;
    if (message.has_flat()) place.flat = {message.flat().x(), message.flat().y()};
    place.positionMm = protocol::vectorFrom(message.position_mm());
    place.triangle = message.triangle();
    place.arcMm = message.arc_mm();
    place.cameraMm = protocol::vectorFrom(message.camera_mm());
    const glm::dvec3 sum = place.positionMm + place.cameraMm;
    const bool inStrip = !place.flat || (place.flat->x >= 0.0 && place.flat->x < 1.0 &&
                                         place.flat->y >= 0.0 && place.flat->y <= maxFlatHeight);
    if (!inStrip || !std::isfinite(sum.x + sum.y + sum.z + place.arcMm))
        return fail(ErrorKind::badInput, "the server sent a place that is nowhere", "wall");
    return place;
}

Bookmark bookmarkFrom(const protocol::Bookmark& message) {
    Bookmark bookmark;
    bookmark.id = message.id();
    bookmark.camera.positionMm = protocol::vectorFrom(message.position_mm());
    bookmark.camera.forward = protocol::vectorFrom(message.forward());
    bookmark.camera.up = protocol::vectorFrom(message.up());
    bookmark.arcMm = message.arc_mm();
    bookmark.note = message.note();
    bookmark.createdUtc = message.created_utc();
    bookmark.clientKey = message.client_key();
    // One that is nowhere is none.
    if (message.has_mark())
        if (const auto mark = placeFrom(message.mark())) bookmark.mark = *mark;
    return bookmark;
}

Result<FlatMeasure> measureFrom(const protocol::FlatMeasure& message) {
    const FlatMeasure measure{message.length_mm(), message.straight_mm(), message.area_mm2(),
                              message.largest_diameter_mm()};
    if (!std::isfinite(measure.lengthMm + measure.straightMm + measure.areaMm2 +
                       measure.largestDiameterMm))
        return fail(ErrorKind::badInput, "the server sent a measurement that is no number", "wall");
    return measure;
}

Result<ScanStatistics> statisticsFrom(const protocol::ScanStatistics& message) {
    const ScanStatistics values{std::size_t(message.samples()), message.mean_hu(),
                                message.deviation_hu(),         message.least_hu(),
                                message.greatest_hu(),          message.area_mm2()};
    if (!std::isfinite(values.meanHu + values.deviationHu + values.leastHu + values.greatestHu +
                       values.areaMm2))
        return fail(ErrorKind::badInput, "the server sent a value that is no number", "scan");
    return values;
}

}  // namespace haustra::reader
