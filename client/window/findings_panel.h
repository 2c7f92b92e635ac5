// The findings of the open case: when they are shown, and the list along the colon.
#pragma once

#include "window/reading.h"

#include <QWidget>

class QCheckBox;
class QComboBox;
class QLabel;
class QPlainTextEdit;
class QPushButton;
class QSpinBox;
class QTreeWidget;

namespace haustra::window {

QString nameOf(DetectionMode mode);

/// The mode that the reader has chosen last is that of the next case, too, whose first reading is
/// still to be done. A click goes to a finding.
class FindingsPanel : public QWidget {
    Q_OBJECT
public:
    explicit FindingsPanel(Reading& reading);
    QSize sizeHint() const override { return {320, 400}; }

private:
    void look();
    void choose(const DetectionChoice& choice);
    void fill();
    int heightOfRows(int rows) const;
    void markCurrent();
    void goTo(int number);
    QString stateText() const;
    QString notesText() const;

    Reading& reading_;
    QComboBox* mode_;
    QPushButton *firstPass_, *measure_;
    QCheckBox* candidates_;
    QSpinBox* least_;
    QTreeWidget* list_;
    QLabel* state_;
    QPlainTextEdit* notes_;
    std::uint64_t shownRevision_ = 0;  // of the session's findings
    DetectionChoice shownChoice_;
    int shownCurrent_ = 0;
    bool looks_ = false;  // the controls are set to what is, by no hand
};

// What the panel and the commands do. A refusal is told.

void chooseDetection(Reading& reading, DetectionMode mode);
void finishFirstPass(Reading& reading);
/// `step`: 1 the next along the colon, −1 the previous.
void goToNextFinding(Reading& reading, int step);
/// The largest diameter of the current finding, as a ruler.
void measureFinding(Reading& reading);

}  // namespace haustra::window
