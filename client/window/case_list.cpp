#include "window/case_list.h"

#include "window/theme.h"

#include <QDateTime>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QStandardItemModel>
#include <QTableView>
#include <QVBoxLayout>
#include <utility>

namespace haustra::window {
namespace {

constexpr int sortRole = Qt::UserRole, nameRole = Qt::UserRole + 1;
constexpr auto askAgain = std::chrono::seconds(10);

QStandardItem* cell(const QString& text, const QVariant& sorted) {
    auto* item = new QStandardItem(text);
    item->setEditable(false);
    item->setData(sorted, sortRole);
    return item;
}

QString stateText(const reader::CaseEntry& entry) {
    switch (entry.state) {
        case reader::CaseEntry::State::unknown:
            return {};
        case reader::CaseEntry::State::incomplete:
            return CaseList::tr("not ready");
        case reader::CaseEntry::State::damaged:
            return CaseList::tr("damaged");
        case reader::CaseEntry::State::ready:
            break;
    }
    QStringList parts{CaseList::tr("ready")};
    if (entry.cleansed) parts += CaseList::tr("cleansed");
    if (entry.flattened) parts += CaseList::tr("flattened");
    return parts.join(QStringLiteral(", "));
}

QString trustText(const reader::CaseEntry& entry) {
    if (!entry.confidence) return {};
    const QString sure = CaseList::tr("%1 % sure").arg(100.0 * *entry.confidence, 0, 'f', 0);
    return entry.warnings > 0
               ? sure + QStringLiteral(", ") +
                     CaseList::tr("%n place(s) to look at", nullptr, int(entry.warnings))
               : sure;
}

}  // namespace

CaseList::CaseList(Reading& reading)
    : reading_(reading),
      heading_(new QLabel),
      state_(new QLabel),
      search_(new QLineEdit),
      table_(new QTableView),
      model_(new QStandardItemModel(this)),
      found_(new QSortFilterProxyModel(this)),
      open_(new QPushButton(tr("Open"))) {
    QFont large = heading_->font();
    large.setPointSizeF(large.pointSizeF() * 1.6);
    heading_->setFont(large);
    state_->setWordWrap(true);
    state_->setTextInteractionFlags(Qt::TextSelectableByMouse);
    search_->setPlaceholderText(tr("search"));
    search_->setClearButtonEnabled(true);
    search_->setAccessibleName(tr("Search in the list of cases"));
    found_->setSourceModel(model_);
    found_->setFilterCaseSensitivity(Qt::CaseInsensitive);
    found_->setFilterKeyColumn(-1);
    found_->setSortRole(sortRole);
    found_->setSortCaseSensitivity(Qt::CaseInsensitive);
    table_->setModel(found_);
    table_->setAccessibleName(tr("Cases of the server"));
    table_->setSelectionBehavior(QAbstractItemView::SelectRows);
    table_->setSelectionMode(QAbstractItemView::SingleSelection);
    table_->setSortingEnabled(true);
    table_->sortByColumn(0, Qt::AscendingOrder);
    table_->horizontalHeader()->setDefaultAlignment(Qt::AlignLeft | Qt::AlignVCenter);
    table_->setAlternatingRowColors(true);
    table_->setShowGrid(false);
    table_->setTabKeyNavigation(false);
    table_->verticalHeader()->hide();
    table_->horizontalHeader()->setStretchLastSection(true);
    auto* row = new QHBoxLayout;
    row->addWidget(search_, 1);
    row->addWidget(open_);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(24, 24, 24, 24);
    column->addWidget(heading_);
    column->addWidget(state_);
    column->addLayout(row);
    column->addWidget(table_, 1);

    connect(search_, &QLineEdit::textChanged, this, [this](const QString& text) {
        found_->setFilterFixedString(text);
        if (found_->rowCount() > 0 && !table_->currentIndex().isValid()) table_->selectRow(0);
    });
    connect(search_, &QLineEdit::returnPressed, this, &CaseList::openCurrent);
    connect(table_, &QTableView::activated, this, &CaseList::openCurrent);
    connect(open_, &QPushButton::clicked, this, &CaseList::openCurrent);
    connect(&reading, &Reading::stepped, this, &CaseList::look);
    connect(&askTimer_, &QTimer::timeout, this, &CaseList::ask);
    askTimer_.start(askAgain);
}

void CaseList::ask() {
    const reader::Phase phase = reading_.reader().session().phase();
    if (isVisible() && (phase == reader::Phase::choosing || phase == reader::Phase::open))
        reading_.reader().session().requestCases();
}

void CaseList::showEvent(QShowEvent*) {
    listed_ = false;
    ask();
    look();
}

void CaseList::look() {
    if (!isVisible()) return;
    const reader::Session& session = reading_.reader().session();
    const reader::Phase phase = session.phase();
    QString heading, state;
    bool trouble = false;
    switch (phase) {
        case reader::Phase::connecting:
            heading =
                session.server().fingerprint.empty() ? tr("Connecting…") : tr("Opening the case…");
            state = reading_.serverName();
            break;
        case reader::Phase::lost:
            heading = tr("Waiting for the server…");
            state = text(session.failure());
            trouble = true;
            break;
        case reader::Phase::failed:
            heading = tr("No connection");
            state = text(session.failure());
            trouble = true;
            break;
        case reader::Phase::choosing:
        case reader::Phase::open:
            heading =
                session.cases().empty() ? tr("The server has no case yet") : tr("Choose a case");
            state = tr("%n case(s) on %1", nullptr, int(session.cases().size()))
                        .arg(reading_.serverName());
            break;
    }
    heading_->setText(heading);
    state_->setText(state);
    QPalette palette = this->palette();
    if (trouble) palette.setColor(QPalette::WindowText, theme().trouble);
    state_->setPalette(palette);
    const bool lists = phase == reader::Phase::choosing || phase == reader::Phase::open;
    for (QWidget* widget : {static_cast<QWidget*>(search_), static_cast<QWidget*>(table_),
                            static_cast<QWidget*>(open_)})
        widget->setVisible(lists && !session.cases().empty());
    if (lists && !std::exchange(listed_, lists)) search_->setFocus();
    listed_ = lists;
    open_->setEnabled(found_->rowCount() > 0);
    if (session.cases() == shown_) return;
    shown_ = session.cases();
    fill();
}

void CaseList::fill() {
    const QString current = table_->currentIndex().data(nameRole).toString();
    model_->clear();
    model_->setHorizontalHeaderLabels({tr("Case"), tr("State"), tr("Colon"), tr("Slices"),
                                       tr("Bookmarks"), tr("Open for"), tr("Prepared")});
    for (const reader::CaseEntry& entry : shown_) {
        const QDateTime prepared =
            QDateTime::fromString(text(entry.preparedUtc), Qt::ISODate).toLocalTime();
        QList<QStandardItem*> row{
            cell(text(entry.name), text(entry.name)),
            cell(stateText(entry), stateText(entry)),
            cell(trustText(entry), entry.confidence.value_or(2.0)),
            cell(entry.size.z > 0 ? QString::number(entry.size.z) : QString(), entry.size.z),
            cell(entry.bookmarks > 0 ? QString::number(entry.bookmarks) : QString(),
                 entry.bookmarks),
            cell(entry.readers > 0 ? tr("%n reader(s)", nullptr, int(entry.readers)) : QString(),
                 entry.readers),
            cell(
                prepared.isValid() ? QLocale().toString(prepared, QLocale::ShortFormat) : QString(),
                prepared)};
        for (QStandardItem* item : row) {
            item->setData(text(entry.name), nameRole);
            item->setToolTip(text(entry.reason));
            if (entry.state == reader::CaseEntry::State::damaged)
                item->setForeground(theme().trouble);
        }
        if (entry.warnings > 0) row[2]->setForeground(theme().bookmark);
        model_->appendRow(row);
    }
    table_->resizeColumnsToContents();
    table_->setColumnWidth(0, std::max(table_->columnWidth(0), 200));
    for (int row = 0; row < found_->rowCount(); ++row)
        if (found_->index(row, 0).data(nameRole).toString() == current || row == 0)
            table_->selectRow(row);
}

void CaseList::openCurrent() {
    QModelIndex index = table_->currentIndex();
    if (!index.isValid() && found_->rowCount() > 0) index = found_->index(0, 0);
    if (!index.isValid()) return;
    const std::string name = index.data(nameRole).toString().toStdString();
    const reader::Session& session = reading_.reader().session();
    const bool isOpen = session.phase() == reader::Phase::open && session.caseInfo() &&
                        session.caseInfo()->name == name;
    if (isOpen) return emit chosenAgain();
    reading_.reader().session().openCase(name);
    reading_.changed();
}

}  // namespace haustra::window
