#include "window/pane.h"

#include "window/picture_out.h"
#include "window/theme.h"

#include <QApplication>
#include <QDateTime>
#include <QDrag>
#include <QMimeData>
#include <QMouseEvent>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace haustra::window {
namespace {

constexpr double clickReach = 4.0;  // what moves no farther is a click

// The picture's memory stays the reader's: valid until the next step.
QImage imageOf(const tiles::Picture& picture) {
    if (picture.width <= 0) return {};
    return QImage(picture.pixels.data(), picture.width, picture.height, 4 * picture.width,
                  QImage::Format_RGB32);
}

}  // namespace

Pane::Pane(Reading& reading, View view, const QString& title, QWidget* parent)
    : QWidget(parent), reading_(reading), view_(view), title_(title) {
    setAttribute(Qt::WA_OpaquePaintEvent);
    setMouseTracking(true);
    setFocusPolicy(Qt::StrongFocus);
    setAccessibleName(title);
    connect(&reading, &Reading::stepped, this, &Pane::look);
    // A drag that was begun in another case ends with it.
    connect(&reading, &Reading::caseOpened, this, [this] { held_ = Qt::NoButton; });
}

QString Pane::inWords() const {
    switch (reader().freshness(view_)) {
        case reader::Freshness::none:
            return tr("waiting for the picture");
        case reader::Freshness::old:
            return tr("old: the link is down");
        case reader::Freshness::exact:
            return tr("exact");
        case reader::Freshness::moving:
            break;
    }
    return tr("moving");
}

double Pane::widgetPerPixel() const {
    return double(width()) / std::max(1, pictureSize().x);
}

// ---- painting -----------------------------------------------------------------------------------

void Pane::look() {
    if (!isVisible()) return;
    tellSize();  // what lies over it may have gone
    Shown shown;
    shown.add(double(reader().panes().pictureCount(view_)));
    shown.add(double(reader().freshness(view_)));
    shown.add(isHovered_ + 2 * hasFocus());
    shown.add(double(reading_.tool()));
    if (isOpen()) addShown(shown);
    if (shown == shown_) return;
    shown_ = std::move(shown);
    setAccessibleDescription(isOpen() ? inWords() : QString());
    update();
}

void Pane::paintPicture(QPainter& painter, const QImage& picture) {
    const double ratio = devicePixelRatioF();
    if (picture.size() == QSize(int(width() * ratio), int(height() * ratio))) {
        QImage exact = picture;
        exact.setDevicePixelRatio(ratio);
        painter.drawImage(QPointF(0, 0), exact);
        return;
    }
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawImage(QRectF(rect()), picture);
}

void Pane::paintAll(QPainter& painter) {
    painter.fillRect(rect(), Qt::black);
    const QImage picture = imageOf(reader().panes().picture(view_));
    const reader::Freshness freshness = reader().freshness(view_);
    if (!isOpen() || freshness == reader::Freshness::none || picture.isNull()) {
        painter.setPen(theme().dimOnPicture);
        painter.setFont(smallFont(font()));
        painter.drawText(rect(), Qt::AlignCenter | Qt::TextWordWrap,
                         tr("waiting for the picture…"));
        return;
    }
    paintPicture(painter, picture);
    painter.setRenderHint(QPainter::Antialiasing);
    if (freshness == reader::Freshness::old) painter.fillRect(rect(), QColor(8, 10, 13, 130));
    paintMarks(painter);
    if (freshness == reader::Freshness::old) {
        painter.setFont(smallFont(font()));
        outlinedText(painter, QRectF(rect()).center(), Qt::AlignCenter, theme().onPicture,
                     tr("old picture"));
    }
}

void Pane::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    paintAll(painter);
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setBrush(Qt::NoBrush);
    if (hasFocus())
        painter.setPen(QPen(theme().accentOnPicture, 2.0 * theme().lineWidth));
    else
        painter.setPen(isHovered_ ? theme().muted : theme().border);
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

