// The reader at work in Qt's event loop: what the window's parts share.
#pragma once

#include "reader/reader.h"

#include <QElapsedTimer>
#include <QObject>
#include <QString>
#include <QTimer>
#include <QUndoStack>
#include <atomic>
#include <functional>
#include <memory>

namespace haustra::window {

/// What a drag in a pane does. `none`: it turns, moves or windows the picture. `ruler`: so it does,
/// and two clicks, in whichever panes, measure how far their places are apart.
enum class DrawingTool { none, line, outline, ruler };

/// Belongs to the main thread. Steps when the server sent something, when a part of the window has
/// changed the reader (changed()), and steadily while something moves by itself.
class Reading : public QObject {
    Q_OBJECT
public:
    /// `serverName` is what the window calls the server.
    Reading(link::ConnectionOptions options, std::string caseName,
            std::optional<reader::BookmarkJournal> journal = {});
    ~Reading() override;

    reader::Reader& reader() { return *reader_; }
    const reader::Reader& reader() const { return *reader_; }
    const QString& serverName() const { return serverName_; }

    /// The hand changed the reader: a step follows as soon as this event is handled.
    void changed();
    /// Tells the person who reads: in the status line, or, of trouble, until it is dismissed.
    void tell(const QString& text, bool trouble = false);

    /// Steps that Ctrl+Z takes back. `redo` has been done already. Steps with the same `mergeId`
    /// (not −1) that follow one another within a second are one.
    void did(const QString& text, std::function<void()> undo, std::function<void()> redo,
             int mergeId = -1);
    QUndoStack& undoStack() { return undoStack_; }
    /// Brings flight and slices back to where they are now; what has been set since stays.
    std::function<void()> wayBack();
    /// A jump of the flight that can be taken back, and done again by `go`; `alsoBack` takes back
    /// what else `go` does.
    void jump(const QString& text, std::function<void()> go, std::function<void()> alsoBack = {});

    /// Rulers and ellipses on slices, and what was measured on the wall.
    void clearMeasures();

    /// How findings are shown in the next case: as this window chose last, or, before it has, as
    /// was chosen last when it began. What another window chooses meanwhile shows none here to
    /// whoever is to read without them.
    DetectionMode nextDetection() const { return nextDetection_; }
    /// Kept for windows that begin later.
    void setNextDetection(DetectionMode mode);

    DrawingTool tool() const { return tool_; }
    void setTool(DrawingTool tool);

    /// Arrows move a pointer in one of the panes; the mouse points at nothing meanwhile.
    bool pointsByKeys() const { return pointsByKeys_; }
    void setPointsByKeys(bool on) { pointsByKeys_ = on; }

    /// After the session has ended for good: a new one with the same server, the same case and, if
    /// that is of the same scan, the same place, its first reading as far done. Bookmarks that are
    /// owed come back from the journal; without one they are lost.
    void connectAgain();

    /// Free flight: the way that keys are held for, right, up and forward.
    void setHeldWay(glm::dvec3 way, bool fast);

signals:
    /// Something may have changed: whoever shows it looks whether it has.
    void stepped();
    /// Another case is open.
    void caseOpened();
    void phaseChanged();
    void told(const QString& text, bool trouble);
    void toolChanged();
    /// reader() is another one, whose session begins.
    void readerReplaced();

private:
    void step();
    void wakeFromThread();
    void watchSession();
    void watchRulers();

    void makeReader(std::string caseName);

    std::atomic<bool> stepWaits_ = false;
    link::ConnectionOptions options_;
    std::optional<reader::BookmarkJournal> journal_;
    QString serverName_;
    std::unique_ptr<reader::Reader> reader_;
    QTimer steady_, idle_, soon_;
    QElapsedTimer sinceStep_;
    QUndoStack undoStack_;
    DrawingTool tool_ = DrawingTool::none;
    DetectionMode nextDetection_ = DetectionMode::off;
    glm::dvec3 heldWay_{0.0};
    bool heldFast_ = false, toldFirstUse_ = false;
    bool pointsByKeys_ = false;
    std::shared_ptr<const reader::CaseInfo> case_;
    /// Where the reader was when the former session ended, of which scan.
    struct Place {
        std::string scan;
        reader::Flight flight;
        reader::SliceViews slices;
        DetectionChoice detection;
    };
    std::optional<Place> placeBefore_;
    reader::Phase phase_ = reader::Phase::connecting;
};

QString text(const std::string& utf8);
QString text(const Error& error);
/// With one decimal, as the language writes it.
QString decimal(double value);
/// What a server says, in a tool tip: Qt would take it for HTML where it looks like that.
QString toolTipOf(const QString& said);

}  // namespace haustra::window
