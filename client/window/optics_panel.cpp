#include "window/optics_panel.h"

#include "window/look_steps.h"
#include "window/theme.h"
#include "window/transfer_graph.h"

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QStackedLayout>
#include <QToolButton>
#include <QVBoxLayout>

namespace haustra::window {
namespace {

/// One number of the headlight.
struct LightControl {
    const char* name;
    const char* hint;
    double Headlight::*value;
    double least, most, step;
    int decimals;
};
constexpr std::array<LightControl, 5> lightControls{{
    {QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Reach"),
     QT_TRANSLATE_NOOP("haustra::window::OpticsPanel",
                       "Where the lamp's light has fallen to a half, mm"),
     &Headlight::halfDepthMm, 5.0, 10000.0, 10.0, 0},
    {QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Ambient"),
     QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Light from everywhere"),
     &Headlight::ambient, 0.0, 1.0, 0.05, 2},
    {QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Diffuse"),
     QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "What faces the lamp is brighter"),
     &Headlight::diffuse, 0.0, 2.0, 0.05, 2},
    {QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Gloss"),
     QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Highlights, as of a moist wall"),
     &Headlight::specular, 0.0, 1.0, 0.05, 2},
    {QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "Sharpness"),
     QT_TRANSLATE_NOOP("haustra::window::OpticsPanel", "How small highlights are"),
     &Headlight::shininess, 1.0, 200.0, 5.0, 0},
}};

constexpr QSize colorSize(28, 14);

QDoubleSpinBox* spinBox(double least, double most, double step, int decimals, const QString& name) {
    auto* box = new QDoubleSpinBox;
    box->setRange(least, most);
    box->setSingleStep(step);
    box->setDecimals(decimals);
    box->setAccessibleName(name);
    box->setToolTip(name);
    box->setKeyboardTracking(false);
    return box;
}

QHBoxLayout* rowOf(QWidget* widget) {
    auto* row = new QHBoxLayout(widget);
    row->setContentsMargins(0, 0, 0, 0);
    return row;
}

}  // namespace

template <class Change>
void OpticsPanel::change(const QString& text, const Change& change) {
    if (!fills_ && reading_.reader().isOpen()) changeOptics(reading_, text, change);
}

OpticsPanel::OpticsPanel(Reading& reading) : reading_(reading), graph_(new TransferGraph(reading)) {
    auto* column = new QVBoxLayout(this);
    column->addWidget(presetRow());
    column->addWidget(description_ = new QLabel);
    description_->setWordWrap(true);
    description_->setTextFormat(Qt::PlainText);
    column->addWidget(gradientRow());
    column->addWidget(graph_, 1);
    column->addWidget(pointRow());
    column->addWidget(compositionRow());
    column->addWidget(lightRow());
    column->addWidget(fileRow());
    connect(graph_, &TransferGraph::pointChosen, this, &OpticsPanel::showPoint);
    connect(&reading, &Reading::stepped, this, &OpticsPanel::look);
    connect(&reading, &Reading::readerReplaced, this, [this] {
        shownRevision_ = ~std::uint64_t(0);
        graph_->choosePoint(-1);
    });
}

// ---- what it consists of ------------------------------------------------------------------------

QWidget* OpticsPanel::presetRow() {
    auto* widget = new QWidget;
    auto* row = rowOf(widget);
    row->addWidget(preset_ = new QComboBox, 1);
    preset_->setAccessibleName(tr("Preset of the wall's optics"));
    row->addWidget(back_ = new QPushButton(tr("Back to the preset")));
    auto* fit = new QPushButton(tr("Fit"));
    fit->setToolTip(tr("The axis as wide as the points"));
    row->addWidget(fit);
    connect(preset_, &QComboBox::activated, this, [this](int n) {
        change(tr("choose a preset"),
               [&](reader::OpticsEditor& optics) { optics.choose(std::size_t(n)); });
    });
    connect(back_, &QPushButton::clicked, this, [this] {
        change(tr("back to the preset"),
               [](reader::OpticsEditor& optics) { optics.backToPreset(); });
        graph_->fitAxis();
    });
    connect(fit, &QPushButton::clicked, graph_, &TransferGraph::fitAxis);
    return widget;
}

