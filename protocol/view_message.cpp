#include "protocol/view_message.h"

#include "protocol/limits.h"

#include <array>
#include <cmath>

namespace haustra::protocol {
namespace {

tl::unexpected<Error> refuseView(std::string message, const char* place) {
    return fail(ErrorKind::badInput, std::move(message), place);
}

struct ViewCode {
    haustra::View view;
    View code;
};
constexpr ViewCode viewCodes[] = {
    {haustra::View::endoscopic, ENDOSCOPIC}, {haustra::View::axial, AXIAL},
    {haustra::View::coronal, CORONAL},       {haustra::View::sagittal, SAGITTAL},
    {haustra::View::flattened, FLATTENED},   {haustra::View::flattenedZoom, FLATTENED_ZOOM},
    {haustra::View::oblique, OBLIQUE},       {haustra::View::overview, OVERVIEW},
};
static_assert(std::size(viewCodes) == viewCount);

struct DetectionCode {
    DetectionMode mode;
    SetDetection::Mode code;
};
constexpr DetectionCode detectionModes[] = {
    {DetectionMode::off, SetDetection::OFF},
    {DetectionMode::secondReader, SetDetection::SECOND_READER},
    {DetectionMode::concurrent, SetDetection::CONCURRENT}};

View codeOf(haustra::View view) {
    for (const ViewCode& one : viewCodes)
        if (one.view == view) return one.code;
    return VIEW_UNSPECIFIED;
}

// The field of view of an orthographic camera has no meaning, nor has the height of any other: they
// are not sent, and keep their defaults.
template <class Message>
void fillCamera(Message& message, const haustra::Camera& camera) {
    fillPose(message, camera);
    message.set_lens(camera.lens == haustra::Lens::fisheye        ? FISHEYE
                     : camera.lens == haustra::Lens::orthographic ? ORTHOGRAPHIC
                                                                  : PERSPECTIVE);
    if (camera.lens == haustra::Lens::orthographic)
        message.set_height_mm(camera.heightMm);
    else
        message.set_fov_degrees(camera.fovDegrees);
}

// Of a SetCamera or a Camera.
template <class Message>
Result<haustra::Camera> soundCamera(const Message& message) {
    const auto position = TRY(positionFrom(message.position_mm()));
    haustra::Camera camera{position, vectorFrom(message.forward()), vectorFrom(message.up())};
    switch (message.lens()) {
        case PERSPECTIVE:
            break;
        case FISHEYE:
            camera.lens = haustra::Lens::fisheye;
            break;
        case ORTHOGRAPHIC:
            camera.lens = haustra::Lens::orthographic;
            camera.heightMm = message.height_mm();
            break;
        default:
            return refuseView("there is no such lens", "camera");
    }
    if (camera.lens != haustra::Lens::orthographic) camera.fovDegrees = message.fov_degrees();
    TRY(checkCamera(camera));
    return camera;
}

Scan scanOf(bool cleansed) {
    return cleansed ? Scan::cleansed : Scan::original;
}

// ---- each state: the body of the message that says it, and back

SetCamera& bodyOf(ClientMessage& message, const haustra::Camera& camera) {
    fillCamera(*message.mutable_set_camera(), camera);
    return *message.mutable_set_camera();
}

SetSlice& bodyOf(ClientMessage& message, const SliceView& slice) {
    SetSlice& body = *message.mutable_set_slice();
    fill(*body.mutable_position_mm(), slice.positionMm);
    body.set_zoom(slice.zoom);
    body.set_cleansed(slice.scan == Scan::cleansed);
    body.set_pan_right_mm(slice.panMm.x);
    body.set_pan_down_mm(slice.panMm.y);
    if (slice.slab != haustra::Slab{}) fill(*body.mutable_slab(), slice.slab);
    return body;
}

SetOblique& bodyOf(ClientMessage& message, const ObliqueView& oblique) {
    SetOblique& body = *message.mutable_set_oblique();
    fillPose(body, oblique);
    body.set_height_mm(oblique.heightMm);
    body.set_cleansed(oblique.scan == Scan::cleansed);
    if (oblique.slab != haustra::Slab{}) fill(*body.mutable_slab(), oblique.slab);
    return body;
}

SetOverview& bodyOf(ClientMessage& message, const Overview& overview) {
    SetOverview& body = *message.mutable_set_overview();
    fill(*body.mutable_camera(), overview.camera);
    body.set_hide_path(!overview.path);
    body.set_hide_body(!overview.body);
    if (overview.reader) fill(*body.mutable_reader(), *overview.reader);
    for (const glm::dvec3 place : overview.bookmarksMm)
        fill(*body.add_bookmarks_mm(), place);
    return body;
}

SetFlat& bodyOf(ClientMessage& message, const FlatWindow& window) {
    SetFlat& body = *message.mutable_set_flat();
    fill(*body.mutable_center(), window.center);
    body.set_pixels_per_circumference(window.pixelsPerUnit);
    return body;
}

SetFlat& bodyOf(ClientMessage& message, const WholeStrip&) {
    return *message.mutable_set_flat();
}

Result<ViewState> stateOf(const SetCamera& message, haustra::View view) {
    if (view != haustra::View::endoscopic)
        return refuseView("only an endoscopic view takes a camera", "viewport");
    return soundCamera(message);
}

Result<ViewState> stateOf(const SetSlice& message, haustra::View view) {
    if (!isSlice(view)) return refuseView("this view takes no slice", "viewport");
    const auto position = TRY(positionFrom(message.position_mm()));
    const auto slab = TRY(slabFrom(message.slab()));
    const SliceView slice{view,
                          position,
                          message.zoom(),
                          {},
                          scanOf(message.cleansed()),
                          {message.pan_right_mm(), message.pan_down_mm()},
                          slab};
    TRY(checkSlice(slice));
    return slice;
}

Result<ViewState> stateOf(const SetOblique& message, haustra::View view) {
    if (view != haustra::View::oblique)
        return refuseView("only an oblique view takes an oblique slice", "viewport");
    const auto position = TRY(positionFrom(message.position_mm()));
    const auto slab = TRY(slabFrom(message.slab()));
    const ObliqueView oblique{position,
                              vectorFrom(message.forward()),
                              vectorFrom(message.up()),
                              message.height_mm(),
                              {},
                              scanOf(message.cleansed()),
                              slab};
    TRY(checkOblique(oblique));
    return oblique;
}

Result<ViewState> stateOf(const SetOverview& message, haustra::View view) {
    if (view != haustra::View::overview)
        return refuseView("only an overview shows the colon from outside", "viewport");
    Overview overview;
    overview.camera = TRY(cameraFrom(message.camera()));
    if (message.has_reader()) overview.reader = TRY(cameraFrom(message.reader()));
    if (std::size_t(message.bookmarks_mm_size()) > maxOverviewBookmarks)
        return refuseView("there are too many bookmarks", "overview");
    for (const Vec3& bookmark : message.bookmarks_mm())
        overview.bookmarksMm.push_back(TRY(positionFrom(bookmark)));
    overview.path = !message.hide_path();
    overview.body = !message.hide_body();
    TRY(checkOverview(overview));
    return overview;
}

Result<ViewState> stateOf(const SetFlat& message, haustra::View view) {
    if (!isFlat(view)) return refuseView("this view shows no strip", "viewport");
    if (view == haustra::View::flattened) return WholeStrip{};
    const auto center = TRY(flatPointFrom(message.center()));
    const double scale = message.pixels_per_circumference();
    if (!(scale >= minPixelsPerCircumference && scale <= maxPixelsPerCircumference))
        return refuseView("a circumference does not have 16 to 65536 pixels", "flat");
    return FlatWindow{{center.x - std::floor(center.x), center.y}, scale};
}

// Calls `visit` with the body of an input of one viewport, or with nothing.
template <class Visit>
auto visitInput(const ClientMessage& message, const Visit& visit) {
    switch (message.body_case()) {
        case ClientMessage::kSetViewport:
            return visit(message.set_viewport());
        case ClientMessage::kSetCamera:
            return visit(message.set_camera());
        case ClientMessage::kSetSlice:
            return visit(message.set_slice());
        case ClientMessage::kSetOblique:
            return visit(message.set_oblique());
        case ClientMessage::kSetOverview:
            return visit(message.set_overview());
        case ClientMessage::kSetFlat:
            return visit(message.set_flat());
        case ClientMessage::kSetWindowLevel:
            return visit(message.set_window_level());
        case ClientMessage::kSetTransferFunction:
            return visit(message.set_transfer_function());
        default:
            return visit(std::monostate{});
    }
}

template <class Body>
void begin(Body& body, InputHeader header) {
    body.set_sequence(header.sequence);
    body.set_viewport(header.viewport);
    if constexpr (requires { body.set_moving(true); }) body.set_moving(header.moving);
}

}  // namespace

std::optional<InputHeader> inputHeader(const ClientMessage& message) {
    return visitInput(message, [](const auto& body) -> std::optional<InputHeader> {
        if constexpr (requires { body.moving(); })
            return InputHeader{body.sequence(), body.viewport(), body.moving()};
        else if constexpr (requires { body.viewport(); })
            return InputHeader{body.sequence(), body.viewport()};
        else
            return std::nullopt;
    });
}

ClientMessage viewportMessage(InputHeader header, haustra::View view, int width, int height,
                              bool lens) {
    ClientMessage message;
    SetViewport& body = *message.mutable_set_viewport();
    begin(body, header);
    body.set_view(codeOf(view));
    body.set_width(std::uint32_t(width));
    body.set_height(std::uint32_t(height));
    body.set_lens(lens);
    return message;
}

ClientMessage stateMessage(InputHeader header, const ViewState& state) {
    ClientMessage message;
    std::visit([&](const auto& shown) { begin(bodyOf(message, shown), header); }, state);
    return message;
}

ClientMessage windowMessage(InputHeader header, const haustra::WindowLevel& window) {
    ClientMessage message;
    SetWindowLevel& body = *message.mutable_set_window_level();
    begin(body, header);
    body.mutable_window()->set_center_hu(window.centerHu);
    body.mutable_window()->set_width_hu(window.widthHu);
    return message;
}

ClientMessage paintMessage(std::uint64_t sequence, const WallPaintChoice& paint) {
    ClientMessage message;
    SetWallPaint& body = *message.mutable_set_wall_paint();
    body.set_sequence(sequence);
    body.set_marks(paint.marks);
    body.set_unseen(paint.unseen);
    body.set_mark_radius_mm(paint.markRadiusMm);
    return message;
}

ClientMessage detectionMessage(std::uint64_t sequence, const DetectionChoice& choice) {
    ClientMessage message;
    SetDetection& body = *message.mutable_set_detection();
    body.set_sequence(sequence);
    for (const auto& [mode, code] : detectionModes)
        if (mode == choice.mode) body.set_mode(code);
    body.set_first_pass_done(choice.firstPassDone);
    if (choice.leastProbability) body.set_least_probability(*choice.leastProbability);
    return message;
}

Result<haustra::View> viewFrom(View view) {
    for (const ViewCode& one : viewCodes)
        if (one.code == view) return one.view;
    return refuseView("there is no view " + std::to_string(int(view)), "viewport");
}

Result<ViewState> stateFrom(const ClientMessage& message, haustra::View view) {
    return visitInput(message, [&](const auto& body) -> Result<ViewState> {
        if constexpr (requires { stateOf(body, view); })
            return stateOf(body, view);
        else
            return refuseView("the message does not say where a viewport looks", "viewport");
    });
}

Result<haustra::WindowLevel> windowFrom(const WindowLevel& message) {
    const haustra::WindowLevel window{message.center_hu(), message.width_hu()};
    TRY(checkWindow(window));
    return window;
}

Result<WallPaintChoice> paintFrom(const SetWallPaint& message) {
    WallPaintChoice choice{message.marks(), message.unseen()};
    const double radius = message.mark_radius_mm();
    if (radius == 0.0) return choice;
    if (!(radius >= minMarkRadiusMm && radius <= maxMarkRadiusMm))
        return refuseView("a mark's radius is not within 1 to 20 mm", "wall paint");
    choice.markRadiusMm = radius;
    return choice;
}

Result<DetectionChoice> detectionFrom(const SetDetection& message) {
    DetectionChoice choice;
    bool known = false;
    for (const auto& [mode, code] : detectionModes)
        if (code == message.mode()) choice.mode = mode, known = true;
    if (!known) return refuseView("there is no such mode", "detection");
    choice.firstPassDone = message.first_pass_done();
    if (!message.has_least_probability()) return choice;
    const double least = message.least_probability();
    if (!(least >= 0.0 && least <= 1.0))
        return refuseView("a probability is not within 0 to 1", "detection");
    choice.leastProbability = least;
    return choice;
}

void fill(Vec3& message, glm::dvec3 v) {
    message.set_x(v.x);
    message.set_y(v.y);
    message.set_z(v.z);
}

void fill(FlatPoint& message, glm::dvec2 flat) {
    message.set_x(flat.x);
    message.set_y(flat.y);
}

void fill(Camera& message, const haustra::Camera& camera) {
    fillCamera(message, camera);
}

glm::dvec3 vectorFrom(const Vec3& message) {
    return {message.x(), message.y(), message.z()};
}

Result<glm::dvec3> positionFrom(const Vec3& message) {
    const glm::dvec3 position = vectorFrom(message);
    if (!isPatientPoint(position))
        return refuseView("a coordinate is not a number within a kilometre", "position");
    return position;
}

Result<glm::dvec2> flatPointFrom(const FlatPoint& message) {
    const glm::dvec2 point(message.x(), message.y());
    if (!(std::abs(point.x) <= maxTurns && std::abs(point.y) <= maxFlatHeight))
        return refuseView("a coordinate is not a number, or lies far beyond the strip", "flat");
    return point;
}

Result<haustra::Camera> cameraFrom(const Camera& message) {
    return soundCamera(message);
}

void fill(Slab& message, const haustra::Slab& slab) {
    message.set_thickness_mm(slab.thicknessMm);
    message.set_projection(slab.projection == haustra::Projection::maximum ? MAXIMUM : MEAN);
}

Result<haustra::Slab> slabFrom(const Slab& message) {
    if (message.projection() != MEAN && message.projection() != MAXIMUM)
        return refuseView("there is no such projection", "slice");
    const haustra::Slab slab{message.thickness_mm(), message.projection() == MAXIMUM
                                                         ? haustra::Projection::maximum
                                                         : haustra::Projection::mean};
    TRY(checkSlab(slab));
    return slab;
}

}  // namespace haustra::protocol