QImage Pane::pictureWithMarks() {
    if (!isOpen() || reader().freshness(view_) == reader::Freshness::none) return {};
    const double ratio = devicePixelRatioF();
    QImage image(size() * ratio, QImage::Format_RGB32);
    image.setDevicePixelRatio(ratio);
    QPainter painter(&image);
    painter.setFont(font());
    namesItself_ = true;
    paintAll(painter);
    namesItself_ = false;
    painter.end();
    image.setText(QStringLiteral("Description"), provenance());
    image.setText(QStringLiteral("Software"), QCoreApplication::applicationName() + ' ' +
                                                  QCoreApplication::applicationVersion());
    return image;
}

QString Pane::provenance() const {
    if (!isOpen()) return {};
    const reader::CaseInfo& info = *reader().session().caseInfo();
    return tr("Case: %1").arg(text(info.name)) + '\n' + tr("View: %1 (%2)").arg(title_, inWords()) +
           '\n' +
           tr("Place: %1 mm of %2 mm along the path")
               .arg(reader().flight().placeArcMm(), 0, 'f', 0)
               .arg(info.centerline.lengthMm(), 0, 'f', 0) +
           '\n' +
           tr("Server: %1, %2")
               .arg(reading_.serverName(), text(reader().session().server().serverSoftware)) +
           '\n' + tr("Taken: %1").arg(QDateTime::currentDateTimeUtc().toString(Qt::ISODate)) +
           '\n' + tr("For a physician's judgement; not a certified medical device.");
}

// ---- size ---------------------------------------------------------------------------------------

void Pane::tellSize() {
    const double ratio = devicePixelRatioF();
    const bool inSight = isVisible() && width() > 1 && height() > 1 && !visibleRegion().isEmpty();
    const glm::ivec2 size =
        inSight ? glm::ivec2(int(width() * ratio), int(height() * ratio)) : glm::ivec2(0);
    if (size == toldSize_) return;
    toldSize_ = size;
    reader().setPaneSize(view_, size);
    reading_.changed();
}

void Pane::resizeEvent(QResizeEvent*) {
    tellSize();
}
void Pane::showEvent(QShowEvent*) {
    shown_ = {};
    tellSize();
}
void Pane::hideEvent(QHideEvent*) {
    held_ = Qt::NoButton;
    tellSize();
}

// ---- the hand -----------------------------------------------------------------------------------

namespace {

Hand handOf(const QMouseEvent& event, QPointF before, Qt::MouseButton held) {
    return {event.position(), event.position() - before, event.modifiers(), held};
}

}  // namespace

void Pane::mousePressEvent(QMouseEvent* event) {
    if (held_ != Qt::NoButton) return;  // a second button does nothing
    held_ = event->button();
    pressedAt_ = lastAt_ = event->position();
    isDrag_ = false;
    takesPictureOut_ = held_ == Qt::LeftButton && event->modifiers().testFlag(Qt::AltModifier);
    if (isOpen() && !takesPictureOut_) pressed(handOf(*event, lastAt_, held_));
    reading_.changed();
}

void Pane::mouseMoveEvent(QMouseEvent* event) {
    const Hand hand = handOf(*event, lastAt_, held_);
    if (held_ == Qt::NoButton) {
        lastAt_ = event->position();
        if (isOpen()) hovered(hand);
        return;
    }
    const QPointF way = event->position() - pressedAt_;
    isDrag_ = isDrag_ || std::hypot(way.x(), way.y()) > clickReach;
    if (!isDrag_ || !isOpen()) return;
    if (takesPictureOut_) return dragOut();
    lastAt_ = event->position();
    dragged(hand);
    reading_.changed();
}

void Pane::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != held_) return;
    const Hand hand = handOf(*event, lastAt_, held_);
    const bool wasMenu = held_ == Qt::RightButton && !isDrag_;
    held_ = Qt::NoButton;
    if (wasMenu) return emit menuWanted(event->globalPosition().toPoint());
    if (!isOpen() || takesPictureOut_) return;
    const int steps = reading_.undoStack().index();
    if (!isDrag_) clicked(hand);
    released(hand);
    clickStep_ = !isDrag_ && reading_.undoStack().index() == steps + 1 ? steps + 1 : -1;
    reading_.changed();
}

