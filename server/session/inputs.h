// Values from the network, checked. Every failure is badInput and names no patient.
#pragma once

#include "core/result.h"
#include "protocol/haustra.pb.h"
#include "records/bookmarks.h"
#include "render/optics/optics_presets.h"
#include "render/picture.h"
#include "session/wall_reading.h"

#include <string>

namespace haustra::session {

inline constexpr int minViewportPixels = 16;
inline constexpr std::size_t maxNoteBytes = 2000;
inline constexpr std::size_t maxClientKeyBytes = 64;
inline constexpr double maxCoordinateMm = 1e6;
inline constexpr double maxTurns = 1e6;
inline constexpr double minPixelsPerCircumference = 16.0, maxPixelsPerCircumference = 65536.0;

/// Each coordinate finite and at most maxCoordinateMm from the origin.
Result<glm::dvec3> positionFrom(const protocol::Vec3& message);

/// Position, directions, lens and field of view or height as render::checkCamera has it.
Result<render::Camera> cameraFrom(const protocol::SetCamera& message);
Result<render::Camera> cameraFrom(const protocol::Camera& message);

/// The plane, without window; as render::placeSlice has it.
Result<render::ObliqueView> obliqueFrom(const protocol::SetOblique& message);

/// What is shown, without optics; as render::checkOverview has it.
Result<render::OverviewView> overviewFrom(const protocol::SetOverview& message);

/// Both finite, |x| at most maxTurns, |y| at most maxFlatHeight; x stays as it is.
Result<glm::dvec2> flatPointFrom(const protocol::FlatPoint& message);

/// The window onto the strip, its x in [0, 1).
Result<FlatWindow> flatWindowFrom(const protocol::SetFlat& message);

/// Fails where there is no such view.
Result<void> checkView(protocol::View view);

/// One of the presets by name, or optics of the client's own; not both.
Result<Optics> opticsFrom(const protocol::SetTransferFunction& message,
                          const render::PresetLibrary& presets);

/// A radius of 0 is the usual one; fails where it is out of bounds.
Result<WallPaintChoice> paintChoiceFrom(const protocol::SetWallPaint& message);

/// A camera's place with finite arc; the note is at most maxNoteBytes without control characters
/// but line feed and tab; the key is 1 to maxClientKeyBytes of visible ASCII.
Result<records::NewBookmark> bookmarkFrom(const protocol::AddBookmark& message,
                                          const std::string& caseName, const std::string& scan);

}  // namespace haustra::session
