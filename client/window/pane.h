// A pane that shows one view of the server: its newest picture, what is drawn over it, the hand.
#pragma once

#include "window/reading.h"

#include <QImage>
#include <QPainter>
#include <QWidget>
#include <vector>

namespace haustra::window {

/// Numbers on which what a pane shows depends: where none has changed, nothing is painted anew.
class Shown {
public:
    void add(double number) { numbers_.push_back(number); }
    void add(glm::dvec3 v) { add(v.x), add(v.y), add(v.z); }
    void add(const Camera& camera) {
        add(camera.positionMm), add(camera.forward), add(camera.up), add(camera.fovDegrees);
    }
    bool operator==(const Shown&) const = default;

private:
    std::vector<double> numbers_;
};

/// Where the mouse is in a pane, and what is held. Lengths are the widget's.
struct Hand {
    QPointF position, moved;  ///< moved: since the last call
    Qt::KeyboardModifiers modifiers;
    Qt::MouseButton button = Qt::NoButton;  ///< that is held
    bool shift() const { return modifiers.testFlag(Qt::ShiftModifier); }
    bool ctrl() const { return modifiers.testFlag(Qt::ControlModifier); }
    bool alt() const { return modifiers.testFlag(Qt::AltModifier); }
};

/// Belongs to the main thread; the reading must outlive it. A pane that is not in sight asks the
/// server for nothing.
class Pane : public QWidget {
    Q_OBJECT
public:
    Pane(Reading& reading, View view, const QString& title, QWidget* parent = nullptr);

    View view() const { return view_; }
    QString title() const { return title_; }
    QSize sizeHint() const override { return {360, 320}; }
    QSize minimumSizeHint() const override { return {120, 90}; }

    /// The picture as it is shown, with what is drawn over it, in pixels; null before there is one.
    /// Its text "Description" says what it is of (provenance()).
    QImage pictureWithMarks();
    /// Case, view, place, server and time, one line each.
    QString provenance() const;
    /// What the view shows, in words, for whoever does not see it.
    virtual QString inWords() const;
    /// Tells the reader how large the pane is; one that is out of sight has no size.
    void tellSize();
    /// Entries of the pane's own for its menu.
    virtual void fillMenu(QMenu& menu) { (void)menu; }

signals:
    /// The menu was asked for at a place of the screen.
    void menuWanted(const QPoint& globalPosition);

protected:
    Reading& reading() { return reading_; }
    reader::Reader& reader() { return reading_.reader(); }
    const reader::Reader& reader() const { return reading_.reader(); }
    bool isOpen() const { return reader().isOpen(); }
    /// Where the mouse was last.
    QPointF lastMouse() const { return lastAt_; }
    /// Logical pixels of the widget a pixel of the picture that the server makes for it.
    double widgetPerPixel() const;
    glm::ivec2 pictureSize() const { return reader().panes().size(view_); }

    /// The dock says what the pane shows; a picture that leaves the window says it itself.
    bool namesItself() const { return namesItself_; }
    /// What is drawn over the picture, and all that it depends on besides the picture.
    virtual void paintMarks(QPainter& painter) = 0;
    virtual void addShown(Shown& shown) const = 0;
    virtual void paintPicture(QPainter& painter, const QImage& picture);

    // The hand. A press that moves no farther than a few pixels is a click.
    virtual void pressed(const Hand&) {}
    virtual void dragged(const Hand&) {}
    virtual void released(const Hand&) {}
    virtual void clicked(const Hand&) {}
    /// Else the second press of a double click is a press.
    virtual bool takesDoubleClicks() const { return false; }
    virtual void doubleClicked(const Hand&) {}
    /// What the first click of a double click has done is undone.
    void takeClickBack();
    /// `steps` of the wheel, away from the hand positive.
    virtual void wheeled(const Hand&, double steps) { (void)steps; }
    virtual void hovered(const Hand&) {}
    virtual void left() {}

    void paintEvent(QPaintEvent*) override;
    void resizeEvent(QResizeEvent*) override;
    void showEvent(QShowEvent*) override;
    void hideEvent(QHideEvent*) override;
    void mousePressEvent(QMouseEvent*) override;
    void mouseMoveEvent(QMouseEvent*) override;
    void mouseReleaseEvent(QMouseEvent*) override;
    void mouseDoubleClickEvent(QMouseEvent*) override;
    void wheelEvent(QWheelEvent*) override;
    void enterEvent(QEnterEvent*) override;
    void leaveEvent(QEvent*) override;
    void keyPressEvent(QKeyEvent*) override;
    void focusInEvent(QFocusEvent*) override;
    void focusOutEvent(QFocusEvent*) override;

private:
    void look();
    void paintAll(QPainter& painter);
    void dragOut();

    Reading& reading_;
    View view_;
    QString title_;
    glm::ivec2 toldSize_{0};
    Shown shown_;
    QPointF pressedAt_, lastAt_;
    Qt::MouseButton held_ = Qt::NoButton;
    int clickStep_ = -1;  // that the last click made, in the undo stack
    bool isDrag_ = false, takesPictureOut_ = false, isHovered_ = false, namesItself_ = false;
};

// ---- what is drawn over pictures ----------------------------------------------------------------

/// With a dark outline, readable on any picture; `at` is a corner or the middle of a side of the
/// text, as `alignment` says: AlignLeft, AlignRight or AlignHCenter with AlignTop, AlignBottom or
/// AlignVCenter.
QRectF outlinedText(QPainter& painter, QPointF at, Qt::Alignment alignment, const QColor& color,
                    const QString& text);
/// A cross with an open middle.
void paintCross(QPainter& painter, QPointF at, double inner, double outer, const QColor& color);
/// The mark of the place that the reader has gone to.
void paintPlaceMark(QPainter& painter, QPointF at);
void paintBookmarkFlag(QPainter& painter, QPointF foot);
/// A line with a dark outline.
void outlinedPolyline(QPainter& painter, const QPolygonF& line, bool closed, const QColor& color);
/// The letters of the patient's sides at the picture's edges, for its directions right and up.
void paintSides(QPainter& painter, const QRectF& area, glm::dvec3 right, glm::dvec3 up);
/// A bar of a round length, at the picture's lower right; returns its top.
double paintScaleBar(QPainter& painter, const QRectF& area, double pixelsPerMm);
QFont smallFont(const QFont& font);
QFont largeFont(const QFont& font);

inline QPointF point(glm::dvec2 v) {
    return {v.x, v.y};
}
inline glm::dvec2 vector(QPointF p) {
    return {p.x(), p.y()};
}

}  // namespace haustra::window
