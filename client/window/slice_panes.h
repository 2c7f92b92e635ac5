// The panes in grey: three slices, and the slice across the gaze.
#pragma once

#include "core/slice_placement.h"
#include "window/pane.h"

#include <optional>

namespace haustra::window {

/// What all grey panes do: a drag changes the window, the wheel scrolls, with Ctrl it enlarges; a
/// tool or Shift draws a ruler, Ctrl an ellipse.
class GreyPane : public Pane {
    Q_OBJECT
public:
    GreyPane(Reading& reading, View view, const QString& title);
    void fillMenu(QMenu& menu) override;
    QString inWords() const override;
    QSize sizeHint() const override { return {300, 280}; }

protected:
    /// Where the picture that is shown lies in the patient, and which scan it is of.
    virtual std::optional<SlicePlacement> placement() const = 0;
    virtual Scan shownScan() const = 0;
    /// In words: "Axial, cleansed".
    QString heading() const;
    static QString textOf(const reader::ScanMeasure& measure);

    void addShown(Shown& shown) const override;
    void dragged(const Hand& hand) override;
    void pressed(const Hand& hand) override;
    bool draws(const Hand& hand) const override;
    void released(const Hand& hand) override;
    void hovered(const Hand& hand) override;
    void left() override;
    virtual void moved(glm::dvec2 mm) { (void)mm; }

    std::optional<glm::dvec3> patientAt(QPointF position) const;
    using Pane::positionOf;
    QPointF positionOf(const SlicePlacement& placement, glm::dvec3 mm) const;
    bool isOn(const SlicePlacement& placement, glm::dvec3 mm) const;
    void paintMeasures(QPainter& painter, const SlicePlacement& placement);
    /// The ruler's end that a click with that tool means; false: another tool is in hand.
    bool addsEnd(const Hand& hand);
    void paintTexts(QPainter& painter, const QString& place);

private:
    void pointAgain();
    void paintRulers(QPainter& painter, const SlicePlacement& placement);
    void paintFindings(QPainter& painter, const SlicePlacement& placement);
    DrawingTool toolOf(const Hand& hand) const;

    std::vector<reader::ScanMeasure> measuresBefore_;
    std::optional<glm::dvec3> drawnFrom_;
    WindowLevel windowBefore_;
    bool drawsEllipse_ = false, hasBegun_ = false;
};

/// Axial, coronal or sagittal. A click goes to that very voxel, in all views.
class SlicePane : public GreyPane {
    Q_OBJECT
public:
    SlicePane(Reading& reading, View view);
    void fillMenu(QMenu& menu) override;
    QString inWords() const override;

protected:
    std::optional<SlicePlacement> placement() const override;
    Scan shownScan() const override;
    void paintMarks(QPainter& painter) override;
    void addShown(Shown& shown) const override;
    void clicked(const Hand& hand) override;
    void wheeled(const Hand& hand, double steps) override;
    void moved(glm::dvec2 mm) override;

private:
    SliceView shownSlice() const;
    double stepMm() const;
    void paintCrosshair(QPainter& painter, const SlicePlacement& placement);
};

/// The slice across the gaze: the lumen's cross-section, as the endoscopic view looks.
class ObliquePane : public GreyPane {
    Q_OBJECT
public:
    explicit ObliquePane(Reading& reading);
    void fillMenu(QMenu& menu) override;

protected:
    std::optional<SlicePlacement> placement() const override;
    Scan shownScan() const override;
    void paintMarks(QPainter& painter) override;
    void addShown(Shown& shown) const override;
    void clicked(const Hand& hand) override;
    void wheeled(const Hand& hand, double steps) override;
    void moved(glm::dvec2 mm) override;

private:
    ObliqueView shownSlice() const;
};

}  // namespace haustra::window
