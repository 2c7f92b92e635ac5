// Views as messages: both ends of the link speak of them. Whatever comes from a message is checked
// here against PROTOCOL.md §4, so that beyond this file there are sound values alone; every failure
// is badInput and names no patient.
#pragma once

#include "core/detection_choice.h"
#include "core/result.h"
#include "core/view.h"
#include "protocol/haustra.pb.h"

#include <cstdint>
#include <optional>

namespace haustra::protocol {

/// What every input of a viewport says first.
struct InputHeader {
    std::uint64_t sequence = 0;  ///< that the answering picture will reach
    std::uint32_t viewport = 0;
    bool moving = false;  ///< the hand is not at rest; window level and colours do not tell
};
/// None of a message that is no input of one viewport.
std::optional<InputHeader> inputHeader(const ClientMessage& message);

// ---- inputs, as the client says them

/// `lens`: its pictures are laid over another's, of an endoscopic view.
ClientMessage viewportMessage(InputHeader header, haustra::View view, int width, int height,
                              bool lens = false);
/// Where a viewport looks: SetCamera, SetSlice, SetOblique, SetOverview or SetFlat. A slice's
/// plane is the viewport's; windows go by a message of their own.
ClientMessage stateMessage(InputHeader header, const ViewState& state);
ClientMessage windowMessage(InputHeader header, const haustra::WindowLevel& window);
ClientMessage paintMessage(std::uint64_t sequence, const WallPaintChoice& paint);
ClientMessage detectionMessage(std::uint64_t sequence, const DetectionChoice& choice);

// ---- and as the server understands them

Result<haustra::View> viewFrom(View view);
/// Fails where the message does not say where a viewport of this view looks, or not soundly. A
/// flat window's x is in [0, 1). Windows of grey values have their defaults.
Result<ViewState> stateFrom(const ClientMessage& message, haustra::View view);
Result<haustra::WindowLevel> windowFrom(const WindowLevel& message);
/// A radius of 0 is the usual one.
Result<WallPaintChoice> paintFrom(const SetWallPaint& message);
/// Fails on a mode that there is not, or what is no probability.
Result<DetectionChoice> detectionFrom(const SetDetection& message);

// ---- what they are made of

void fill(Vec3& message, glm::dvec3 v);
void fill(FlatPoint& message, glm::dvec2 flat);
void fill(Camera& message, const haustra::Camera& camera);
void fill(Slab& message, const haustra::Slab& slab);
/// Of whatever message has a place, a gaze and what is up in it.
template <class Message, class Pose>
void fillPose(Message& message, const Pose& pose) {
    fill(*message.mutable_position_mm(), pose.positionMm);
    fill(*message.mutable_forward(), pose.forward);
    fill(*message.mutable_up(), pose.up);
}

/// Not checked.
glm::dvec3 vectorFrom(const Vec3& message);
/// Each coordinate finite and at most maxCoordinateMm from the origin.
Result<glm::dvec3> positionFrom(const Vec3& message);
/// Both finite, |x| at most maxTurns, |y| at most maxFlatHeight; x stays as it is.
Result<glm::dvec2> flatPointFrom(const FlatPoint& message);
/// Position, directions, lens and field of view or height as checkCamera has it.
Result<haustra::Camera> cameraFrom(const Camera& message);
/// Fails on a projection that there is not, or a thickness out of range.
Result<haustra::Slab> slabFrom(const Slab& message);

}  // namespace haustra::protocol