void Pane::takeClickBack() {
    if (std::exchange(clickStep_, -1) == reading_.undoStack().index()) reading_.undoStack().undo();
}

void Pane::mouseDoubleClickEvent(QMouseEvent* event) {
    if (!takesDoubleClicks()) return mousePressEvent(event);
    if (isOpen() && event->button() == Qt::LeftButton)
        doubleClicked(handOf(*event, event->position(), Qt::LeftButton));
    held_ = Qt::NoButton;
    reading_.changed();
}

void Pane::wheelEvent(QWheelEvent* event) {
    // Alt turns some platforms' wheels sideways.
    const QPoint angle = event->angleDelta();
    const double steps = (angle.y() != 0 ? angle.y() : angle.x()) / 120.0;
    if (isOpen() && steps != 0.0)
        wheeled({event->position(), {}, event->modifiers(), held_}, steps);
    event->accept();
    reading_.changed();
}

void Pane::enterEvent(QEnterEvent*) {
    isHovered_ = true;
    look();
}
void Pane::leaveEvent(QEvent*) {
    isHovered_ = false;
    if (isOpen()) left();
    look();
}
void Pane::focusInEvent(QFocusEvent*) {
    look();
}
void Pane::focusOutEvent(QFocusEvent*) {
    look();
}

void Pane::keyPressEvent(QKeyEvent* event) {
    if (event->key() == Qt::Key_Menu)
        emit menuWanted(mapToGlobal(rect().center()));
    else
        QWidget::keyPressEvent(event);
}

void Pane::dragOut() {
    const QImage image = pictureWithMarks();
    held_ = Qt::NoButton;
    if (image.isNull()) return;
    auto* drag = new QDrag(this);
    drag->setMimeData(mimeDataOf(image));
    drag->setPixmap(QPixmap::fromImage(image.scaledToWidth(160, Qt::SmoothTransformation)));
    drag->exec(Qt::CopyAction);
}

// ---- what is drawn over pictures ----------------------------------------------------------------

QFont smallFont(const QFont& font) {
    QFont small = font;
    small.setPointSizeF(font.pointSizeF() * 0.92);
    return small;
}
QFont largeFont(const QFont& font) {
    QFont large = font;
    large.setPointSizeF(font.pointSizeF() * 1.5);
    return large;
}

QRectF outlinedText(QPainter& painter, QPointF at, Qt::Alignment alignment, const QColor& color,
                    const QString& text) {
    const QFontMetricsF metrics(painter.font());
    QRectF box(at, QSizeF(metrics.horizontalAdvance(text), metrics.height()));
    if (alignment & Qt::AlignRight) box.translate(-box.width(), 0);
    if (alignment & Qt::AlignHCenter) box.translate(-box.width() / 2, 0);
    if (alignment & Qt::AlignBottom) box.translate(0, -box.height());
    if (alignment & Qt::AlignVCenter) box.translate(0, -box.height() / 2);
    const QPointF baseline(std::round(box.left()), std::round(box.top() + metrics.ascent()));
    painter.setPen(theme().outline);
    for (const QPointF way : {QPointF(-1, 0), QPointF(1, 0), QPointF(0, -1), QPointF(0, 1),
                              QPointF(-1, -1), QPointF(1, 1), QPointF(-1, 1), QPointF(1, -1)})
        painter.drawText(baseline + way, text);
    painter.setPen(color);
    painter.drawText(baseline, text);
    return box;
}

void outlinedPolyline(QPainter& painter, const QPolygonF& line, bool closed, const QColor& color) {
    painter.setBrush(Qt::NoBrush);
    const double wide = theme().lineWidth;
    for (const QPen& pen : {QPen(theme().outline, 3.6 * wide), QPen(color, 1.6 * wide)}) {
        painter.setPen(pen);
        closed ? painter.drawPolygon(line) : painter.drawPolyline(line);
    }
}

