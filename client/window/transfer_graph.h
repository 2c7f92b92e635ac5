// A transfer function's points over a scan's values, as a picture that a hand changes.
#pragma once

#include "window/reading.h"

#include <QWidget>

namespace haustra::window {

/// Draws the row that is being edited over the scan's histogram. A drag moves a point, a double
/// click adds one, a right click takes one, the wheel enlarges the axis of values, a drag beside
/// the points moves it. Keys: N and P go through the points, arrows move the chosen one, Insert
/// adds one, Delete takes it.
class TransferGraph : public QWidget {
    Q_OBJECT
public:
    explicit TransferGraph(Reading& reading);
    QSize sizeHint() const override { return {420, 220}; }
    QSize minimumSizeHint() const override { return {220, 120}; }

    /// Of the row being edited; −1: none.
    int chosenPoint() const { return point_; }
    void choosePoint(int point);
    /// The axis as wide as the points, with something on either side.
    void fitAxis();

signals:
    void pointChosen();

protected:
    void paintEvent(QPaintEvent*) override;
    void mousePressEvent(QMouseEvent*) override;
    void mouseMoveEvent(QMouseEvent*) override;
    void mouseReleaseEvent(QMouseEvent*) override;
    void mouseDoubleClickEvent(QMouseEvent*) override;
    void wheelEvent(QWheelEvent*) override;
    void keyPressEvent(QKeyEvent*) override;

private:
    struct Scales;
    Scales scales() const;
    reader::OpticsEditor& optics() { return reading_.reader().optics(); }
    void setAxis(double lowHu, double highHu);
    int pointAt(QPointF position) const;
    void change(const reader::TransferCurve& curve);

    Reading& reading_;
    int point_ = -1;
    double lowHu_ = -1000.0, highHu_ = 1000.0;
    QPointF lastAt_;
    bool dragsAxis_ = false;
};

}  // namespace haustra::window
