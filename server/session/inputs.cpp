#include "session/inputs.h"

#include "core/flat_map.h"

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
    const auto position = positionFrom(message.position_mm());
    if (!position) return tl::make_unexpected(position.error());
    const render::Camera camera{*position, vectorFrom(message.forward()), vectorFrom(message.up()),
                                message.fov_degrees()};
    if (const auto checked = render::checkCamera(camera); !checked)
        return tl::make_unexpected(checked.error());
    return camera;
}

Result<glm::dvec2> flatPointFrom(const protocol::FlatPoint& message) {
    const glm::dvec2 point(message.x(), message.y());
    if (!(std::abs(point.x) <= maxTurns && std::abs(point.y) <= maxFlatHeight))
        return refuse("a coordinate is not a number, or lies far beyond the strip", "flat");
    return point;
}

Result<FlatWindow> flatWindowFrom(const protocol::SetFlat& message) {
    const auto center = flatPointFrom(message.center());
    if (!center) return tl::make_unexpected(center.error());
    const double scale = message.pixels_per_circumference();
    if (!(scale >= minPixelsPerCircumference && scale <= maxPixelsPerCircumference))
        return refuse("a circumference does not have 16 to 65536 pixels", "flat");
    return FlatWindow{{center->x - std::floor(center->x), center->y}, scale};
}

Result<void> checkView(protocol::View view) {
    if (view == protocol::VIEW_UNSPECIFIED || !protocol::View_IsValid(view))
        return refuse("there is no view " + std::to_string(int(view)), "viewport");
    return {};
}

Result<render::Optics> opticsFrom(const protocol::SetTransferFunction& message) {
    if (message.preset().empty() == message.points().empty())
        return refuse("either a preset or points are needed", "transfer function");
    if (!message.preset().empty()) return render::opticsPreset(message.preset());
    render::Optics optics;
    for (const auto& point : message.points())
        optics.transferFunction.points.push_back(
            {point.hu(), {point.red(), point.green(), point.blue()}, point.opacity()});
    if (const auto checked = render::checkOptics(optics); !checked)
        return tl::make_unexpected(checked.error());
    return optics;
}

Result<records::NewBookmark> bookmarkFrom(const protocol::AddBookmark& message,
                                          const std::string& caseName) {
    const auto position = positionFrom(message.position_mm());
    if (!position) return tl::make_unexpected(position.error());
    const render::Camera camera{*position, vectorFrom(message.forward()), vectorFrom(message.up())};
    if (const auto checked = render::checkCamera(camera); !checked)
        return tl::make_unexpected(checked.error());
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
    return records::NewBookmark{caseName,         key, camera.positionMm, camera.forward, camera.up,
                                message.arc_mm(), note};
}

}  // namespace haustra::session
