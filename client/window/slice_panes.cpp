#include "window/slice_panes.h"

#include "window/look_steps.h"
#include "window/theme.h"

#include <QMenu>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

constexpr Qt::Alignment topLeft = Qt::AlignLeft | Qt::AlignTop,
                        topRight = Qt::AlignRight | Qt::AlignTop,
                        bottomLeft = Qt::AlignLeft | Qt::AlignBottom,
                        bottomRight = Qt::AlignRight | Qt::AlignBottom;

QString axisOf(View view) {
    return view == View::coronal    ? QStringLiteral("y")
           : view == View::sagittal ? QStringLiteral("x")
                                    : QStringLiteral("z");
}

}  // namespace

// ---- what all grey panes do ---------------------------------------------------------------------

GreyPane::GreyPane(Reading& reading, View view, const QString& title) : Pane(reading, view, title) {
    connect(&reading, &Reading::stepped, this, &GreyPane::pointAgain);
}

DrawingTool GreyPane::toolOf(const Hand& hand) const {
    if (hand.button != Qt::LeftButton) return DrawingTool::none;
    if (hand.shift()) return DrawingTool::line;
    if (hand.ctrl()) return DrawingTool::outline;
    return reading().tool() == DrawingTool::ruler ? DrawingTool::none : reading().tool();
}

bool GreyPane::addsEnd(const Hand& hand) {
    if (reading().tool() != DrawingTool::ruler) return false;
    if (const auto place = patientAt(hand.position)) reader().rulers().addEnd(*place);
    reading().changed();
    return true;
}

QString GreyPane::heading() const {
    QStringList heading;
    if (namesItself()) heading += title();
    if (shownScan() == Scan::cleansed) heading += tr("cleansed");
    const Slab& slab = reader().slices().slab();
    if (slab.thicknessMm > 0.0)
        heading += slab.projection == Projection::maximum
                       ? tr("maximum of %1 mm").arg(slab.thicknessMm, 0, 'g', 3)
                       : tr("mean of %1 mm").arg(slab.thicknessMm, 0, 'g', 3);
    return heading.join(QStringLiteral(", "));
}

QString GreyPane::inWords() const {
    const WindowLevel& window = reader().slices().window();
    QString words = tr("window centre %1, width %2 HU").arg(window.centerHu).arg(window.widthHu);
    if (const auto& pointed = reader().measures().pointed(); pointed && pointedAt())
        words += QStringLiteral(", ") + tr("%1 HU").arg(std::lround(pointed->hu));
    if (const auto& measures = reader().measures().measures(); !measures.empty())
        words += QStringLiteral(", ") + textOf(measures.back());
    words += rulerInWords();
    return words + QStringLiteral(", ") + Pane::inWords();
}

void GreyPane::fillMenu(QMenu& menu) {
    menu.addAction(tr("Clear rulers and ellipses"), this, [this] { reading().clearMeasures(); })
        ->setEnabled(!reader().measures().measures().empty() || !reader().shownRulers().empty());
}

void GreyPane::addShown(Shown& shown) const {
    const reader::SliceViews& slices = reader().slices();
    shown.add(slices.window().centerHu), shown.add(slices.window().widthHu);
    shown.add(slices.slab().thicknessMm), shown.add(double(slices.slab().projection));
    shown.add(slices.linked());
    for (const reader::ScanMeasure& measure : reader().measures().measures()) {
        shown.add(measure.fromMm), shown.add(measure.toMm);
        shown.add(measure.values ? measure.values->meanHu : -1e9);
    }
    if (const auto& picked = reader().flat().picked()) shown.add(picked->positionMm);
    addRulersAndFindings(shown);
    if (const auto& pointed = reader().measures().pointed(); pointed && pointedAt()) {
        shown.add(pointed->placeMm);
        shown.add(pointed->hu);
    }
}

std::optional<glm::dvec3> GreyPane::patientAt(QPointF position) const {
    const auto placed = placement();
    if (!placed) return std::nullopt;
    return placed->patientFromPixel(pixelAt(position) - 0.5);
}

QPointF GreyPane::positionOf(const SlicePlacement& placement, glm::dvec3 mm) const {
    return positionOf(placement.pixelFromPatient(mm) + 0.5);
}

bool GreyPane::draws(const Hand& hand) const {
    return toolOf(hand) != DrawingTool::none;
}

