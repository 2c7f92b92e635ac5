#include "window/transfer_graph.h"

#include "window/look_steps.h"
#include "window/theme.h"

#include <QKeyEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::window {
namespace {

constexpr double leastAxisHu = 8.0, mostAxisHu = 70'000.0;

QColor colorOf(glm::dvec3 c, double alpha = 1.0) {
    c = glm::clamp(c, 0.0, 1.0);
    return QColor::fromRgbF(float(c.r), float(c.g), float(c.b), float(alpha));
}

double roundStep(double atLeast) {
    const double ten = std::pow(10.0, std::floor(std::log10(atLeast)));
    for (const double times : {1.0, 2.0, 5.0})
        if (ten * times >= atLeast) return ten * times;
    return 10.0 * ten;
}

}  // namespace

/// HU across, and opacity up by its root, so that veils of a hundredth can be told apart.
struct TransferGraph::Scales {
    QRectF area;
    double lowHu, highHu;

    QPointF place(double hu, double opacity) const {
        return {area.left() + (hu - lowHu) / (highHu - lowHu) * area.width(),
                area.bottom() - std::sqrt(opacity) * area.height()};
    }
    double huPerPixel() const { return (highHu - lowHu) / std::max(area.width(), 1.0); }
    double hu(QPointF p) const { return lowHu + huPerPixel() * (p.x() - area.left()); }
    double opacity(QPointF p) const {
        const double up = std::clamp((area.bottom() - p.y()) / area.height(), 0.0, 1.0);
        return up * up;
    }
};

TransferGraph::TransferGraph(Reading& reading) : reading_(reading) {
    setFocusPolicy(Qt::StrongFocus);
    setMouseTracking(true);
    setAccessibleName(tr("Transfer function: opacity and colour over the scan's values"));
}

TransferGraph::Scales TransferGraph::scales() const {
    return {QRectF(rect()).adjusted(38, 6, -8, -22), lowHu_, highHu_};
}

void TransferGraph::choosePoint(int point) {
    point_ = point;
    update();
    emit pointChosen();
}

void TransferGraph::setAxis(double lowHu, double highHu) {
    const double wide = std::clamp(highHu - lowHu, leastAxisHu, mostAxisHu);
    const double middle = std::clamp(0.5 * (lowHu + highHu), lowestTransferHu, highestTransferHu);
    lowHu_ = middle - 0.5 * wide;
    highHu_ = middle + 0.5 * wide;
    update();
}

void TransferGraph::fitAxis() {
    double low = highestTransferHu, high = lowestTransferHu;
    const auto take = [&](const std::vector<TransferFunctionPoint>& points) {
        low = std::min(low, points.front().hu);
        high = std::max(high, points.back().hu);
    };
    const TransferFunction& function = optics().optics().transferFunction;
    take(function.points);
    for (const GradientRow& row : function.rows)
        take(row.points);
    const double margin = 0.12 * (high - low);
    setAxis(low - margin, high + margin);
}

// ---- painting -----------------------------------------------------------------------------------

namespace {

// By its logarithm: air is most of a scan, and what matters is little of it.
template <class Scales>
void paintHistogram(QPainter& painter, const Histogram& histogram, const Scales& scales) {
    std::uint64_t most = 0;
    for (const std::uint64_t voxels : histogram.voxels)
        most = std::max(most, voxels);
    if (most == 0) return;
    const double scale = 0.9 / std::log1p(double(most));
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme().raised);
    for (std::size_t n = 0; n < histogram.voxels.size(); ++n) {
        const double low = histogram.firstHu + double(n) * histogram.huPerBin;
        const double tall = std::log1p(double(histogram.voxels[n])) * scale;
        painter.drawRect(
            QRectF(scales.place(low, tall * tall), scales.place(low + histogram.huPerBin, 0.0)));
    }
}

template <class Scales>
void paintScales(QPainter& painter, const Scales& scales) {
    const QRectF area = scales.area;
    const QFontMetricsF metrics(painter.font());
    const double step = roundStep(scales.huPerPixel() * 64.0);
    for (double n = std::ceil(scales.lowHu / step); n * step <= scales.highHu; ++n) {
        const double x = scales.place(n * step, 0.0).x();
        painter.setPen(theme().border);
        painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
        painter.setPen(theme().muted);
        painter.drawText(QRectF(x - 60, area.bottom() + 2, 120, metrics.height()), Qt::AlignHCenter,
                         QString::number(n * step + 0.0, 'f', 0));
    }
    for (const double opacity : {0.01, 0.1, 0.5, 1.0}) {
        const double y = scales.place(0.0, opacity).y();
        painter.setPen(theme().border);
        if (opacity < 1.0) painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
        painter.setPen(theme().muted);
        painter.drawText(QRectF(0, y - metrics.height() / 2, area.left() - 6, metrics.height()),
                         Qt::AlignRight | Qt::AlignVCenter, QString::number(opacity));
    }
}

}  // namespace

