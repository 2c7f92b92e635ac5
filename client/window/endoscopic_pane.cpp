#include "window/endoscopic_pane.h"

#include "core/bridges.h"
#include "protocol/capabilities.h"
#include "window/theme.h"

#include <QMenu>
#include <algorithm>
#include <cmath>

namespace haustra::window {

EndoscopicPane::EndoscopicPane(Reading& reading)
    : Pane(reading, View::endoscopic, tr("Endoscopic view")) {}

QString EndoscopicPane::inWords() const {
    const reader::Flight& flight = reader().flight();
    const QString where =
        flight.isFree()
            ? tr("free flight")
            : tr("%1 mm of %2 mm, %3")
                  .arg(flight.arcMm(), 0, 'f', 0)
                  .arg(flight.centerline().lengthMm(), 0, 'f', 0)
                  .arg(flight.direction() == FlightDirection::antegrade ? tr("towards the cecum")
                                                                        : tr("towards the rectum"));
    return where + QStringLiteral(", ") + Pane::inWords();
}

void EndoscopicPane::fillMenu(QMenu& menu) {
    menu.addAction(tr("Straight ahead"), this, [this] {
        reader().flight().resetLook();
        reading().changed();
    });
}

void EndoscopicPane::addShown(Shown& shown) const {
    const reader::Flight& flight = reader().flight();
    shown.add(flight.camera());
    shown.add(flight.arcMm());
    shown.add(flight.isFree() + 2 * int(flight.direction()));
    shown.add(flight.yawDegrees()), shown.add(flight.pitchDegrees());
    if (const auto& picked = reader().flat().picked()) shown.add(picked->positionMm);
}

void EndoscopicPane::paintMarks(QPainter& painter) {
    if (const auto& picked = reader().flat().picked()) {
        // Where it is seen, or would be but for what is in front of it.
        if (const auto seen = reader::seenAt(shownCamera(), picked->positionMm))
            paintPlaceMark(painter, pictureArea().center() + pictureArea().height() * point(*seen));
    }
    paintFlight(painter);
    paintBadge(painter);
}

void EndoscopicPane::paintFlight(QPainter& painter) {
    const reader::Flight& flight = reader().flight();
    const double margin = 12.0;
    const QFont usual = font();
    painter.setFont(largeFont(usual));
    double y = outlinedText(
                   painter, {margin, margin}, Qt::AlignLeft | Qt::AlignTop, theme().onPicture,
                   flight.isFree() ? tr("Free flight") : tr("%1 mm").arg(flight.arcMm(), 0, 'f', 0))
                   .bottom();
    painter.setFont(smallFont(usual));
    const auto line = [&](const QColor& color, const QString& text) {
        y = outlinedText(painter, {margin, y}, Qt::AlignLeft | Qt::AlignTop, color, text).bottom();
    };
    line(theme().dimOnPicture, flight.isFree()
                                   ? tr("W A S D move, drag to look, C returns to the path")
                                   : tr("of %1 mm, %2")
                                         .arg(flight.centerline().lengthMm(), 0, 'f', 0)
                                         .arg(flight.direction() == FlightDirection::antegrade
                                                  ? tr("towards the cecum")
                                                  : tr("towards the rectum")));
    const auto bridges = bridgesOf(flight.centerline());
    const auto bridge = std::find_if(bridges.begin(), bridges.end(), [&](const Bridge& b) {
        return flight.arcMm() >= b.fromArcMm && flight.arcMm() <= b.toArcMm;
    });
    if (!flight.isFree() && bridge != bridges.end())
        line(theme().bookmarkOnPicture,
             tr("bridge of %1 mm: the colon is collapsed or filled, no wall is seen")
                 .arg(bridge->lengthMm(), 0, 'f', 0));
    if (std::abs(flight.yawDegrees()) >= 0.5 || std::abs(flight.pitchDegrees()) >= 0.5)
        outlinedText(painter, {margin, height() - margin}, Qt::AlignLeft | Qt::AlignBottom,
                     theme().dimOnPicture,
                     tr("look %1°  %2°   double-click: straight ahead")
                         .arg(std::lround(flight.yawDegrees()))
                         .arg(std::lround(flight.pitchDegrees())));
}

void EndoscopicPane::paintBadge(QPainter& painter) {
    const reader::Freshness freshness = reader().freshness(View::endoscopic);
    const bool old = freshness == reader::Freshness::old,
               exact = freshness == reader::Freshness::exact;
    const double margin = 12.0;
    const QRectF box = outlinedText(painter, {width() - margin, height() - margin},
                                    Qt::AlignRight | Qt::AlignBottom,
                                    old ? theme().troubleOnPicture : theme().dimOnPicture,
                                    old     ? tr("old")
                                    : exact ? tr("exact")
                                            : tr("moving"));
    painter.setPen(Qt::NoPen);
    painter.setBrush(old     ? theme().troubleOnPicture
                     : exact ? theme().accentOnPicture
                             : theme().bookmarkOnPicture);
    painter.drawEllipse(QPointF(box.left() - 9, box.center().y()), 4, 4);
}

// The picture lags behind a flight.
Camera EndoscopicPane::shownCamera() const {
    const Camera* pictured = reader().panes().shown<Camera>(View::endoscopic);
    return pictured ? *pictured : reader().flight().camera();
}

void EndoscopicPane::dragged(const Hand& hand) {
    if (hand.button != Qt::LeftButton) return;
    // A drag across the pane's height turns by the field of view, towards the hand.
    const double degreesPerPixel = reader().flight().camera().fovDegrees / height();
    reader().flight().look(hand.moved.x() * degreesPerPixel, -hand.moved.y() * degreesPerPixel);
}

void EndoscopicPane::clicked(const Hand& hand) {
    if (hand.button != Qt::LeftButton) return;
    if (!reader().session().serverCan(protocol::capability::pick))
        return reading().tell(tr("This server cannot tell where the wall is that was clicked."));
    const Camera camera = shownCamera();
    const glm::dvec2 fromMiddle =
        vector(hand.position - pictureArea().center()) / pictureArea().height();
    const auto direction = rayThrough(camera, fromMiddle);
    if (!direction) return;
    reading().jump(tr("go to a place of the wall"),
                   [this, from = camera.positionMm, direction = *direction] {
                       reader().flat().pick(from, direction);
                   });
}

void EndoscopicPane::doubleClicked(const Hand&) {
    takeClickBack();
    reader().flight().resetLook();
}

void EndoscopicPane::wheeled(const Hand& hand, double steps) {
    reader::Flight& flight = reader().flight();
    if (hand.ctrl()) return flight.setFov(flight.camera().fovDegrees - 5.0 * steps);
    const double stepMm = steps * (hand.shift() ? 10.0 : 3.0);
    if (flight.isFree())
        flight.moveFreely({0, 0, stepMm});
    else
        flight.goTo(flight.arcMm() +
                    (flight.direction() == FlightDirection::antegrade ? stepMm : -stepMm));
}

}  // namespace haustra::window
