// The colon of the fake server: a spiral tube, and its strip.
#pragma once

#include "core/centerline.h"
#include "protocol/haustra.pb.h"

#include <glm/glm.hpp>

namespace haustra::tests {

inline constexpr double fakeRadiusMm = 15.0, fakeCircumferenceMm = 90.0, fakeStripHeight = 6.0;

Centerline fakeCenterline();
/// y grows evenly with the arc.
protocol::FlatStrip fakeStrip();
/// The place at a flat coordinate: fakeRadiusMm away from the path, at the angle 2πx in the
/// patient's axial plane.
protocol::WallPlace fakePlace(glm::dvec2 flat);
/// The answer to LocateFlat, LocatePoint (at x = ¼ of the nearest place of the path) or
/// MeasureFlat (as on a cylinder), a refusal where the place is not on the strip.
protocol::ServerMessage aboutFakeWall(const protocol::ClientMessage& question);

/// What a bookmark at an arc means: the place across from what LocatePoint finds.
protocol::WallPlace fakeMark(double arcMm);
/// The wall is fakeRadiusMm from the camera wherever it looks; a ray straight down (−z) meets
/// nothing, and is refused.
protocol::ServerMessage fakePick(const protocol::PickWall& question, bool flattened);
/// What is told of the case's findings after this choice: two and, between them along the colon, a
/// candidate (number 3, 0.3 probable) at the places of fakePlace where x = ¼, a third, a half and
/// two thirds of the way up the strip. The candidate has a view, which is not on the path.
protocol::FindingList fakeFindings(const protocol::SetDetection& choice);
/// Three patches at the places of fakePlace where y is 1, 4 and 5, of 900, 600 and 400 mm²; the
/// first two with a view, from fakeRadiusMm / 2 off the path.
protocol::MissedList fakeMissed();
/// Of a scan whose value at (x, y, z) mm is 2x + 3y + z HU, 1000 more where it is cleansed: what
/// is known of it without sampling.
protocol::ScanStatistics fakeStatistics(const protocol::MeasureScan& question);

}  // namespace haustra::tests
