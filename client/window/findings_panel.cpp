#include "window/findings_panel.h"

#include "protocol/capabilities.h"
#include "window/chosen_items.h"
#include "window/pane.h"
#include "window/theme.h"
#include "window/told_sentences.h"

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QMessageBox>
#include <QPlainTextEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSpinBox>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

constexpr int numberRole = Qt::UserRole;
constexpr int leastRows = 4;  // of the list in sight
constexpr DetectionMode modes[] = {DetectionMode::off, DetectionMode::secondReader,
                                   DetectionMode::concurrent};

QString nameOfSegment(const std::optional<ColonSegment>& segment) {
    if (!segment) return QStringLiteral("–");
    switch (*segment) {
        case ColonSegment::rectum:
            return FindingsPanel::tr("rectum");
        case ColonSegment::sigmoid:
            return FindingsPanel::tr("sigmoid");
        case ColonSegment::descending:
            return FindingsPanel::tr("descending");
        case ColonSegment::transverse:
            return FindingsPanel::tr("transverse");
        case ColonSegment::ascending:
            return FindingsPanel::tr("ascending");
        case ColonSegment::cecum:
            break;
    }
    return FindingsPanel::tr("cecum");
}

QString percent(double probability) {
    return FindingsPanel::tr("%1 %").arg(std::lround(100.0 * probability));
}

// Empty where there are some.
QString whyNone(const reader::Session& session) {
    if (!session.caseInfo()) return {};
    if (!session.serverCan(protocol::capability::findings))
        return FindingsPanel::tr("This server cannot show findings.");
    switch (session.caseInfo()->detection) {
        case reader::Detection::damaged:
            return FindingsPanel::tr("The findings of this case cannot be read.");
        case reader::Detection::none:
            return FindingsPanel::tr("This case has not been searched for polyps.");
        default:
            return {};
    }
}

QString nameOfKind(const std::string& kind) {
    if (kind == "sessile") return FindingsPanel::tr("sessile");
    if (kind == "pedunculated") return FindingsPanel::tr("pedunculated");
    if (kind == "flat") return FindingsPanel::tr("flat");
    return text(kind);
}

QString shapeOf(const Finding& finding) {
    const QString mm = decimal(finding.heightMm);
    return finding.kind == annularKind
               ? FindingsPanel::tr("all around, %1 mm thick").arg(mm)
               : FindingsPanel::tr("%1, %2 mm high").arg(nameOfKind(finding.kind), mm);
}

/// A mode is chosen from the list that opens: neither the wheel, which scrolls the panel, nor a key
/// that is meant for the flight shows findings before the first reading is done.
class ModeBox : public QComboBox {
public:
    ModeBox() { setFocusPolicy(Qt::TabFocus); }

protected:
    void wheelEvent(QWheelEvent* event) override { event->ignore(); }
    void keyPressEvent(QKeyEvent* event) override {
        const int key = event->key();
        const bool opens = (key >= Qt::Key_Home && key <= Qt::Key_PageDown) || key == Qt::Key_F4 ||
                           key == Qt::Key_Space || key == Qt::Key_Return || key == Qt::Key_Enter;
        opens ? showPopup() : event->ignore();
    }
};

/// The wheel scrolls the panel here, too: nothing is shown or hidden by the way.
class ThresholdBox : public QSpinBox {
protected:
    void wheelEvent(QWheelEvent* event) override { event->ignore(); }
};

void tellRefusal(Reading& reading, const Result<void>& done) {
    const QString why = whyNone(reading.reader().session());
    if (!done) reading.tell(why.isEmpty() ? text(done.error().message) : why);
    reading.changed();
}

void jumpTo(Reading& reading, const reader::ListedFinding& finding) {
    reading.jump(FindingsPanel::tr("go to a finding"),
                 // Redone while findings are hidden, or once others were found, it leads nowhere.
                 [&reading, finding] {
                     const auto* now = reading.reader().findings().find(finding.number);
                     if (now && isSame(*now, finding)) reading.reader().goTo(finding);
                 });
}

}  // namespace

QString nameOf(DetectionMode mode) {
    switch (mode) {
        case DetectionMode::secondReader:
            return FindingsPanel::tr("After my own reading (second reader)");
        case DetectionMode::concurrent:
            return FindingsPanel::tr("From the start (concurrent)");
        case DetectionMode::off:
            break;
    }
    return FindingsPanel::tr("Not shown");
}

