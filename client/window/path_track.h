// The colon's path as one track from rectum to cecum.
#pragma once

#include "window/reading.h"

#include <QSlider>

namespace haustra::window {

/// A slider over the path's millimetres: bridges are marked, bookmarks are flags, the knob shows
/// the direction of flight. A press or a drag goes there.
class PathTrack : public QSlider {
    Q_OBJECT
public:
    explicit PathTrack(Reading& reading);
    QSize sizeHint() const override { return {400, 30}; }
    QSize minimumSizeHint() const override { return {120, 26}; }

protected:
    void paintEvent(QPaintEvent*) override;
    void mousePressEvent(QMouseEvent*) override;
    void mouseMoveEvent(QMouseEvent*) override;
    void mouseReleaseEvent(QMouseEvent*) override;

private:
    void look();
    void goTo(double arcMm);
    double xOf(double arcMm) const;
    double arcAt(double x) const;
    double lengthMm() const;

    Reading& reading_;
    std::function<void()> back_;                  // while it is pressed: to where it was
    std::uint64_t bookmarks_ = 0, findings_ = 0;  // their revisions, as painted
    bool antegrade_ = true, follows_ = false;
};

}  // namespace haustra::window
