// The reader's window.
#pragma once

#include "window/commands.h"
#include "window/layouts.h"
#include "window/reading.h"

#include <QDialog>
#include <QMainWindow>
#include <QPointer>
#include <map>
#include <vector>

class QLabel;
class QMenu;
class QMenuBar;

namespace haustra::window {

class BookmarkPanel;
class CaseList;
class MissedPanel;
class NarrowButton;
class Notices;
class Pane;

/// Panes in docks, the flight's bar, menus. One per program, on the main thread.
class ReaderWindow : public QMainWindow {
    Q_OBJECT
public:
    explicit ReaderWindow(Reading& reading);
    ~ReaderWindow() override;

    Reading& reading() { return reading_; }
    reader::Reader& reader() { return reading_.reader(); }

    // What the commands do.
    void showCases();
    bool showsCases() const;
    void savePicture();
    void copyPicture();
    void quit();
    /// The pane under the mouse, or that which has the keyboard; back again.
    void enlarge();
    void leaveEnlarged();
    /// The pane that has the keyboard, else that under the mouse.
    Pane* keyboardPane() const;
    void focusNextPane(int step);
    void togglePointing();
    bool pointsByKeys() const { return reading_.pointsByKeys(); }
    void connectAgain();
    bool isEnlarged() const { return !beforeEnlarged_.isEmpty(); }
    void arrange(BuiltinLayout layout);
    void saveLayout();
    void toggleFullScreen();
    void askForPlace();
    void setWindowPreset(std::size_t n);
    std::size_t windowPreset() const;
    void toggleOptics();
    bool showsOptics() const;
    void writeNote();
    void toggleBookmarks();
    bool showsBookmarks() const;
    void toggleFindings();
    bool showsFindings() const;
    void toggleMissed();
    bool showsMissed() const;
    void saveSeenReport();
    void showHelp();
    void changeKeys();
    void showAbout();

    /// All panes that are in sight show their lossless stills, or none is open.
    bool isSettled() const;

protected:
    void closeEvent(QCloseEvent*) override;
    bool eventFilter(QObject* object, QEvent* event) override;

private:
    QDockWidget* dock(QWidget* content, const char* name, const QString& title);
    Docks makeDocks();
    void makeMenus();
    void makeHeader();
    void makeStatus();
    void fillLayoutMenu();
    void showMenuOf(Pane& pane, const QPoint& globalPosition);
    Pane* currentPane() const;
    Pane* focusedPane() const;
    void focusPane(Pane* wanted);
    void caseOpened();
    void look();
    void keepLayout();
    bool handleHeldKeys(QEvent* event);
    void toggleList(QDockWidget* dock);
    void keepKeysOnPanes();

    Reading& reading_;
    QMainWindow second_;
    CommandSet commands_;
    std::vector<Pane*> panes_;
    BookmarkPanel* bookmarks_ = nullptr;
    MissedPanel* missed_ = nullptr;
    Docks docks_;
    Layouts layouts_;
    CaseList* cases_ = nullptr;
    Notices* notices_ = nullptr;
    QMenuBar* menus_ = nullptr;
    QToolBar *trackBar_ = nullptr, *flightBar_ = nullptr;
    QLabel *caseName_ = nullptr, *about_ = nullptr, *notCleansed_ = nullptr;
    NarrowButton* trust_ = nullptr;
    QLabel *figures_ = nullptr, *server_ = nullptr;
    QMenu* layoutMenu_ = nullptr;
    QPointer<QDialog> help_, keys_;
    QByteArray beforeEnlarged_;
    std::map<int, const Command*> held_;  // of free flight, by key
    bool placedOptics_ = false;
};

}  // namespace haustra::window