// A button for each row of a 2-D transfer function, by its gradient magnitude.
QWidget* OpticsPanel::gradientRow() {
    auto* widget = new QWidget;
    auto* row = rowOf(widget);
    auto* label = new QLabel(tr("Gradient magnitude"));
    label->setToolTip(tr("HU per mm: how quickly the scan's values change there"));
    row->addWidget(label);
    row->addWidget(rows_ = new QWidget);
    rowOf(rows_)->setSpacing(2);
    auto* add = new QToolButton;
    add->setText(QStringLiteral("+"));
    add->setAccessibleName(tr("Add a row by gradient magnitude"));
    add->setToolTip(tr("Other colours where the gradient is greater: a row more"));
    auto* remove = new QToolButton;
    remove->setText(QStringLiteral("−"));
    remove->setAccessibleName(tr("Remove this row"));
    remove->setToolTip(tr("Take this row away"));
    row->addWidget(add);
    row->addWidget(remove);
    row->addWidget(gradient_ = spinBox(1.0, 65536.0, 5.0, 0,
                                       tr("From which gradient magnitude on, HU per mm")));
    gradient_->setSuffix(tr(" HU/mm"));
    row->addStretch(1);
    connect(add, &QToolButton::clicked, this, [this] {
        bool added = false;
        change(tr("add a row"), [&](reader::OpticsEditor& optics) { added = optics.addRow(); });
        if (!added) reading_.tell(tr("There is no room for another row."), true);
    });
    connect(remove, &QToolButton::clicked, this, [this] {
        graph_->choosePoint(-1);
        change(tr("remove a row"), [](reader::OpticsEditor& optics) { optics.removeRow(); });
    });
    connect(gradient_, &QDoubleSpinBox::valueChanged, this, [this](double steep) {
        change(tr("move a row"),
               [&](reader::OpticsEditor& optics) { optics.setGradient(optics.row(), steep); });
    });
    return widget;
}

QWidget* OpticsPanel::pointRow() {
    // As high either way: the graph above stays where it is when a point is chosen.
    auto* widget = new QWidget;
    pointRow_ = new QStackedLayout(widget);
    auto* hint = new QLabel(
        tr("Drag a point. Double click adds one, right click takes one. The wheel enlarges, a drag "
           "beside the points moves the axis."));
    hint->setWordWrap(true);
    auto* editing = new QWidget;
    auto* editor = rowOf(editing);
    editor->addWidget(color_ = new QToolButton);
    color_->setAccessibleName(tr("Colour of the point"));
    color_->setToolTip(tr("Colour"));
    color_->setMinimumWidth(44);
    color_->setIcon(QPixmap(colorSize));
    editor->addWidget(
        hu_ = spinBox(lowestTransferHu, highestTransferHu, 5.0, 0, tr("Value of the point, HU")));
    hu_->setSuffix(tr(" HU"));
    editor->addWidget(opacity_ = spinBox(0.0, 1.0, 0.01, 4, tr("Opacity of a millimetre")));
    opacity_->setPrefix(tr("opacity "));
    auto* remove = new QPushButton(tr("Remove"));
    remove->setAccessibleName(tr("Remove the point"));
    editor->addWidget(remove);
    editor->addStretch(1);
    pointRow_->addWidget(hint);
    pointRow_->addWidget(editing);
    widget->setFixedHeight(
        std::max(3 * hint->fontMetrics().lineSpacing(), editing->sizeHint().height()));
    connect(color_, &QToolButton::clicked, this, &OpticsPanel::chooseColor);
    for (QDoubleSpinBox* box : {hu_, opacity_})
        connect(box, &QDoubleSpinBox::valueChanged, this, &OpticsPanel::editPoint);
    connect(remove, &QPushButton::clicked, this, [this] {
        reader::TransferCurve curve = optics().curve();
        const int point = graph_->chosenPoint();
        if (point < 0 || !curve.remove(std::size_t(point))) return;
        graph_->choosePoint(-1);
        change(tr("remove a point"), [&](reader::OpticsEditor& optics) { optics.setCurve(curve); });
    });
    return widget;
}

