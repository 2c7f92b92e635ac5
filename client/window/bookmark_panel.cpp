#include "window/bookmark_panel.h"

#include "window/chosen_items.h"
#include "window/icons.h"
#include "window/theme.h"

#include <QDateTime>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QInputDialog>
#include <QLabel>
#include <QLineEdit>
#include <QLocale>
#include <QMenu>
#include <QToolButton>
#include <QTreeWidget>
#include <QVBoxLayout>
#include <algorithm>

namespace haustra::window {
namespace {

enum State { saved, sending, refused };
constexpr int keyRole = Qt::UserRole, stateRole = Qt::UserRole + 1, noteRole = Qt::UserRole + 2;

/// Of those that the server has or will have, and those that it refused; along the colon, as they
/// are met in flight.
struct Entry {
    reader::Bookmark bookmark;
    State state;
    QString reason{};
};

std::vector<Entry> entriesOf(const reader::Session& session) {
    std::vector<Entry> entries;
    for (const reader::Bookmark& bookmark : session.bookmarks())
        entries.push_back({bookmark, bookmark.acknowledged() ? saved : sending});
    for (const reader::RefusedBookmark& refusal : session.refusedBookmarks())
        entries.push_back({refusal.bookmark, refused, text(refusal.reason)});
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return a.bookmark.arcMm < b.bookmark.arcMm;
    });
    return entries;
}

std::string keyOf(const QTreeWidgetItem& item) {
    return item.data(0, keyRole).toString().toStdString();
}

QDateTime whenOf(const std::string& utc) {
    return QDateTime::fromString(text(utc), Qt::ISODate).toLocalTime();
}

// Short, for the note's sake: of today the time, else the day.
QString whenText(const QDateTime& when) {
    if (!when.isValid()) return {};
    return when.date() == QDate::currentDate()
               ? QLocale().toString(when.time(), QStringLiteral("HH:mm"))
               : QLocale().toString(when.date(), QLocale::ShortFormat);
}

}  // namespace

BookmarkPanel::BookmarkPanel(Reading& reading)
    : reading_(reading),
      note_(new QLineEdit),
      list_(new QTreeWidget),
      hint_(new QLabel(tr("B marks the place in view; Shift+B with a note."))),
      reason_(new QLabel) {
    note_->setPlaceholderText(tr("note, then Enter"));
    note_->setAccessibleName(tr("Note of a new bookmark"));
    auto* addButton = new QToolButton;
    addButton->setIcon(iconOf(Symbol::bookmark));
    addButton->setToolTip(tr("Bookmark this place with this note"));
    addButton->setAccessibleName(tr("Add the bookmark"));
    list_->setAccessibleName(tr("Bookmarks along the colon"));
    list_->setColumnCount(3);
    list_->setHeaderLabels({tr("mm"), tr("Note"), tr("Saved")});
    list_->setRootIsDecorated(false);
    list_->setAllColumnsShowFocus(true);
    list_->setContextMenuPolicy(Qt::CustomContextMenu);
    list_->header()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
    list_->header()->setSectionResizeMode(1, QHeaderView::Stretch);
    list_->header()->setSectionResizeMode(2, QHeaderView::ResizeToContents);
    list_->header()->setStretchLastSection(false);
    hint_->setWordWrap(true);
    hint_->setAlignment(Qt::AlignCenter);
    reason_->setWordWrap(true);
    reason_->setTextFormat(Qt::PlainText);
    reason_->hide();
    auto* row = new QHBoxLayout;
    row->addWidget(note_);
    row->addWidget(addButton);
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(6, 6, 6, 6);
    column->addLayout(row);
    column->addWidget(reason_);
    column->addWidget(list_, 1);
    column->addWidget(hint_);
    connect(note_, &QLineEdit::returnPressed, this, &BookmarkPanel::add);
    connect(addButton, &QToolButton::clicked, this, &BookmarkPanel::add);
    onChosen(*list_, [this](QTreeWidgetItem& item) { goTo(keyOf(item)); });
    connect(list_, &QTreeWidget::customContextMenuRequested, this, &BookmarkPanel::showMenu);
    connect(&reading, &Reading::stepped, this, &BookmarkPanel::look);
    connect(note_, &QLineEdit::textEdited, this, [this](const QString& text) {
        // Set anew, so that undoing does not bring it back as the note of another place.
        if (text.isEmpty() && !offered_.empty()) {
            endOffer();
            note_->setText({});
        }
    });
    connect(&reading, &Reading::readerReplaced, this, [this] { shownRevision_ = 0; });
    // A note that was begun is of its patient.
    connect(&reading, &Reading::caseOpened, this, [this] {
        if (!offered_.empty()) note_->setText({});  // it is in its case's list
        endOffer();
        deferred_.clear();
        drafts_[std::exchange(draftOf_, reading_.reader().session().caseInfo()->scan)] =
            note_->text();
        note_->setText(drafts_[draftOf_]);
    });
}

void BookmarkPanel::writeNote() {
    // A new one, of the place in view; the other is in the list.
    if (!offered_.empty()) {
        endOffer();
        note_->setText({});
    }
    note_->setFocus(Qt::ShortcutFocusReason);
}

