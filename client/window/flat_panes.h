// The flattened colon: the whole strip, and a window onto it.
#pragma once

#include "core/strip_layout.h"
#include "window/pane.h"

namespace haustra::window {

/// A flattened view stands beside the endoscopic one in most layouts, and the eye is on one of
/// them: on this where the mouse or the keys' pointer is in it and nothing flies, or where the
/// endoscopic one is out of sight.
inline bool isFlatLookedAt(const reader::Reader& reader, bool pointedAt) {
    return reader.panes().size(View::endoscopic) == glm::ivec2(0) ||
           (pointedAt && reader.motion() == reader::Motion::paused);
}

/// The whole strip in columns. A click goes to that place of the wall, a drag looks it over.
class StripPane : public Pane {
    Q_OBJECT
public:
    explicit StripPane(Reading& reading);
    QSize sizeHint() const override { return {260, 600}; }

protected:
    bool isLookedAt() const override { return isFlatLookedAt(reader(), pointedAt().has_value()); }
    QPointF dragFrom() const override;
    void paintMarks(QPainter& painter) override;
    void addShown(Shown& shown) const override;
    void dragged(const Hand& hand) override;
    void clicked(const Hand& hand) override;
    void released(const Hand& hand) override;
    void hovered(const Hand& hand) override;

private:
    StripLayout layout() const;
    std::optional<glm::dvec2> flatAt(QPointF position) const;

    bool setsEnd_ = false;  // the click that is about to end has set a ruler's end
};

/// The window onto it. A click looks at that place in all views; a drag moves the wall, or with a
/// tool, Shift or Ctrl measures a line or an outline; the wheel enlarges.
class FlatZoomPane : public Pane {
    Q_OBJECT
public:
    explicit FlatZoomPane(Reading& reading);
    QSize sizeHint() const override { return {520, 340}; }
    void fillMenu(QMenu& menu) override;

protected:
    bool isLookedAt() const override {
        return reader().flat().tour().flyingOver() ||
               isFlatLookedAt(reader(), pointedAt().has_value());
    }
    void paintPicture(QPainter& painter, const QImage& picture) override;
    void paintMarks(QPainter& painter) override;
    void addShown(Shown& shown) const override;
    void pressed(const Hand& hand) override;
    bool draws(const Hand& hand) const override;
    void dragged(const Hand& hand) override;
    void released(const Hand& hand) override;
    void clicked(const Hand& hand) override;
    void wheeled(const Hand& hand, double steps) override;

private:
    void draw(glm::dvec2 flat, double leastStep);
    void clearMeasurement();
    DrawingTool toolOf(const Hand& hand) const;
    void paintMeasurement(QPainter& painter);
    void paintTexts(QPainter& painter);

    std::vector<glm::dvec2> drawing_;  // flat, while the mouse draws a line or an outline
    bool drawsOutline_ = false;
    std::optional<reader::Measurement> measuredBefore_;  // before the mouse draws
};

}  // namespace haustra::window