void TransferGraph::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    painter.fillRect(rect(), theme().window);
    const Scales s = scales();
    painter.fillRect(s.area, theme().base);
    if (!reading_.reader().isOpen()) return;
    const reader::TransferCurve curve = optics().curve();
    painter.save();
    painter.setClipRect(s.area);
    paintHistogram(painter, reading_.reader().session().caseInfo()->histogram, s);
    QPainterPath line;
    for (double x = s.area.left(); x <= s.area.right(); x += 2.0) {
        const TransferFunctionPoint here = curve.at(s.hu({x, 0.0}));
        const QPointF top = s.place(here.hu, here.opacity);
        painter.fillRect(QRectF(x, top.y(), 2.0, s.area.bottom() - top.y()),
                         colorOf(here.color, 0.62));
        x == s.area.left() ? line.moveTo(x, top.y()) : line.lineTo(x, top.y());
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme().text, 1.4));
    painter.drawPath(line);
    painter.restore();
    painter.setFont(font());
    paintScales(painter, s);
    for (std::size_t n = 0; n < curve.points().size(); ++n) {
        const TransferFunctionPoint& point = curve.points()[n];
        if (point.hu < lowHu_ || point.hu > highHu_) continue;
        const QPointF p = s.place(point.hu, point.opacity);
        const bool chosen = int(n) == point_;
        painter.setPen(Qt::NoPen);
        painter.setBrush(chosen ? theme().accentOnPicture : theme().text);
        painter.drawEllipse(p, chosen ? 8 : 6, chosen ? 8 : 6);
        painter.setBrush(colorOf(point.color));
        painter.drawEllipse(p, chosen ? 5.0 : 4.2, chosen ? 5.0 : 4.2);
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(hasFocus() ? QPen(theme().accentOnPicture, 2) : QPen(theme().border, 1));
    painter.drawRect(s.area);
}

// ---- the hand -----------------------------------------------------------------------------------

int TransferGraph::pointAt(QPointF position) const {
    const auto points = reading_.reader().optics().curve().points();
    const Scales s = scales();
    int found = -1;
    double nearest = 12.0;
    for (std::size_t n = 0; n < points.size(); ++n) {
        const QPointF away = s.place(points[n].hu, points[n].opacity) - position;
        if (std::hypot(away.x(), away.y()) < nearest)
            nearest = std::hypot(away.x(), away.y()), found = int(n);
    }
    return found;
}

void TransferGraph::change(const reader::TransferCurve& curve) {
    changeOptics(reading_, tr("change the transfer function"),
                 [&](reader::OpticsEditor& optics) { optics.setCurve(curve); });
    update();
    emit pointChosen();
}

void TransferGraph::mousePressEvent(QMouseEvent* event) {
    lastAt_ = event->position();
    const int under = pointAt(lastAt_);
    if (event->button() == Qt::RightButton) {
        reader::TransferCurve curve = optics().curve();
        if (under < 0 || !curve.remove(std::size_t(under))) return;
        point_ = -1;
        return change(curve);
    }
    choosePoint(under);
    dragsAxis_ = under < 0;
}

void TransferGraph::mouseMoveEvent(QMouseEvent* event) {
    const QPointF now = event->position();
    if (!event->buttons().testFlag(Qt::LeftButton)) {
        setCursor(pointAt(now) >= 0 ? Qt::PointingHandCursor : Qt::ArrowCursor);
        return;
    }
    const Scales s = scales();
    if (dragsAxis_) {
        const double moved = (lastAt_.x() - now.x()) * s.huPerPixel();
        setAxis(lowHu_ + moved, highHu_ + moved);
    } else if (point_ >= 0) {
        reader::TransferCurve curve = optics().curve();
        curve.move(std::size_t(point_), s.hu(now), s.opacity(now));
        change(curve);
    }
    lastAt_ = now;
}

void TransferGraph::mouseReleaseEvent(QMouseEvent*) {
    dragsAxis_ = false;
}

void TransferGraph::mouseDoubleClickEvent(QMouseEvent* event) {
    if (event->button() != Qt::LeftButton || pointAt(event->position()) >= 0) return;
    const Scales s = scales();
    reader::TransferCurve curve = optics().curve();
    point_ = int(curve.add(s.hu(event->position()), s.opacity(event->position())));
    dragsAxis_ = false;
    change(curve);
}

void TransferGraph::wheelEvent(QWheelEvent* event) {
    const Scales s = scales();
    const double shrink = std::pow(0.85, event->angleDelta().y() / 120.0),
                 at = s.hu(event->position());
    setAxis(at - (at - lowHu_) * shrink, at + (highHu_ - at) * shrink);
    event->accept();
}

void TransferGraph::keyPressEvent(QKeyEvent* event) {
    reader::TransferCurve curve = optics().curve();
    const int points = int(curve.points().size());
    const Scales s = scales();
    const double stepHu = s.huPerPixel() * (event->modifiers() & Qt::ShiftModifier ? 20.0 : 4.0);
    const auto move = [&](double hu, double rootOpacity) {
        if (point_ < 0 || point_ >= points) return;
        const TransferFunctionPoint& p = curve.points()[std::size_t(point_)];
        const double root = std::clamp(std::sqrt(p.opacity) + rootOpacity, 0.0, 1.0);
        curve.move(std::size_t(point_), p.hu + hu, root * root);
        change(curve);
    };
    switch (event->key()) {
        case Qt::Key_N:
            return choosePoint((point_ + 1) % points);
        case Qt::Key_P:
            return choosePoint((point_ + points - 1) % points);
        case Qt::Key_Left:
            return move(-stepHu, 0.0);
        case Qt::Key_Right:
            return move(stepHu, 0.0);
        case Qt::Key_Up:
            return move(0.0, 0.02);
        case Qt::Key_Down:
            return move(0.0, -0.02);
        case Qt::Key_Insert:
            point_ = int(curve.add(0.5 * (lowHu_ + highHu_), 0.5));
            return change(curve);
        case Qt::Key_Delete:
            if (point_ < 0 || point_ >= points || !curve.remove(std::size_t(point_))) return;
            point_ = -1;
            return change(curve);
        default:
            QWidget::keyPressEvent(event);
    }
}

}  // namespace haustra::window
