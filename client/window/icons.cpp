#include "window/icons.h"

#include "window/theme.h"

#include <QIconEngine>
#include <QPainter>
#include <QPainterPath>

namespace haustra::window {
namespace {

// Within the square from (−1, −1) to (1, 1).
void paintSymbol(QPainter& painter, Symbol symbol, const QColor& color) {
    const QPen line(color, 0.2, Qt::SolidLine, Qt::RoundCap);
    const auto fill = [&](const QPolygonF& polygon) {
        painter.setPen(Qt::NoPen);
        painter.setBrush(color);
        painter.drawPolygon(polygon);
    };
    const auto stroke = [&](QPointF a, QPointF b) {
        painter.setPen(line);
        painter.drawLine(a, b);
    };
    const auto box = [&](double left, double top, double right, double bottom) {
        fill(QPolygonF(QRectF(QPointF(left, top), QPointF(right, bottom))));
    };
    painter.setBrush(Qt::NoBrush);
    switch (symbol) {
        case Symbol::none:
            break;
        case Symbol::forward:
            fill({{-0.6, -0.8}, {0.85, 0}, {-0.6, 0.8}});
            break;
        case Symbol::backward:
            fill({{0.6, -0.8}, {-0.85, 0}, {0.6, 0.8}});
            break;
        case Symbol::pause:
            box(-0.65, -0.75, -0.15, 0.75);
            box(0.15, -0.75, 0.65, 0.75);
            break;
        case Symbol::toRectum:
            box(-0.8, -0.7, -0.55, 0.7);
            fill({{0.7, -0.7}, {-0.45, 0}, {0.7, 0.7}});
            break;
        case Symbol::toCecum:
            box(0.55, -0.7, 0.8, 0.7);
            fill({{-0.7, -0.7}, {0.45, 0}, {-0.7, 0.7}});
            break;
        case Symbol::turnRound:
            stroke({-0.5, -0.4}, {0.8, -0.4});
            fill({{-0.95, -0.4}, {-0.35, -0.85}, {-0.35, 0.05}});
            stroke({-0.8, 0.45}, {0.5, 0.45});
            fill({{0.95, 0.45}, {0.35, 0.0}, {0.35, 0.9}});
            break;
        case Symbol::bookmark:
            fill({{-0.55, -0.85}, {0.55, -0.85}, {0.55, 0.9}, {0, 0.35}, {-0.55, 0.9}});
            break;
        case Symbol::center:
            painter.setPen(line);
            painter.drawEllipse(QPointF(0, 0), 0.55, 0.55);
            stroke({-1, 0}, {-0.35, 0});
            stroke({0.35, 0}, {1, 0});
            stroke({0, -1}, {0, -0.35});
            stroke({0, 0.35}, {0, 1});
            break;
        case Symbol::flyOver:
            painter.setPen(line);
            painter.drawRect(QRectF(-0.75, -0.9, 1.5, 1.8));
            stroke({0, 0.6}, {0, -0.1});
            fill({{-0.4, 0}, {0, -0.6}, {0.4, 0}});
            break;
        case Symbol::line:
            stroke({-0.7, 0.7}, {0.7, -0.7});
            painter.setPen(Qt::NoPen);
            painter.setBrush(color);
            painter.drawEllipse(QPointF(-0.7, 0.7), 0.24, 0.24);
            painter.drawEllipse(QPointF(0.7, -0.7), 0.24, 0.24);
            break;
        case Symbol::outline:
            painter.setPen(line);
            painter.drawEllipse(QPointF(0, 0), 0.85, 0.65);
            break;
        case Symbol::cases:
            for (const double y : {-0.6, 0.0, 0.6}) {
                box(-0.85, y - 0.12, -0.55, y + 0.12);
                box(-0.3, y - 0.12, 0.85, y + 0.12);
            }
            break;
        case Symbol::more:
            for (const double x : {-0.55, 0.25}) {
                stroke({x, -0.55}, {x + 0.5, 0.0});
                stroke({x, 0.55}, {x + 0.5, 0.0});
            }
            break;
        case Symbol::enlarge:
            for (const double way : {1.0, -1.0}) {
                stroke({0.25 * way, -0.25 * way}, {0.8 * way, -0.8 * way});
                stroke({0.8 * way, -0.8 * way}, {0.3 * way, -0.8 * way});
                stroke({0.8 * way, -0.8 * way}, {0.8 * way, -0.3 * way});
            }
            break;
    }
}

// Painted when it is needed: in the colour of the theme of that moment.
class SymbolEngine : public QIconEngine {
public:
    explicit SymbolEngine(Symbol symbol) : symbol_(symbol) {}
    void paint(QPainter* painter, const QRect& rect, QIcon::Mode mode,
               QIcon::State state) override {
        QColor color = state == QIcon::On ? theme().accentText : theme().text;
        if (mode == QIcon::Disabled) color.setAlpha(90);
        painter->save();
        painter->setRenderHint(QPainter::Antialiasing);
        painter->translate(QRectF(rect).center());
        const double half = 0.42 * std::min(rect.width(), rect.height());
        painter->scale(half, half);
        paintSymbol(*painter, symbol_, color);
        painter->restore();
    }
    QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
        QPixmap pixmap(size);
        pixmap.fill(Qt::transparent);
        QPainter painter(&pixmap);
        paint(&painter, QRect(QPoint(0, 0), size), mode, state);
        return pixmap;
    }
    QIconEngine* clone() const override { return new SymbolEngine(symbol_); }

private:
    Symbol symbol_;
};

}  // namespace

QIcon iconOf(Symbol symbol) {
    return symbol == Symbol::none ? QIcon() : QIcon(new SymbolEngine(symbol));
}

}  // namespace haustra::window
