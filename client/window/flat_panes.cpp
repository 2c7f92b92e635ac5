#include "window/flat_panes.h"

#include "core/bridges.h"
#include "window/theme.h"

#include <QMenu>
#include <QToolTip>
#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

/// A stretch of the pane that shows a window of the strip.
struct FlatArea {
    QRectF area;
    FlatWindow window;
    glm::ivec2 size;  ///< of the window's picture

    double pixels() const { return area.width() / std::max(1, size.x); }
    QPointF position(glm::dvec2 flat) const {
        return area.topLeft() + point(window.pixelFromFlat(flat, size) * pixels());
    }
    glm::dvec2 flat(QPointF position) const {
        return window.flatFromPixel(vector(position - area.topLeft()) / pixels(), size);
    }
    // Calls visit(position) for each copy of a place that may be seen.
    template <class Visit>
    void forEachCopy(glm::dvec2 flat, const Visit& visit) const {
        const double half = 0.5 * size.x / window.pixelsPerUnit + 0.1;
        const double first = std::ceil(window.center.x - half - flat.x);
        for (double turn = first; flat.x + turn <= window.center.x + half; turn += 1.0)
            visit(position({flat.x + turn, flat.y}));
    }
};

// Their lengths beside the hatched bridges: what the strip makes long or short is not to be read
// off.
void paintBridges(QPainter& painter, const reader::Reader& reader, const FlatArea& flat) {
    const reader::FlatStrip& strip = reader.flat().tour().strip();
    const double high = QFontMetricsF(painter.font()).height();
    double lastAt = INFINITY;
    for (const Bridge& bridge : bridgesOf(reader.session().caseInfo()->centerline)) {
        const double y = strip.yAtArc(0.5 * (bridge.fromArcMm + bridge.toArcMm));
        const double at = flat.position({0.0, y}).y();
        // Nobody reads one above the other; a path may have bridges without number.
        const bool inSight = at > flat.area.top() - high && at < flat.area.bottom() + high;
        if (!inSight || std::abs(at - lastAt) < high) continue;
        lastAt = at;
        outlinedText(painter, {flat.area.left() + 8, at}, Qt::AlignLeft | Qt::AlignVCenter,
                     theme().bookmarkOnPicture,
                     StripPane::tr("bridge %1 mm").arg(bridge.lengthMm(), 0, 'f', 0));
    }
}

// The row of the camera, bookmarks, and the place that was gone to.
void paintPlaces(QPainter& painter, const reader::Reader& reader, const FlatArea& flat) {
    const double y = reader.flat().tour().strip().yAtArc(reader.flight().placeArcMm());
    const double row = flat.position({0.0, y}).y(), tip = 6.0;
    const QRectF& area = flat.area;
    QColor faint = theme().accentOnPicture;
    faint.setAlpha(theme().lineWidth > 1.0 ? 255 : 110);
    painter.setPen(QPen(faint, theme().lineWidth));
    painter.drawLine(QPointF(area.left(), row), QPointF(area.right(), row));
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme().accentOnPicture);
    painter.drawPolygon(
        QPolygonF({{area.left(), row - tip}, {area.left() + tip, row}, {area.left(), row + tip}}));
    painter.drawPolygon(QPolygonF(
        {{area.right(), row - tip}, {area.right(), row + tip}, {area.right() - tip, row}}));
    for (const auto& [key, place] : reader.flat().wall().bookmarkPlaces())
        if (place.flat)
            flat.forEachCopy(*place.flat, [&](QPointF p) { paintBookmarkFlag(painter, p); });
    if (const auto& picked = reader.flat().picked(); picked && picked->wall && picked->wall->flat)
        flat.forEachCopy(*picked->wall->flat, [&](QPointF p) { paintPlaceMark(painter, p); });
}

// Where findings are. A conformal map has no scale of its own to draw their sizes by: how far one
// reaches its colour shows.
void paintFindings(QPainter& painter, const reader::Reader& reader, const FlatArea& flat) {
    constexpr double ringPixels = 7.0;
    FindingRings rings(painter, flat.area);
    for (const reader::ListedFinding& one : reader.findings().shown())
        if (one.wall.flat)
            flat.forEachCopy(*one.wall.flat, [&](QPointF p) { rings.paint(p, ringPixels, one); });
}