void GreyPane::pressed(const Hand& hand) {
    drawnFrom_.reset();
    windowBefore_ = reader().slices().window();
    const DrawingTool tool = toolOf(hand);
    if (tool == DrawingTool::none) return;
    drawnFrom_ = patientAt(hand.position);
    drawsEllipse_ = tool == DrawingTool::outline;
    hasBegun_ = false;
    measuresBefore_ = reader().measures().measures();
}

void GreyPane::dragged(const Hand& hand) {
    const auto placed = placement();
    if (hand.button == Qt::MiddleButton || hand.button == Qt::RightButton) {
        if (placed) moved(vector(hand.moved) / widgetPerPixel() * placed->pixelMm());
        return;
    }
    if (drawnFrom_ && placed) {
        reader::ScanMeasure measure;
        measure.isEllipse = drawsEllipse_;
        measure.right = glm::normalize(placed->rightMm);
        measure.normal = glm::normalize(glm::cross(placed->rightMm, placed->downMm));
        measure.fromMm = *drawnFrom_;
        measure.toMm = *patientAt(hand.position);
        measure.scan = shownScan();
        measure.slab = reader().slices().slab();
        reader().measures().draw(measure, !std::exchange(hasBegun_, true));
        return;
    }
    // Across: the window's width; up and down: its centre.
    WindowLevel window = reader().slices().window();
    const double stepHu = std::max(1.0, window.widthHu / 400.0);
    window.widthHu += std::round(hand.moved.x() * stepHu);
    window.centerHu += std::round(hand.moved.y() * stepHu);
    reader().slices().setWindow(window);
}

void GreyPane::released(const Hand&) {
    reader::Reader& r = reader();
    if (drawnFrom_ && hasBegun_) {
        const auto after = r.measures().measures();
        reading().did(
            drawsEllipse_ ? tr("draw an ellipse") : tr("draw a ruler"),
            [&r, before = measuresBefore_] { r.measures().set(before); },
            [&r, after] { r.measures().set(after); });
    } else {
        changedWindow(reading(), windowBefore_);
    }
    drawnFrom_.reset();
}

// What lies under a mouse that rests changes with the slice.
void GreyPane::pointAgain() {
    if (!isVisible() || !isOpen() || !reader().measures().pointed()) return;
    if (const auto at = pointedAt()) reader().measures().pointAt(patientAt(*at), shownScan());
}

void GreyPane::hovered(const Hand& hand) {
    reader().measures().pointAt(patientAt(hand.position), shownScan());
    reading().changed();
}

void GreyPane::left() {
    reader().measures().pointAt({}, Scan::original);
    reading().changed();
}

QString GreyPane::textOf(const reader::ScanMeasure& measure) {
    if (!measure.isEllipse) return tr("%1 mm").arg(decimal(measure.lengthMm()));
    const double area = M_PI * glm::length(measure.halfAMm()) * glm::length(measure.halfBMm());
    const QString size = tr("%1 mm²").arg(area, 0, 'f', 0);
    if (!measure.values) return size;
    return tr("mean %1 ± %2 HU   %3")
        .arg(decimal(measure.values->meanHu))
        .arg(decimal(measure.values->deviationHu))
        .arg(size);
}

void GreyPane::paintMeasures(QPainter& painter, const SlicePlacement& placement) {
    const glm::dvec3 normal = placement.normal();
    painter.setFont(smallFont(font()));
    paintFindings(painter, placement);
    painter.setFont(font());
    paintRulers(painter, placement);
    for (const reader::ScanMeasure& measure : reader().measures().measures()) {
        if (std::abs(glm::dot(measure.normal, normal)) < 0.999 || !isOn(placement, measure.fromMm))
            continue;
        const QPointF from = positionOf(placement, measure.fromMm),
                      to = positionOf(placement, measure.toMm);
        const QColor color = theme().measuredOnPicture;
        const QString text = textOf(measure);
        if (measure.isEllipse) {
            QPainterPath path;
            path.addEllipse(QRectF(from, to).normalized());
            outlinedPolyline(painter, path.toFillPolygon(), true, color);
        } else {
            outlinedPolyline(painter, QPolygonF({from, to}), false, color);
            painter.setPen(Qt::NoPen);
            painter.setBrush(color);
            for (const QPointF end : {from, to})
                painter.drawEllipse(end, 2.5, 2.5);
        }
        const double wide = QFontMetricsF(painter.font()).horizontalAdvance(text);
        const QPointF low((from.x() + to.x()) / 2, std::max(from.y(), to.y()) + 4);
        outlinedText(
            painter,
            {std::clamp(low.x(), wide / 2 + 4, std::max(wide / 2 + 4, width() - wide / 2 - 4)),
             std::min(low.y(), height() - 24.0)},
            Qt::AlignHCenter | Qt::AlignTop, color, text);
    }
}

