// What of the wall the reader has seen, and the patches that have been missed, to be looked at one
// after the other.
#pragma once

#include "window/reading.h"

#include <QWidget>

class QDoubleSpinBox;
class QLabel;
class QProgressBar;
class QPushButton;
class QSpinBox;
class QTreeWidget;

namespace haustra::window {

/// A click goes to where a patch is seen from. The limits that the reader has chosen last are those
/// of the next start, too.
class MissedPanel : public QWidget {
    Q_OBJECT
public:
    explicit MissedPanel(Reading& reading);
    QSize sizeHint() const override { return {320, 400}; }

    /// Asks for a file, and writes what every reader has seen of this wall once the server has
    /// told.
    void saveReport();

private:
    void look();
    void chooseLimits();
    void fill();
    void writeReport();
    QString stateText() const;

    Reading& reading_;
    QProgressBar* share_;
    QLabel* state_;
    QTreeWidget* list_;
    QPushButton *previous_, *next_, *report_;
    QDoubleSpinBox* pixels_;
    QSpinBox* ms_;
    std::uint64_t shownRevision_ = 0;  // of the session's list
    std::optional<SeenLimits> shownLimits_;
    int shownCurrent_ = -1;
    bool looks_ = false;  // the controls are set to what is, by no hand
    QString reportFile_;
    std::uint64_t reportRequest_ = 0;  // 0: none waits
};

/// `step`: 1 the next missed patch, −1 the previous. A refusal is told.
void goToNextMissed(Reading& reading, int step);

}  // namespace haustra::window
