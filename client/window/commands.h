// The one table of what the window can be told to do: menus, buttons, keys and the page of keys are
// made of it.
#pragma once

#include "window/icons.h"

#include <QAction>
#include <QKeySequence>
#include <QObject>
#include <QString>
#include <map>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::window {

class ReaderWindow;

enum class Menu { file, edit, view, pane, flight, slices, wall, findings, bookmarks, help };
inline constexpr std::size_t menuCount = 10;
QString nameOf(Menu menu);

struct Command {
    const char* id;  ///< what the settings keep
    Menu menu;
    const char* text;  ///< to be translated (context "Commands")
    const char* keys;  ///< of old; several with a blank between
    Symbol symbol = Symbol::none;
    bool needsCase = true;
    void (*run)(ReaderWindow& window) = nullptr;
    /// Of what is on or off.
    bool (*isOn)(ReaderWindow& window) = nullptr;
    bool separatorBefore = false;
    const char* shortText = nullptr;  ///< on a button; to be translated as `text`
    /// Of free flight, instead of `run`: right, up and forward, as long as the key is held.
    glm::dvec3 heldWay{0.0};

    bool isHeld() const { return heldWay != glm::dvec3(0.0); }
};
std::span<const Command> commands();
QString textOf(const Command& command);

/// The commands as actions of a window, with the keys that the reader has chosen (the settings'
/// "keys/<id>") or those of old.
class CommandSet : public QObject {
    Q_OBJECT
public:
    explicit CommandSet(ReaderWindow& window);

    QAction* action(const char* id) const { return actions_.at(id); }
    QAction* action(const Command& command) const { return actions_.at(command.id); }
    static QList<QKeySequence> keysOfOld(const Command& command);
    /// Keeps them; an empty list: no key.
    void setKeys(const Command& command, const QList<QKeySequence>& keys);
    void resetKeys();
    /// What is on, and what can be done now.
    void look();

private:
    ReaderWindow& window_;
    std::map<std::string, QAction*> actions_;
};

}  // namespace haustra::window
