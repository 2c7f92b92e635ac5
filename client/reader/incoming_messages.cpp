#include "reader/incoming_messages.h"

#include "core/case_name.h"
#include "core/flat_map.h"
#include "link/peer_text.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace haustra::reader {
namespace {

using link::peerText;
using protocol::maxCoordinateMm;

constexpr double maxBinHu = 1e6;
// Of the scan, along each axis.
constexpr double minSpacingMm = 1e-3, maxSpacingMm = 1e3;
constexpr int maxPresets = 64;
constexpr std::size_t maxScanBytes = 64, maxDescriptionBytes = 1000, maxTimeBytes = 40;

// Written so that what is not a number is outside, too.
bool isWithin(double value, double low, double high) {
    return value >= low && value <= high;
}
bool isArc(double mm) {
    return isWithin(mm, -maxCoordinateMm, maxCoordinateMm);
}
bool isVisibleAscii(const std::string& text, std::size_t mostBytes) {
    return text.size() <= mostBytes &&
           std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 127; });
}

// PROTOCOL.md bounds every place; a grid's are those of its corners.
Result<void> checkExtent(const Grid& grid) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 last(grid.size - 1);
        const glm::dvec3 voxel((corner & 1) ? last.x : 0.0, (corner & 2) ? last.y : 0.0,
                               (corner & 4) ? last.z : 0.0);
        if (!isPatientPoint(grid.patientFromVoxelPoint(voxel)))
            return fail(ErrorKind::badInput, "the volume lies nowhere",
                        "case opened: patient_from_voxel");
    }
    const glm::dvec3 spacing = grid.spacingMm();
    for (int axis = 0; axis < 3; ++axis)
        if (!isWithin(spacing[axis], minSpacingMm, maxSpacingMm))
            return fail(ErrorKind::badInput, "the voxels are of no scan's size",
                        "case opened: patient_from_voxel");
    return {};
}

