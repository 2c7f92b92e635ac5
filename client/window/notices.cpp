#include "window/notices.h"

#include "window/reading.h"
#include "window/theme.h"

#include <QAccessible>
#include <QHBoxLayout>
#include <QLabel>
#include <QToolButton>
#include <QVBoxLayout>

namespace haustra::window {
namespace {

constexpr int mostNotices = 4;

}  // namespace

QWidget* Notices::rowOf(const QString& text, bool dismissible) {
    auto* row = new QWidget;
    auto* line = new QHBoxLayout(row);
    line->setContentsMargins(12, 4, 8, 4);
    auto* label = new QLabel(text);
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    label->setTextInteractionFlags(Qt::TextSelectableByMouse);
    line->addWidget(label, 1);
    row->setAutoFillBackground(true);
    paint(*row);
    if (dismissible) {
        auto* dismiss = new QToolButton;
        dismiss->setText(QStringLiteral("×"));
        dismiss->setAutoRaise(true);
        dismiss->setAccessibleName(tr("Dismiss this notice"));
        connect(dismiss, &QToolButton::clicked, this, [this, row] {
            row->deleteLater();
            --told_;
            reading_.changed();
        });
        line->addWidget(dismiss);
    }
    return row;
}

void Notices::paint(QWidget& row) {
    QPalette palette = this->palette();
    palette.setColor(QPalette::Window, theme().base);
    palette.setColor(QPalette::WindowText, theme().trouble);
    row.setPalette(palette);
    row.findChild<QLabel*>()->setPalette(palette);
}

// Another theme.
void Notices::changeEvent(QEvent* event) {
    if (event->type() != QEvent::PaletteChange) return;
    for (int n = 0; n < rows_->count(); ++n)
        paint(*rows_->itemAt(n)->widget());
}

Notices::Notices(Reading& reading) : reading_(reading), rows_(new QVBoxLayout(this)) {
    rows_->setContentsMargins(0, 0, 0, 0);
    rows_->setSpacing(1);
    linkRow_ = rowOf({}, false);
    link_ = linkRow_->findChild<QLabel*>();
    rows_->addWidget(linkRow_);
    linkRow_->hide();
    connect(&reading, &Reading::stepped, this, &Notices::look);
    connect(&reading, &Reading::told, this, &Notices::tell);
}

void Notices::look() {
    const reader::Session& session = reading_.reader().session();
    const reader::Phase phase = session.phase();
    const bool down = phase != reader::Phase::open && phase != reader::Phase::choosing;
    // A server may be slow; one that says nothing of it must not look like one that is done.
    constexpr std::chrono::seconds longWait{15};
    const auto overdue = session.overdue();
    const bool wanted = (down || overdue >= longWait) && reading_.reader().isOpen();
    if (wanted && !down) {
        const QString state =
            tr("The server has owed a picture or an answer for %1 s.").arg(overdue.count());
        if (link_->text() != state) link_->setText(state);
    } else if (wanted) {
        QString state = text(session.failure());
        if (phase == reader::Phase::connecting)
            state = tr("The server opens the case. What is shown is old until then.");
        else if (phase == reader::Phase::lost)
            state = tr("The link is down: %1. Trying again; the flight stands still.").arg(state);
        else if (phase == reader::Phase::failed)
            state = tr("The session has ended: %1. “Connect again” in the menu of files begins "
                       "another.")
                        .arg(state);
        if (session.owedBookmarks() > 0)
            state += ' ' + tr("%n bookmark(s) will be saved when the server is back.", nullptr,
                              int(session.owedBookmarks()));
        if (link_->text() != state) link_->setText(state);
    }
    if (wanted == linkIsDown_) return;
    linkIsDown_ = wanted;
    linkRow_->setVisible(wanted);
}

void Notices::tell(const QString& text, bool trouble) {
    if (!trouble) return;
    // The same again is not another notice.
    for (QLabel* label : findChildren<QLabel*>())
        if (label != link_ && label->text() == text) return;
    if (told_ >= mostNotices) {
        delete rows_->itemAt(1)->widget();  // its place in the layout goes with it
        --told_;
    }
    QWidget* row = rowOf(text, true);
    rows_->addWidget(row);
    ++told_;
    reading_.changed();
    QAccessibleEvent alert(row, QAccessible::Alert);
    QAccessible::updateAccessibility(&alert);
}

}  // namespace haustra::window