// What lies beside the plane is shown on it, dashed, where the plane passes through it or near it.
void GreyPane::paintRulers(QPainter& painter, const SlicePlacement& placement) {
    constexpr double nearMm = 5.0;
    const glm::dvec3 normal = placement.normal();
    const auto above = [&](glm::dvec3 mm) { return glm::dot(mm - placement.topLeftMm, normal); };
    RulerTexts rulers(painter, rect());
    for (const reader::PlaceRuler& ruler : reader().shownRulers()) {
        const double from = above(ruler.from.positionMm), to = above(ruler.to.positionMm);
        if (std::min(from, to) > nearMm || std::max(from, to) < -nearMm) continue;
        const bool lies =
            isOn(placement, ruler.from.positionMm) && isOn(placement, ruler.to.positionMm);
        rulers.paint(positionOf(placement, ruler.from.positionMm),
                     positionOf(placement, ruler.to.positionMm), !lies, window::textOf(ruler));
    }
    if (const auto& begun = reader().rulers().begun(); begun && isOn(placement, begun->positionMm))
        paintCross(painter, positionOf(placement, begun->positionMm), 3.0, 8.0,
                   theme().measuredOnPicture);
}

// Where the plane passes through a finding, a ring around its section as of a ball; of wall that is
// thick all around, as of a ball that a colon holds: its length may reach into other loops.
void GreyPane::paintFindings(QPainter& painter, const SlicePlacement& placement) {
    FindingRings rings(painter, rect());
    for (const reader::ListedFinding& one : reader().findings().shown()) {
        const double aside =
            std::abs(glm::dot(one.finding.positionMm - placement.topLeftMm, placement.normal()));
        constexpr double aroundMm = 2.0, colonRadiusMm = 20.0;
        double radiusMm = 0.5 * one.finding.diameterMm + aroundMm;
        if (one.finding.kind == annularKind) radiusMm = std::min(radiusMm, colonRadiusMm);
        if (aside >= radiusMm) continue;
        const double sectionMm = std::sqrt(radiusMm * radiusMm - aside * aside);
        rings.paint(positionOf(placement, one.finding.positionMm),
                    sectionMm / placement.pixelMm() * widgetPerPixel(), one);
    }
}

// Within half a voxel of the plane, or within its slab.
bool GreyPane::isOn(const SlicePlacement& placement, glm::dvec3 mm) const {
    const glm::dvec3 spacing = reader().session().caseInfo()->grid.spacingMm();
    const double thickMm =
        std::max({spacing.x, spacing.y, spacing.z, reader().slices().slab().thicknessMm});
    return std::abs(glm::dot(mm - placement.topLeftMm, placement.normal())) <= 0.51 * thickMm;
}

void GreyPane::paintTexts(QPainter& painter, const QString& place) {
    painter.setFont(smallFont(font()));
    const double margin = 8.0;
    outlinedText(painter, {margin, margin}, topLeft, theme().onPicture, heading());
    outlinedText(painter, {width() - margin, margin}, topRight, theme().dimOnPicture, place);
    const WindowLevel& window = reader().slices().window();
    outlinedText(painter, {margin, height() - margin}, bottomLeft, theme().dimOnPicture,
                 tr("C %1  W %2 HU").arg(window.centerHu).arg(window.widthHu));
    const auto& pointed = reader().measures().pointed();
    const auto placed = placement();
    if (!pointed || !pointedAt() || !placed || pointed->scan != shownScan() ||
        !isOn(*placed, pointed->placeMm))
        return;
    // Beside the mouse, on that side of it where there is room.
    const QPointF at = positionOf(*placed, pointed->placeMm);
    const bool isRight = at.x() > width() - 90.0, isLow = at.y() > height() - 50.0;
    outlinedText(
        painter, at + QPointF(isRight ? -12 : 14, isLow ? -12 : 16),
        (isRight ? Qt::AlignRight : Qt::AlignLeft) | (isLow ? Qt::AlignBottom : Qt::AlignTop),
        theme().accentOnPicture, tr("%1 HU").arg(std::lround(pointed->hu)));
}

// ---- a slice ------------------------------------------------------------------------------------