void BookmarkPanel::add() {
    if (!reading_.reader().isOpen()) return;
    const std::string note = note_->text().toStdString();
    if (offered_.empty())
        reading_.reader().addBookmark(note);
    else if (reading_.reader().session().sendRefusedAgain(offered_, note).empty())
        reading_.tell(tr("That bookmark is no longer to be sent."));
    deferred_.erase(offered_);  // refused again, it is in the field again
    endOffer();
    note_->setText({});
    reading_.changed();
    emit written();
}

void BookmarkPanel::look() {
    setEnabled(reading_.reader().isOpen());
    const std::uint64_t revision = reading_.reader().session().bookmarksRevision();
    const bool writes = window()->focusWidget() == note_;
    if (!isVisible() || (revision == shownRevision_ && writes == writes_)) return;
    writes_ = writes;
    if (std::exchange(shownRevision_, revision) != revision) fill();
    offerRefused();
}

void BookmarkPanel::fill() {
    const QString current =
        list_->currentItem() ? list_->currentItem()->data(0, keyRole).toString() : QString();
    list_->clear();
    for (const Entry& entry : entriesOf(reading_.reader().session())) {
        const QString note = text(entry.bookmark.note);
        const QString when = entry.state == saved     ? whenText(whenOf(entry.bookmark.createdUtc))
                             : entry.state == sending ? tr("sending…")
                                                      : tr("refused");
        auto* item = new QTreeWidgetItem(list_, {QString::number(entry.bookmark.arcMm, 'f', 0),
                                                 note.isEmpty() ? tr("Bookmark") : note, when});
        item->setTextAlignment(0, Qt::AlignRight | Qt::AlignVCenter);
        item->setData(0, keyRole, text(entry.bookmark.clientKey));
        item->setData(0, stateRole, entry.state);
        item->setData(0, noteRole, note);
        item->setToolTip(1, toolTipOf(entry.state == refused ? note + '\n' + entry.reason : note));
        if (entry.state == saved)
            item->setToolTip(
                2, QLocale().toString(whenOf(entry.bookmark.createdUtc), QLocale::LongFormat));
        if (entry.state == refused)
            for (int column = 0; column < 3; ++column)
                item->setForeground(column, theme().trouble);
        else
            item->setForeground(0, theme().bookmark);
        if (item->data(0, keyRole).toString() == current) list_->setCurrentItem(item);
    }
    hint_->setVisible(list_->topLevelItemCount() == 0);
}

// What the server refused is in the field again, where nothing else is being written: Enter sends
// it, at its own place; an empty field leaves it in the list.
void BookmarkPanel::offerRefused() {
    const auto refused = reading_.reader().session().refusedBookmarks();
    const auto isRefused = [&](const std::string& key) {
        return std::any_of(refused.begin(), refused.end(), [&](const reader::RefusedBookmark& r) {
            return r.bookmark.clientKey == key;
        });
    };
    if (!offered_.empty() && !isRefused(offered_)) {  // dealt with in the list
        endOffer();
        note_->setText({});
    }
    // Not under a hand that is about to write of another place.
    if (!offered_.empty() || !note_->text().isEmpty() || window()->focusWidget() == note_) return;
    for (const reader::RefusedBookmark& refusal : refused) {
        const reader::Bookmark& bookmark = refusal.bookmark;
        if (bookmark.note.empty() || !deferred_.insert(bookmark.clientKey).second) continue;
        offered_ = bookmark.clientKey;
        note_->setText(text(bookmark.note));
        reason_->setText(tr("At %1 mm, not saved: %2. Enter sends it again.")
                             .arg(bookmark.arcMm, 0, 'f', 0)
                             .arg(text(refusal.reason)));
        QPalette palette = this->palette();
        palette.setColor(QPalette::WindowText, theme().trouble);
        reason_->setPalette(palette);
        reason_->show();
        note_->setAccessibleDescription(reason_->text());
        return;
    }
}

void BookmarkPanel::endOffer() {
    offered_.clear();
    reason_->hide();
    note_->setAccessibleDescription({});
}

void BookmarkPanel::goTo(const std::string& key) {
    for (const Entry& entry : entriesOf(reading_.reader().session()))
        if (entry.bookmark.clientKey == key)
            return reading_.jump(tr("go to a bookmark"), [this, bookmark = entry.bookmark] {
                reading_.reader().goTo(bookmark);
            });
}

void BookmarkPanel::showMenu(const QPoint& position) {
    QTreeWidgetItem* item = list_->itemAt(position);
    if (!item) return;
    // The list may be filled anew while the menu is open: the item is not to be kept.
    const std::string key = keyOf(*item);
    QMenu menu(this);
    menu.addAction(tr("Go there"), this, [this, key] { goTo(key); });
    if (item->data(0, stateRole).toInt() == refused) {
        const QString before = item->data(0, noteRole).toString();
        menu.addAction(tr("Send again…"), this, [this, key, before] {
            bool wanted = false;
            const QString note =
                QInputDialog::getText(this, tr("Send the bookmark again"), tr("Note"),
                                      QLineEdit::Normal, before, &wanted);
            if (wanted) reading_.reader().session().sendRefusedAgain(key, note.toStdString());
            reading_.changed();
        });
        menu.addAction(tr("Discard"), this, [this, key] {
            reading_.reader().session().dismissRefused(key);
            reading_.changed();
        });
    }
    menu.exec(list_->viewport()->mapToGlobal(position));
}

}  // namespace haustra::window
