#include "window/chosen_items.h"

#include <QKeyEvent>
#include <QTreeWidget>
#include <utility>

namespace haustra::window {
namespace {

class EnterKey : public QObject {
public:
    EnterKey(QTreeWidget& list, std::function<void(QTreeWidgetItem&)> choose)
        : QObject(&list), list_(list), choose_(std::move(choose)) {}

    bool eventFilter(QObject*, QEvent* event) override {
        if (event->type() != QEvent::KeyPress) return false;
        const int key = static_cast<QKeyEvent*>(event)->key();
        if ((key != Qt::Key_Return && key != Qt::Key_Enter) || !list_.currentItem()) return false;
        choose_(*list_.currentItem());
        return true;
    }

private:
    QTreeWidget& list_;
    std::function<void(QTreeWidgetItem&)> choose_;
};

}  // namespace

void onChosen(QTreeWidget& list, std::function<void(QTreeWidgetItem&)> choose) {
    QObject::connect(&list, &QTreeWidget::itemClicked, &list,
                     [choose](QTreeWidgetItem* item) { choose(*item); });
    list.installEventFilter(new EnterKey(list, std::move(choose)));
}

}  // namespace haustra::window