// Rulers whose ends lie on the wall, by the shorter way round.
void paintRulers(QPainter& painter, const reader::Reader& reader, const FlatArea& flat,
                 bool withText) {
    RulerTexts rulers(painter, flat.area);
    for (const reader::PlaceRuler& ruler : reader.shownRulers()) {
        if (!ruler.from.flat || !ruler.to.flat) continue;
        glm::dvec2 way = *ruler.to.flat - *ruler.from.flat;
        way.x -= std::round(way.x);
        const QPointF across =
            flat.position(*ruler.from.flat + way) - flat.position(*ruler.from.flat);
        flat.forEachCopy(*ruler.from.flat, [&](QPointF from) {
            rulers.paint(from, from + across, false,
                         withText && flat.area.contains(from) ? textOf(ruler) : QString());
        });
    }
    if (const auto& begun = reader.rulers().begun(); begun && begun->flat)
        flat.forEachCopy(*begun->flat, [&](QPointF p) {
            paintCross(painter, p, 3.0, 8.0, theme().measuredOnPicture);
        });
}

// What the zoom view shows of the strip.
void paintZoomFrame(QPainter& painter, const reader::Reader& reader, const FlatArea& flat) {
    const reader::StripTour& tour = reader.flat().tour();
    const FlatWindow& window = tour.window();
    const glm::dvec2 half = 0.5 * glm::dvec2(tour.paneSize()) / window.pixelsPerUnit;
    const bool allAround = 2.0 * half.x >= 1.0;
    for (const double turn : {-1.0, 0.0, 1.0}) {
        if (allAround && turn != 0.0) continue;
        QRectF frame(flat.position(window.center + half + glm::dvec2(turn, 0)),
                     flat.position(window.center - half + glm::dvec2(turn, 0)));
        if (allAround) frame.setLeft(flat.area.left()), frame.setRight(flat.area.right());
        frame &= flat.area.adjusted(1, 1, -1, -1);
        if (frame.isEmpty()) continue;
        painter.setBrush(Qt::NoBrush);
        painter.setPen(QPen(QColor(0, 0, 0, 150), 3.0));
        painter.drawRect(frame);
        painter.setPen(QPen(QColor(255, 255, 255, 220), 1.2 * theme().lineWidth));
        painter.drawRect(frame);
    }
}

void addPlaces(Shown& shown, const reader::Reader& reader) {
    shown.add(reader.flight().placeArcMm());
    const reader::StripTour& tour = reader.flat().tour();
    shown.add(tour.window().center.x), shown.add(tour.window().center.y);
    shown.add(tour.window().pixelsPerUnit);
    shown.add(tour.flyingOver());
    for (const auto& [key, place] : reader.flat().wall().bookmarkPlaces())
        shown.add(place.positionMm);
    if (const auto& picked = reader.flat().picked(); picked && picked->wall)
        shown.add(picked->wall->positionMm);
}

}  // namespace

// ---- the whole strip ----------------------------------------------------------------------------

StripPane::StripPane(Reading& reading) : Pane(reading, View::flattened, tr("Flattened colon")) {}

StripLayout StripPane::layout() const {
    return layOutStrip(reader().flat().tour().strip().height, pictureSize());
}

std::optional<glm::dvec2> StripPane::flatAt(QPointF position) const {
    if (!reader().flat().hasStrip() || pictureSize().x < 1) return std::nullopt;
    return layout().flatFromPixel(pixelAt(position), reader().flat().tour().strip().height);
}

void StripPane::addShown(Shown& shown) const {
    if (reader().flat().hasStrip()) addPlaces(shown, reader());
    addRulersAndFindings(shown);
}