SlicePane::SlicePane(Reading& reading, View view)
    : GreyPane(reading, view,
               view == View::coronal    ? tr("Coronal")
               : view == View::sagittal ? tr("Sagittal")
                                        : tr("Axial")) {}

SliceView SlicePane::shownSlice() const {
    const SliceView* pictured = reader().panes().shown<SliceView>(view());
    return pictured ? *pictured : reader().slices().slice(view());
}

std::optional<SlicePlacement> SlicePane::placement() const {
    const glm::ivec2 size = pictureSize();
    const auto placed =
        placeSlice(shownSlice(), reader().session().caseInfo()->grid, size.x, size.y);
    return placed ? std::optional(*placed) : std::nullopt;
}

Scan SlicePane::shownScan() const {
    return shownSlice().scan;
}

double SlicePane::stepMm() const {
    const glm::dvec3 spacing = reader().session().caseInfo()->grid.spacingMm();
    return view() == View::axial ? spacing.z : view() == View::coronal ? spacing.y : spacing.x;
}

QString SlicePane::inWords() const {
    return tr("%1 %2 mm")
               .arg(axisOf(view()))
               .arg(decimal(glm::dot(shownSlice().positionMm, reader::sliceNormal(view())))) +
           QStringLiteral(", ") + GreyPane::inWords();
}

void SlicePane::fillMenu(QMenu& menu) {
    menu.addAction(tr("Whole slice"), this, [this] {
        reader().slices().showWhole(view());
        reading().changed();
    });
    GreyPane::fillMenu(menu);
}

void SlicePane::addShown(Shown& shown) const {
    GreyPane::addShown(shown);
    shown.add(reader().flight().camera());
    shown.add(shownSlice().positionMm);
}

// A cross with an open middle where the camera is, and an arrow along its gaze.
void SlicePane::paintCrosshair(QPainter& painter, const SlicePlacement& placement) {
    const Camera camera = reader().flight().camera();
    const QPointF p = positionOf(placement, camera.positionMm);
    constexpr double gap = 9.0;
    QColor faint = theme().accentOnPicture;
    faint.setAlpha(theme().lineWidth > 1.0 ? 255 : 120);
    // Dashed where the camera is not in this slice.
    const bool isHere = isOn(placement, camera.positionMm);
    painter.setPen(QPen(faint, theme().lineWidth, isHere ? Qt::SolidLine : Qt::DashLine));
    painter.setRenderHint(QPainter::Antialiasing, false);
    painter.drawLine(QPointF(0, p.y()), p - QPointF(gap, 0));
    painter.drawLine(p + QPointF(gap, 0), QPointF(width(), p.y()));
    painter.drawLine(QPointF(p.x(), 0), p - QPointF(0, gap));
    painter.drawLine(p + QPointF(0, gap), QPointF(p.x(), height()));
    painter.setRenderHint(QPainter::Antialiasing);
    painter.setPen(QPen(theme().accentOnPicture, 1.2));
    painter.setBrush(isHere ? QBrush(theme().accentOnPicture) : QBrush(Qt::NoBrush));
    painter.drawEllipse(p, 2.5, 2.5);
    painter.setBrush(theme().accentOnPicture);
    const glm::dvec2 ahead =
        placement.pixelFromPatient(camera.positionMm + camera.forward * placement.pixelMm()) -
        placement.pixelFromPatient(camera.positionMm);
    const double length = glm::length(ahead);
    if (length < 0.15) return;  // looking along the slice's normal
    const QPointF along = point(ahead / length), across(-along.y(), along.x());
    const QPointF end = p + along * (4.0 + 16.0 * length);
    painter.setPen(QPen(theme().accentOnPicture, 1.5 * theme().lineWidth));
    painter.drawLine(p, end);
    painter.setPen(Qt::NoPen);
    painter.drawPolygon(QPolygonF({end + along * 4.0, end + across * 3.2, end - across * 3.2}));
}

void SlicePane::paintMarks(QPainter& painter) {
    const auto placed = placement();
    if (!placed) return;
    paintCrosshair(painter, *placed);
    if (const auto& picked = reader().flat().picked(); picked && isOn(*placed, picked->positionMm))
        paintPlaceMark(painter, positionOf(*placed, picked->positionMm));
    painter.setFont(smallFont(font()));
    paintSides(painter, rect(), glm::normalize(placed->rightMm), -glm::normalize(placed->downMm));
    paintMeasures(painter, *placed);
    const SliceView shown = shownSlice();
    paintTexts(painter, tr("%1 %2 mm")
                            .arg(axisOf(view()))
                            .arg(decimal(glm::dot(shown.positionMm, reader::sliceNormal(view())))));
    const double top = paintScaleBar(painter, rect(), widgetPerPixel() / placed->pixelMm());
    QString state = shown.zoom > 1.001 ? tr("×%1").arg(decimal(shown.zoom)) : QString();
    if (!reader().slices().linked()) state = tr("not linked") + QStringLiteral("  ") + state;
    outlinedText(painter, {width() - 8.0, top}, bottomRight, theme().dimOnPicture, state);
}