QWidget* OpticsPanel::compositionRow() {
    auto* widget = new QWidget;
    auto* row = rowOf(widget);
    row->addWidget(composition_ = new QComboBox);
    composition_->addItems(
        {tr("emission and absorption"), tr("maximum intensity"), tr("first hit")});
    composition_->setAccessibleName(tr("Composition"));
    composition_->setToolTip(
        tr("What a ray makes of its samples: all of them front to back, the greatest, or the first "
           "that is half opaque"));
    row->addWidget(preIntegrated_ = new QCheckBox(tr("pre-integrated")));
    preIntegrated_->setToolTip(
        tr("Smooth where opacity changes quickly; not with rows by gradient magnitude"));
    row->addWidget(lit_ = new QCheckBox(tr("lit")));
    row->addStretch(1);
    connect(composition_, &QComboBox::activated, this, [this](int n) {
        change(tr("choose the composition"),
               [&](reader::OpticsEditor& optics) { optics.setComposition(Composition(n)); });
    });
    connect(preIntegrated_, &QCheckBox::clicked, this, [this](bool on) {
        change(tr("pre-integration"),
               [&](reader::OpticsEditor& optics) { optics.setPreIntegrated(on); });
    });
    connect(lit_, &QCheckBox::clicked, this, [this](bool on) {
        change(tr("shading"), [&](reader::OpticsEditor& optics) { optics.setShading(on); });
    });
    return widget;
}

QWidget* OpticsPanel::lightRow() {
    auto* widget = new QWidget;
    auto* row = rowOf(widget);
    for (std::size_t n = 0; n < light_.size(); ++n) {
        const LightControl& control = lightControls[n];
        auto* column = new QVBoxLayout;
        auto* label = new QLabel(tr(control.name));
        light_[n] =
            spinBox(control.least, control.most, control.step, control.decimals, tr(control.name));
        light_[n]->setToolTip(tr(control.hint));
        label->setBuddy(light_[n]);
        column->addWidget(label);
        column->addWidget(light_[n]);
        row->addLayout(column, 1);
        connect(light_[n], &QDoubleSpinBox::valueChanged, this, [this, &control](double value) {
            change(tr("change the light"), [&](reader::OpticsEditor& optics) {
                Headlight light = optics.optics().light;
                light.*control.value = value;
                optics.setLight(light);
            });
        });
    }
    light_[0]->setSpecialValueText({});
    return widget;
}

QWidget* OpticsPanel::fileRow() {
    auto* widget = new QWidget;
    auto* row = rowOf(widget);
    auto* save = new QPushButton(tr("Save as a file…"));
    save->setToolTip(tr("For haustra render --tf, or a server's --presets folder"));
    auto* open = new QPushButton(tr("Open…"));
    open->setAccessibleName(tr("Open a preset's file"));
    row->addWidget(save);
    row->addWidget(open);
    row->addStretch(1);
    connect(save, &QPushButton::clicked, this, &OpticsPanel::save);
    connect(open, &QPushButton::clicked, this, &OpticsPanel::open);
    return widget;
}

// ---- what it shows ------------------------------------------------------------------------------

void OpticsPanel::look() {
    setEnabled(reading_.reader().isOpen());
    if (!isVisible()) return;
    const reader::OpticsEditor& o = optics();
    if (o.revision() == shownRevision_ && o.row() == shownRow_) return;
    const bool another = o.preset(o.chosen()).name != shownPreset_;
    shownRevision_ = o.revision();
    shownRow_ = o.row();
    shownPreset_ = o.preset(o.chosen()).name;
    fills_ = true;
    fillPresets();
    fillRows();
    composition_->setCurrentIndex(int(o.optics().composition));
    const bool absorbs = o.optics().composition == Composition::emissionAbsorption,
               maximum = o.optics().composition == Composition::maximumIntensity;
    preIntegrated_->setChecked(o.optics().preIntegrated);
    preIntegrated_->setEnabled(absorbs && o.rows() == 1);
    lit_->setChecked(o.optics().shading);
    lit_->setEnabled(!maximum);
    for (std::size_t n = 0; n < light_.size(); ++n) {
        light_[n]->setValue(o.optics().light.*lightControls[n].value);
        light_[n]->setEnabled(o.optics().shading && !maximum);
    }
    fills_ = false;
    if (another) {
        graph_->choosePoint(-1);
        graph_->fitAxis();
    }
    showPoint();
    graph_->update();
}