void StripPane::paintMarks(QPainter& painter) {
    if (!reader().flat().hasStrip() || pictureSize().x < 1) return;
    const double pixels = widgetPerPixel();
    const StripLayout columns = layout();
    painter.setFont(smallFont(font()));
    for (const StripColumn& column : columns.columns) {
        const FlatArea flat{QRectF(positionOf({column.left, 0.0}),
                                   QSizeF(column.size.x * pixels, pictureArea().height())),
                            column.window, column.size};
        painter.save();
        painter.setClipRect(flat.area);
        paintZoomFrame(painter, reader(), flat);
        paintBridges(painter, reader(), flat);
        paintPlaces(painter, reader(), flat);
        paintFindings(painter, reader(), flat);
        paintRulers(painter, reader(), flat, false);
        painter.restore();
    }
    painter.setFont(smallFont(font()));
    constexpr double margin = 6.0;
    outlinedText(painter,
                 {positionOf({columns.columns.front().left, 0.0}).x() + margin, height() - margin},
                 Qt::AlignLeft | Qt::AlignBottom, theme().dimOnPicture, tr("rectum"));
    const double high = reader().flat().tour().strip().height;
    const QPointF top = positionOf(columns.pixelFromFlat({0.5, high}));
    const double textHigh = QFontMetricsF(painter.font()).height();
    outlinedText(painter, {top.x(), std::max(margin, top.y() - textHigh - margin)},
                 Qt::AlignHCenter | Qt::AlignTop, theme().dimOnPicture, tr("cecum"));
}

void StripPane::dragged(const Hand& hand) {
    if (const auto flat = flatAt(hand.position)) reader().flat().tour().centerOn(*flat);
}

// From the place that is shown: so keys go along the colon.
QPointF StripPane::dragFrom() const {
    if (!reader().flat().hasStrip() || pictureSize().x < 1) return Pane::dragFrom();
    return positionOf(layout().pixelFromFlat(reader().flat().tour().window().center));
}

// Clicks and drags alike lead along the colon when they end; with the ruler, a click sets an end.
void StripPane::clicked(const Hand& hand) {
    if (hand.button != Qt::LeftButton || reading().tool() != DrawingTool::ruler) return;
    setsEnd_ = true;
    if (const auto flat = flatAt(hand.position)) reader().rulers().addEnd(*flat);
    reading().changed();
}

void StripPane::released(const Hand& hand) {
    if (std::exchange(setsEnd_, false) || hand.button != Qt::LeftButton) return;
    if (const auto flat = flatAt(hand.position))
        reading().jump(tr("go along the flattened colon"),
                       [this, flat = *flat] { reader().flat().goTo(flat, true); });
}

void StripPane::hovered(const Hand& hand) {
    const auto flat = flatAt(hand.position);
    setToolTip(flat ? tr("%1 mm").arg(reader().flat().tour().strip().arcAtY(flat->y), 0, 'f', 0)
                    : QString());
}

// ---- the window onto it -------------------------------------------------------------------------

FlatZoomPane::FlatZoomPane(Reading& reading)
    : Pane(reading, View::flattenedZoom, tr("Flattened wall")) {}

namespace {

void measureAgain(reader::WallQuestions& wall,
                  const std::optional<reader::Measurement>& measurement) {
    if (measurement)
        wall.measure(measurement->points, measurement->closed);
    else
        wall.clearMeasurement();
}

FlatArea areaOf(const QWidget& pane, const reader::Reader& reader) {
    return {QRectF(pane.rect()), reader.flat().tour().window(), reader.flat().tour().paneSize()};
}

}  // namespace

void FlatZoomPane::fillMenu(QMenu& menu) {
    menu.addAction(tr("Whole circumference"), this, [this] {
        reader().flat().tour().showWholeCircumference();
        reading().changed();
    });
    menu.addAction(tr("Clear the measurement"), this, [this] { clearMeasurement(); });
}

void FlatZoomPane::addShown(Shown& shown) const {
    if (!reader().flat().hasStrip()) return;
    addPlaces(shown, reader());
    addRulersAndFindings(shown);
    shown.add(int(reading().tool()));
    const auto& measurement = reader().flat().wall().measurement();
    if (!measurement) return;
    shown.add(measurement->result ? measurement->result->lengthMm : -1.0);
    for (const glm::dvec2 p : measurement->points)
        shown.add(p.x), shown.add(p.y);
}

// The newest picture where it belongs: it lags behind the window that the hand moves.
void FlatZoomPane::paintPicture(QPainter& painter, const QImage& picture) {
    const FlatArea flat = areaOf(*this, reader());
    const auto* window = reader().panes().shown<FlatWindow>(View::flattenedZoom);
    const bool isOfThisPane = pictureSize() == flat.size && pictureArea() == QRectF(rect());
    if (!window || (*window == flat.window && isOfThisPane))
        return Pane::paintPicture(painter, picture);
    FlatWindow shown = *window;
    shown.center.x += std::round(flat.window.center.x - shown.center.x);
    const glm::ivec2 size = pictureSize();
    painter.setRenderHint(QPainter::SmoothPixmapTransform);
    painter.drawImage(QRectF(flat.position(shown.flatFromPixel({0.0, 0.0}, size)),
                             flat.position(shown.flatFromPixel(glm::dvec2(size), size))),
                      picture);
}

