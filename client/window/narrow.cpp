#include "window/narrow.h"

#include <QPainter>

namespace haustra::window {

void NarrowLabel::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setPen(palette().color(foregroundRole()));
    painter.drawText(contentsRect(), Qt::AlignVCenter | Qt::TextSingleLine,
                     fontMetrics().elidedText(text(), Qt::ElideRight, contentsRect().width()));
}

void NarrowButton::setWords(const QString& whole, const QString& least) {
    if (whole == whole_ && least == least_) return;
    whole_ = whole, least_ = least;
    setAccessibleName(whole);
    fit();
    updateGeometry();
}

void NarrowButton::resizeEvent(QResizeEvent* event) {
    QToolButton::resizeEvent(event);
    fit();
}

// A button's own hint is of the words that it shows now, by their size, which may be some pixels
// off how far they advance.
QSize NarrowButton::hintFor(const QString& words) const {
    constexpr int slack = 4;
    const QSize shown = QToolButton::sizeHint();
    return {shown.width() + fontMetrics().horizontalAdvance(words) -
                fontMetrics().horizontalAdvance(text()) + slack,
            shown.height()};
}

void NarrowButton::fit() {
    const int around = QToolButton::sizeHint().width() - fontMetrics().horizontalAdvance(text());
    const int room = width() - around;
    QString words = fontMetrics().elidedText(whole_, Qt::ElideRight, room);
    if (!words.startsWith(least_)) words = least_;
    if (words != text()) setText(words);
}

}  // namespace haustra::window
