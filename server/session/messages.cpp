#include "session/messages.h"

#include "protocol/framing.h"
#include "protocol/limits.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"
#include "store/sha256.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace haustra::session {
namespace {

tl::unexpected<Error> refuse(std::string message, const char* place) {
    return fail(ErrorKind::badInput, std::move(message), place);
}

bool isControl(char c) {
    const auto code = static_cast<unsigned char>(c);
    return (code < 0x20 && c != '\n' && c != '\t') || code == 0x7f;
}

bool isVisibleAscii(char c) {
    return c > 0x20 && c < 0x7f;
}

// Of texts the first bytes that fit, not cut within a character.
std::string shortened(const std::string& text, std::size_t most) {
    if (text.size() <= most) return text;
    std::size_t end = most;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
        --end;
    return text.substr(0, end);
}

void fill(protocol::ColonTrust& message, const ColonTrust& trust) {
    message.set_confidence(trust.confidence);
    message.set_length_mm(trust.lengthMm);
    for (const std::string& warning : trust.warnings) {
        if (message.warnings_size() == protocol::maxWarnings) break;
        message.add_warnings(shortened(warning, protocol::maxWarningBytes));
    }
    for (const SegmentDistension& segment : trust.segments) {
        auto* told = message.add_segments();
        told->set_length_mm(segment.lengthMm);
        told->set_diameter_mm(segment.diameterMm);
        told->set_gas_ml(segment.gasMl);
        told->set_tagged_ml(segment.taggedMl + segment.untaggedMl);
        told->set_collapsed_mm(segment.collapsedMm);
    }
}

}  // namespace

// ---- from clients -----------------------------------------------------------------------------

Result<Optics> opticsFrom(const protocol::SetTransferFunction& message,
                          const render::PresetLibrary& presets) {
    if (message.preset().empty() != message.has_optics())
        return refuse("either a preset or optics are needed", "transfer function");
    if (message.has_optics()) return protocol::opticsFrom(message.optics());
    const OpticsPreset* preset = presets.find(message.preset());
    if (!preset) return refuse("there is no such preset", "transfer function");
    return preset->optics;
}

Result<records::NewBookmark> bookmarkFrom(const protocol::AddBookmark& message,
                                          const std::string& caseName, const std::string& scan) {
    const auto position = TRY(protocol::positionFrom(message.position_mm()));
    const Camera camera{position, protocol::vectorFrom(message.forward()),
                        protocol::vectorFrom(message.up())};
    TRY(checkCamera(camera));
    if (!(std::abs(message.arc_mm()) <= protocol::maxCoordinateMm))
        return refuse("the arc is not a number within a kilometre", "bookmark");
    const std::string& note = message.note();
    if (note.size() > protocol::maxNoteBytes)
        return refuse("the note has more than " + std::to_string(protocol::maxNoteBytes) + " bytes",
                      "bookmark");
    if (std::any_of(note.begin(), note.end(), isControl))
        return refuse("the note holds a control character", "bookmark");
    const std::string& key = message.client_key();
    if (key.empty() || key.size() > protocol::maxClientKeyBytes ||
        !std::all_of(key.begin(), key.end(), isVisibleAscii))
        return refuse("the client key is not 1 to " + std::to_string(protocol::maxClientKeyBytes) +
                          " visible ASCII characters",
                      "bookmark");
    return records::NewBookmark{
        caseName, scan, key, camera.positionMm, camera.forward, camera.up, message.arc_mm(), note};
}

Result<std::string> readerFrom(const std::string& name) {
    if (name.empty() || name.size() > protocol::maxReaderBytes ||
        !std::all_of(name.begin(), name.end(), isVisibleAscii))
        return refuse("a reader's name is 1 to " + std::to_string(protocol::maxReaderBytes) +
                          " visible ASCII characters",
                      "reader");
    return name;
}

Result<SeenLimits> seenLimitsFrom(const protocol::SetSeenLimits& message) {
    SeenLimits limits;
    if (!message.has_limits()) return limits;
    if (message.limits().pixels_per_mm() != 0.0)
        limits.pixelsPerMm = message.limits().pixels_per_mm();
    if (message.limits().least_ms() > std::uint32_t(protocol::mostSeenMs))
        return refuse("a place is looked at for 0 to 60000 ms", "seen");
    limits.leastMs = int(message.limits().least_ms());
    TRY(checkSeenLimits(limits));
    return limits;
}

Result<double> leastMm2From(double message) {
    if (message == 0.0) return leastMissedMm2;
    if (!(message >= protocol::leastListedMm2 && message <= protocol::mostListedMm2))
        return refuse("patches are listed from 1 to 1000000 mm2 on", "missed");
    return message;
}

