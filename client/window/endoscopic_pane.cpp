#include "window/endoscopic_pane.h"

#include "core/bridges.h"
#include "protocol/capabilities.h"
#include "window/theme.h"

#include <QMenu>
#include <algorithm>
#include <cmath>

namespace haustra::window {

EndoscopicPane::EndoscopicPane(Reading& reading)
    : Pane(reading, View::endoscopic, tr("Endoscopic view")) {
    connect(&reading, &Reading::stepped, this, &EndoscopicPane::lensFollows);
}

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
    const QString lens = reader().lens().isOn() ? QStringLiteral(", ") + lensInWords() : QString();
    return where + rulerInWords() + QStringLiteral(", ") + Pane::inWords() + lens;
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
    addRulersAndFindings(shown);
    for (const reader::PlaceRuler& ruler : reader().shownRulers())
        for (const reader::PlaceRuler::End* end : {&ruler.from, &ruler.to})
            shown.add(reader().seenEnds().has(shownCamera(), end->positionMm));
    if (const auto& begun = reader().rulers().begun())
        shown.add(reader().seenEnds().has(shownCamera(), begun->positionMm));
    shown.add(int(reading().tool()));
    const reader::BiopsyLens& lens = reader().lens();
    shown.add(lens.isOn() + 2 * lens.isAvailable() + 4 * lens.isExact());
    if (!lens.isOn()) return;
    shown.add(lens.place().center.x), shown.add(lens.place().center.y);
    shown.add(lens.place().radius), shown.add(double(lens.pictureCount()));
}

void EndoscopicPane::paintMarks(QPainter& painter) {
    paintLens(painter);
    if (const auto& picked = reader().flat().picked()) {
        // Where it is seen, or would be but for what is in front of it.
        if (const auto seen = reader::seenAt(shownCamera(), picked->positionMm))
            paintPlaceMark(painter, pictureArea().center() + pictureArea().height() * point(*seen));
    }
    paintRulers(painter);
    paintFlight(painter);
    paintBadge(painter);
}

// Dashed where a wall stands before one of the ends; where one does before both, not at all.
void EndoscopicPane::paintRulers(QPainter& painter) {
    const Camera camera = shownCamera();
    const auto positionOf = [&](glm::dvec3 placeMm) -> std::optional<QPointF> {
        const auto seen = reader::seenAt(camera, placeMm);
        if (!seen) return std::nullopt;
        return pictureArea().center() + pictureArea().height() * point(*seen);
    };
    const auto isSeen = [&](glm::dvec3 placeMm) {
        return reader().seenEnds().has(camera, placeMm);
    };
    painter.setFont(font());
    RulerTexts rulers(painter, rect());
    for (const reader::PlaceRuler& ruler : reader().shownRulers()) {
        const auto from = positionOf(ruler.from.positionMm), to = positionOf(ruler.to.positionMm);
        const bool seesFrom = isSeen(ruler.from.positionMm), seesTo = isSeen(ruler.to.positionMm);
        if (from && to && (seesFrom || seesTo) &&
            (rect().contains(from->toPoint()) || rect().contains(to->toPoint())))
            rulers.paint(*from, *to, !(seesFrom && seesTo), textOf(ruler));
    }
    if (const auto& begun = reader().rulers().begun())
        if (const auto at = positionOf(begun->positionMm); at && isSeen(begun->positionMm))
            paintCross(painter, *at, 3.0, 8.0, theme().measuredOnPicture);
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

// ---- the lens -----------------------------------------------------------------------------------

void EndoscopicPane::lensFollows() {
    if (!isOpen() || !isVisible()) return;
    reader::BiopsyLens& lens = reader().lens();
    const auto at = pointedAt();
    if (!lens.isOn() || !at) return;
    const glm::dvec2 place = vector(*at - pictureArea().center()) / pictureArea().height();
    if (place == lens.place().center) return;
    lens.moveTo(place);
    reading().changed();
}

void EndoscopicPane::hovered(const Hand&) {
    lensFollows();
}

QString EndoscopicPane::lensInWords() const {
    const reader::BiopsyLens& lens = reader().lens();
    if (!lens.isAvailable()) return tr("this server cannot show a lens");
    return lens.showsOwnColors() ? tr("electronic biopsy, colours of this scan")
                                 : tr("electronic biopsy, fixed colours");
}

void EndoscopicPane::paintLens(QPainter& painter) {
    const reader::BiopsyLens& lens = reader().lens();
    if (!lens.isOn()) return;
    const QRectF area = pictureArea();
    const double radius = area.height() * lens.place().radius;
    const QPointF middle = area.center() + area.height() * point(lens.place().center);
    // Never a picture of another place over this one: while the camera moves there is none.
    const Camera beneath = shownCamera();
    const tiles::Picture* picture = lens.isAvailable() ? lens.pictureOver(beneath) : nullptr;
    if (picture) {
        const double ratio = devicePixelRatioF();
        const glm::ivec2 size(std::lround(area.width() * ratio),
                              std::lround(area.height() * ratio));
        const reader::LensDisc disc =
            throughLens(*picture, lens.pictureCamera(), beneath, lens.place(), size);
        QImage image(reinterpret_cast<const uchar*>(disc.pixels.data()), disc.side, disc.side,
                     4 * disc.side, QImage::Format_ARGB32_Premultiplied);
        image.setDevicePixelRatio(ratio);
        painter.drawImage(area.topLeft() + QPointF(disc.corner.x, disc.corner.y) / ratio, image);
    }
    const QRectF ring(middle - QPointF(radius, radius), QSizeF(2 * radius, 2 * radius));
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme().outline, 3.5 * theme().lineWidth));
    painter.drawEllipse(ring);
    painter.setPen(QPen(!picture         ? theme().dimOnPicture
                        : lens.isExact() ? theme().accentOnPicture
                                         : theme().bookmarkOnPicture,
                        1.5 * theme().lineWidth, picture ? Qt::SolidLine : Qt::DashLine));
    painter.drawEllipse(ring);
    if (picture || !lens.isAvailable()) paintLensCaption(painter, ring);
}