void FlatZoomPane::paintMarks(QPainter& painter) {
    if (!reader().flat().hasStrip()) return;
    const FlatArea flat = areaOf(*this, reader());
    painter.setFont(smallFont(font()));
    paintBridges(painter, reader(), flat);
    paintPlaces(painter, reader(), flat);
    paintFindings(painter, reader(), flat);
    painter.setFont(font());
    paintRulers(painter, reader(), flat, true);
    paintMeasurement(painter);
    paintTexts(painter);
}

void FlatZoomPane::paintMeasurement(QPainter& painter) {
    const auto& measurement = reader().flat().wall().measurement();
    if (!measurement || measurement->points.size() < 2) return;
    const FlatArea flat = areaOf(*this, reader());
    const QColor color = theme().measuredOnPicture;
    // Where it was drawn, or the copy that is nearest to the window's middle.
    const double away = flat.window.center.x - measurement->points.front().x;
    const bool inWindow = std::abs(away) * flat.window.pixelsPerUnit <= 0.5 * flat.size.x;
    const double turn = inWindow ? 0.0 : std::round(away);
    QPolygonF points;
    for (const glm::dvec2 p : measurement->points)
        points << flat.position(p + glm::dvec2(turn, 0.0));
    outlinedPolyline(painter, points, measurement->closed, color);
    if (!measurement->closed) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(color);
        painter.drawEllipse(points.front(), 3, 3);
        painter.drawEllipse(points.back(), 3, 3);
    }
    const bool inSight =
        std::any_of(points.begin(), points.end(), [&](QPointF p) { return flat.area.contains(p); });
    if (!measurement->result || !inSight) return;
    const QPointF low = *std::max_element(points.begin(), points.end(),
                                          [](QPointF a, QPointF b) { return a.y() < b.y(); });
    const reader::FlatMeasure& result = *measurement->result;
    const QString text = measurement->closed ? tr("%1 mm across   %2 mm²")
                                                   .arg(decimal(result.largestDiameterMm))
                                                   .arg(result.areaMm2, 0, 'f', 0)
                                             : tr("%1 mm   straight %2 mm")
                                                   .arg(decimal(result.lengthMm))
                                                   .arg(decimal(result.straightMm));
    painter.setFont(font());
    const QFontMetricsF metrics(painter.font());
    const double half = metrics.horizontalAdvance(text) / 2 + 6;
    outlinedText(painter,
                 {std::clamp(low.x(), half, std::max(half, width() - half)),
                  std::min(low.y() + 8, height() - metrics.height() - 6)},
                 Qt::AlignHCenter | Qt::AlignTop, color, text);
}

void FlatZoomPane::paintTexts(QPainter& painter) {
    const reader::StripTour& tour = reader().flat().tour();
    const double margin = 10.0;
    painter.setFont(smallFont(font()));
    if (tour.flyingOver())
        outlinedText(painter, {margin, 8}, Qt::AlignLeft | Qt::AlignTop, theme().accentOnPicture,
                     tr("Fly-over   %1 mm").arg(tour.arcMm(), 0, 'f', 0));
    else if (namesItself())
        outlinedText(painter, {margin, 8}, Qt::AlignLeft | Qt::AlignTop, theme().onPicture,
                     title());
    const double zoom = tour.window().pixelsPerUnit / reader::wholeCircumference(tour.paneSize().x);
    outlinedText(
        painter, {width() - margin, 8}, Qt::AlignRight | Qt::AlignTop, theme().dimOnPicture,
        std::abs(zoom - 1.0) < 0.01 ? tr("cecum ↑") : tr("×%1   cecum ↑").arg(decimal(zoom)));
    if (reading().tool() == DrawingTool::none) return;
    outlinedText(painter, {margin, height() - 8.0}, Qt::AlignLeft | Qt::AlignBottom,
                 theme().measuredOnPicture,
                 reading().tool() == DrawingTool::line ? tr("drag a line to measure it   Esc ends")
                 : reading().tool() == DrawingTool::ruler
                     ? tr("click two places to measure between them   Esc ends")
                     : tr("drag around a polyp   Esc ends"));
}

