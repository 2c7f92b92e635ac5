// Values from the network that are neither views (protocol/view_message.h) nor optics of their own,
// checked. Every failure is badInput and names no patient.
#pragma once

#include "core/result.h"
#include "protocol/haustra.pb.h"
#include "records/bookmarks.h"
#include "render/optics/optics_presets.h"

#include <string>

namespace haustra::session {

/// One of the presets by name, or optics of the client's own; not both.
Result<Optics> opticsFrom(const protocol::SetTransferFunction& message,
                          const render::PresetLibrary& presets);

/// A camera's place with finite arc; the note is at most protocol::maxNoteBytes without control
/// characters but line feed and tab; the key is 1 to protocol::maxClientKeyBytes of visible ASCII.
Result<records::NewBookmark> bookmarkFrom(const protocol::AddBookmark& message,
                                          const std::string& caseName, const std::string& scan);

}  // namespace haustra::session
