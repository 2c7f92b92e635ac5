// Where the parts of the window lie.
#pragma once

#include "window/ui.h"

namespace haustra::window {

/// As dissertation §6.3.2 arranges them: slices at the left, the endoscopic view in the middle, the
/// flattened strip to its right and the window onto it below; at the right the overview, the slice
/// across the gaze and the bookmarks. Without a flattened colon the endoscopic view takes the place
/// of both its pictures.
struct Layout {
    Rect top, transport, middle;  ///< `middle`: all between the two bars
    Rect axial, coronal, sagittal, endoscopic, strip, zoom, overview, oblique, bookmarks;
};
Layout layOut(const Ui& ui, ImVec2 size);

}  // namespace haustra::window
