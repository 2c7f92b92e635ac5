#include "panels/messages.h"

#include <cmath>

namespace haustra::panels {
namespace {

void set(protocol::Vec3* out, glm::dvec3 v) {
    out->set_x(v.x);
    out->set_y(v.y);
    out->set_z(v.z);
}

protocol::Lens lensCode(const Camera& camera) {
    return camera.fisheye ? protocol::FISHEYE : protocol::PERSPECTIVE;
}

constexpr double maxStripHeight = 4096.0;

glm::dvec3 vectorFrom(const protocol::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

protocol::View viewCode(View view) {
    switch (view) {
        case View::endoscopic:
            return protocol::ENDOSCOPIC;
        case View::axial:
            return protocol::AXIAL;
        case View::coronal:
            return protocol::CORONAL;
        case View::sagittal:
            return protocol::SAGITTAL;
        case View::flattened:
            return protocol::FLATTENED;
        case View::flattenedZoom:
            return protocol::FLATTENED_ZOOM;
        case View::oblique:
            return protocol::OBLIQUE;
        case View::overview:
            return protocol::OVERVIEW;
    }
    return protocol::VIEW_UNSPECIFIED;
}

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
    if (!(strip.height > 0.0 && strip.height <= maxStripHeight))
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

void set(protocol::FlatPoint* out, glm::dvec2 flat) {
    out->set_x(flat.x);
    out->set_y(flat.y);
}

}  // namespace

const char* toString(View view) {
    switch (view) {
        case View::endoscopic:
            return "endoscopic";
        case View::axial:
            return "axial";
        case View::coronal:
            return "coronal";
        case View::sagittal:
            return "sagittal";
        case View::flattened:
            return "flattened";
        case View::flattenedZoom:
            return "flattened-zoom";
        case View::oblique:
            return "oblique";
        case View::overview:
            return "overview";
    }
    return "";
}

std::optional<View> viewFromString(const std::string& text) {
    for (const View view : {View::endoscopic, View::axial, View::coronal, View::sagittal,
                            View::flattened, View::flattenedZoom, View::oblique, View::overview})
        if (text == toString(view)) return view;
    return std::nullopt;
}

protocol::ClientMessage viewportMessage(std::uint64_t sequence, int viewport, View view, int width,
                                        int height) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_viewport();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    body->set_view(viewCode(view));
    body->set_width(std::uint32_t(width));
    body->set_height(std::uint32_t(height));
    return message;
}

protocol::ClientMessage cameraMessage(std::uint64_t sequence, int viewport, const Camera& camera,
                                      bool moving) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_camera();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    set(body->mutable_position_mm(), camera.positionMm);
    set(body->mutable_forward(), camera.forward);
    set(body->mutable_up(), camera.up);
    body->set_fov_degrees(camera.fovDegrees);
    body->set_lens(lensCode(camera));
    body->set_moving(moving);
    return message;
}

protocol::ClientMessage obliqueMessage(std::uint64_t sequence, int viewport, const Oblique& oblique,
                                       bool moving) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_oblique();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    set(body->mutable_position_mm(), oblique.positionMm);
    set(body->mutable_forward(), oblique.forward);
    set(body->mutable_up(), oblique.up);
    body->set_height_mm(oblique.heightMm);
    body->set_cleansed(oblique.cleansed);
    body->set_moving(moving);
    return message;
}

protocol::ClientMessage overviewMessage(std::uint64_t sequence, int viewport,
                                        const Overview& overview, bool moving) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_overview();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    const OrbitPose pose = poseOf(overview.orbit);
    protocol::Camera* camera = body->mutable_camera();
    set(camera->mutable_position_mm(), pose.positionMm);
    set(camera->mutable_forward(), pose.forward);
    set(camera->mutable_up(), pose.up);
    camera->set_lens(protocol::ORTHOGRAPHIC);
    camera->set_height_mm(overview.orbit.heightMm);
    body->set_hide_body(!overview.body);
    if (const auto& reader = overview.reader) {
        protocol::Camera* marked = body->mutable_reader();
        set(marked->mutable_position_mm(), reader->positionMm);
        set(marked->mutable_forward(), reader->forward);
        set(marked->mutable_up(), reader->up);
        marked->set_fov_degrees(reader->fovDegrees);
        marked->set_lens(lensCode(*reader));
    }
    for (const glm::dvec3 place : overview.bookmarksMm)
        set(body->add_bookmarks_mm(), place);
    body->set_moving(moving);
    return message;
}

protocol::ClientMessage sliceMessage(std::uint64_t sequence, int viewport, const Slice& slice,
                                     bool moving) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_slice();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    set(body->mutable_position_mm(), slice.positionMm);
    body->set_zoom(slice.zoom);
    body->set_cleansed(slice.cleansed);
    body->set_moving(moving);
    return message;
}

protocol::ClientMessage flatMessage(std::uint64_t sequence, int viewport, const FlatWindow& window,
                                    bool moving) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_flat();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    set(body->mutable_center(), window.center);
    body->set_pixels_per_circumference(window.pixelsPerUnit);
    body->set_moving(moving);
    return message;
}

protocol::ClientMessage windowMessage(std::uint64_t sequence, int viewport,
                                      const WindowLevel& window) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_window_level();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    body->mutable_window()->set_center_hu(window.centerHu);
    body->mutable_window()->set_width_hu(window.widthHu);
    return message;
}

