#include "reader/outgoing_messages.h"

#include "protocol/optics_message.h"

#include <array>

namespace haustra::reader {
namespace {

constexpr std::array<protocol::View, viewCount> viewCodes = {
    protocol::ENDOSCOPIC, protocol::AXIAL,          protocol::CORONAL, protocol::SAGITTAL,
    protocol::FLATTENED,  protocol::FLATTENED_ZOOM, protocol::OBLIQUE, protocol::OVERVIEW};

void set(protocol::Vec3* out, glm::dvec3 v) {
    out->set_x(v.x);
    out->set_y(v.y);
    out->set_z(v.z);
}

void set(protocol::FlatPoint* out, glm::dvec2 flat) {
    out->set_x(flat.x);
    out->set_y(flat.y);
}

// Of whatever message has a place, a gaze and what is up in it.
template <class Body, class Pose>
void setPose(Body* body, const Pose& pose) {
    set(body->mutable_position_mm(), pose.positionMm);
    set(body->mutable_forward(), pose.forward);
    set(body->mutable_up(), pose.up);
}

template <class Body>
void setLens(Body* body, const Camera& camera) {
    body->set_fov_degrees(camera.fovDegrees);
    body->set_lens(camera.fisheye ? protocol::FISHEYE : protocol::PERSPECTIVE);
}

template <class Body>
Body* begin(Body* body, const InputHeader& header) {
    body->set_sequence(header.sequence);
    body->set_viewport(std::uint32_t(header.viewport));
    if constexpr (requires { body->set_moving(true); }) body->set_moving(header.moving);
    return body;
}

}  // namespace

protocol::ClientMessage viewportMessage(InputHeader header, View view, int width, int height) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_viewport(), header);
    body->set_view(viewCodes[std::size_t(view)]);
    body->set_width(std::uint32_t(width));
    body->set_height(std::uint32_t(height));
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const Camera& camera) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_camera(), header);
    setPose(body, camera);
    setLens(body, camera);
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const Slice& slice) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_slice(), header);
    set(body->mutable_position_mm(), slice.positionMm);
    body->set_zoom(slice.zoom);
    body->set_cleansed(slice.cleansed);
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const FlatWindow& window) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_flat(), header);
    set(body->mutable_center(), window.center);
    body->set_pixels_per_circumference(window.pixelsPerUnit);
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const Oblique& oblique) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_oblique(), header);
    setPose(body, oblique);
    body->set_height_mm(oblique.heightMm);
    body->set_cleansed(oblique.cleansed);
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const Overview& overview) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_overview(), header);
    protocol::Camera* camera = body->mutable_camera();
    setPose(camera, cameraOf(overview.orbit));
    camera->set_lens(protocol::ORTHOGRAPHIC);
    camera->set_height_mm(overview.orbit.heightMm);
    body->set_hide_body(!overview.body);
    if (const auto& reader = overview.reader) {
        setPose(body->mutable_reader(), *reader);
        setLens(body->mutable_reader(), *reader);
    }
    for (const glm::dvec3 place : overview.bookmarksMm)
        set(body->add_bookmarks_mm(), place);
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const WindowLevel& window) {
    protocol::ClientMessage message;
    auto* out = begin(message.mutable_set_window_level(), header)->mutable_window();
    out->set_center_hu(window.centerHu);
    out->set_width_hu(window.widthHu);
    return message;
}

protocol::ClientMessage inputMessage(InputHeader header, const OpticsChoice& optics) {
    protocol::ClientMessage message;
    auto* body = begin(message.mutable_set_transfer_function(), header);
    if (const auto* preset = std::get_if<std::string>(&optics)) body->set_preset(*preset);
    if (const auto* own = std::get_if<Optics>(&optics)) fill(*body->mutable_optics(), *own);
    return message;
}

protocol::ClientMessage paintMessage(std::uint64_t sequence, const WallPaint& paint) {
    protocol::ClientMessage message;
    auto* body = message.mutable_set_wall_paint();
    body->set_sequence(sequence);
    body->set_marks(paint.marks);
    body->set_unseen(paint.unseen);
    body->set_mark_radius_mm(paint.markRadiusMm);
    return message;
}

protocol::ClientMessage bookmarkMessage(std::uint64_t request, const Bookmark& bookmark) {
    protocol::ClientMessage message;
    auto* body = message.mutable_add_bookmark();
    body->set_request(request);
    setPose(body, bookmark.camera);
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

}  // namespace haustra::reader