void OpticsPanel::fillPresets() {
    const reader::OpticsEditor& o = optics();
    preset_->clear();
    for (std::size_t n = 0; n < o.presets(); ++n) {
        preset_->addItem(text(o.preset(n).name) +
                         (o.isChanged(n) ? QStringLiteral(" *") : QString()));
        preset_->setItemData(int(n), toolTipOf(text(o.preset(n).description)), Qt::ToolTipRole);
    }
    preset_->setCurrentIndex(int(o.chosen()));
    description_->setText(text(o.preset(o.chosen()).description));
    back_->setEnabled(o.isChanged(o.chosen()));
}

void OpticsPanel::fillRows() {
    const reader::OpticsEditor& o = optics();
    for (QToolButton* old : rows_->findChildren<QToolButton*>(Qt::FindDirectChildrenOnly))
        old->deleteLater();
    for (std::size_t row = 0; row < o.rows(); ++row) {
        auto* button = new QToolButton(rows_);
        button->setText(row == 0 && o.rows() == 1 ? tr("any")
                                                  : QString::number(o.gradientOf(row), 'f', 0));
        button->setCheckable(true);
        button->setChecked(row == o.row());
        button->setAccessibleName(tr("Row from %1 HU per mm").arg(o.gradientOf(row), 0, 'f', 0));
        rows_->layout()->addWidget(button);
        connect(button, &QToolButton::clicked, this, [this, row] {
            optics().chooseRow(row);
            graph_->choosePoint(-1);
            reading_.changed();
        });
    }
    gradient_->setVisible(o.row() > 0);
    gradient_->setValue(o.gradientOf(o.row()));
}

void OpticsPanel::showPoint() {
    const auto points = optics().curve().points();
    const int point = graph_->chosenPoint();
    const bool any = point >= 0 && point < int(points.size());
    pointRow_->setCurrentIndex(any);
    if (!any) return;
    const TransferFunctionPoint& p = points[std::size_t(point)];
    fills_ = true;
    hu_->setValue(p.hu);
    opacity_->setValue(p.opacity);
    QPixmap sample(colorSize);
    sample.fill(QColor::fromRgbF(float(p.color.r), float(p.color.g), float(p.color.b)));
    color_->setIcon(sample);
    fills_ = false;
}

// ---- what the hand does -------------------------------------------------------------------------

void OpticsPanel::editPoint() {
    reader::TransferCurve curve = optics().curve();
    const int point = graph_->chosenPoint();
    if (fills_ || point < 0 || point >= int(curve.points().size())) return;
    curve.move(std::size_t(point), hu_->value(), opacity_->value());
    change(tr("move a point"), [&](reader::OpticsEditor& optics) { optics.setCurve(curve); });
}

void OpticsPanel::chooseColor() {
    reader::TransferCurve curve = optics().curve();
    const int point = graph_->chosenPoint();
    if (point < 0 || point >= int(curve.points().size())) return;
    const glm::dvec3 c = curve.points()[std::size_t(point)].color;
    const QColor chosen = QColorDialog::getColor(
        QColor::fromRgbF(float(c.r), float(c.g), float(c.b)), this, tr("Colour of the point"));
    if (!chosen.isValid()) return;
    curve.setColor(std::size_t(point), {chosen.redF(), chosen.greenF(), chosen.blueF()});
    change(tr("colour a point"), [&](reader::OpticsEditor& optics) { optics.setCurve(curve); });
}

void OpticsPanel::save() {
    const QString file =
        QFileDialog::getSaveFileName(this, tr("Save the optics as a preset"),
                                     QStringLiteral("my-look.json"), tr("Presets (*.json)"));
    if (file.isEmpty()) return;
    const auto saved = optics().save(file.toStdString());
    saved ? reading_.tell(tr("Saved %1").arg(file)) : reading_.tell(text(saved.error()), true);
    reading_.changed();
}

void OpticsPanel::open() {
    const QString file =
        QFileDialog::getOpenFileName(this, tr("Open a preset"), {}, tr("Presets (*.json)"));
    if (file.isEmpty()) return;
    const auto opened = optics().open(file.toStdString());
    if (!opened) reading_.tell(text(opened.error()), true);
    reading_.changed();
}

}  // namespace haustra::window
