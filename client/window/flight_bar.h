// The controls of flight and views, along the bottom.
#pragma once

#include "window/reading.h"

#include <QToolBar>

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QSlider;

namespace haustra::window {

class CommandSet;

/// Windows of grey values by name, in the order of their keys.
struct WindowPreset {
    const char* name;  ///< to be translated (context "haustra::window::FlightBar")
    WindowLevel window;
};
inline constexpr std::array windowPresets = {
    WindowPreset{QT_TRANSLATE_NOOP("haustra::window::FlightBar", "colon"), {0, 2000}},
    WindowPreset{QT_TRANSLATE_NOOP("haustra::window::FlightBar", "soft tissue"), {40, 400}},
    WindowPreset{QT_TRANSLATE_NOOP("haustra::window::FlightBar", "lung"), {-600, 1600}},
    WindowPreset{QT_TRANSLATE_NOOP("haustra::window::FlightBar", "bone"), {400, 1800}}};

/// What has no room is behind the arrow at its end.
class FlightBar : public QToolBar {
    Q_OBJECT
public:
    FlightBar(Reading& reading, const CommandSet& commands);

private:
    void look();
    void addButtons(const CommandSet& commands);
    void addControl(const QString& label, QWidget* control);

    Reading& reading_;
    QSlider* speed_;
    QLabel* speedText_;
    QDoubleSpinBox* fov_;
    QComboBox *optics_, *window_;
    bool fills_ = false;
    std::uint64_t shownOptics_ = ~std::uint64_t(0);
};

}  // namespace haustra::window