Result<CaseQuestion> questionFrom(const protocol::LocateFlat& message, const OpenCase& of) {
    const auto flat = TRY(protocol::flatPointFrom(message.flat()));
    if (!(flat.y >= 0.0 && flat.y <= of.wall->map->height))
        return fail(ErrorKind::badInput, "the place lies beyond the strip", "flat");
    return WallQuestion(LocateInStrip{flat});
}

Result<CaseQuestion> questionFrom(const protocol::LocatePoint& message, const OpenCase&) {
    const auto position = TRY(protocol::positionFrom(message.position_mm()));
    return WallQuestion(LocateInSpace{position});
}

Result<CaseQuestion> questionFrom(const protocol::MeasureFlat& message, const OpenCase& of) {
    Measure question;
    question.closed = message.closed();
    if (message.points_size() <
            (question.closed ? protocol::minOutlinePoints : protocol::minLinePoints) ||
        message.points_size() > protocol::maxMeasuredPoints)
        return refuse("a line has 2, an outline 3, and both at most " +
                          std::to_string(protocol::maxMeasuredPoints) + " points",
                      "measurement");
    for (const protocol::FlatPoint& corner : message.points()) {
        const auto point = TRY(protocol::flatPointFrom(corner));
        if (std::abs(point.x) > protocol::maxMeasuredTurns)
            return refuse("a point lies more than 32 turns away", "measurement");
        question.points.push_back({point.x, std::clamp(point.y, 0.0, of.wall->map->height)});
    }
    const auto& points = question.points;
    double legs = question.closed ? glm::distance(points.front(), points.back()) : 0.0;
    for (std::size_t n = 1; n < points.size(); ++n)
        legs += glm::distance(points[n - 1], points[n]);
    if (legs >
        (question.closed ? protocol::maxOutlineCircumferences : protocol::maxLineCircumferences))
        return refuse("what is measured is too long", "measurement");
    const auto [left, right] = std::minmax_element(
        points.begin(), points.end(), [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; });
    if (question.closed && right->x - left->x > 1.0)
        return refuse("the outline is wider than the colon", "measurement");
    return WallQuestion(std::move(question));
}

Result<CaseQuestion> questionFrom(const protocol::MeasureScan& message, const OpenCase& of) {
    ScanRegion region;
    region.centerMm = TRY(protocol::positionFrom(message.center_mm()));
    region.halfAMm = protocol::vectorFrom(message.half_a_mm());
    region.halfBMm = protocol::vectorFrom(message.half_b_mm());
    region.slab = TRY(protocol::slabFrom(message.slab()));
    if (message.cleansed()) region.scan = Scan::cleansed;
    TRY(checkScanRegion(region));
    if (message.cleansed() && !of.cleansed)
        return refuse("the case has no cleansed scan", "scan values");
    return region;
}

Result<CaseQuestion> questionFrom(const protocol::PickWall& message, const OpenCase&) {
    const auto position = TRY(protocol::positionFrom(message.position_mm()));
    const glm::dvec3 direction = protocol::vectorFrom(message.direction());
    const double length = glm::length(direction);
    if (!std::isfinite(length) || !(length > 0.0))
        return refuse("the direction is zero, or no number", "wall");
    return PickRay{position, direction / length};
}

// ---- to clients -------------------------------------------------------------------------------

namespace {

// Of answers that have a request and no bound of their own.
std::uint64_t requestOf(const protocol::ServerMessage& message) {
    switch (message.body_case()) {
        case protocol::ServerMessage::kCaseList:
            return message.case_list().request();
        case protocol::ServerMessage::kBookmarkList:
            return message.bookmark_list().request();
        case protocol::ServerMessage::kFindingList:
            return message.finding_list().request();
        case protocol::ServerMessage::kLedger:
            return message.ledger().request();
        default:
            return 0;
    }
}

}  // namespace

std::vector<std::uint8_t> frameOf(const protocol::ServerMessage& message) {
    if (message.ByteSizeLong() > protocol::maxServerControlBytes)
        return frameOf(errorMessage(protocol::ErrorReport::INTERNAL,
                                    "the answer is too long for one message", false,
                                    requestOf(message)));
    return protocol::controlFrame(message);
}

protocol::ServerMessage errorMessage(protocol::ErrorReport::Code code, const std::string& message,
                                     bool fatal, std::uint64_t request) {
    protocol::ServerMessage answer;
    auto* error = answer.mutable_error();
    error->set_code(code);
    error->set_message(message);
    error->set_fatal(fatal);
    error->set_request(request);
    return answer;
}

