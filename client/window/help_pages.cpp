#include "window/help_pages.h"

#include "window/commands.h"
#include "window/reading.h"

#include <QCheckBox>
#include <QCoreApplication>
#include <QDialogButtonBox>
#include <QHeaderView>
#include <QKeySequenceEdit>
#include <QLabel>
#include <QMessageBox>
#include <QPushButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <array>

namespace haustra::window {
namespace {

struct Gesture {
    const char *hand, *meaning;
};
constexpr std::array gestures = {
    Gesture{QT_TRANSLATE_NOOP("Help", "click in any view"),
            QT_TRANSLATE_NOOP("Help", "go to that place, in all views")},
    Gesture{QT_TRANSLATE_NOOP("Help", "drag the endoscopic view"),
            QT_TRANSLATE_NOOP("Help", "look around; double-click: straight ahead")},
    Gesture{QT_TRANSLATE_NOOP("Help", "wheel on the endoscopic view"),
            QT_TRANSLATE_NOOP(
                "Help", "move along the path; with Shift farther; with Ctrl the field of view")},
    Gesture{QT_TRANSLATE_NOOP("Help", "Alt wheel on the endoscopic view"),
            QT_TRANSLATE_NOOP("Help", "size of the lens, where it is on")},
    Gesture{QT_TRANSLATE_NOOP("Help", "drag a slice"),
            QT_TRANSLATE_NOOP("Help", "window (across) and centre (up, down)")},
    Gesture{QT_TRANSLATE_NOOP("Help", "middle or right drag on a slice"),
            QT_TRANSLATE_NOOP("Help", "move the picture")},
    Gesture{QT_TRANSLATE_NOOP("Help", "wheel on a slice"),
            QT_TRANSLATE_NOOP("Help", "scroll; with Ctrl enlarge; with Shift ten times as far")},
    Gesture{
        QT_TRANSLATE_NOOP("Help", "arrows while the keys point"),
        QT_TRANSLATE_NOOP("Help",
                          "move the pointer; with Shift farther, with Ctrl by one pixel; Return "
                          "clicks, or begins and ends a line or an outline")},
    Gesture{
        QT_TRANSLATE_NOOP("Help", "keys on the transfer function"),
        QT_TRANSLATE_NOOP(
            "Help", "N, P: next, previous point; arrows: move it; Insert, Delete: add, take it")},
    Gesture{QT_TRANSLATE_NOOP("Help", "Shift, Ctrl drag"),
            QT_TRANSLATE_NOOP("Help", "measure a line, an ellipse or an outline")},
    Gesture{QT_TRANSLATE_NOOP("Help", "drag the overview"),
            QT_TRANSLATE_NOOP("Help", "turn it; wheel: enlarge; double-click: from the front")},
    Gesture{QT_TRANSLATE_NOOP("Help", "click a bookmark"), QT_TRANSLATE_NOOP("Help", "go there")},
    Gesture{QT_TRANSLATE_NOOP("Help", "drag the strip"), QT_TRANSLATE_NOOP("Help", "look it over")},
    Gesture{QT_TRANSLATE_NOOP("Help", "drag the flattened wall"),
            QT_TRANSLATE_NOOP("Help", "move it; wheel: enlarge")},
    Gesture{QT_TRANSLATE_NOOP("Help", "press the track"),
            QT_TRANSLATE_NOOP("Help", "go to that place along the path")},
    Gesture{QT_TRANSLATE_NOOP("Help", "Alt drag in a view"),
            QT_TRANSLATE_NOOP("Help", "take its picture into another program")},
    Gesture{QT_TRANSLATE_NOOP("Help", "right click in a view"),
            QT_TRANSLATE_NOOP("Help", "what else can be done there")},
};

QString keysText(const QAction& action) {
    QStringList keys;
    for (const QKeySequence& key : action.shortcuts())
        keys += key.toString(QKeySequence::NativeText);
    return keys.join(QStringLiteral("   "));
}

QTreeWidget* listOf(const QStringList& headings) {
    auto* list = new QTreeWidget;
    list->setHeaderLabels(headings);
    list->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    list->header()->setStretchLastSection(true);
    return list;
}

QTreeWidgetItem* groupOf(QTreeWidget* list, const QString& name) {
    auto* group = new QTreeWidgetItem(list, {name});
    group->setFirstColumnSpanned(true);
    group->setExpanded(true);
    QFont bold = list->font();
    bold.setBold(true);
    group->setFont(0, bold);
    group->setFlags(Qt::ItemIsEnabled);
    return group;
}

QString plain(QString menu) {
    return menu.remove('&');
}

}  // namespace

HelpPage::HelpPage(const CommandSet& commands, QWidget* parent) : QDialog(parent) {
    setWindowTitle(tr("Keys and mouse"));
    setAttribute(Qt::WA_DeleteOnClose);
    auto* list = listOf({tr("Key"), tr("Meaning")});
    list->setAccessibleName(tr("Keys and mouse"));
    for (std::size_t menu = 0; menu < menuCount; ++menu) {
        auto* group = groupOf(list, plain(nameOf(Menu(menu))));
        for (const Command& command : window::commands())
            if (command.menu == Menu(menu))
                new QTreeWidgetItem(group, {keysText(*commands.action(command)), textOf(command)});
    }
    auto* mouse = groupOf(list, tr("Mouse"));
    for (const Gesture& gesture : gestures)
        new QTreeWidgetItem(mouse, {QCoreApplication::translate("Help", gesture.hand),
                                    QCoreApplication::translate("Help", gesture.meaning)});
    auto* note = new QLabel(tr("For a physician's judgement; not a certified medical device."));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
    auto* column = new QVBoxLayout(this);
    column->addWidget(list, 1);
    column->addWidget(note);
    column->addWidget(buttons);
    resize(760, 720);
}

KeysDialog::KeysDialog(CommandSet& commands, QWidget* parent)
    : QDialog(parent), commands_(commands), list_(listOf({tr("Command"), tr("Keys")})) {
    setWindowTitle(tr("Change the keys"));
    setAttribute(Qt::WA_DeleteOnClose);
    list_->setAccessibleName(tr("Commands and their keys"));
    auto* change = new QPushButton(tr("Change…"));
    auto* reset = new QPushButton(tr("All as they were at first"));
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
    buttons->addButton(change, QDialogButtonBox::ActionRole);
    buttons->addButton(reset, QDialogButtonBox::ResetRole);
    connect(change, &QPushButton::clicked, this, &KeysDialog::change);
    connect(list_, &QTreeWidget::itemActivated, this, &KeysDialog::change);
    connect(reset, &QPushButton::clicked, this, [this] {
        commands_.resetKeys();
        fill();
    });
    connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
    auto* column = new QVBoxLayout(this);
    column->addWidget(list_, 1);
    column->addWidget(buttons);
    fill();
    resize(680, 640);
}

void KeysDialog::fill() {
    const int row = list_->currentItem() ? list_->currentItem()->data(0, Qt::UserRole).toInt() : -1;
    list_->clear();
    for (std::size_t menu = 0; menu < menuCount; ++menu) {
        auto* group = groupOf(list_, plain(nameOf(Menu(menu))));
        for (std::size_t n = 0; n < window::commands().size(); ++n) {
            const Command& command = window::commands()[n];
            if (command.menu != Menu(menu)) continue;
            auto* item =
                new QTreeWidgetItem(group, {textOf(command), keysText(*commands_.action(command))});
            item->setData(0, Qt::UserRole, int(n));
            if (int(n) == row) list_->setCurrentItem(item);
        }
    }
}

void KeysDialog::change() {
    const QTreeWidgetItem* item = list_->currentItem();
    if (!item || !item->data(0, Qt::UserRole).isValid()) return;
    const Command& command = window::commands()[std::size_t(item->data(0, Qt::UserRole).toInt())];
    QDialog dialog(this);
    dialog.setWindowTitle(textOf(command));
    auto* keys = new QKeySequenceEdit;
    keys->setAccessibleName(tr("The new key"));
    auto* hint = new QLabel(
        tr("Press the new key for “%1”. An empty field means: no key.").arg(textOf(command)));
    const QList<QKeySequence> former = commands_.action(command)->shortcuts();
    auto* keep = new QCheckBox(
        tr("keep the keys that it has: %1").arg(keysText(*commands_.action(command))));
    keep->setVisible(!former.isEmpty());
    auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    auto* clear = buttons->addButton(tr("No key"), QDialogButtonBox::ActionRole);
    connect(clear, &QPushButton::clicked, keys, &QKeySequenceEdit::clear);
    connect(buttons, &QDialogButtonBox::accepted, &dialog, &QDialog::accept);
    connect(buttons, &QDialogButtonBox::rejected, &dialog, &QDialog::reject);
    auto* column = new QVBoxLayout(&dialog);
    column->addWidget(hint);
    column->addWidget(keys);
    column->addWidget(keep);
    column->addWidget(buttons);
    keys->setFocus();
    if (dialog.exec() != QDialog::Accepted) return;
    const QKeySequence chosen = keys->keySequence();
    if (command.isHeld() && !chosen.isEmpty() &&
        (chosen.count() > 1 || chosen[0].keyboardModifiers() != Qt::NoModifier)) {
        QMessageBox::information(
            this, textOf(command),
            tr("This is a key to be held: one key, without Shift, Ctrl or Alt."));
        return;
    }
    for (const Command& other : window::commands()) {
        QList<QKeySequence> held = commands_.action(other)->shortcuts();
        if (&other == &command || chosen.isEmpty() || !held.contains(chosen)) continue;
        const auto answer = QMessageBox::question(
            this, tr("The key is taken"),
            tr("%1 is the key of “%2”. Take it from there?")
                .arg(chosen.toString(QKeySequence::NativeText), textOf(other)),
            QMessageBox::Yes | QMessageBox::No, QMessageBox::No);
        if (answer != QMessageBox::Yes) return;
        held.removeAll(chosen);
        commands_.setKeys(other, held);
    }
    QList<QKeySequence> wanted = keep->isChecked() ? former : QList<QKeySequence>();
    if (!chosen.isEmpty() && !wanted.contains(chosen)) wanted += chosen;
    commands_.setKeys(command, wanted);
    fill();
}

void showAbout(QWidget* parent, const Reading& reading) {
    const link::LinkUp& server = reading.reader().session().server();
    QString about = QStringLiteral("<h3>Haustra</h3><p>") +
                    QCoreApplication::applicationVersion().toHtmlEscaped() +
                    QStringLiteral("</p><p>") +
                    HelpPage::tr(
                        "Virtual colonoscopy. For a physician's judgement; not a certified medical "
                        "device.") +
                    QStringLiteral("</p><p>");
    const auto line = [&](const QString& name, const QString& value) {
        if (!value.isEmpty())
            about += name + QStringLiteral(": ") + value.toHtmlEscaped() + QStringLiteral("<br>");
    };
    line(HelpPage::tr("Server"), reading.serverName());
    line(HelpPage::tr("Software"), text(server.serverSoftware));
    line(HelpPage::tr("Renderer"), text(server.renderer));
    line(HelpPage::tr("Certificate"), text(server.fingerprint));
    QMessageBox box(QMessageBox::NoIcon, HelpPage::tr("About Haustra"),
                    about + QStringLiteral("</p>"), QMessageBox::Close, parent);
    box.setTextFormat(Qt::RichText);
    box.exec();
}

}  // namespace haustra::window
