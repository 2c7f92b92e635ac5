// Panes and graphs for whoever does not see them.
#pragma once

class QWidget;

namespace haustra::window {

/// What reads the screen meets them as pictures, with a name and a description.
void describePanes();
/// Names what Qt leaves without a name in the controls of a window: lists of combo boxes, buttons
/// that clear a field, buttons for what does not fit a bar.
void nameParts(const QWidget& window);

}  // namespace haustra::window
