// What the server says, as messages and as frames.
#pragma once

#include "protocol/haustra.pb.h"
#include "records/bookmarks.h"
#include "render/optics/optics_presets.h"
#include "session/open_case.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haustra::session {

/// The message as a frame. One over the protocol's bound becomes an INTERNAL error.
std::vector<std::uint8_t> frameOf(const protocol::ServerMessage& message);

protocol::ServerMessage errorMessage(protocol::ErrorReport::Code code, const std::string& message,
                                     bool fatal, std::uint64_t request = 0);

protocol::ServerMessage caseOpenedMessage(const OpenCase& opened,
                                          const render::PresetLibrary& presets);

void fill(protocol::Bookmark& message, const records::Bookmark& bookmark);

}  // namespace haustra::session
