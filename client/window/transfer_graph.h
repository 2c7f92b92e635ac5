// A transfer function's points over a scan's values, as a picture that a hand changes.
#pragma once

#include "window/ui.h"

namespace haustra::window {

/// Draws the row that is being edited within `area`, over the scan's histogram, and acts on what
/// the hand does there: a drag moves a point, a double click adds one, a right click takes one, the
/// wheel enlarges the axis of values, a drag beside the points moves it.
void drawTransferGraph(Ui& ui, Rect area);

/// The axis as wide as the points, with something on either side.
void fitTransferAxis(Ui& ui);

}  // namespace haustra::window