void chooseDetection(Reading& reading, DetectionMode mode) {
    const DetectionChoice& choice = reading.reader().findings().choice();
    if (mode == DetectionMode::concurrent && choice.mode == DetectionMode::secondReader &&
        !choice.firstPassDone && reading.reader().findings().has() &&
        QMessageBox::question(
            QApplication::activeWindow(), FindingsPanel::tr("The first reading is not done"),
            FindingsPanel::tr("Show the findings all the same, in this and the next cases?"),
            QMessageBox::Yes | QMessageBox::No, QMessageBox::No) != QMessageBox::Yes)
        return reading.changed();
    const auto done = reading.reader().findings().choose(mode);
    if (done) {
        reading.setNextDetection(mode);
        reading.tell(FindingsPanel::tr("Findings: %1").arg(nameOf(mode)));
    }
    tellRefusal(reading, done);
}

void finishFirstPass(Reading& reading) {
    const reader::FindingsReading& findings = reading.reader().findings();
    if (findings.has() && findings.choice().mode != DetectionMode::secondReader)
        return reading.tell(
            FindingsPanel::tr("No findings wait for the first reading in this mode."));
    tellRefusal(reading, reading.reader().findings().finishFirstPass());
}

void goToNextFinding(Reading& reading, int step) {
    const reader::Reader& reader = reading.reader();
    double arcMm = reader.flight().placeArcMm();
    // From beside the path another loop's may be nearer.
    if (const auto* here = reader.findings().current();
        here && here->view &&
        glm::distance(here->view->positionMm, reader.flight().camera().positionMm) <=
            reader::FindingsReading::besideMm)
        arcMm = here->wall.arcMm;
    if (const auto* finding = reader.findings().next(step, arcMm)) return jumpTo(reading, *finding);
    const auto& list = reader.session().findings();
    const QString why = whyNone(reader.session());
    reading.tell(!why.isEmpty() ? why
                 : !reader.findings().choice().shows()
                     ? FindingsPanel::tr("Findings are not shown in this mode.")
                 : !list || list->state != reader::FindingList::State::shown
                     ? FindingsPanel::tr("asking…")
                 : step > 0 ? FindingsPanel::tr("No finding further along the colon.")
                            : FindingsPanel::tr("No finding before this place."));
}

void measureFinding(Reading& reading) {
    const reader::ListedFinding* finding = reading.reader().findings().current();
    const QString why = whyNone(reading.reader().session());
    if (!finding)
        return reading.tell(why.isEmpty() ? FindingsPanel::tr("Go to a finding first.") : why);
    reading.reader().rulers().measure(*finding);
    reading.changed();
}

