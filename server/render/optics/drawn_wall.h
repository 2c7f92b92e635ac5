// Whether optics show the colon's wall itself, or let the eye through it.
#pragma once

#include "render/optics/optics.h"

namespace haustra::render {

/// Of light across a wall as CT shows it, from gas at −1000 HU to tissue at 40 HU, both reached
/// within 2 mm of the surface: 10 mm of the gas stop under a half; and the wall, to 1 mm beneath
/// its surface, nine tenths, or, of a first hit, it is hit there. A maximum-intensity picture shows
/// no wall. Neither do unlit optics (shading off, or less than a tenth of the lamp's light sent
/// back by `diffuse`, or half of it gone within 10 mm), nor what is darker than a tenth of full
/// display brightness: no relief is seen on them. So the built-in `mucosa`, `surface` and `skin`
/// do, and `biopsy`, `translucent` and `tissue-borders` do not. The optics have passed checkOptics.
/// Some microseconds.
bool drawsWall(const Optics& optics);

}  // namespace haustra::render