protocol::ServerMessage caseOpenedMessage(const OpenCase& opened,
                                          const render::PresetLibrary& presets) {
    protocol::ServerMessage answer;
    auto* message = answer.mutable_case_opened();
    message->set_name(opened.name);
    message->set_scan(opened.scan);
    message->set_size_x(std::uint32_t(opened.grid.size.x));
    message->set_size_y(std::uint32_t(opened.grid.size.y));
    message->set_size_z(std::uint32_t(opened.grid.size.z));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            message->add_patient_from_voxel(opened.grid.patientFromVoxel[column][row]);
    std::uint32_t sample = 0;
    for (const CenterlinePoint& point : opened.centerline.points) {
        for (const double number : {point.positionMm.x, point.positionMm.y, point.positionMm.z,
                                    point.arcMm, point.radiusMm})
            message->add_centerline(number);
        if (point.gap) message->add_gap_samples(sample);
        ++sample;
    }
    message->set_patient_position(toString(opened.position));
    for (const OpticsPreset& preset : presets.presets)
        fill(*message->add_presets(), preset);
    message->set_cleansed(opened.cleansed);
    message->set_detection(opened.findings          ? protocol::CaseOpened::THERE
                           : opened.findingsDamaged ? protocol::CaseOpened::DAMAGED
                                                    : protocol::CaseOpened::NONE);
    if (opened.trust) fill(*message->mutable_trust(), *opened.trust);
    message->set_raycaster(toString(opened.raycaster));
    for (const render::RaycasterTrial& trial : opened.trials) {
        auto* tried = message->add_trials();
        tried->set_raycaster(toString(trial.kind));
        if (!trial.ms.empty()) tried->set_median_ms(trial.medianMs());
        tried->set_failure(trial.failure);
    }
    auto* histogram = message->mutable_histogram();
    histogram->set_first_hu(opened.histogram.firstHu);
    histogram->set_hu_per_bin(opened.histogram.huPerBin);
    histogram->mutable_voxels()->Add(opened.histogram.voxels.begin(),
                                     opened.histogram.voxels.end());
    if (opened.wall) {
        auto* flat = message->mutable_flat();
        flat->set_height(opened.wall->map->height);
        flat->set_circumference_mm(opened.wall->circumferenceMm);
        for (const WallRow& row : opened.wall->rows) {
            flat->add_rows(row.arcMm);
            flat->add_rows(row.y);
        }
    }
    return answer;
}

namespace {

protocol::CaseEntry::State stateOf(CaseSummary::State state) {
    switch (state) {
        case CaseSummary::State::ready:
            return protocol::CaseEntry::READY;
        case CaseSummary::State::incomplete:
            return protocol::CaseEntry::INCOMPLETE;
        default:
            return protocol::CaseEntry::DAMAGED;
    }
}

void fill(protocol::CaseEntry& message, const CaseSummary& summary) {
    message.set_name(summary.name);
    message.set_state(stateOf(summary.state));
    message.set_reason(shortened(summary.reason, protocol::maxWarningBytes));
    message.set_prepared_utc(summary.preparedUtc);
    message.set_size_x(std::uint32_t(summary.size.x));
    message.set_size_y(std::uint32_t(summary.size.y));
    message.set_size_z(std::uint32_t(summary.size.z));
    protocol::fill(*message.mutable_spacing_mm(), summary.spacingMm);
    message.set_cleansed(summary.cleansed);
    message.set_flattened(summary.flattened);
    if (summary.confidence) message.set_confidence(*summary.confidence);
    message.set_warnings(
        std::uint32_t(std::min(summary.warnings, std::size_t(protocol::maxWarnings))));
    message.set_bookmarks(std::uint32_t(summary.bookmarks));
}

}  // namespace

protocol::ServerMessage caseListMessage(const std::vector<CaseSummary>& cases,
                                        const OpenCounts& readers, std::uint64_t request) {
    protocol::ServerMessage message;
    auto* list = message.mutable_case_list();
    list->set_request(request);
    for (const CaseSummary& summary : cases)
        list->add_names(summary.name);
    std::size_t bytes = message.ByteSizeLong();
    for (const CaseSummary& summary : cases) {
        protocol::CaseEntry entry;
        fill(entry, summary);
        entry.set_readers(std::uint32_t(readers.of(summary.name)));
        constexpr std::size_t around = 16;  // what says that an entry follows, and how long it is
        bytes += entry.ByteSizeLong() + around;
        if (bytes > protocol::maxServerControlBytes) break;
        *list->add_entries() = std::move(entry);
    }
    return message;
}

