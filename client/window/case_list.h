// The server's cases, to choose from.
#pragma once

#include "window/reading.h"

#include <QWidget>

class QLabel;
class QLineEdit;
class QPushButton;
class QSortFilterProxyModel;
class QTableView;

namespace haustra::window {

class CaseTable;

/// A table with a field to search in it. While it is in sight it is asked for anew every few
/// seconds. While the link is down it is as it came last, and what is chosen is opened when the
/// link is back; what takes long to open can be left for the list.
class CaseList : public QWidget {
    Q_OBJECT
public:
    explicit CaseList(Reading& reading);

signals:
    /// The case that is open was chosen again.
    void chosenAgain();
    /// After the session has ended for good.
    void connectionWanted();

protected:
    void showEvent(QShowEvent*) override;

private:
    void look();
    void fill();
    void openCurrent();
    void ask();

    Reading& reading_;
    QLabel *heading_, *state_;
    QLineEdit* search_;
    QTableView* table_;
    CaseTable* model_;
    QSortFilterProxyModel* found_;
    QPushButton *open_, *back_, *again_;
    std::uint64_t shownRevision_ = 0;  // of the session's list
    QTimer askTimer_;
    bool listed_ = false;  // the list is in sight
};

}  // namespace haustra::window
