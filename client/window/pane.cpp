#include "window/pane.h"

#include "window/picture_out.h"
#include "window/theme.h"

#include <QApplication>
#include <QDateTime>
#include <QDrag>
#include <QMimeData>
#include <QMouseEvent>
#include <QWindow>
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
    connect(&reading, &Reading::caseOpened, this, [this] {
        held_ = Qt::NoButton;
        keyDraws_ = false;  // what was begun is of the former case
        setKeyPointer(false);
    });
    connect(&reading, &Reading::readerReplaced, this, [this] {
        shown_ = {};
        toldSize_ = glm::ivec2(0);
        tellSizeSoon();
    });
    sizeDue_.setSingleShot(true);
    connect(&sizeDue_, &QTimer::timeout, this, &Pane::tellSize);
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

QRectF Pane::pictureArea() const {
    const glm::ivec2 pixels = glm::max(pictureSize(), glm::ivec2(1));
    const QSizeF own = QSizeF(pixels.x, pixels.y).scaled(size(), Qt::KeepAspectRatio);
    // Pixels are whole: so small a difference is none.
    if (width() - own.width() < 1.5 && height() - own.height() < 1.5) return rect();
    return {0.5 * (width() - own.width()), 0.5 * (height() - own.height()), own.width(),
            own.height()};
}

double Pane::widgetPerPixel() const {
    return pictureArea().width() / std::max(1, pictureSize().x);
}
glm::dvec2 Pane::pixelAt(QPointF position) const {
    return vector(position - pictureArea().topLeft()) / widgetPerPixel();
}
QPointF Pane::positionOf(glm::dvec2 pixel) const {
    return pictureArea().topLeft() + point(pixel * widgetPerPixel());
}

// ---- painting -----------------------------------------------------------------------------------

void Pane::look() {
    tellOnScreen();
    if (!isVisible()) return;
    if (!sizeDue_.isActive()) tellSize();  // what lies over it may have gone
    Shown shown;
    shown.add(double(reader().panes().pictureCount(view_)));
    shown.add(double(reader().freshness(view_)));
    shown.add(isHovered_ + 2 * hasFocus() + 4 * hasKeyPointer());
    if (keyPointer_) shown.add(keyPointer_->x()), shown.add(keyPointer_->y());
    shown.add(double(reading_.tool()));
    if (isOpen()) addShown(shown);
    if (shown == shown_) return;
    shown_ = std::move(shown);
    setAccessibleDescription(isOpen() ? inWords() : QString());
    update();
}

// The picture that was painted last, where the window's system shows it.
void Pane::tellOnScreen() {
    const QWindow* around = window()->windowHandle();
    if (!isVisible() || visibleRegion().isEmpty() || !around || !around->isExposed() ||
        !isLookedAt())
        reader().session().offScreen(int(view_));
    else if (paintedCount_ > 0 && paintedCount_ == reader().panes().pictureCount(view_))
        reader().session().onScreen(reader().panes().picture(view_));
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
    painter.drawImage(pictureArea(), picture);
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
    paintedCount_ = isOpen() ? reader().panes().pictureCount(view_) : 0;
    tellOnScreen();
    paintKeyPointer(painter);
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.setBrush(Qt::NoBrush);
    if (hasFocus())
        painter.setPen(QPen(theme().accentOnPicture, 2.0 * theme().lineWidth));
    else
        painter.setPen(isHovered_ ? theme().muted : theme().border);
    painter.drawRect(QRectF(rect()).adjusted(0.5, 0.5, -0.5, -0.5));
}

void Pane::addRulersAndFindings(Shown& shown) const {
    for (const reader::PlaceRuler& ruler : reader().shownRulers()) {
        for (const reader::PlaceRuler::End* end : {&ruler.from, &ruler.to}) {
            shown.add(end->positionMm);
            shown.add(end->flat ? end->flat->x : -1.0);
        }
    }
    if (const auto& begun = reader().rulers().begun()) shown.add(begun->positionMm);
    for (const reader::ListedFinding& finding : reader().findings().shown())
        shown.add(finding.number);
}