namespace {

void fill(protocol::WallPlace& message, const WallPlace& place) {
    if (place.flatTriangle >= 0) protocol::fill(*message.mutable_flat(), place.flat);
    protocol::fill(*message.mutable_position_mm(), place.positionMm);
    message.set_triangle(std::uint32_t(std::max(place.sourceTriangle, 0)));
    message.set_arc_mm(place.arcMm);
    protocol::fill(*message.mutable_camera_mm(), place.cameraMm);
}

}  // namespace

void fill(protocol::Bookmark& message, const MarkedBookmark& marked) {
    const records::Bookmark& bookmark = marked.bookmark;
    message.set_id(bookmark.id);
    protocol::fillPose(message, bookmark);
    message.set_arc_mm(bookmark.arcMm);
    message.set_note(bookmark.note);
    message.set_created_utc(bookmark.createdUtc);
    message.set_client_key(bookmark.clientKey);
    if (marked.mark) fill(*message.mutable_mark(), *marked.mark);
}

protocol::ServerMessage bookmarkAddedMessage(const MarkedBookmark& bookmark,
                                             std::uint64_t request) {
    protocol::ServerMessage message;
    message.mutable_bookmark_added()->set_request(request);
    fill(*message.mutable_bookmark_added()->mutable_bookmark(), bookmark);
    return message;
}

namespace {

void fill(protocol::Finding& message, const CaseFindings::Entry& entry, const Finding& finding) {
    message.set_number(std::uint32_t(entry.number));
    protocol::fill(*message.mutable_position_mm(), finding.positionMm);
    fill(*message.mutable_wall(), entry.wall);
    message.set_diameter_mm(finding.diameterMm);
    protocol::fill(*message.mutable_diameter_from_mm(), finding.diameterEndsMm.first);
    protocol::fill(*message.mutable_diameter_to_mm(), finding.diameterEndsMm.second);
    message.set_height_mm(finding.heightMm);
    message.set_arc_mm(finding.arcMm);
    // The wire's segments are core's, after one that is not known.
    if (finding.segment) message.set_segment(protocol::Finding::Segment(int(*finding.segment) + 1));
    message.set_kind(shortened(finding.kind, protocol::maxFindingKindBytes));
    message.set_probability(finding.score);
    message.set_below_operating_point(entry.candidate);
    if (entry.view) protocol::fill(*message.mutable_view(), *entry.view);
}

}  // namespace

protocol::ServerMessage findingListMessage(const OpenCase& of, const DetectionChoice& choice,
                                           std::uint64_t request) {
    using protocol::FindingList;
    protocol::ServerMessage message;
    FindingList& list = *message.mutable_finding_list();
    list.set_request(request);
    list.set_state(of.findingsDamaged                  ? FindingList::DAMAGED
                   : !of.findings                      ? FindingList::NONE
                   : choice.shows()                    ? FindingList::SHOWN
                   : choice.mode == DetectionMode::off ? FindingList::OFF
                                                       : FindingList::FIRST_PASS);
    if (!of.findings) return message;
    const CaseFindings& findings = *of.findings;
    list.set_operating_point(findings.product.operatingPoint);
    list.set_model(shortened(findings.product.model.name, protocol::maxModelNameBytes));
    list.set_trained_on(shortened(findings.product.model.trainedOn, protocol::maxTrainedOnBytes));
    if (list.state() != FindingList::SHOWN) return message;
    for (const std::string& warning : findings.product.warnings) {
        if (list.warnings_size() == protocol::maxWarnings) break;
        list.add_warnings(shortened(warning, protocol::maxWarningBytes));
    }
    std::vector<std::pair<protocol::Finding*, const Finding*>> told;
    for (const int n : findings.alongColon) {
        if (!findings.isShown(n, choice)) continue;
        protocol::Finding& one = *list.add_findings();
        fill(one, findings.entries[std::size_t(n)], findings.finding(n));
        told.emplace_back(&one, &findings.finding(n));
    }
    std::size_t runs = 0;
    for (const bool candidates : {false, true}) {
        for (const auto& [one, finding] : told) {
            if (one->below_operating_point() != candidates) continue;
            if (runs + finding->voxels.size() > protocol::maxListedRuns) continue;
            runs += finding->voxels.size();
            for (const VoxelRun& run : finding->voxels)
                for (const int number : {run.first.x, run.first.y, run.first.z, run.count})
                    one->add_voxels(std::uint32_t(number));
        }
    }
    return message;
}

// ---- what has been seen -------------------------------------------------------------------------