// Beneath the ring, or above it where there is no room; what the colours mean, and whose they are.
void EndoscopicPane::paintLensCaption(QPainter& painter, const QRectF& ring) {
    const reader::BiopsyLens& lens = reader().lens();
    const QFont usual = painter.font();
    painter.setFont(smallFont(usual));
    const double line = painter.fontMetrics().height(), gap = 5.0;
    double y = ring.bottom() + gap;
    if (y + 2 * line > height()) y = ring.top() - gap - 2 * line;
    y = std::clamp(y, 0.0, std::max(0.0, height() - 2 * line));
    const QString words = lensInWords();
    const double half = 0.5 * painter.fontMetrics().horizontalAdvance(words) + gap;
    const double x = std::clamp(ring.center().x(), std::min(half, 0.5 * width()),
                                std::max(width() - half, 0.5 * width()));
    outlinedText(painter, {x, y}, Qt::AlignHCenter | Qt::AlignTop, theme().onPicture, words);
    if (lens.isAvailable()) {
        constexpr double bar = 60.0, thick = 6.0;
        const QRectF colors(x - 0.5 * bar, y + line + 0.5 * (line - thick), bar, thick);
        QLinearGradient scale(colors.topLeft(), colors.topRight());
        scale.setColorAt(0.0, QColor(26, 64, 242));
        scale.setColorAt(0.5, QColor(40, 224, 56));
        scale.setColorAt(1.0, QColor(242, 32, 20));
        painter.setPen(QPen(theme().outline, 1.0));
        painter.setBrush(scale);
        painter.drawRect(colors);
        outlinedText(painter, {colors.left() - gap, y + line}, Qt::AlignRight | Qt::AlignTop,
                     theme().dimOnPicture, tr("less dense"));
        outlinedText(painter, {colors.right() + gap, y + line}, Qt::AlignLeft | Qt::AlignTop,
                     theme().dimOnPicture, tr("denser"));
    }
    painter.setFont(usual);
}

// ---- the hand -----------------------------------------------------------------------------------

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
    if (reading().tool() == DrawingTool::ruler) {
        reader().rulers().addEnd(camera.positionMm, *direction);
        return reading().changed();
    }
    reading().jump(tr("go to a place of the wall"),
                   [this, from = camera.positionMm, direction = *direction] {
                       reader().flat().pick(from, direction);
                   });
}

void EndoscopicPane::doubleClicked(const Hand&) {
    if (reading().tool() == DrawingTool::ruler) return;  // its first click has set an end
    takeClickBack();
    reader().flight().resetLook();
}

void EndoscopicPane::wheeled(const Hand& hand, double steps) {
    reader::Flight& flight = reader().flight();
    if (hand.alt() && reader().lens().isOn()) {
        reader::BiopsyLens& lens = reader().lens();
        return lens.setRadius(lens.place().radius * std::pow(reader::lensGrowth, steps));
    }
    if (hand.ctrl()) return flight.setFov(flight.camera().fovDegrees - 5.0 * steps);
    const double stepMm = steps * (hand.shift() ? 10.0 : 3.0);
    if (flight.isFree())
        flight.moveFreely({0, 0, stepMm});
    else
        flight.goTo(flight.arcMm() +
                    (flight.direction() == FlightDirection::antegrade ? stepMm : -stepMm));
}

}  // namespace haustra::window
