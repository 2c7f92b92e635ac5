// The page of keys, the dialog that changes them, and what the program says of itself.
#pragma once

#include <QDialog>

class QTreeWidget;

namespace haustra::window {

class CommandSet;
class Reading;

/// Keys as they are now, and what the mouse does.
class HelpPage : public QDialog {
    Q_OBJECT
public:
    HelpPage(const CommandSet& commands, QWidget* parent);
};

/// A key for each command; a key that another command has is taken from it only after asking.
class KeysDialog : public QDialog {
    Q_OBJECT
public:
    KeysDialog(CommandSet& commands, QWidget* parent);

private:
    void fill();
    void change();

    CommandSet& commands_;
    QTreeWidget* list_;
};

void showAbout(QWidget* parent, const Reading& reading);

}  // namespace haustra::window
