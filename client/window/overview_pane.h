// The colon from outside.
#pragma once

#include "window/pane.h"

#include <optional>

namespace haustra::window {

/// A drag turns it, the wheel enlarges, a click goes to that place of the path or to that bookmark,
/// a double click looks from the front again.
class OverviewPane : public Pane {
    Q_OBJECT
public:
    explicit OverviewPane(Reading& reading);
    QSize sizeHint() const override { return {300, 340}; }
    void fillMenu(QMenu& menu) override;

protected:
    void paintMarks(QPainter& painter) override;
    void addShown(Shown& shown) const override;
    void dragged(const Hand& hand) override;
    void clicked(const Hand& hand) override;
    bool takesDoubleClicks() const override { return true; }
    void doubleClicked(const Hand& hand) override;
    void wheeled(const Hand& hand, double steps) override;
    void hovered(const Hand& hand) override;
    void left() override;

private:
    glm::dvec2 areaSize() const { return {pictureArea().width(), pictureArea().height()}; }
    QPointF positionOf(const Camera& from, glm::dvec3 mm) const;
    std::optional<std::size_t> bookmarkAt(QPointF position) const;
    void paintReader(QPainter& painter, const Camera& from);

    std::optional<std::size_t> under_;  // the bookmark under the mouse
};

}  // namespace haustra::window