namespace {

void fill(google::protobuf::RepeatedPtrField<protocol::MissedPatch>& message,
          const Missed& missed) {
    for (const Missed::Patch& patch : missed.patches) {
        protocol::MissedPatch& one = *message.Add();
        one.set_area_mm2(patch.areaMm2);
        fill(*one.mutable_place(), patch.place);
        if (patch.view) protocol::fill(*one.mutable_view(), *patch.view);
    }
}

// The lowest bit of a byte first.
std::string bitsOf(const std::vector<std::uint8_t>& flags) {
    std::string bits((flags.size() + 7) / 8, '\0');
    for (std::size_t n = 0; n < flags.size(); ++n)
        if (flags[n]) bits[n / 8] = char(static_cast<unsigned char>(bits[n / 8]) | 1u << n % 8);
    return bits;
}

}  // namespace

void fill(protocol::SeenLimits& message, const SeenLimits& limits) {
    message.set_pixels_per_mm(limits.pixelsPerMm);
    message.set_least_ms(std::uint32_t(limits.leastMs));
}

protocol::ServerMessage missedListMessage(const Missed& missed, double leastMm2,
                                          std::uint64_t request) {
    protocol::ServerMessage message;
    protocol::MissedList& list = *message.mutable_missed_list();
    list.set_request(request);
    list.set_share(missed.share);
    list.set_least_mm2(leastMm2);
    list.set_count(std::uint32_t(missed.count));
    list.set_area_mm2(missed.areaMm2);
    fill(*list.mutable_patches(), missed);
    return message;
}

protocol::ServerMessage ledgerMessage(const SeenFlags& flags, const records::LedgerKey& key,
                                      bool recorded, std::uint64_t request) {
    protocol::ServerMessage message;
    protocol::Ledger& ledger = *message.mutable_ledger();
    ledger.set_request(request);
    ledger.set_wall(key.wall);
    fill(*ledger.mutable_limits(), key.limits);
    ledger.set_share(flags.share);
    ledger.set_recorded(recorded);
    ledger.set_triangles(std::uint32_t(flags.seen.size()));
    ledger.set_shown(bitsOf(flags.shown));
    ledger.set_seen(bitsOf(flags.seen));
    return message;
}

protocol::ServerMessage seenReportMessage(const std::vector<ReaderSeen>& readers,
                                          const records::LedgerKey& own, double leastMm2,
                                          std::uint64_t request) {
    // Whoever knows another's name may go on under it. With a key of this process alone, so that no
    // list of likely names tells whose mark it is.
    static const std::string key = [] {
        std::random_device random;
        std::string made;
        for (int n = 0; n < 8; ++n)
            made += std::to_string(random()) + ' ';
        return made;
    }();
    const auto markOf = [](const std::string& reader) {
        return "sha256:" + store::toHex(store::textDigest(key + reader)).substr(0, 16);
    };
    protocol::ServerMessage message;
    protocol::SeenReport& report = *message.mutable_seen_report();
    report.set_request(request);
    report.set_wall(own.wall);
    report.set_least_mm2(leastMm2);
    for (const ReaderSeen& reader : readers) {
        protocol::ReaderSeen& one = *report.add_readers();
        one.set_reader(reader.key.reader == own.reader ? own.reader : markOf(reader.key.reader));
        fill(*one.mutable_limits(), reader.key.limits);
        one.set_share(reader.share);
        one.set_changed_utc(reader.changedUtc);
        one.set_missed(std::uint32_t(reader.missed.count));
        one.set_missed_mm2(reader.missed.areaMm2);
        fill(*one.mutable_patches(), reader.missed);
    }
    return message;
}

protocol::ServerMessage messageOf(const CaseAnswer& answer, std::uint64_t request) {
    protocol::ServerMessage message;
    if (const auto* place = std::get_if<WallPlace>(&answer)) {
        message.mutable_wall_place()->set_request(request);
        fill(*message.mutable_wall_place(), *place);
        return message;
    }
    if (const auto* values = std::get_if<ScanStatistics>(&answer)) {
        auto* body = message.mutable_scan_statistics();
        body->set_request(request);
        body->set_samples(values->samples);
        body->set_mean_hu(values->meanHu);
        body->set_deviation_hu(values->deviationHu);
        body->set_least_hu(values->leastHu);
        body->set_greatest_hu(values->greatestHu);
        body->set_area_mm2(values->areaMm2);
        return message;
    }
    const auto& measure = std::get<WallMeasure>(answer);
    auto* body = message.mutable_flat_measure();
    body->set_request(request);
    body->set_length_mm(measure.lengthMm);
    body->set_straight_mm(measure.straightMm);
    body->set_area_mm2(measure.areaMm2);
    body->set_largest_diameter_mm(measure.largestDiameterMm);
    return message;
}

}  // namespace haustra::session
