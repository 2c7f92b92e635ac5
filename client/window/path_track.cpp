#include "window/path_track.h"

#include "core/bridges.h"
#include "window/theme.h"

#include <QMouseEvent>
#include <QPainter>
#include <QToolTip>
#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::window {
namespace {

constexpr double margin = 10.0;  // the knob's

}  // namespace

PathTrack::PathTrack(Reading& reading) : QSlider(Qt::Horizontal), reading_(reading) {
    setAccessibleName(tr("Place along the colon, millimetres from the rectum"));
    setSingleStep(1);
    setPageStep(10);
    setMouseTracking(true);
    connect(&reading, &Reading::stepped, this, &PathTrack::look);
    connect(&reading, &Reading::caseOpened, this, [this] { back_ = nullptr; });
    // From the keyboard, or by what reads the screen.
    connect(this, &QSlider::valueChanged, this, [this](int mm) {
        if (follows_ || !reading_.reader().isOpen()) return;
        goTo(mm);
    });
}

double PathTrack::lengthMm() const {
    return std::max(reading_.reader().flight().centerline().lengthMm(), 1e-6);
}

double PathTrack::xOf(double arcMm) const {
    return margin + arcMm / lengthMm() * (width() - 2.0 * margin);
}

double PathTrack::arcAt(double x) const {
    return std::clamp((x - margin) / (width() - 2.0 * margin), 0.0, 1.0) * lengthMm();
}

void PathTrack::look() {
    const reader::Flight& flight = reading_.reader().flight();
    const bool antegrade = flight.direction() == FlightDirection::antegrade;
    const std::uint64_t bookmarks = reading_.reader().session().bookmarksRevision(),
                        findings = reading_.reader().session().findingsRevision();
    follows_ = true;
    setRange(0, int(std::lround(lengthMm())));
    setValue(int(std::lround(flight.placeArcMm())));
    follows_ = false;
    setEnabled(reading_.reader().isOpen() && !flight.centerline().points.empty());
    if (antegrade != antegrade_ || bookmarks != bookmarks_ || findings != findings_) update();
    antegrade_ = antegrade;
    bookmarks_ = bookmarks;
    findings_ = findings;
}

void PathTrack::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const Theme& t = theme();
    const reader::Flight& flight = reading_.reader().flight();
    const double middle = height() / 2.0, thick = 3.0;
    painter.setPen(Qt::NoPen);
    painter.setBrush(t.border);
    painter.drawRoundedRect(QRectF(margin, middle - thick, width() - 2 * margin, 2 * thick), thick,
                            thick);
    if (!isEnabled()) return;
    const double here = xOf(flight.placeArcMm());
    painter.setBrush(t.accent);
    painter.drawRoundedRect(QRectF(margin, middle - thick, here - margin, 2 * thick), thick, thick);
    painter.setBrush(t.trouble);
    for (const Bridge& bridge : bridgesOf(flight.centerline()))
        painter.drawRect(QRectF(xOf(bridge.fromArcMm), middle - thick,
                                xOf(bridge.toArcMm) - xOf(bridge.fromArcMm) + 1, 2 * thick));
    for (const reader::Bookmark& bookmark : reading_.reader().session().bookmarks()) {
        const double x = xOf(bookmark.arcMm);
        painter.setPen(QPen(t.bookmark, 1.5));
        painter.drawLine(QPointF(x, middle - 9), QPointF(x, middle + thick));
        painter.setPen(Qt::NoPen);
        painter.setBrush(t.bookmark);
        painter.drawPolygon(QPolygonF({{x, middle - 11}, {x + 7, middle - 8}, {x, middle - 5}}));
    }
    for (const reader::ListedFinding& one : reading_.reader().findings().shown()) {
        const double x = xOf(one.wall.arcMm);
        painter.setPen(QPen(one.candidate ? t.muted : t.text, 1.0));
        painter.setBrush(one.candidate ? QBrush(Qt::NoBrush) : QBrush(t.accentOnPicture));
        painter.drawEllipse(QPointF(x, middle + 9), 3, 3);
    }
    painter.setPen(hasFocus() ? QPen(t.text, 2) : QPen(t.window, 1));
    painter.setBrush(underMouse() ? t.text : t.accentOnPicture);
    painter.drawEllipse(QPointF(here, middle), 8, 8);
    const double way = antegrade_ ? 1.0 : -1.0;
    painter.setPen(Qt::NoPen);
    painter.setBrush(t.window);
    painter.drawPolygon(QPolygonF({{here - 2.5 * way, middle - 4},
                                   {here + 4.0 * way, middle},
                                   {here - 2.5 * way, middle + 4}}));
}

void PathTrack::goTo(double arcMm) {
    reading_.reader().setMotion(reader::Motion::paused);
    reading_.reader().flight().goTo(arcMm);
    reading_.changed();
}

void PathTrack::mousePressEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton) return;
    setFocus(Qt::MouseFocusReason);
    back_ = reading_.wayBack();
    goTo(arcAt(event->position().x()));
}

void PathTrack::mouseMoveEvent(QMouseEvent* event) {
    if (event->buttons().testFlag(Qt::LeftButton)) return goTo(arcAt(event->position().x()));
    QToolTip::showText(event->globalPosition().toPoint(),
                       tr("%1 mm").arg(arcAt(event->position().x()), 0, 'f', 0), this);
}

// However long the drag, it is one step back to where it began.
void PathTrack::mouseReleaseEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || !back_) return;
    reading_.did(tr("go along the path"), std::exchange(back_, {}),
                 [this, arc = arcAt(event->position().x())] { goTo(arc); });
}

}  // namespace haustra::window