protocol::ClientMessage transferMessage(std::uint64_t sequence, int viewport,
                                        const TransferFunction& function) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_transfer_function();
    body->set_sequence(sequence);
    body->set_viewport(std::uint32_t(viewport));
    if (const auto* preset = std::get_if<std::string>(&function)) body->set_preset(*preset);
    if (const auto* points = std::get_if<std::vector<TransferPoint>>(&function))
        for (const TransferPoint& point : *points) {
            auto* out = body->add_points();
            out->set_hu(point.hu);
            out->set_red(point.color.r);
            out->set_green(point.color.g);
            out->set_blue(point.color.b);
            out->set_opacity(point.opacity);
        }
    return message;
}

protocol::ClientMessage bookmarkMessage(std::uint64_t request, const Bookmark& bookmark) {
    protocol::ClientMessage message;
    auto* body = message.mutable_add_bookmark();
    body->set_request(request);
    set(body->mutable_position_mm(), bookmark.camera.positionMm);
    set(body->mutable_forward(), bookmark.camera.forward);
    set(body->mutable_up(), bookmark.camera.up);
    body->set_arc_mm(bookmark.arcMm);
    body->set_note(bookmark.note);
    body->set_client_key(bookmark.clientKey);
    return message;
}

protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec2 flat) {
    protocol::ClientMessage message;
    message.mutable_locate_flat()->set_request(request);
    set(message.mutable_locate_flat()->mutable_flat(), flat);
    return message;
}

protocol::ClientMessage locateMessage(std::uint64_t request, glm::dvec3 positionMm) {
    protocol::ClientMessage message;
    message.mutable_locate_point()->set_request(request);
    set(message.mutable_locate_point()->mutable_position_mm(), positionMm);
    return message;
}

protocol::ClientMessage measureMessage(std::uint64_t request, const std::vector<glm::dvec2>& points,
                                       bool closed) {
    protocol::ClientMessage message;
    auto* body = message.mutable_measure_flat();
    body->set_request(request);
    for (const glm::dvec2 point : points)
        set(body->add_points(), point);
    body->set_closed(closed);
    return message;
}

Result<CaseInfo> caseInfoFrom(const protocol::CaseOpened& message) {
    CaseInfo info;
    info.name = message.name();
    for (const std::uint32_t extent : {message.size_x(), message.size_y(), message.size_z()})
        if (extent > 4096)
            return fail(ErrorKind::badInput, "the volume is too large", "case opened: size");
    info.grid.size = {int(message.size_x()), int(message.size_y()), int(message.size_z())};
    if (message.patient_from_voxel_size() != 12)
        return fail(ErrorKind::badInput, "not 12 numbers", "case opened: patient_from_voxel");
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            info.grid.patientFromVoxel[column][row] = message.patient_from_voxel(4 * row + column);
    if (auto sound = checkGrid(info.grid, "case opened"); !sound)
        return tl::make_unexpected(sound.error());
    auto centerline = centerlineFrom(message);
    if (!centerline) return tl::make_unexpected(centerline.error());
    info.centerline = std::move(*centerline);
    info.position = patientPositionFromString(message.patient_position());
    info.transferFunctions.assign(message.transfer_functions().begin(),
                                  message.transfer_functions().end());
    info.cleansed = message.cleansed();
    if (message.has_flat()) {
        auto strip = stripFrom(message.flat());
        if (!strip) return tl::make_unexpected(strip.error());
        info.flat = std::move(*strip);
    }
    return info;
}

Bookmark bookmarkFrom(const protocol::Bookmark& message) {
    Bookmark bookmark;
    bookmark.id = message.id();
    bookmark.camera.positionMm = vectorFrom(message.position_mm());
    bookmark.camera.forward = vectorFrom(message.forward());
    bookmark.camera.up = vectorFrom(message.up());
    bookmark.arcMm = message.arc_mm();
    bookmark.note = message.note();
    bookmark.createdUtc = message.created_utc();
    bookmark.clientKey = message.client_key();
    return bookmark;
}

Result<WallPlace> placeFrom(const protocol::WallPlace& message) {
    WallPlace place;
    place.flat = {message.flat().x(), message.flat().y()};
    place.positionMm = vectorFrom(message.position_mm());
    place.triangle = message.triangle();
    place.arcMm = message.arc_mm();
    place.cameraMm = vectorFrom(message.camera_mm());
    const glm::dvec3 sum = place.positionMm + place.cameraMm;
    const bool inStrip = place.flat.x >= 0.0 && place.flat.x < 1.0 && place.flat.y >= 0.0 &&
                         place.flat.y <= maxStripHeight;
    if (!inStrip || !std::isfinite(sum.x + sum.y + sum.z + place.arcMm))
        return fail(ErrorKind::badInput, "the server sent a place that is nowhere", "wall");
    return place;
}

Result<FlatMeasure> measureFrom(const protocol::FlatMeasure& message) {
    const FlatMeasure measure{message.length_mm(), message.straight_mm(), message.area_mm2(),
                              message.largest_diameter_mm()};
    if (!std::isfinite(measure.lengthMm + measure.straightMm + measure.areaMm2 +
                       measure.largestDiameterMm))
        return fail(ErrorKind::badInput, "the server sent a measurement that is no number", "wall");
    return measure;
}

}  // namespace haustra::panels