QString Pane::rulerInWords() const {
    const auto rulers = reader().shownRulers();
    return rulers.empty() ? QString() : QStringLiteral(", ") + textOf(rulers.back());
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

// Panes that are arranged anew are hidden, moved and shown again, and slide to where they belong:
// the server is told what has come of it, or every view would begin anew several times.
void Pane::tellSizeSoon() {
    sizeDue_.start(std::chrono::milliseconds(50));
}

void Pane::resizeEvent(QResizeEvent*) {
    if (keyPointer_) keyPointer_ = within(*keyPointer_);
    tellSizeSoon();
}
void Pane::showEvent(QShowEvent*) {
    shown_ = {};
    tellSizeSoon();
}
void Pane::hideEvent(QHideEvent*) {
    reader().session().offScreen(int(view_));
    held_ = Qt::NoButton;
    mouseAt_.reset();
    setKeyPointer(false);
    tellSizeSoon();
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
    mouseAt_ = event->globalPosition();
    isDrag_ = false;
    takesPictureOut_ = held_ == Qt::LeftButton && event->modifiers().testFlag(Qt::AltModifier);
    if (isOpen() && !takesPictureOut_) pressed(handOf(*event, lastAt_, held_));
    reading_.changed();
}

void Pane::mouseMoveEvent(QMouseEvent* event) {
    const Hand hand = handOf(*event, lastAt_, held_);
    mouseAt_ = event->globalPosition();
    if (held_ == Qt::NoButton) {
        lastAt_ = event->position();
        if (isOpen() && !reading_.pointsByKeys()) hovered(hand);
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

// Panes that are arranged anew pass beneath a mouse that rests, and some are entered and never
// left.
void Pane::enterEvent(QEnterEvent*) {
    isHovered_ = true;
    mouseAt_.reset();
    look();
}
void Pane::leaveEvent(QEvent*) {
    isHovered_ = false;
    mouseAt_.reset();
    if (isOpen() && !reading_.pointsByKeys()) left();
    look();
}
void Pane::focusInEvent(QFocusEvent*) {
    look();
}
void Pane::focusOutEvent(QFocusEvent* event) {
    if (event->reason() != Qt::PopupFocusReason && event->reason() != Qt::MenuBarFocusReason)
        setKeyPointer(false);
    look();
}

namespace {

// The way of an arrow; none: of none.
std::optional<QPointF> wayOf(const QKeyEvent& key) {
    if (key.modifiers() & Qt::AltModifier) return std::nullopt;
    const bool isFine = key.modifiers().testFlag(Qt::ControlModifier),
               isFar = key.modifiers().testFlag(Qt::ShiftModifier);
    const double step = isFine ? 1.0 : isFar ? 24.0 : 5.0;
    switch (key.key()) {
        case Qt::Key_Left:
            return QPointF(-step, 0);
        case Qt::Key_Right:
            return QPointF(step, 0);
        case Qt::Key_Up:
            return QPointF(0, -step);
        case Qt::Key_Down:
            return QPointF(0, step);
        default:
            return std::nullopt;
    }
}
bool presses(const QKeyEvent& key) {
    return key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter;
}

}  // namespace

void Pane::keyPressEvent(QKeyEvent* event) {
    if (isOpen() && needsKey(*event)) {
        if (const auto way = wayOf(*event)) return moveKeyPointer(*way);
        if (!event->isAutoRepeat()) pressKeyPointer(event->modifiers());
        return;
    }
    if (event->key() == Qt::Key_Menu)
        emit menuWanted(mapToGlobal(rect().center()));
    else
        QWidget::keyPressEvent(event);
}

// ---- the keyboard in the place of the mouse -----------------------------------------------------

std::optional<QPointF> Pane::pointedAt() const {
    if (keyPointer_) return keyPointer_;
    // One place is pointed at: a mouse that rests elsewhere does not count.
    if (!underMouse() || !mouseAt_ || reading_.pointsByKeys()) return std::nullopt;
    const QPointF at = mapFromGlobal(*mouseAt_);
    return QRectF(rect()).contains(at) ? std::optional(at) : std::nullopt;
}

Hand Pane::keyHand(Qt::KeyboardModifiers modifiers, QPointF moved) const {
    return {keyPointer_.value_or(QRectF(rect()).center()), moved, modifiers, Qt::LeftButton};
}

void Pane::setKeyPointer(bool on) {
    if (on == hasKeyPointer()) return;
    if (!on) {
        if (std::exchange(keyDraws_, false)) released(keyHand({}));
        keyPointer_.reset();
        if (isOpen()) left();
    } else {
        window()->activateWindow();
        setFocus(Qt::ShortcutFocusReason);
        keyPointer_ = QRectF(rect()).center();
        if (isOpen()) hovered(keyHand({}));
    }
    reading_.setPointsByKeys(on);
    reading_.changed();
}

bool Pane::needsKey(const QKeyEvent& key) const {
    return keyPointer_ && (wayOf(key) || presses(key));
}

QPointF Pane::within(QPointF position) const {
    return {std::clamp(position.x(), 0.0, std::max(0.0, width() - 1.0)),
            std::clamp(position.y(), 0.0, std::max(0.0, height() - 1.0))};
}

void Pane::moveKeyPointer(QPointF way) {
    const QPointF before = *keyPointer_, there = before + way;
    keyPointer_ = within(there);
    // The modifiers that are held are the pointer's, not a hand's.
    const Hand hand = keyHand({}, *keyPointer_ - before);
    keyDraws_ ? dragged(hand) : hovered(hand);
    reading_.changed();
}

void Pane::pressKeyPointer(Qt::KeyboardModifiers modifiers) {
    const Hand hand = keyHand(modifiers);
    if (std::exchange(keyDraws_, false)) {
        released(hand);
    } else {
        pressed(hand);
        if (draws(hand)) {
            keyDraws_ = true;
        } else {
            clicked(hand);
            released(hand);
        }
    }
    reading_.changed();
}

void Pane::paintKeyPointer(QPainter& painter) {
    if (!keyPointer_) return;
    painter.setRenderHint(QPainter::Antialiasing, false);
    for (const QPen& pen : {QPen(theme().outline, 3.0), QPen(theme().onPicture, 1.0)}) {
        painter.setPen(pen);
        for (const QPointF way : {QPointF(1, 0), QPointF(-1, 0), QPointF(0, 1), QPointF(0, -1)})
            painter.drawLine(*keyPointer_ + 3 * way, *keyPointer_ + 14 * way);
    }
}

void Pane::scrollByKeys(double steps, bool far) {
    if (!isOpen()) return;
    Hand hand = keyHand(far ? Qt::ShiftModifier : Qt::NoModifier);
    hand.button = Qt::NoButton;
    wheeled(hand, steps);
    reading_.changed();
}

void Pane::zoomByKeys(double steps) {
    if (!isOpen()) return;
    Hand hand = keyHand(Qt::ControlModifier);
    hand.button = Qt::NoButton;
    wheeled(hand, steps);
    reading_.changed();
}

void Pane::dragByKeys(QPoint steps, Qt::MouseButton button) {
    if (!isOpen() || held_ != Qt::NoButton || keyDraws_) return;
    const QPointF from = dragFrom(), way(steps.x() * width() / 20.0, steps.y() * height() / 20.0);
    const std::optional<QPointF> pointer = std::exchange(keyPointer_, std::nullopt);
    const DrawingTool tool = reading_.tool();
    reading_.setTool(DrawingTool::none);
    pressed({from, {}, {}, button});
    dragged({from + way, way, {}, button});
    released({from + way, {}, {}, button});
    reading_.setTool(tool);
    keyPointer_ = pointer;
    reading_.changed();
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

void RulerTexts::paint(QPointF from, QPointF to, bool dashed, const QString& text) {
    QPainter& painter = painter_;
    const QRectF around = QRectF(from, to).normalized().adjusted(-1, -1, 1, 1);
    if (!around.intersects(area_)) return;
    const QColor color = theme().measuredOnPicture;
    painter.setPen(QPen(theme().outline, 3.5));
    painter.drawLine(from, to);
    painter.setPen(QPen(color, 1.6 * theme().lineWidth, dashed ? Qt::DashLine : Qt::SolidLine));
    painter.drawLine(from, to);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    for (const QPointF end : {from, to})
        painter.drawEllipse(end, 2.5, 2.5);
    if (text.isEmpty()) return;
    const QFontMetricsF metrics(painter.font());
    const QSizeF size(metrics.horizontalAdvance(text), metrics.height());
    constexpr double gap = 4.0;
    const double left = around.center().x() - 0.5 * size.width(),
                 middle = around.center().y() - 0.5 * size.height();
    // Beneath first; where nothing is free, farther and farther beneath.
    std::vector<QPointF> corners{{left, around.bottom() + gap},
                                 {left, around.top() - gap - size.height()},
                                 {around.right() + gap, middle},
                                 {around.left() - gap - size.width(), middle}};
    for (std::size_t n = 1; n <= texts_.size(); ++n)
        corners.push_back({left, around.bottom() + gap + double(n) * size.height()});
    QRectF box;
    for (const QPointF corner : corners) {
        box = QRectF(corner, size);
        // The area's edges push it in; a higher text would still be cut.
        box.moveLeft(
            std::max(area_.left() + gap, std::min(box.left(), area_.right() - gap - size.width())));
        box.moveTop(
            std::max(area_.top(), std::min(box.top(), area_.bottom() - gap - size.height())));
        if (std::ranges::none_of(texts_,
                                 [&](const QRectF& other) { return other.intersects(box); }))
            break;
    }
    texts_.push_back(box);
    outlinedText(painter, box.topLeft(), Qt::AlignLeft | Qt::AlignTop, color, text);
}

QString textOf(const reader::PlaceRuler& ruler) {
    const QString length = Pane::tr("%1 mm").arg(decimal(ruler.lengthMm()));
    return ruler.finding > 0 ? Pane::tr("finding %1: %2").arg(ruler.finding).arg(length) : length;
}

void FindingRings::paint(QPointF middle, double radius, const reader::ListedFinding& finding) {
    QPainter& painter = painter_;
    const QColor color = finding.candidate ? theme().dimOnPicture : theme().accentOnPicture;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme().outline, 3.0));
    painter.drawEllipse(middle, radius, radius);
    painter.setPen(
        QPen(color, 1.3 * theme().lineWidth, finding.candidate ? Qt::DashLine : Qt::SolidLine));
    painter.drawEllipse(middle, radius, radius);
    const QString number = QString::number(finding.number);
    const QFontMetricsF metrics(painter.font());
    const QSizeF size(metrics.horizontalAdvance(number), metrics.height());
    for (const QPointF way : {QPointF(1, -1), QPointF(1, 1), QPointF(-1, 1), QPointF(-1, -1)}) {
        const QPointF corner = middle + 0.75 * radius * way + QPointF(3 * way.x(), 0);
        const QRectF box(
            corner - QPointF(way.x() < 0 ? size.width() : 0.0, way.y() < 0 ? size.height() : 0.0),
            size);
        const bool lies = std::ranges::any_of(
            numbers_, [&](const QRectF& other) { return other.intersects(box); });
        if (lies || !area_.contains(box)) continue;
        numbers_.push_back(box);
        outlinedText(painter, box.topLeft(), Qt::AlignLeft | Qt::AlignTop, color, number);
        return;
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
