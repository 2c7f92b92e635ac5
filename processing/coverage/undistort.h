// A lens' picture as a pinhole camera would have taken it.
#pragma once

#include "core/image.h"
#include "coverage/fisheye_lens.h"

namespace haustra::coverage {

/// What a pinhole camera in the lens' place sees, in a picture of the same size: straight edges
/// come out straight. Its axis is the lens', its middle the picture's, and its shorter side shows
/// what the lens shows from side to side there, 110° at most. Between pixels by their four
/// neighbours; black where the lens shows nothing. Cost: a projection a pixel; any thread.
Image undistorted(const Image& picture, const FisheyeLens& lens);

}  // namespace haustra::coverage
