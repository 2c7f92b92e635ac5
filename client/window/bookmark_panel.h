// The bookmarks of the open case.
#pragma once

#include "window/reading.h"

#include <QWidget>
#include <map>
#include <set>
#include <string>

class QLabel;
class QLineEdit;
class QTreeWidget;

namespace haustra::window {

/// A note to write, and the list along the colon: who has which, which are on their way, which the
/// server refused (to be sent again with another note, or discarded). A note that was refused is in
/// the field again, with the server's reason. A click goes there.
class BookmarkPanel : public QWidget {
    Q_OBJECT
public:
    explicit BookmarkPanel(Reading& reading);
    /// The cursor goes to the note's field.
    void writeNote();
    QSize sizeHint() const override { return {300, 220}; }

signals:
    /// The note is written, or given up: the keyboard goes back to the views.
    void written();

private:
    void look();
    void add();
    void fill();
    void goTo(const std::string& clientKey);
    void offerRefused();
    void endOffer();
    void showMenu(const QPoint& position);

    Reading& reading_;
    QLineEdit* note_;
    std::map<std::string, QString> drafts_;  // not sent, by scan
    std::string draftOf_;
    QTreeWidget* list_;
    QLabel *hint_, *reason_;
    std::string offered_;              // key of the refused bookmark whose note is in the field
    std::set<std::string> deferred_;   // keys of those that have been in the field
    bool writes_ = false;              // the keyboard is in the field
    std::uint64_t shownRevision_ = 0;  // of the session's bookmarks
};

}  // namespace haustra::window