DrawingTool FlatZoomPane::toolOf(const Hand& hand) const {
    if (hand.shift()) return DrawingTool::line;
    if (hand.ctrl()) return DrawingTool::outline;
    return reading().tool() == DrawingTool::ruler ? DrawingTool::none : reading().tool();
}
bool FlatZoomPane::draws(const Hand& hand) const {
    return reader().flat().hasStrip() && toolOf(hand) != DrawingTool::none;
}

void FlatZoomPane::pressed(const Hand& hand) {
    drawing_.clear();
    if (!reader().flat().hasStrip() || hand.button != Qt::LeftButton) return;
    const DrawingTool held = toolOf(hand);
    drawsOutline_ = held == DrawingTool::outline;
    measuredBefore_ = reader().flat().wall().measurement();
    if (held != DrawingTool::none) drawing_.push_back(areaOf(*this, reader()).flat(hand.position));
}

// Follows the hand with a line or an outline, of at most as many points as a server measures.
void FlatZoomPane::draw(glm::dvec2 flat, double leastStep) {
    constexpr std::size_t mostPoints = 120;
    flat.y = std::clamp(flat.y, 0.0, reader().flat().tour().strip().height);
    if (!drawsOutline_) {
        drawing_.resize(1);
        drawing_.push_back(flat);
    } else if (glm::distance(drawing_.back(), flat) > leastStep) {
        drawing_.push_back(flat);
        if (drawing_.size() > mostPoints) {  // every other one is enough
            for (std::size_t n = 0; 2 * n < drawing_.size(); ++n)
                drawing_[n] = drawing_[2 * n];
            drawing_.resize((drawing_.size() + 1) / 2);
        }
    }
    if (drawing_.size() >= (drawsOutline_ ? 3u : 2u))
        reader().flat().wall().measure(drawing_, drawsOutline_);
}

void FlatZoomPane::dragged(const Hand& hand) {
    if (!reader().flat().hasStrip()) return;
    const FlatArea flat = areaOf(*this, reader());
    if (!drawing_.empty())
        draw(flat.flat(hand.position), 4.0 / flat.pixels() / flat.window.pixelsPerUnit);
    else
        reader().flat().tour().drag(vector(hand.moved) / flat.pixels());
}

void FlatZoomPane::released(const Hand&) {
    const auto& measurement = reader().flat().wall().measurement();
    if (drawing_.size() >= (drawsOutline_ ? 3u : 2u) && measurement) {
        reader::WallQuestions& wall = reader().flat().wall();
        reading().did(
            tr("measure on the wall"),
            [&wall, before = measuredBefore_] { measureAgain(wall, before); },
            [&wall, made = measurement] { measureAgain(wall, made); });
    }
    drawing_.clear();
}

void FlatZoomPane::clearMeasurement() {
    reader::WallQuestions& wall = reader().flat().wall();
    const auto before = wall.measurement();
    if (!before) return;
    wall.clearMeasurement();
    reading().did(
        tr("clear the measurement"), [&wall, before] { measureAgain(wall, before); },
        [&wall] { wall.clearMeasurement(); });
}

void FlatZoomPane::clicked(const Hand& hand) {
    if (hand.button != Qt::LeftButton || !drawing_.empty() || !reader().flat().hasStrip()) return;
    if (reading().tool() == DrawingTool::ruler) {
        glm::dvec2 flat = areaOf(*this, reader()).flat(hand.position);
        flat.y = std::clamp(flat.y, 0.0, reader().flat().tour().strip().height);
        reader().rulers().addEnd(flat);
        return reading().changed();
    }
    const glm::dvec2 flat = areaOf(*this, reader()).flat(hand.position);
    reader::WallQuestions& wall = reader().flat().wall();
    reading().jump(
        tr("go to a place of the wall"),
        [this, flat, &wall] {
            wall.clearMeasurement();
            reader().flat().goTo(flat, false);
        },
        [&wall, before = wall.measurement()] { measureAgain(wall, before); });
}

void FlatZoomPane::wheeled(const Hand& hand, double steps) {
    if (!reader().flat().hasStrip()) return;
    reader().flat().tour().zoom(std::pow(1.2, steps),
                                vector(hand.position) / areaOf(*this, reader()).pixels());
}

}  // namespace haustra::window
