#include "window/accessible_panes.h"

#include <QAbstractItemView>
#include <QAccessibleWidget>
#include <QComboBox>
#include <QCoreApplication>
#include <QLineEdit>
#include <QToolBar>
#include <QToolButton>
#include <QWidget>

namespace haustra::window {
namespace {

// Qt asks for each class that an object is of, the last derived first.
QAccessibleInterface* describe(const QString& className, QObject* object) {
    auto* widget = qobject_cast<QWidget*>(object);
    const bool isPicture = className == QStringLiteral("haustra::window::Pane") ||
                           className == QStringLiteral("haustra::window::TransferGraph");
    return widget && isPicture ? new QAccessibleWidget(widget, QAccessible::Graphic) : nullptr;
}

}  // namespace

void describePanes() {
    QAccessible::installFactory(describe);
}

void nameParts(const QWidget& window) {
    for (const QComboBox* box : window.findChildren<QComboBox*>())
        box->view()->setAccessibleName(box->accessibleName());
    for (const QLineEdit* field : window.findChildren<QLineEdit*>())
        for (QToolButton* button : field->findChildren<QToolButton*>())
            button->setAccessibleName(QCoreApplication::translate("Help", "Clear the field"));
    for (const QToolBar* bar : window.findChildren<QToolBar*>())
        if (auto* more = bar->findChild<QToolButton*>(QStringLiteral("qt_toolbar_ext_button")))
            more->setAccessibleName(QCoreApplication::translate("Help", "What does not fit"));
}

}  // namespace haustra::window
