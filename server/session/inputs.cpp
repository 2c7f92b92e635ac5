#include "session/inputs.h"

#include "core/flat_map.h"
#include "protocol/optics_message.h"

#include <algorithm>
#include <cmath>

namespace haustra::session {
namespace {

tl::unexpected<Error> refuse(std::string message, const char* place) {
    return fail(ErrorKind::badInput, std::move(message), place);
}

glm::dvec3 vectorFrom(const protocol::Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

// Of a SetCamera or a Camera.
template <class Message>
Result<render::Camera> soundCamera(const Message& message) {
    const auto position = TRY(positionFrom(message.position_mm()));
    render::Camera camera{position, vectorFrom(message.forward()), vectorFrom(message.up())};
    switch (message.lens()) {
        case protocol::PERSPECTIVE:
            break;
        case protocol::FISHEYE:
            camera.lens = render::Lens::fisheye;
            break;
        case protocol::ORTHOGRAPHIC:
            camera.lens = render::Lens::orthographic;
            camera.heightMm = message.height_mm();
            break;
        default:
            return refuse("there is no such lens", "camera");
    }
    // The field of view of an orthographic camera has no meaning, and keeps its default.
    if (camera.lens != render::Lens::orthographic) camera.fovDegrees = message.fov_degrees();
    TRY(render::checkCamera(camera));
    return camera;
}

bool isControl(char c) {
    const auto code = static_cast<unsigned char>(c);
    return (code < 0x20 && c != '\n' && c != '\t') || code == 0x7f;
}

bool isVisibleAscii(char c) {
    return c > 0x20 && c < 0x7f;
}

}  // namespace

Result<glm::dvec3> positionFrom(const protocol::Vec3& message) {
    const glm::dvec3 position = vectorFrom(message);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(position[axis]) <= maxCoordinateMm))
            return refuse("a coordinate is not a number within a kilometre", "position");
    return position;
}

Result<render::Camera> cameraFrom(const protocol::SetCamera& message) {
    return soundCamera(message);
}

Result<render::Camera> cameraFrom(const protocol::Camera& message) {
    return soundCamera(message);
}

Result<render::ObliqueView> obliqueFrom(const protocol::SetOblique& message) {
    const auto position = TRY(positionFrom(message.position_mm()));
    render::ObliqueView view;
    view.positionMm = position;
    view.forward = vectorFrom(message.forward());
    view.up = vectorFrom(message.up());
    view.heightMm = message.height_mm();
    view.scan = message.cleansed() ? render::Scan::cleansed : render::Scan::original;
    TRY(render::placeSlice(view, minViewportPixels, minViewportPixels));
    return view;
}

Result<render::OverviewView> overviewFrom(const protocol::SetOverview& message) {
    render::OverviewView view;
    const auto camera = TRY(cameraFrom(message.camera()));
    view.camera = camera;
    if (message.has_reader()) {
        const auto reader = TRY(cameraFrom(message.reader()));
        view.reader = reader;
    }
    if (std::size_t(message.bookmarks_mm_size()) > render::maxOverviewBookmarks)
        return refuse("there are too many bookmarks", "overview");
    for (const protocol::Vec3& bookmark : message.bookmarks_mm()) {
        const auto position = TRY(positionFrom(bookmark));
        view.bookmarksMm.push_back(position);
    }
    view.path = !message.hide_path();
    view.body = !message.hide_body();
    TRY(render::checkOverview(view));
    return view;
}

Result<glm::dvec2> flatPointFrom(const protocol::FlatPoint& message) {
    const glm::dvec2 point(message.x(), message.y());
    if (!(std::abs(point.x) <= maxTurns && std::abs(point.y) <= maxFlatHeight))
        return refuse("a coordinate is not a number, or lies far beyond the strip", "flat");
    return point;
}

Result<FlatWindow> flatWindowFrom(const protocol::SetFlat& message) {
    const auto center = TRY(flatPointFrom(message.center()));
    const double scale = message.pixels_per_circumference();
    if (!(scale >= minPixelsPerCircumference && scale <= maxPixelsPerCircumference))
        return refuse("a circumference does not have 16 to 65536 pixels", "flat");
    return FlatWindow{{center.x - std::floor(center.x), center.y}, scale};
}

Result<void> checkView(protocol::View view) {
    if (view == protocol::VIEW_UNSPECIFIED || !protocol::View_IsValid(view))
        return refuse("there is no view " + std::to_string(int(view)), "viewport");
    return {};
}

Result<Optics> opticsFrom(const protocol::SetTransferFunction& message,
                          const render::PresetLibrary& presets) {
    if (message.preset().empty() != message.has_optics())
        return refuse("either a preset or optics are needed", "transfer function");
    if (message.has_optics()) return protocol::opticsFrom(message.optics());
    const OpticsPreset* preset = presets.find(message.preset());
    if (!preset) return refuse("there is no such preset", "transfer function");
    return preset->optics;
}

Result<WallPaintChoice> paintChoiceFrom(const protocol::SetWallPaint& message) {
    WallPaintChoice choice{message.marks(), message.unseen()};
    const double radius = message.mark_radius_mm();
    if (radius == 0.0) return choice;
    if (!(radius >= render::minMarkRadiusMm && radius <= render::maxMarkRadiusMm))
        return refuse("a mark's radius is not within 1 to 20 mm", "wall paint");
    choice.markRadiusMm = radius;
    return choice;
}

Result<records::NewBookmark> bookmarkFrom(const protocol::AddBookmark& message,
                                          const std::string& caseName, const std::string& scan) {
    const auto position = TRY(positionFrom(message.position_mm()));
    const render::Camera camera{position, vectorFrom(message.forward()), vectorFrom(message.up())};
    TRY(render::checkCamera(camera));
    if (!(std::abs(message.arc_mm()) <= maxCoordinateMm))
        return refuse("the arc is not a number within a kilometre", "bookmark");
    const std::string& note = message.note();
    if (note.size() > maxNoteBytes)
        return refuse("the note has more than " + std::to_string(maxNoteBytes) + " bytes",
                      "bookmark");
    if (std::any_of(note.begin(), note.end(), isControl))
        return refuse("the note holds a control character", "bookmark");
    const std::string& key = message.client_key();
    if (key.empty() || key.size() > maxClientKeyBytes ||
        !std::all_of(key.begin(), key.end(), isVisibleAscii))
        return refuse("the client key is not 1 to " + std::to_string(maxClientKeyBytes) +
                          " visible ASCII characters",
                      "bookmark");
    return records::NewBookmark{
        caseName, scan, key, camera.positionMm, camera.forward, camera.up, message.arc_mm(), note};
}

}  // namespace haustra::session
