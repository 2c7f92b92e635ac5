#include "session/inputs.h"

#include "protocol/limits.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

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

}  // namespace haustra::session