void paintCross(QPainter& painter, QPointF at, double inner, double outer, const QColor& color) {
    painter.setPen(QPen(color, 1.4 * theme().lineWidth));
    for (const QPointF way : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)})
        painter.drawLine(at + inner * way, at + outer * way);
}

void paintPlaceMark(QPainter& painter, QPointF at) {
    const double wide = theme().lineWidth;
    for (const QPointF way : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)}) {
        painter.setPen(QPen(QColor(0, 0, 0, 180), 3.5 * wide));
        painter.drawLine(at + 4 * way, at + 10 * way);
        painter.setPen(QPen(theme().accentOnPicture, 1.6 * wide));
        painter.drawLine(at + 4 * way, at + 10 * way);
    }
}

void paintBookmarkFlag(QPainter& painter, QPointF foot) {
    const QColor color = theme().bookmarkOnPicture;
    painter.setPen(QPen(theme().outline, 3.5));
    painter.drawLine(foot, foot + QPointF(0, -12));
    painter.setPen(QPen(color, 1.5 * theme().lineWidth));
    painter.drawLine(foot, foot + QPointF(0, -12));
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawPolygon(
        QPolygonF({foot + QPointF(0, -13), foot + QPointF(8, -9.5), foot + QPointF(0, -6)}));
    painter.drawEllipse(foot, 2, 2);
}

namespace {

// Towards which sides of the patient a direction goes: one letter, or two between them, the nearer
// first.
QString lettersOf(glm::dvec3 direction) {
    constexpr std::array low{'R', 'A', 'F'}, high{'L', 'P', 'H'};
    std::array<int, 3> axes{0, 1, 2};
    const auto share = [&](int axis) { return std::abs(direction[axis]); };
    std::sort(axes.begin(), axes.end(), [&](int a, int b) { return share(a) > share(b); });
    const auto letter = [&](int axis) {
        return QChar::fromLatin1((direction[axis] > 0.0 ? high : low)[std::size_t(axis)]);
    };
    QString letters = letter(axes[0]);
    if (share(axes[1]) > 0.42 * glm::length(direction)) letters += letter(axes[1]);
    return letters;
}

}  // namespace

void paintSides(QPainter& painter, const QRectF& area, glm::dvec3 right, glm::dvec3 up) {
    const QPointF middle = area.center();
    const QColor color = theme().dimOnPicture;
    constexpr double margin = 5.0;
    outlinedText(painter, {area.left() + margin, middle.y()}, Qt::AlignLeft | Qt::AlignVCenter,
                 color, lettersOf(-right));
    outlinedText(painter, {area.right() - margin, middle.y()}, Qt::AlignRight | Qt::AlignVCenter,
                 color, lettersOf(right));
    outlinedText(painter, {middle.x(), area.top() + margin}, Qt::AlignHCenter | Qt::AlignTop, color,
                 lettersOf(up));
    outlinedText(painter, {middle.x(), area.bottom() - margin}, Qt::AlignHCenter | Qt::AlignBottom,
                 color, lettersOf(-up));
}

double paintScaleBar(QPainter& painter, const QRectF& area, double pixelsPerMm) {
    double mm = 100.0;
    constexpr std::array lengths{100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.5};
    for (const double length : lengths) {
        mm = length;
        if (mm * pixelsPerMm <= area.width() / 3.5) break;
    }
    const double margin = 10.0;
    const QPointF to(area.right() - margin, area.bottom() - margin),
        from(to.x() - mm * pixelsPerMm, to.y());
    painter.setPen(QPen(theme().outline, 4));
    painter.drawLine(from, to);
    painter.setPen(QPen(theme().onPicture, 1.5));
    painter.drawLine(from, to);
    return outlinedText(painter, {(from.x() + to.x()) / 2, to.y() - 4},
                        Qt::AlignHCenter | Qt::AlignBottom, theme().dimOnPicture,
                        QStringLiteral("%1 mm").arg(mm))
        .top();
}

}  // namespace haustra::window
