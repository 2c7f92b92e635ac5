#include "window/missed_panel.h"

#include "reader/seen_lists_json.h"
#include "window/chosen_items.h"
#include "window/pane.h"

#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSaveFile>
#include <QSettings>
#include <QSpinBox>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <cmath>

namespace haustra::window {
namespace {

constexpr auto pixelsSetting = "reading/seen-pixels-per-mm", msSetting = "reading/seen-ms";
constexpr int patchRole = Qt::UserRole;

// Empty where there is something to tell.
QString whyNone(const reader::Reader& reader) {
    if (!reader.isOpen()) return {};
    if (!reader.session().caseInfo()->flat)
        return MissedPanel::tr("This case has not been flattened.");
    if (!reader.missed().has())
        return MissedPanel::tr("This server does not keep what has been seen.");
    return {};
}

void jumpTo(Reading& reading, const reader::MissedPlace& patch) {
    reading.jump(MissedPanel::tr("go to a missed patch"),
                 [&reading, patch] { reading.reader().goTo(patch); });
}

}  // namespace

void goToNextMissed(Reading& reading, int step) {
    if (const QString why = whyNone(reading.reader()); !why.isEmpty()) return reading.tell(why);
    reading.reader().missed().want(step);
    reading.changed();
}

MissedPanel::MissedPanel(Reading& reading)
    : reading_(reading),
      share_(new QProgressBar),
      state_(new QLabel),
      list_(new QTreeWidget),
      previous_(new QPushButton(tr("Previous"))),
      next_(new QPushButton(tr("Next"))),
      report_(new QPushButton(tr("Save a report…"))),
      pixels_(new QDoubleSpinBox),
      ms_(new QSpinBox) {
    share_->setRange(0, 1000);
    share_->setAccessibleName(tr("Share of the wall that has been seen"));
    state_->setWordWrap(true);
    state_->setTextFormat(Qt::PlainText);
    report_->setToolTip(tr("What every reader has seen of this wall, and missed, as a JSON file"));
    pixels_->setRange(leastSeenPixelsPerMm, 20.0);
    pixels_->setDecimals(2);
    pixels_->setSingleStep(0.1);
    pixels_->setKeyboardTracking(false);
    pixels_->setSuffix(tr(" pixels/mm"));
    pixels_->setAccessibleName(tr("How large a place must have been on screen to count as seen"));
    ms_->setRange(0, mostSeenMs);
    ms_->setSingleStep(50);
    ms_->setKeyboardTracking(false);
    ms_->setSuffix(tr(" ms"));
    ms_->setAccessibleName(tr("How long a place must have been on screen to count as seen"));
    for (QWidget* limit : {static_cast<QWidget*>(pixels_), static_cast<QWidget*>(ms_)})
        limit->setToolTip(
            tr("A place counts as seen that has been on screen so large, for so long in all. Each "
               "choice has a record of its own."));
    list_->setAccessibleName(tr("Missed patches of the wall, the largest first"));
    list_->setColumnCount(2);
    list_->setHeaderLabels({tr("mm²"), tr("mm from the rectum")});
    list_->setRootIsDecorated(false);
    list_->setAllColumnsShowFocus(true);
    list_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    constexpr int leastRows = 4;
    list_->setMinimumHeight(leastRows * (QFontMetrics(list_->font()).height() + 6));
    auto* buttons = new QHBoxLayout;
    buttons->addWidget(previous_);
    buttons->addWidget(next_);
    buttons->addStretch(1);
    buttons->addWidget(report_);
    auto* limits = new QHBoxLayout;
    limits->addWidget(new QLabel(tr("Seen from")));
    limits->addWidget(pixels_);
    limits->addWidget(ms_);
    limits->addStretch(1);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(6, 6, 6, 6);
    column->addWidget(share_);
    column->addWidget(state_);
    column->addWidget(list_, 1);
    column->addLayout(buttons);
    column->addLayout(limits);
    connect(previous_, &QPushButton::clicked, this, [this] { goToNextMissed(reading_, -1); });
    connect(next_, &QPushButton::clicked, this, [this] { goToNextMissed(reading_, +1); });
    connect(report_, &QPushButton::clicked, this, &MissedPanel::saveReport);
    connect(pixels_, &QDoubleSpinBox::valueChanged, this, &MissedPanel::chooseLimits);
    connect(ms_, &QSpinBox::valueChanged, this, &MissedPanel::chooseLimits);
    onChosen(*list_, [this](QTreeWidgetItem& item) {
        const reader::MissedList* list = reading_.reader().missed().list();
        const auto patch = std::size_t(item.data(0, patchRole).toInt());
        if (!list || patch >= list->patches.size()) return;
        reading_.reader().missed().setCurrent(patch);
        jumpTo(reading_, list->patches[patch]);
    });
    connect(&reading, &Reading::stepped, this, &MissedPanel::look);
    connect(&reading, &Reading::readerReplaced, this, [this] {
        shownRevision_ = 0;
        reportRequest_ = 0;
    });
    connect(&reading, &Reading::caseOpened, this, [this] {
        shownRevision_ = 0;
        const QSettings settings;
        const SeenLimits kept{
            settings.value(QLatin1String(pixelsSetting), SeenLimits{}.pixelsPerMm).toDouble(),
            settings.value(QLatin1String(msSetting), SeenLimits{}.leastMs).toInt()};
        if (reading_.reader().missed().has() && kept != SeenLimits{} && checkSeenLimits(kept))
            reading_.reader().session().setSeenLimits(kept);
    });
    look();
}

void MissedPanel::chooseLimits() {
    if (looks_ || !reading_.reader().missed().has()) return;
    SeenLimits limits{pixels_->value(), ms_->value()};
    // The box rounds what is usual.
    if (std::abs(limits.pixelsPerMm - SeenLimits{}.pixelsPerMm) < 0.005)
        limits.pixelsPerMm = SeenLimits{}.pixelsPerMm;
    QSettings settings;
    settings.setValue(QLatin1String(pixelsSetting), limits.pixelsPerMm);
    settings.setValue(QLatin1String(msSetting), limits.leastMs);
    reading_.reader().session().setSeenLimits(limits);
    reading_.changed();
}

void MissedPanel::look() {
    reader::Reader& reader = reading_.reader();
    bool none = false;
    if (const auto patch = reader.missed().takeWanted(none)) jumpTo(reading_, *patch);
    if (none)
        reading_.tell(reader.missed().list()->patches.empty()
                          ? tr("No patch of 300 mm² or more has been missed.")
                          : tr("No earlier patch is still missed."));
    if (reportRequest_ > 0 && !reader.session().awaits(reportRequest_)) writeReport();
    reader.missed().setWatched(isVisible());
    const bool has = reader.isOpen() && reader.missed().has();
    for (QWidget* control : {static_cast<QWidget*>(list_), static_cast<QWidget*>(previous_),
                             static_cast<QWidget*>(next_), static_cast<QWidget*>(report_),
                             static_cast<QWidget*>(pixels_), static_cast<QWidget*>(ms_)})
        control->setEnabled(has);
    if (!isVisible()) return;
    const reader::Session& session = reader.session();
    const int perMille = int(std::floor(1000.0 * session.seenShare().value_or(0.0)));
    if (share_->value() != perMille) share_->setValue(perMille);
    const QString share = session.seenShare()
                              ? tr("%1 % of the wall seen").arg(decimal(0.1 * perMille))
                              : tr("asking…");
    if (share_->format() != share) share_->setFormat(share);
    const auto& limits = session.seenLimits();
    if (limits && limits != shownLimits_) {
        shownLimits_ = limits;
        looks_ = true;
        pixels_->setValue(limits->pixelsPerMm);
        ms_->setValue(limits->leastMs);
        looks_ = false;
    }
    if (shownRevision_ != session.missedRevision()) {
        shownRevision_ = session.missedRevision();
        fill();
    }
    if (const QString state = stateText(); state_->text() != state) state_->setText(state);
    const auto current = reader.missed().current();
    if (const int row = current ? int(*current) : -1; row != shownCurrent_) {
        shownCurrent_ = row;
        list_->setCurrentItem(row < 0 ? nullptr : list_->topLevelItem(row));
    }
}

void MissedPanel::fill() {
    list_->clear();
    shownCurrent_ = -1;
    const reader::MissedList* list = reading_.reader().missed().list();
    if (!list) return;
    for (std::size_t n = 0; n < list->patches.size(); ++n) {
        const reader::MissedPlace& patch = list->patches[n];
        auto* item = new QTreeWidgetItem(list_, {QString::number(patch.areaMm2, 'f', 0),
                                                 QString::number(patch.place.arcMm, 'f', 0)});
        for (const int column : {0, 1})
            item->setTextAlignment(column, Qt::AlignRight | Qt::AlignVCenter);
        item->setData(0, patchRole, int(n));
    }
    list_->viewport()->update();
}

QString MissedPanel::stateText() const {
    const reader::Reader& reader = reading_.reader();
    if (!reader.isOpen()) return {};
    if (const QString why = whyNone(reader); !why.isEmpty()) return why;
    QStringList lines;
    if (const reader::MissedList* list = reader.missed().list())
        lines += tr("%n patch(es) of 300 mm² or more missed, %1 cm² together", nullptr, list->count)
                     .arg(decimal(0.01 * list->areaMm2));
    else
        lines += tr("asking…");
    if (reader.session().seenShare() && !reader.session().seenIsRecorded())
        lines += tr("It is not kept: with this session it is forgotten.");
    return lines.join('\n');
}

// ---- the report ---------------------------------------------------------------------------------

void MissedPanel::saveReport() {
    reader::Reader& reader = reading_.reader();
    if (const QString why = whyNone(reader); !why.isEmpty()) return reading_.tell(why);
    const QString file = QFileDialog::getSaveFileName(
        this, tr("Save a report of what has been seen"),
        text(reader.session().caseInfo()->name) + QStringLiteral("-seen.json"),
        tr("Reports (*.json)"));
    if (file.isEmpty()) return;
    reportFile_ = file;
    reportRequest_ = reader.session().requestSeenReport();
    reading_.changed();
}

void MissedPanel::writeReport() {
    reportRequest_ = 0;
    const reader::Session& session = reading_.reader().session();
    // Refused, or the case has been left meanwhile.
    if (!session.seenReport()) return reading_.tell(tr("No report was saved."), true);
    QSaveFile out(reportFile_);  // replaced in one step
    const std::string json = reader::toJson(*session.seenReport(), session.caseInfo()->name);
    if (out.open(QIODevice::WriteOnly) && out.write(json.data(), qint64(json.size())) >= 0 &&
        out.commit())
        reading_.tell(tr("Report saved: %1").arg(reportFile_));
    else
        reading_.tell(tr("cannot write %1: %2").arg(reportFile_, out.errorString()), true);
}

}  // namespace haustra::window
