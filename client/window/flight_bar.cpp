#include "window/flight_bar.h"

#include "window/commands.h"
#include "window/look_steps.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSlider>
#include <cmath>

namespace haustra::window {
namespace {

using reader::Flight;

// The slider's steps are those of the speed's logarithm.
constexpr int speedSteps = 100;

int stepOf(double mmPerS) {
    return int(std::lround(speedSteps * std::log(mmPerS / Flight::minSpeedMmPerS) /
                           std::log(Flight::maxSpeedMmPerS / Flight::minSpeedMmPerS)));
}

double speedOf(int step) {
    return Flight::minSpeedMmPerS *
           std::pow(Flight::maxSpeedMmPerS / Flight::minSpeedMmPerS, double(step) / speedSteps);
}

}  // namespace

FlightBar::FlightBar(Reading& reading, const CommandSet& commands)
    : QToolBar(tr("Flight")),
      reading_(reading),
      speed_(new QSlider(Qt::Horizontal)),
      speedText_(new QLabel),
      fov_(new QDoubleSpinBox),
      optics_(new QComboBox),
      window_(new QComboBox) {
    speed_->setRange(0, speedSteps);
    speed_->setAccessibleName(tr("Speed of flight"));
    speed_->setToolTip(tr("Speed (+ and −)"));
    speed_->setMinimumWidth(80);
    speed_->setMaximumWidth(110);
    speedText_->setMinimumWidth(
        speedText_->fontMetrics().horizontalAdvance(tr("%1 mm/s").arg(200)));
    fov_->setRange(10.0, 240.0);
    fov_->setDecimals(0);
    fov_->setSingleStep(5.0);
    fov_->setPrefix(QStringLiteral("∠ "));
    fov_->setSuffix(QStringLiteral("°"));
    fov_->setKeyboardTracking(false);
    fov_->setAccessibleName(tr("Field of view, degrees"));
    fov_->setToolTip(tr("Field of view (Ctrl and the wheel on the endoscopic view)"));
    optics_->setAccessibleName(tr("Look of the wall"));
    window_->setAccessibleName(tr("Window of the slices"));
    for (const WindowPreset& preset : windowPresets)
        window_->addItem(tr(preset.name));
    window_->addItem(tr("own"));

    addButtons(commands);
    auto* speed = new QWidget;
    speed->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Preferred);
    auto* row = new QHBoxLayout(speed);
    row->setContentsMargins(0, 0, 0, 0);
    row->addWidget(speed_);
    row->addWidget(speedText_);
    addSeparator();
    addWidget(speed);
    addWidget(fov_);
    addControl(tr("Wall"), optics_);
    addAction(commands.action("optics"));
    addControl(tr("Slices"), window_);

    connect(speed_, &QSlider::valueChanged, this, [this](int step) {
        if (fills_) return;
        reading_.reader().flight().setSpeed(speedOf(step));
        reading_.changed();
    });
    connect(fov_, &QDoubleSpinBox::valueChanged, this, [this](double degrees) {
        if (fills_) return;
        reading_.reader().flight().setFov(degrees);
        reading_.changed();
    });
    connect(optics_, &QComboBox::activated, this, [this](int n) {
        changeOptics(reading_, tr("choose a preset"),
                     [n](reader::OpticsEditor& optics) { optics.choose(std::size_t(n)); });
    });
    connect(window_, &QComboBox::activated, this, [this](int n) {
        if (std::size_t(n) < windowPresets.size())
            changeWindow(reading_, windowPresets[std::size_t(n)].window);
        else
            reading_.changed();  // the hand's own is not to be chosen: back to what it is
    });
    connect(&reading, &Reading::stepped, this, &FlightBar::look);
}

void FlightBar::addControl(const QString& label, QWidget* control) {
    auto* widget = new QWidget;
    widget->setSizePolicy(QSizePolicy::Maximum, QSizePolicy::Preferred);
    auto* row = new QHBoxLayout(widget);
    row->setContentsMargins(6, 0, 0, 0);
    row->setSpacing(4);
    auto* name = new QLabel(label);
    name->setBuddy(control);
    row->addWidget(name);
    row->addWidget(control);
    addWidget(widget);
}

void FlightBar::addButtons(const CommandSet& commands) {
    setIconSize({18, 18});
    const auto add = [&](const char* id) {
        addAction(commands.action(id));
        widgetForAction(commands.action(id))->setAccessibleName(commands.action(id)->text());
    };
    for (const char* id : {"to-rectum", "fly-backward", "pause", "fly-forward", "to-cecum"})
        add(id);
    addSeparator();
    for (const char* id : {"turn-round", "to-path", "bookmark"})
        add(id);
    addSeparator();
    for (const char* id : {"fly-over", "line", "outline", "enlarge"})
        add(id);
    addSeparator();
    for (const char* id : {"paint-marks", "paint-unseen", "cleansed"})
        add(id);
}

void FlightBar::look() {
    const reader::Reader& reader = reading_.reader();
    setEnabled(reader.isOpen());
    fills_ = true;
    if (!speed_->isSliderDown()) speed_->setValue(stepOf(reader.flight().speedMmPerS()));
    speedText_->setText(tr("%1 mm/s").arg(reader.flight().speedMmPerS(), 0, 'f', 0));
    // A number that is set is painted anew, whether it is another or not.
    const double fov = std::round(reader.flight().camera().fovDegrees);
    if (!fov_->hasFocus() && fov_->value() != fov) fov_->setValue(fov);
    const reader::OpticsEditor& optics = reader.optics();
    if (optics.revision() != shownOptics_) {
        shownOptics_ = optics.revision();
        optics_->clear();
        for (std::size_t n = 0; n < optics.presets(); ++n)
            optics_->addItem(text(optics.preset(n).name) +
                             (optics.isChanged(n) ? QStringLiteral(" *") : QString()));
        optics_->setCurrentIndex(int(optics.chosen()));
    }
    std::size_t preset = 0;
    while (preset < windowPresets.size() &&
           !(windowPresets[preset].window == reader.slices().window()))
        ++preset;
    window_->setCurrentIndex(int(preset));
    fills_ = false;
}

}  // namespace haustra::window
