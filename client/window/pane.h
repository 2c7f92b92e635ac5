// What the panes with pictures share.
#pragma once

#include "window/ui.h"

namespace haustra::window {

/// Black over `area`, and a dim note where the view has no picture yet. False then. Uploads the
/// newest picture otherwise.
bool preparePicture(Ui& ui, View view, Rect area, ImDrawList* list);
/// The view's newest picture over all of `area`.
void drawPicture(Ui& ui, View view, Rect area, ImDrawList* list);
/// Dims `area` where the view's picture is old (Freshness::old): nothing follows the hand there.
void dimOldPicture(Ui& ui, View view, Rect area, ImDrawList* list);
/// An invisible button that takes the mouse over the pane; Ui::drag grows while it is held. True
/// while the mouse is over it.
bool pane(Ui& ui, const char* id, Rect area);
glm::ivec2 framebufferSize(Rect area);
/// A drag across a slice: the window's width; up and down: its centre.
void dragWindow(reader::Reader& reader, ImVec2 moved);
/// The mark of the place on the wall that the reader has picked.
void drawPickedCross(Ui& ui, ImDrawList* list, ImVec2 p);

}  // namespace haustra::window
