// The view from within the colon.
#pragma once

#include "window/pane.h"

namespace haustra::window {

/// A drag looks around, a click goes to the wall there in all views, a double click looks straight
/// ahead, the wheel moves along the path; with Ctrl it sets the field of view. A lens that is on
/// follows the pointer, the mouse's or the keys'; the wheel with Alt sets its size.
class EndoscopicPane : public Pane {
    Q_OBJECT
public:
    explicit EndoscopicPane(Reading& reading);
    QString inWords() const override;
    void fillMenu(QMenu& menu) override;
    QSize sizeHint() const override { return {560, 520}; }

protected:
    void paintMarks(QPainter& painter) override;
    void addShown(Shown& shown) const override;
    void dragged(const Hand& hand) override;
    void clicked(const Hand& hand) override;
    bool takesDoubleClicks() const override { return true; }
    void doubleClicked(const Hand& hand) override;
    void wheeled(const Hand& hand, double steps) override;
    void hovered(const Hand& hand) override;

private:
    Camera shownCamera() const;
    void lensFollows();
    QString lensInWords() const;
    void paintLens(QPainter& painter);
    void paintLensCaption(QPainter& painter, const QRectF& ring);
    void paintFlight(QPainter& painter);
    void paintRulers(QPainter& painter);
    void paintBadge(QPainter& painter);
};

}  // namespace haustra::window