FindingsPanel::FindingsPanel(Reading& reading)
    : reading_(reading),
      mode_(new ModeBox),
      firstPass_(new QPushButton(tr("First reading done:\nshow findings"))),
      measure_(new QPushButton(tr("Measure"))),
      candidates_(new QCheckBox(tr("also those from"))),
      least_(new ThresholdBox),
      list_(new QTreeWidget),
      state_(new QLabel),
      notes_(new QPlainTextEdit) {
    for (const DetectionMode mode : modes)
        mode_->addItem(nameOf(mode));
    mode_->setAccessibleName(tr("When findings are shown"));
    mode_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    candidates_->setAccessibleName(tr("Also show less probable findings"));
    candidates_->setToolTip(tr("Places that scored below the operating point, in another colour"));
    measure_->setToolTip(tr("The finding's largest diameter, as a ruler in all views"));
    least_->setFocusPolicy(Qt::StrongFocus);  // not by the wheel
    least_->setRange(0, 100);
    least_->setValue(30);
    least_->setSuffix(tr(" %"));
    least_->setAccessibleName(tr("Least probability of less probable findings"));
    list_->setAccessibleName(tr("Findings along the colon"));
    list_->setColumnCount(5);
    list_->setHeaderLabels({tr("No."), tr("mm"), tr("Segment"), tr("Size"), tr("Prob.")});
    list_->headerItem()->setToolTip(1, toolTipOf(tr("From the rectum")));
    list_->headerItem()->setToolTip(4, toolTipOf(tr("Probability")));
    list_->setRootIsDecorated(false);
    list_->setAllColumnsShowFocus(true);
    for (int column = 0; column < 5; ++column)
        list_->header()->setSectionResizeMode(
            column, column == 2 ? QHeaderView::Stretch : QHeaderView::ResizeToContents);
    list_->header()->setStretchLastSection(false);
    state_->setWordWrap(true);
    state_->setTextFormat(Qt::PlainText);
    // However much there is to say of them, the list stays in sight; what it leaves is theirs.
    constexpr int noteLines = 3;
    notes_->setReadOnly(true);
    notes_->setTabChangesFocus(true);
    notes_->setFont(smallFont(font()));
    notes_->setAccessibleName(tr("What must be known of the findings"));
    notes_->setMinimumHeight(noteLines * QFontMetrics(notes_->font()).lineSpacing() +
                             2 * int(notes_->document()->documentMargin() + notes_->frameWidth()));
    notes_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
    // It takes what it needs of the height; some findings are in sight, however low the panel is.
    list_->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Ignored);
    list_->setMinimumHeight(heightOfRows(leastRows));
    auto* row = new QHBoxLayout;
    row->addWidget(candidates_);
    row->addWidget(least_);
    row->addStretch(1);
    auto* said = new QHBoxLayout;
    said->addWidget(state_, 1);
    said->addWidget(measure_);
    // In a panel lower than all this, one scrolls; words that wrap would lie over the list.
    auto* inside = new QWidget;
    auto* scroll = new QScrollArea;
    scroll->setWidget(inside);
    scroll->setWidgetResizable(true);
    scroll->setFrameShape(QFrame::NoFrame);
    scroll->setFocusPolicy(Qt::NoFocus);
    auto* whole = new QVBoxLayout(this);
    whole->setContentsMargins(0, 0, 0, 0);
    whole->addWidget(scroll);
    auto* column = new QVBoxLayout(inside);
    column->setContentsMargins(6, 6, 6, 6);
    column->addWidget(mode_);
    column->addWidget(firstPass_);
    column->addLayout(row);
    column->addLayout(said);
    column->addWidget(list_, 2);
    column->addWidget(notes_, 1);
    connect(mode_, &QComboBox::activated, this,
            [this](int n) { chooseDetection(reading_, modes[n]); });
    connect(firstPass_, &QPushButton::clicked, this, [this] { finishFirstPass(reading_); });
    connect(measure_, &QPushButton::clicked, this, [this] { measureFinding(reading_); });
    const auto threshold = [this] {
        if (looks_) return;
        DetectionChoice choice = reading_.reader().findings().choice();
        choice.leastProbability.reset();
        if (candidates_->isChecked()) choice.leastProbability = 0.01 * least_->value();
        choose(choice);
    };
    connect(candidates_, &QCheckBox::toggled, this, threshold);
    connect(least_, &QSpinBox::valueChanged, this, threshold);
    onChosen(*list_, [this](QTreeWidgetItem& item) { goTo(item.data(0, numberRole).toInt()); });
    connect(&reading, &Reading::stepped, this, &FindingsPanel::look);
    connect(&reading, &Reading::readerReplaced, this, [this] { shownRevision_ = 0; });
    connect(&reading, &Reading::caseOpened, this, [this] {
        // Of a case that is open again, as before a lost link, its own mode stays.
        reader::FindingsReading& findings = reading_.reader().findings();
        if (findings.has() && findings.choice().mode == DetectionMode::off)
            (void)findings.choose(reading_.nextDetection());
        shownRevision_ = 0;
    });
    look();
}

void FindingsPanel::choose(const DetectionChoice& choice) {
    tellRefusal(reading_, reading_.reader().findings().choose(choice));
}

void FindingsPanel::look() {
    const reader::FindingsReading& findings = reading_.reader().findings();
    const bool has = reading_.reader().isOpen() && findings.has();
    for (QWidget* control : {static_cast<QWidget*>(mode_), static_cast<QWidget*>(candidates_)})
        control->setEnabled(has);
    const DetectionChoice& choice = findings.choice();
    least_->setEnabled(has && candidates_->isChecked());
    const bool waits = choice.mode == DetectionMode::secondReader && !choice.firstPassDone;
    list_->setEnabled(has);
    // What is hidden leaves the keyboard to the next control, which Space would press.
    if (!waits && firstPass_->hasFocus()) list_->setFocus();
    firstPass_->setVisible(waits);
    firstPass_->setEnabled(has && !choice.firstPassDone);
    const bool measures = has && findings.current();
    if (measure_->isEnabled() != measures) measure_->setEnabled(measures);
    if (!isVisible()) return;
    const std::uint64_t revision = reading_.reader().session().findingsRevision();
    if (shownChoice_ != choice || mode_->currentIndex() != int(choice.mode)) {
        shownChoice_ = choice;
        looks_ = true;
        mode_->setCurrentIndex(int(choice.mode));
        candidates_->setChecked(choice.leastProbability.has_value());
        if (choice.leastProbability)
            least_->setValue(int(std::lround(100.0 * *choice.leastProbability)));
        looks_ = false;
        shownRevision_ = 0;
    }
    // Revisions grow from 1 on, where there is a case.
    if (shownRevision_ != revision || revision == 0) {
        shownRevision_ = revision;
        fill();
    }
    markCurrent();
}