Result<std::vector<OpticsPreset>> presetsFrom(const protocol::CaseOpened& message) {
    const auto refuse = [](const std::string& what) {
        return fail(ErrorKind::badInput, what, "case opened: presets");
    };
    if (message.presets().empty()) return refuse("there is none");
    if (message.presets_size() > maxPresets) return refuse("there are too many");
    std::vector<OpticsPreset> presets;
    std::set<std::string> names;
    for (const protocol::OpticsPreset& preset : message.presets()) {
        auto sound = protocol::presetFrom(preset);
        if (!sound) return refuse(describe(sound.error()));
        if (!names.insert(sound->name).second) return refuse("two have the same name");
        sound->description = peerText(sound->description, maxDescriptionBytes);
        presets.push_back(std::move(*sound));
    }
    return presets;
}
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
        if (!isPatientPoint(point.positionMm) || !isArc(point.arcMm) ||
            !isWithin(point.radiusMm, 0.0, maxCoordinateMm))
            return refuse("a sample lies nowhere");
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
    constexpr double leastHeight = 1e-3, leastMm = 1e-3;
    if (!isWithin(strip.height, leastHeight, maxFlatHeight))
        return refuse("the strip's height is none");
    if (!isWithin(strip.circumferenceMm, leastMm, maxCoordinateMm))
        return refuse("its circumference is none");
    if (message.rows_size() < 2 || message.rows_size() % 2 != 0)
        return refuse("its rows do not come in pairs");
    FlatStrip::Row before;
    for (int n = 0; n < message.rows_size(); n += 2) {
        const FlatStrip::Row row{message.rows(n), message.rows(n + 1)};
        if (!(isWithin(row.arcMm, before.arcMm, maxCoordinateMm) &&
              isWithin(row.y, before.y, strip.height)))
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
    if (!isWithin(trust.confidence, 0.0, 1.0) || !isWithin(trust.lengthMm, 0.0, maxCoordinateMm))
        return refuse("its confidence or length is none");
    if (message.warnings_size() > protocol::maxWarnings) return refuse("too many warnings");
    for (const std::string& warning : message.warnings()) {
        if (warning.size() > protocol::maxWarningBytes) return refuse("a warning is too long");
        trust.warnings.push_back(peerText(warning, protocol::maxWarningBytes));
    }
    if (message.segments_size() != colonSegments) return refuse("not six segments");
    constexpr double maxFigure = 1e6;
    for (int n = 0; n < colonSegments; ++n) {
        const protocol::ColonSegment& segment = message.segments(n);
        trust.segments[std::size_t(n)] = {
            .lengthMm = segment.length_mm(),
            .diameterMm = segment.diameter_mm(),
            .gasMl = segment.gas_ml(),
            .taggedMl = segment.tagged_ml(),  // that without tagging is part of it
            .collapsedMm = segment.collapsed_mm()};
        for (const double number : {segment.length_mm(), segment.diameter_mm(), segment.gas_ml(),
                                    segment.tagged_ml(), segment.collapsed_mm()}) {
            if (!isWithin(number, 0.0, maxFigure)) return refuse("a segment's figure is none");
        }
    }
    return trust;
}

}  // namespace

Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message) {
    CaseInfo info;
    info.name = message.name();
    info.scan = message.scan();
    if (!isCaseName(info.name))
        return fail(ErrorKind::badInput, "its name is none", "case opened: name");
    if (!isVisibleAscii(info.scan, maxScanBytes))
        return fail(ErrorKind::badInput, "its scan has no name", "case opened: scan");
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
    TRY(checkExtent(info.grid));
    auto centerline = TRY(centerlineFrom(message));
    info.centerline = std::move(centerline);
    info.position = patientPositionFromString(message.patient_position());
    auto presets = TRY(presetsFrom(message));
    info.presets = std::move(presets);
    info.histogram = {message.histogram().first_hu(),
                      message.histogram().hu_per_bin(),
                      {message.histogram().voxels().begin(), message.histogram().voxels().end()}};
    if (!info.histogram.voxels.empty() &&
        !(std::abs(info.histogram.firstHu) <= maxBinHu && info.histogram.huPerBin > 0.0 &&
          info.histogram.huPerBin <= maxBinHu && info.histogram.voxels.size() <= maxBins))
        return fail(ErrorKind::badInput, "its bins are none", "case opened: histogram");
    info.cleansed = message.cleansed();
    if (message.detection() == protocol::CaseOpened::THERE) info.detection = Detection::there;
    if (message.detection() == protocol::CaseOpened::DAMAGED) info.detection = Detection::damaged;
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

Result<std::vector<CaseEntry>> casesFrom(const protocol::CaseList& message) {
    std::map<std::string, const protocol::CaseEntry*> told;
    for (const protocol::CaseEntry& entry : message.entries())
        told[entry.name()] = &entry;
    std::vector<CaseEntry> cases;
    for (const std::string& name : message.names()) {
        if (cases.size() == protocol::maxListedCases) break;
        if (!isCaseName(name))
            return fail(ErrorKind::badInput, "the server names a case that cannot be", "case list");
        if (!cases.empty() && name <= cases.back().name)
            return fail(ErrorKind::badInput, "the server's cases are not sorted", "case list");
        CaseEntry& made = cases.emplace_back();
        made.name = name;
        const auto found = told.find(name);
        if (found == told.end()) continue;
        const protocol::CaseEntry& entry = *found->second;
        if (entry.state() == protocol::CaseEntry::READY) made.state = CaseEntry::State::ready;
        if (entry.state() == protocol::CaseEntry::INCOMPLETE)
            made.state = CaseEntry::State::incomplete;
        if (entry.state() == protocol::CaseEntry::DAMAGED) made.state = CaseEntry::State::damaged;
        made.reason = peerText(entry.reason());
        made.preparedUtc = peerText(entry.prepared_utc(), maxTimeBytes);
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
    const bool inStrip = !place.flat || (place.flat->x >= 0.0 && place.flat->x < 1.0 &&
                                         isWithin(place.flat->y, 0.0, maxFlatHeight));
    if (!inStrip || !isPatientPoint(place.positionMm) || !isPatientPoint(place.cameraMm) ||
        !isArc(place.arcMm))
        return fail(ErrorKind::badInput, "the server sent a place that is nowhere", "wall");
    return place;
}

Result<Bookmark> bookmarkFrom(const protocol::Bookmark& message) {
    const auto refuse = [](const char* what) {
        return fail(ErrorKind::badInput, what, "bookmark");
    };
    Bookmark bookmark;
    bookmark.id = message.id();
    bookmark.camera.positionMm = protocol::vectorFrom(message.position_mm());
    bookmark.arcMm = message.arc_mm();
    if (bookmark.id == 0) return refuse("the server sent one without a number");
    if (!isPatientPoint(bookmark.camera.positionMm) || !isArc(bookmark.arcMm))
        return refuse("the server sent one that lies nowhere");
    const glm::dvec3 forward = protocol::vectorFrom(message.forward()),
                     up = protocol::vectorFrom(message.up());
    const double length = glm::length(forward), high = glm::length(up);
    constexpr double least = 1e-100, most = 1e100, leastSine = 1e-6;
    if (!isWithin(length, least, most) || !isWithin(high, least, most))
        return refuse("the server sent one that looks nowhere");
    const glm::dvec3 right = glm::cross(forward / length, up / high);
    if (!(glm::length(right) > leastSine)) return refuse("the server sent one that looks nowhere");
    // One that the client has sent comes back as it was.
    constexpr double asGood = 1e-9;
    const bool unit = std::abs(length - 1.0) < asGood && std::abs(high - 1.0) < asGood &&
                      std::abs(glm::length(right) - 1.0) < asGood;
    bookmark.camera.forward = unit ? forward : forward / length;
    bookmark.camera.up = unit ? up : glm::cross(glm::normalize(right), bookmark.camera.forward);
    if (message.note().size() > protocol::maxNoteBytes)
        return refuse("the server sent one whose note is too long");
    if (!isVisibleAscii(message.client_key(), protocol::maxClientKeyBytes))
        return refuse("the server sent one whose key is none");
    bookmark.note = peerText(message.note(), protocol::maxNoteBytes, true);
    bookmark.createdUtc = peerText(message.created_utc(), maxTimeBytes);
    bookmark.clientKey = message.client_key();
    // A mark that is nowhere is none.
    if (message.has_mark())
        if (const auto mark = placeFrom(message.mark())) bookmark.mark = *mark;
    return bookmark;
}

Result<FlatMeasure> measureFrom(const protocol::FlatMeasure& message) {
    const FlatMeasure measure{message.length_mm(), message.straight_mm(), message.area_mm2(),
                              message.largest_diameter_mm()};
    constexpr double most = 1e9;
    for (const double figure :
         {measure.lengthMm, measure.straightMm, measure.areaMm2, measure.largestDiameterMm})
        if (!isWithin(figure, 0.0, most))
            return fail(ErrorKind::badInput, "the server sent a measurement that is none", "wall");
    return measure;
}

Result<ScanStatistics> statisticsFrom(const protocol::ScanStatistics& message) {
    const ScanStatistics values{std::size_t(message.samples()), message.mean_hu(),
                                message.deviation_hu(),         message.least_hu(),
                                message.greatest_hu(),          message.area_mm2()};
    constexpr double most = 1e9;
    for (const double figure :
         {values.meanHu, values.deviationHu, values.leastHu, values.greatestHu, values.areaMm2})
        if (!isWithin(figure, -most, most))
            return fail(ErrorKind::badInput, "the server sent a value that is none", "scan");
    return values;
}

namespace {

tl::unexpected<Error> refuseFinding(const char* what) {
    return fail(ErrorKind::badInput, what, "findings");
}

// With unit, orthogonal directions.
Result<Camera> viewFrom(const protocol::Camera& message) {
    auto view = TRY(protocol::cameraFrom(message));
    view.forward = glm::normalize(view.forward);
    view.up = glm::cross(glm::normalize(glm::cross(view.forward, view.up)), view.forward);
    return view;
}

Result<ListedFinding> findingFrom(const protocol::Finding& message, const Grid& grid) {
    ListedFinding listed;
    constexpr std::uint32_t greatestNumber = 1'000'000;
    if (message.number() == 0 || message.number() > greatestNumber)
        return refuseFinding("the server sent one without a number");
    listed.number = int(message.number());
    listed.candidate = message.below_operating_point();
    listed.wall = TRY(placeFrom(message.wall()));
    if (message.has_view()) listed.view = TRY(viewFrom(message.view()));
    Finding& finding = listed.finding;
    finding.positionMm = protocol::vectorFrom(message.position_mm());
    finding.wallMm = listed.wall.positionMm;
    finding.diameterEndsMm = {protocol::vectorFrom(message.diameter_from_mm()),
                              protocol::vectorFrom(message.diameter_to_mm())};
    finding.diameterMm = message.diameter_mm();
    finding.heightMm = message.height_mm();
    finding.arcMm = message.arc_mm();
    finding.score = message.probability();
    for (const glm::dvec3 place :
         {finding.positionMm, finding.diameterEndsMm.first, finding.diameterEndsMm.second})
        if (!isPatientPoint(place)) return refuseFinding("the server sent one that lies nowhere");
    if (!isArc(finding.arcMm) || !isWithin(finding.diameterMm, 0.0, maxCoordinateMm) ||
        !isWithin(finding.heightMm, -maxCoordinateMm, maxCoordinateMm) ||
        !isWithin(finding.score, 0.0, 1.0))
        return refuseFinding("the server sent one whose figures are none");
    if (message.segment() > protocol::Finding::UNKNOWN &&
        message.segment() <= protocol::Finding::CECUM)
        finding.segment = ColonSegment(int(message.segment()) - 1);
    if (message.kind().size() > protocol::maxFindingKindBytes)
        return refuseFinding("the server sent one whose kind is too long");
    finding.kind = peerText(message.kind(), protocol::maxFindingKindBytes);
    constexpr int perRun = 4;  // i, j, k, count
    if (message.voxels_size() % perRun != 0)
        return refuseFinding("its voxels do not come in fours");
    for (int n = 0; n < message.voxels_size(); n += perRun) {
        constexpr std::uint32_t most = 1U << 30;
        for (int number = 0; number < perRun; ++number)
            if (message.voxels(n + number) > most)
                return refuseFinding("its voxels lie outside the scan");
        const VoxelRun run{
            {int(message.voxels(n)), int(message.voxels(n + 1)), int(message.voxels(n + 2))},
            int(message.voxels(n + 3))};
        if (!grid.contains(run.first) || run.count < 1 || run.count > grid.size.x - run.first.x)
            return refuseFinding("its voxels lie outside the scan");
        finding.voxels.push_back(run);
    }
    return listed;
}

}  // namespace

Result<FindingList> findingsFrom(const protocol::FindingList& message, const Grid& grid) {
    FindingList list;
    if (message.state() < protocol::FindingList::NONE ||
        message.state() > protocol::FindingList::SHOWN)
        return refuseFinding("the server sent a list that is none");
    list.state = FindingList::State(int(message.state()));
    list.operatingPoint = message.operating_point();
    if (!isWithin(list.operatingPoint, 0.0, 1.0))
        return refuseFinding("the operating point is no probability");
    if (message.model().size() > protocol::maxModelNameBytes ||
        message.trained_on().size() > protocol::maxTrainedOnBytes)
        return refuseFinding("what made them is told at too great length");
    list.model = peerText(message.model(), protocol::maxModelNameBytes);
    list.trainedOn = peerText(message.trained_on(), protocol::maxTrainedOnBytes);
    if (message.warnings_size() > protocol::maxWarnings) return refuseFinding("too many warnings");
    for (const std::string& warning : message.warnings()) {
        if (warning.size() > protocol::maxWarningBytes)
            return refuseFinding("a warning is too long");
        list.warnings.push_back(peerText(warning, protocol::maxWarningBytes));
    }
    if (message.findings_size() > protocol::maxFindings)
        return refuseFinding("the server sent more than a case can have");
    if (list.state != FindingList::State::shown && !message.findings().empty())
        return refuseFinding("the server sent some that are to be hidden");
    std::set<int> numbers;
    std::size_t runs = 0;
    for (const protocol::Finding& one : message.findings()) {
        runs += std::size_t(one.voxels_size()) / 4;
        if (runs > protocol::maxListedRuns) return refuseFinding("they have too many voxels");
        auto sound = TRY(findingFrom(one, grid));
        if (!numbers.insert(sound.number).second) return refuseFinding("two have the same number");
        if (!list.findings.empty() && sound.finding.arcMm < list.findings.back().finding.arcMm)
            return refuseFinding("they are not in the order of the colon");
        list.findings.push_back(std::move(sound));
    }
    return list;
}

// ---- what has been seen -------------------------------------------------------------------------

namespace {

constexpr double mostWallMm2 = 1e9;

tl::unexpected<Error> refuseSeen(const char* what) {
    return fail(ErrorKind::badInput, what, "seen");
}

bool isWallName(const std::string& name) {
    return isVisibleAscii(name, 64);
}

Result<std::vector<MissedPlace>> patchesFrom(
    const google::protobuf::RepeatedPtrField<protocol::MissedPatch>& message, int most) {
    if (message.size() > most) return refuseSeen("the server sent more patches than a list has");
    std::vector<MissedPlace> patches;
    for (const protocol::MissedPatch& patch : message) {
        MissedPlace one{patch.area_mm2(), TRY(placeFrom(patch.place())), std::nullopt};
        if (!isWithin(one.areaMm2, 0.0, mostWallMm2))
            return refuseSeen("the server sent a patch whose area is none");
        if (patch.has_view()) one.view = TRY(viewFrom(patch.view()));
        patches.push_back(std::move(one));
    }
    return patches;
}

std::vector<std::uint8_t> flagsOf(const std::string& bits, std::size_t count) {
    std::vector<std::uint8_t> flags(count);
    for (std::size_t n = 0; n < count; ++n)
        flags[n] = static_cast<unsigned char>(bits[n / 8]) >> n % 8 & 1u;
    return flags;
}

}  // namespace

Result<SeenLimits> seenLimitsFrom(const protocol::SeenLimits& message) {
    if (message.least_ms() > std::uint32_t(mostSeenMs))
        return refuseSeen("the server sent limits that are none");
    const SeenLimits limits{message.pixels_per_mm(), int(message.least_ms())};
    TRY(checkSeenLimits(limits));
    return limits;
}

Result<MissedList> missedFrom(const protocol::MissedList& message) {
    MissedList list{message.share(), message.least_mm2(), 0, message.area_mm2(), {}};
    if (!isWithin(list.share, 0.0, 1.0) || !isWithin(list.leastMm2, 0.0, mostWallMm2) ||
        !isWithin(list.areaMm2, 0.0, mostWallMm2) ||
        message.count() > std::uint32_t(protocol::maxLedgerTriangles))
        return refuseSeen("the server sent a list whose figures are none");
    list.count = int(message.count());
    list.patches = TRY(patchesFrom(message.patches(), protocol::maxMissedPatches));
    return list;
}

Result<LedgerFlags> ledgerFrom(const protocol::Ledger& message) {
    if (!isWallName(message.wall()) || !isWithin(message.share(), 0.0, 1.0) ||
        message.triangles() > std::uint32_t(protocol::maxLedgerTriangles))
        return refuseSeen("the server sent a ledger of no wall");
    const std::size_t triangles = message.triangles(), bytes = (triangles + 7) / 8;
    if (message.shown().size() != bytes || message.seen().size() != bytes)
        return refuseSeen("the server sent a ledger whose flags are not as many as triangles");
    return LedgerFlags{message.wall(),
                       TRY(seenLimitsFrom(message.limits())),
                       message.share(),
                       message.recorded(),
                       flagsOf(message.shown(), triangles),
                       flagsOf(message.seen(), triangles)};
}

Result<SeenReport> seenReportFrom(const protocol::SeenReport& message) {
    SeenReport report{message.wall(), message.least_mm2(), {}};
    if (!isWallName(report.wall) || !isWithin(report.leastMm2, 0.0, mostWallMm2))
        return refuseSeen("the server sent a report of no wall");
    if (message.readers_size() > protocol::maxReportedLedgers)
        return refuseSeen("the server sent more readers than a report has");
    for (const protocol::ReaderSeen& reader : message.readers()) {
        ReaderSeen one;
        if (!isVisibleAscii(reader.reader(), protocol::maxReaderBytes) ||
            !isWithin(reader.share(), 0.0, 1.0) ||
            !isWithin(reader.missed_mm2(), 0.0, mostWallMm2) ||
            reader.missed() > std::uint32_t(protocol::maxLedgerTriangles))
            return refuseSeen("the server sent a reader whose figures are none");
        one.reader = reader.reader();
        one.limits = TRY(seenLimitsFrom(reader.limits()));
        one.share = reader.share();
        one.changedUtc = peerText(reader.changed_utc(), maxTimeBytes);
        one.missed = {one.share, report.leastMm2, int(reader.missed()), reader.missed_mm2(),
                      TRY(patchesFrom(reader.patches(), protocol::maxReportedPatches))};
        report.readers.push_back(std::move(one));
    }
    return report;
}

}  // namespace haustra::reader