void SlicePane::clicked(const Hand& hand) {
    if (hand.button != Qt::LeftButton || addsEnd(hand)) return;
    if (const auto place = patientAt(hand.position))
        reading().jump(tr("go to a voxel"),
                       [this, place = *place] { reader().goTo(place, view()); });
}

void SlicePane::wheeled(const Hand& hand, double steps) {
    if (hand.ctrl())
        reader().slices().zoom(view(), std::pow(1.2, steps), pixelAt(hand.position) - 0.5,
                               pictureSize());
    else
        reader().slices().scroll(view(), steps * stepMm() * (hand.shift() ? 10.0 : 1.0));
}

void SlicePane::moved(glm::dvec2 mm) {
    reader().slices().pan(view(), mm);
}

// ---- the slice across the gaze ------------------------------------------------------------------

ObliquePane::ObliquePane(Reading& reading)
    : GreyPane(reading, View::oblique, tr("Across the gaze")) {}

ObliqueView ObliquePane::shownSlice() const {
    const ObliqueView* pictured = reader().panes().shown<ObliqueView>(View::oblique);
    return pictured ? *pictured : reader().slices().oblique(reader().flight().camera());
}

std::optional<SlicePlacement> ObliquePane::placement() const {
    const glm::ivec2 size = pictureSize();
    const auto placed = placeSlice(shownSlice(), size.x, size.y);
    return placed ? std::optional(*placed) : std::nullopt;
}

Scan ObliquePane::shownScan() const {
    return shownSlice().scan;
}

void ObliquePane::addShown(Shown& shown) const {
    GreyPane::addShown(shown);
    const ObliqueView slice = shownSlice();
    shown.add(slice.positionMm), shown.add(slice.forward), shown.add(slice.heightMm);
    shown.add(reader().flight().camera().positionMm);
}

void ObliquePane::paintMarks(QPainter& painter) {
    const auto placed = placement();
    if (!placed) return;
    const ObliqueView shown = shownSlice();
    const Camera camera = reader().flight().camera();
    const double ahead = glm::dot(shown.positionMm - camera.positionMm, shown.forward);
    paintCross(painter, positionOf(*placed, camera.positionMm + ahead * shown.forward), 4.0, 9.0,
               theme().accentOnPicture);
    if (const auto& picked = reader().flat().picked()) {
        if (isOn(*placed, picked->positionMm))
            paintPlaceMark(painter, positionOf(*placed, picked->positionMm));
    }
    painter.setFont(smallFont(font()));
    paintSides(painter, rect(), glm::cross(shown.forward, shown.up), shown.up);
    paintMeasures(painter, *placed);
    paintTexts(painter, std::abs(ahead) < 0.5 ? QString()
                        : ahead > 0.0         ? tr("%1 mm ahead").arg(ahead, 0, 'f', 0)
                                              : tr("%1 mm behind").arg(-ahead, 0, 'f', 0));
    paintScaleBar(painter, rect(), widgetPerPixel() / placed->pixelMm());
}

void ObliquePane::clicked(const Hand& hand) {
    if (hand.button != Qt::LeftButton || addsEnd(hand)) return;
    if (const auto place = patientAt(hand.position))
        reading().jump(tr("go to a voxel"), [this, place = *place] { reader().goTo(place, {}); });
}

void ObliquePane::wheeled(const Hand& hand, double steps) {
    if (hand.ctrl())
        reader().slices().zoomOblique(std::pow(1.2, steps));
    else
        reader().slices().scrollOblique(steps * (hand.shift() ? 10.0 : 1.0));
}

void ObliquePane::moved(glm::dvec2 mm) {
    reader().slices().panOblique(mm);
}

void ObliquePane::fillMenu(QMenu& menu) {
    menu.addAction(tr("In the middle again"), this, [this] {
        reader().slices().centerOblique();
        reading().changed();
    });
    GreyPane::fillMenu(menu);
}

}  // namespace haustra::window
