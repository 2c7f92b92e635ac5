// The optics of the wall, changed by hand: presets, points, composition and light.
#pragma once

#include "window/reading.h"

#include <QWidget>
#include <array>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QHBoxLayout;
class QLabel;
class QPushButton;
class QStackedLayout;
class QToolButton;

namespace haustra::window {

class TransferGraph;

class OpticsPanel : public QWidget {
    Q_OBJECT
public:
    explicit OpticsPanel(Reading& reading);
    QSize sizeHint() const override { return {560, 470}; }

private:
    QWidget* presetRow();
    QWidget* gradientRow();
    QWidget* pointRow();
    QWidget* compositionRow();
    QWidget* lightRow();
    QWidget* fileRow();
    void look();
    void fillPresets();
    void fillRows();
    void showPoint();
    void editPoint();
    void chooseColor();
    void save();
    void open();
    reader::OpticsEditor& optics() { return reading_.reader().optics(); }
    template <class Change>
    void change(const QString& text, const Change& change);

    Reading& reading_;
    QComboBox *preset_, *composition_;
    QLabel* description_;
    QPushButton* back_;
    TransferGraph* graph_;
    QWidget* rows_;
    QStackedLayout* pointRow_;  // a hint, or the point that is chosen
    QToolButton* color_;
    QDoubleSpinBox *gradient_, *hu_, *opacity_;
    QCheckBox *preIntegrated_, *lit_;
    std::array<QDoubleSpinBox*, 5> light_{};
    std::uint64_t shownRevision_ = ~std::uint64_t(0);
    std::size_t shownRow_ = 0;
    std::string shownPreset_;
    bool fills_ = false;  // what the controls say comes from the optics, not from a hand
};

}  // namespace haustra::window
