// Items of a list that lead somewhere.
#pragma once

#include <functional>

class QTreeWidget;
class QTreeWidgetItem;

namespace haustra::window {

/// Calls `choose` with an item that is clicked, and with the current one when Enter is pressed in
/// the list. Once of a double click, which Qt tells of as a click and an activation, so that it is
/// one step to be undone.
void onChosen(QTreeWidget& list, std::function<void(QTreeWidgetItem&)> choose);

}  // namespace haustra::window
