#include "session/messages.h"

#include "protocol/framing.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"

namespace haustra::session {
namespace {

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

std::vector<std::uint8_t> frameOf(const protocol::ServerMessage& message) {
    if (message.ByteSizeLong() > protocol::maxServerControlBytes)
        return frameOf(errorMessage(protocol::ErrorReport::INTERNAL,
                                    "the answer is too long for one message", false));
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

void fill(protocol::Bookmark& message, const records::Bookmark& bookmark) {
    message.set_id(bookmark.id);
    protocol::fillPose(message, bookmark);
    message.set_arc_mm(bookmark.arcMm);
    message.set_note(bookmark.note);
    message.set_created_utc(bookmark.createdUtc);
    message.set_client_key(bookmark.clientKey);
}

}  // namespace haustra::session
