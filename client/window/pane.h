// A pane that shows one view of the server: its newest picture, what is drawn over it, the hand.
#pragma once

#include "window/reading.h"

#include <QImage>
#include <QPainter>
#include <QWidget>
#include <optional>
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
/// server for nothing. With the keys' pointer, everything that a click or a drawing does in it can
/// be done by the keyboard: arrows move it (Shift: farther, Ctrl: by one pixel), Return clicks, or
/// with a tool begins and ends a drawing.
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
    /// Tells the reader how large the pane is, once it has come to rest; one that is out of sight
    /// has no size.
    void tellSizeSoon();
    bool isAtRest() const { return !sizeDue_.isActive(); }
    // What the keyboard does in the place of the mouse, at the keys' pointer or the pane's middle.
    bool hasKeyPointer() const { return keyPointer_.has_value(); }
    /// Whether the keys' pointer takes it, though it may be a command's.
    bool needsKey(const QKeyEvent& key) const;
    void setKeyPointer(bool on);
    /// Slices: to the next; the endoscopic view: along the path. `far`: ten times as far.
    void scrollByKeys(double steps, bool far);
    void zoomByKeys(double steps);
    /// As a drag by `steps` twentieths of the pane does.
    void dragByKeys(QPoint steps, Qt::MouseButton button);

    /// Entries of the pane's own for its menu.
    virtual void fillMenu(QMenu& menu) { (void)menu; }

signals:
    /// The menu was asked for at a place of the screen.
    void menuWanted(const QPoint& globalPosition);

protected:
    Reading& reading() { return reading_; }
    const Reading& reading() const { return reading_; }
    reader::Reader& reader() { return reading_.reader(); }
    const reader::Reader& reader() const { return reading_.reader(); }
    bool isOpen() const { return reader().isOpen(); }
    /// Where the mouse or the keys' pointer is, if it is in this pane; a mouse, once it has moved
    /// there.
    std::optional<QPointF> pointedAt() const;
    /// Of the picture that is shown, in the pane's pixels for which it was asked; before there is
    /// one, of the pane.
    glm::ivec2 pictureSize() const { return reader().panes().shownPaneSize(view_); }
    /// Where it lies in the widget: of its own shape, in the middle. After a resize that is not the
    /// whole pane until the next picture comes.
    QRectF pictureArea() const;
    /// Logical pixels of the widget a pixel of the picture.
    double widgetPerPixel() const;
    glm::dvec2 pixelAt(QPointF position) const;
    QPointF positionOf(glm::dvec2 pixel) const;

    /// Whether its picture, while it is on screen, is what the reader looks at: else nothing in it
    /// counts as seen.
    virtual bool isLookedAt() const { return true; }

    /// The dock says what the pane shows; a picture that leaves the window says it itself.
    bool namesItself() const { return namesItself_; }
    /// What is drawn over the picture, and all that it depends on besides the picture.
    virtual void paintMarks(QPainter& painter) = 0;
    virtual void addShown(Shown& shown) const = 0;
    virtual void paintPicture(QPainter& painter, const QImage& picture);
    /// What rulers and findings change.
    void addRulersAndFindings(Shown& shown) const;
    /// Of the newest ruler, where there is one: ", 8.2 mm".
    QString rulerInWords() const;

    // The hand. A press that moves no farther than a few pixels is a click.
    /// Where a drag by keys begins.
    virtual QPointF dragFrom() const { return QRectF(rect()).center(); }
    virtual void pressed(const Hand&) {}
    /// Whether a press there begins a drawing.
    virtual bool draws(const Hand&) const { return false; }
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
    void tellOnScreen();
    void tellSize();
    void paintAll(QPainter& painter);
    void paintKeyPointer(QPainter& painter);
    void moveKeyPointer(QPointF way);
    QPointF within(QPointF position) const;
    void pressKeyPointer(Qt::KeyboardModifiers modifiers);
    Hand keyHand(Qt::KeyboardModifiers modifiers, QPointF moved = {}) const;
    void dragOut();

    Reading& reading_;
    View view_;
    QString title_;
    glm::ivec2 toldSize_{0};
    Shown shown_;
    std::uint64_t paintedCount_ = 0;  // of the view's pictures, when it was painted last
    QPointF pressedAt_, lastAt_;
    std::optional<QPointF> mouseAt_;  // on the screen, where it last moved in the pane
    std::optional<QPointF> keyPointer_;
    bool keyDraws_ = false;
    QTimer sizeDue_;
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
/// "8.2 mm", of a finding's diameter with its number.
QString textOf(const reader::PlaceRuler& ruler);
/// Rulers of a picture, each with its text beside it where that lies on no other's.
class RulerTexts {
public:
    /// Texts stay within `area`.
    RulerTexts(QPainter& painter, const QRectF& area) : painter_(painter), area_(area) {}
    /// A line between two places, with its ends; dashed where it does not lie in the picture's
    /// plane, or a wall stands before one of them. `text` may be empty.
    void paint(QPointF from, QPointF to, bool dashed, const QString& text);

private:
    QPainter& painter_;
    QRectF area_;
    std::vector<QRectF> texts_;
};
/// Rings of a picture's findings, each with its number beside it: at the first corner where it lies
/// on no other number, and nowhere where there is none.
class FindingRings {
public:
    /// Numbers stay within `area`.
    FindingRings(QPainter& painter, const QRectF& area) : painter_(painter), area_(area) {}
    void paint(QPointF middle, double radius, const reader::ListedFinding& finding);

private:
    QPainter& painter_;
    QRectF area_;
    std::vector<QRectF> numbers_;
};
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