void FindingsPanel::fill() {
    list_->clear();
    for (const reader::ListedFinding& one : reading_.reader().findings().shown()) {
        const Finding& finding = one.finding;
        const bool isAnnular = finding.kind == annularKind;
        auto* item = new QTreeWidgetItem(
            list_, {QString::number(one.number), QString::number(finding.arcMm, 'f', 0),
                    nameOfSegment(finding.segment), tr("%1 mm").arg(decimal(finding.diameterMm)),
                    isAnnular ? QStringLiteral("–") : percent(finding.score)});
        for (const int column : {0, 1, 3, 4})
            item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
        item->setData(0, numberRole, one.number);
        item->setToolTip(2, toolTipOf(shapeOf(finding)));
        if (isAnnular) item->setToolTip(4, toolTipOf(tr("A rule tells it: no probability")));
        QFont font = list_->font();
        font.setItalic(one.candidate);
        for (int column = 0; column < list_->columnCount(); ++column) {
            item->setFont(column, font);
            if (one.candidate) item->setForeground(column, theme().muted);
        }
    }
    shownCurrent_ = 0;
    state_->setText(stateText());
    const QString notes = notesText();
    if (notes_->toPlainText() != notes) notes_->setPlainText(notes);
    notes_->setVisible(!notes.isEmpty());
    list_->setMaximumHeight(notes.isEmpty()
                                ? QWIDGETSIZE_MAX
                                : heightOfRows(std::max(leastRows, list_->topLevelItemCount())));
}

int FindingsPanel::heightOfRows(int rows) const {
    const int row = list_->topLevelItemCount() > 0
                        ? list_->visualItemRect(list_->topLevelItem(0)).height()
                        : QFontMetrics(list_->font()).height() + 6;
    return list_->header()->sizeHint().height() + rows * row + 2 * list_->frameWidth();
}

void FindingsPanel::markCurrent() {
    const reader::ListedFinding* current = reading_.reader().findings().current();
    const int number = current ? current->number : 0;
    if (number == shownCurrent_) return;
    shownCurrent_ = number;
    // Bold, too: the arrow keys lead the list's own mark on, and "Measure" measures this one.
    for (int n = 0; n < list_->topLevelItemCount(); ++n) {
        QTreeWidgetItem* item = list_->topLevelItem(n);
        const bool isIt = item->data(0, numberRole).toInt() == number;
        for (int column = 0; column < list_->columnCount(); ++column) {
            QFont font = item->font(column);
            font.setBold(isIt);
            item->setFont(column, font);
        }
        if (isIt) list_->setCurrentItem(item);
    }
}

void FindingsPanel::goTo(int number) {
    if (const reader::ListedFinding* finding = reading_.reader().findings().find(number))
        jumpTo(reading_, *finding);
}

QString FindingsPanel::stateText() const {
    const reader::Session& session = reading_.reader().session();
    if (!session.caseInfo()) return {};
    if (const QString why = whyNone(session); !why.isEmpty()) return why;
    const DetectionChoice& choice = session.detection();
    if (choice.mode == DetectionMode::off) return tr("Findings are not shown.");
    if (!choice.shows()) return tr("Findings are shown once the first reading is done.");
    const auto& list = session.findings();
    if (!list || list->state != reader::FindingList::State::shown) return tr("asking…");
    return tr("%n place(s) to judge", nullptr, int(list->findings.size()));
}

QString FindingsPanel::notesText() const {
    const auto& list = reading_.reader().session().findings();
    if (!list || list->model.empty()) return {};
    QStringList lines{tr("For a physician to judge.")};
    for (const std::string& warning : list->warnings)
        lines += translatedSentence(text(warning));
    lines += tr("Found by %1, which has learnt from: %2. Operating point %3.")
                 .arg(text(list->model), translatedSentence(text(list->trainedOn)),
                      percent(list->operatingPoint));
    return lines.join('\n');
}

}  // namespace haustra::window
