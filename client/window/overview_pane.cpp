#include "window/overview_pane.h"

#include "reader/overview_map.h"
#include "window/theme.h"

#include <QMenu>
#include <cmath>

namespace haustra::window {

OverviewPane::OverviewPane(Reading& reading) : Pane(reading, View::overview, tr("Overview")) {}

void OverviewPane::fillMenu(QMenu& menu) {
    menu.addAction(tr("From the front"), this, [this] {
        reader().outside().reset();
        reading().changed();
    });
}

void OverviewPane::addShown(Shown& shown) const {
    shown.add(reader().flight().camera());
    shown.add(under_ ? double(*under_) : -1.0);
    if (const Overview* pictured = reader().panes().shown<Overview>(View::overview))
        shown.add(pictured->camera);
    shown.add(double(reader().session().bookmarksRevision()));
    if (const auto& picked = reader().flat().picked()) shown.add(picked->positionMm);
    addRulersAndFindings(shown);
}

QPointF OverviewPane::positionOf(const Camera& from, glm::dvec3 mm) const {
    return pictureArea().topLeft() + point(glm::dvec2(projected(from, mm, areaSize())));
}

// The reader's camera as a cone that opens to where it looks.
void OverviewPane::paintReader(QPainter& painter, const Camera& from) {
    const Camera camera = reader().flight().camera();
    const double lengthMm = 20.0 * from.heightMm / areaSize().y, radiusMm = 0.42 * lengthMm;
    const glm::dvec3 right = glm::cross(camera.forward, camera.up);
    const auto seen = [&](glm::dvec3 mm) { return positionOf(from, mm); };
    constexpr int sides = 24;
    QPolygonF rim;
    for (int side = 0; side < sides; ++side) {
        const double angle = 2.0 * M_PI * side / sides;
        rim << seen(camera.positionMm + lengthMm * camera.forward +
                    radiusMm * (std::cos(angle) * right + std::sin(angle) * camera.up));
    }
    const QPointF apex = seen(camera.positionMm);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(60, 205, 235));
    for (int side = 0; side < sides; ++side)
        painter.drawPolygon(QPolygonF({apex, rim[side], rim[(side + 1) % sides]}));
    // Seen from where it looks to, the opening is darker than the mantle.
    const bool open = glm::dot(camera.forward, from.forward) < 0.0;
    painter.setBrush(open ? QColor(120, 230, 250) : QColor(40, 165, 195));
    painter.setPen(QPen(QColor(8, 30, 38, 200), 1));
    painter.drawPolygon(rim);
    painter.setPen(Qt::NoPen);
    painter.setBrush(QColor(230, 250, 255));
    painter.drawEllipse(apex, 2.5, 2.5);
}

void OverviewPane::paintMarks(QPainter& painter) {
    if (const Overview* pictured = reader().panes().shown<Overview>(View::overview)) {
        const Camera& from = pictured->camera;
        const auto bookmarks = reader().session().bookmarks();
        for (std::size_t n = 0; n < bookmarks.size(); ++n) {
            const QPointF p = positionOf(from, bookmarks[n].camera.positionMm);
            painter.setPen(QPen(QColor(20, 14, 4, 220), 2.4));
            painter.setBrush(theme().bookmarkOnPicture);
            const double radius = under_ == n ? 6.0 : 4.5;
            painter.drawEllipse(p, radius, radius);
        }
        painter.setFont(smallFont(font()));
        constexpr double ringPixels = 5.0;
        FindingRings rings(painter, rect());
        for (const reader::ListedFinding& one : reader().findings().shown())
            rings.paint(positionOf(from, one.finding.positionMm), ringPixels, one);
        paintReader(painter, from);
        if (const auto& picked = reader().flat().picked())
            paintPlaceMark(painter, positionOf(from, picked->positionMm));
        painter.setFont(smallFont(font()));
        paintSides(painter, rect(), glm::cross(from.forward, from.up), from.up);
    }
    if (!namesItself()) return;
    painter.setFont(smallFont(font()));
    outlinedText(painter, {8, 8}, Qt::AlignLeft | Qt::AlignTop, theme().onPicture, title());
}

std::optional<std::size_t> OverviewPane::bookmarkAt(QPointF position) const {
    std::vector<glm::dvec3> places;
    for (const reader::Bookmark& bookmark : reader().session().bookmarks())
        places.push_back(bookmark.camera.positionMm);
    return reader::placeAt(reader().outside().orbit(), places,
                           vector(position - pictureArea().topLeft()), areaSize(), 9.0);
}

void OverviewPane::dragged(const Hand& hand) {
    // The near side follows the hand.
    reader().outside().turn(-0.5 * hand.moved.x(), 0.5 * hand.moved.y());
}

void OverviewPane::clicked(const Hand& hand) {
    if (hand.button != Qt::LeftButton) return;
    if (const auto under = bookmarkAt(hand.position)) {
        const reader::Bookmark bookmark = reader().session().bookmarks()[*under];
        return reading().jump(tr("go to a bookmark"),
                              [this, bookmark] { reader().goTo(bookmark); });
    }
    const auto arc =
        reader::arcAt(reader().outside().orbit(), reader().flight().centerline(),
                      vector(hand.position - pictureArea().topLeft()), areaSize(), 40.0);
    if (arc)
        reading().jump(tr("go along the path"),
                       [this, arc = *arc] { reader().flight().goTo(arc); });
}

void OverviewPane::doubleClicked(const Hand&) {
    takeClickBack();
    reader().outside().reset();
}

void OverviewPane::wheeled(const Hand&, double steps) {
    reader().outside().zoom(std::pow(1.15, steps));
}

void OverviewPane::hovered(const Hand& hand) {
    under_ = bookmarkAt(hand.position);
    QString tip;
    if (under_) {
        const std::string note = reader().session().bookmarks()[*under_].note;
        tip = note.empty() ? tr("Bookmark") : text(note);
    }
    setToolTip(tip);
    reading().changed();
}

void OverviewPane::left() {
    under_.reset();
}

}  // namespace haustra::window
