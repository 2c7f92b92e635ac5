#include "window/case_list.h"

#include "window/theme.h"

#include <QAbstractTableModel>
#include <QDateTime>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QPushButton>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QVBoxLayout>
#include <array>
#include <utility>

namespace haustra::window {
namespace {

constexpr int sortRole = Qt::UserRole, nameRole = Qt::UserRole + 1;
constexpr auto askAgain = std::chrono::seconds(10);

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

QDateTime preparedAt(const reader::CaseEntry& entry) {
    return QDateTime::fromString(text(entry.preparedUtc), Qt::ISODate).toLocalTime();
}

}  // namespace

/// Makes each cell when it is looked at: of a list of a hundred thousand, few are.
class CaseTable : public QAbstractTableModel {
public:
    using QAbstractTableModel::QAbstractTableModel;

    void set(const std::vector<reader::CaseEntry>& cases) {
        beginResetModel();
        cases_ = cases;
        endResetModel();
    }
    int rowCount(const QModelIndex& parent) const override {
        return parent.isValid() ? 0 : int(cases_.size());
    }
    int columnCount(const QModelIndex& parent) const override {
        return parent.isValid() ? 0 : columns;
    }
    QVariant headerData(int column, Qt::Orientation along, int role) const override {
        const std::array<QString, columns> headings{
            CaseList::tr("Case"),    CaseList::tr("State"),     CaseList::tr("Colon"),
            CaseList::tr("Slices"),  CaseList::tr("Bookmarks"), CaseList::tr("Open for"),
            CaseList::tr("Prepared")};
        if (along != Qt::Horizontal || role != Qt::DisplayRole) return {};
        return headings[std::size_t(column)];
    }
    QVariant data(const QModelIndex& index, int role) const override {
        // Copying where nothing is chosen asks for the cell of nowhere.
        if (!checkIndex(index, CheckIndexOption::IndexIsValid)) return {};
        const reader::CaseEntry& entry = cases_[std::size_t(index.row())];
        switch (role) {
            case Qt::DisplayRole:
                return textOf(entry, index.column());
            case sortRole:
                return sortedBy(entry, index.column());
            case nameRole:
                return text(entry.name);
            case Qt::ToolTipRole:
                return toolTipOf(text(entry.reason));
            case Qt::ForegroundRole:
                if (index.column() == 2 && entry.warnings > 0) return theme().bookmark;
                if (entry.state == reader::CaseEntry::State::damaged) return theme().trouble;
                return {};
            default:
                return {};
        }
    }

private:
    static constexpr int columns = 7;

    static QString textOf(const reader::CaseEntry& entry, int column) {
        switch (column) {
            case 0:
                return text(entry.name);
            case 1:
                return stateText(entry);
            case 2:
                return trustText(entry);
            case 3:
                return entry.size.z > 0 ? QString::number(entry.size.z) : QString();
            case 4:
                return entry.bookmarks > 0 ? QString::number(entry.bookmarks) : QString();
            case 5:
                return entry.readers > 0 ? CaseList::tr("%n reader(s)", nullptr, int(entry.readers))
                                         : QString();
            default:
                break;
        }
        const QDateTime prepared = preparedAt(entry);
        return prepared.isValid() ? QLocale().toString(prepared, QLocale::ShortFormat) : QString();
    }
    static QVariant sortedBy(const reader::CaseEntry& entry, int column) {
        switch (column) {
            case 2:
                return entry.confidence.value_or(2.0);
            case 3:
                return entry.size.z;
            case 4:
                return entry.bookmarks;
            case 5:
                return entry.readers;
            case 6:
                return preparedAt(entry);
            default:
                return textOf(entry, column);
        }
    }

    std::vector<reader::CaseEntry> cases_;
};

CaseList::CaseList(Reading& reading)
    : reading_(reading),
      heading_(new QLabel),
      state_(new QLabel),
      search_(new QLineEdit),
      table_(new QTableView),
      model_(new CaseTable(this)),
      found_(new QSortFilterProxyModel(this)),
      open_(new QPushButton(tr("Open"))),
      back_(new QPushButton(tr("Back to the list of cases"))),
      again_(new QPushButton(tr("Connect again"))) {
    QFont large = heading_->font();
    large.setPointSizeF(large.pointSizeF() * 1.6);
    heading_->setFont(large);
    state_->setWordWrap(true);
    state_->setTextFormat(Qt::PlainText);
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
    auto* ways = new QHBoxLayout;
    ways->addWidget(back_);
    ways->addWidget(again_);
    ways->addStretch(1);
    column->addLayout(ways);
    column->addLayout(row);
    column->addWidget(table_, 1);
    column->addStretch(0);

    connect(search_, &QLineEdit::textChanged, this, [this](const QString& text) {
        found_->setFilterFixedString(text.trimmed());
        if (found_->rowCount() > 0 && !table_->currentIndex().isValid()) table_->selectRow(0);
    });
    connect(search_, &QLineEdit::returnPressed, this, &CaseList::openCurrent);
    connect(table_, &QTableView::activated, this, &CaseList::openCurrent);
    connect(open_, &QPushButton::clicked, this, &CaseList::openCurrent);
    connect(back_, &QPushButton::clicked, this, [this] {
        reading_.reader().session().openCase({});
        reading_.changed();
    });
    connect(again_, &QPushButton::clicked, this, &CaseList::connectionWanted);
    connect(&reading, &Reading::readerReplaced, this, [this] { shownRevision_ = 0; });
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
            if (!session.wantedCase().empty()) state += '\n' + text(session.wantedCase());
            break;
        case reader::Phase::lost:
            heading = tr("Waiting for the server…");
            state = text(session.failure());
            if (!session.wantedCase().empty())
                state +=
                    '\n' + tr("“%1” is opened when it is back.").arg(text(session.wantedCase()));
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
    back_->setVisible(phase == reader::Phase::connecting && !session.wantedCase().empty());
    again_->setVisible(phase == reader::Phase::failed);
    const bool lists = phase == reader::Phase::choosing || phase == reader::Phase::open ||
                       phase == reader::Phase::lost;
    for (QWidget* widget : {static_cast<QWidget*>(search_), static_cast<QWidget*>(table_),
                            static_cast<QWidget*>(open_)})
        widget->setVisible(lists && !session.cases().empty());
    if (lists && !std::exchange(listed_, lists)) search_->setFocus();
    listed_ = lists;
    open_->setEnabled(found_->rowCount() > 0);
    if (session.casesRevision() == shownRevision_) return;
    shownRevision_ = session.casesRevision();
    fill();
}

void CaseList::fill() {
    const QString current = table_->currentIndex().data(nameRole).toString();
    model_->set(reading_.reader().session().cases());
    table_->resizeColumnsToContents();
    table_->setColumnWidth(0, std::max(table_->columnWidth(0), 200));
    int shown = 0;
    for (int row = 0; row < found_->rowCount() && shown == 0; ++row)
        if (found_->index(row, 0).data(nameRole).toString() == current) shown = row;
    if (found_->rowCount() > 0) table_->selectRow(shown);
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
