#include "reader/optics_editor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haustra::reader {
namespace {

constexpr double leastRowStepHuPerMm = 1.0, steepestHuPerMm = 65536.0;

}  // namespace

OpticsEditor::OpticsEditor() {
    Optics optics;
    optics.transferFunction.points = TransferCurve().points();
    drafts_.push_back({{"none", "", optics}, optics, false});
}

void OpticsEditor::offer(std::vector<OpticsPreset> presets) {
    *this = OpticsEditor(revision_ + 1);
    if (presets.empty()) return;
    drafts_.clear();
    for (OpticsPreset& preset : presets) {
        const Optics optics = preset.optics;
        drafts_.push_back({std::move(preset), optics, true});
    }
}

bool OpticsEditor::isChanged(std::size_t n) const {
    return !(drafts_[n].optics == drafts_[n].preset.optics);
}

void OpticsEditor::choose(std::size_t n) {
    chosen_ = std::min(n, drafts_.size() - 1);
    row_ = 0;
    ++revision_;
}

bool OpticsEditor::choose(const std::string& name) {
    const auto found = std::find_if(drafts_.begin(), drafts_.end(),
                                    [&](const Draft& d) { return d.preset.name == name; });
    if (found == drafts_.end()) return false;
    choose(std::size_t(found - drafts_.begin()));
    return true;
}

void OpticsEditor::show(const ShownOptics& shown) {
    if (!choose(shown.preset)) return;
    change() = shown.optics;
    row_ = std::min(shown.row, rows() - 1);
}

void OpticsEditor::backToPreset() {
    change() = draft().preset.optics;
    row_ = std::min(row_, rows() - 1);
}

OpticsChoice OpticsEditor::choice() const {
    if (draft().served && !isChanged(chosen_)) return draft().preset.name;
    return optics();
}

Optics& OpticsEditor::change() {
    ++revision_;
    return drafts_[chosen_].optics;
}

void OpticsEditor::setComposition(Composition composition) {
    change().composition = composition;
}

void OpticsEditor::setPreIntegrated(bool preIntegrated) {
    change().preIntegrated = preIntegrated && rows() == 1;
}

void OpticsEditor::setShading(bool shading) {
    change().shading = shading;
}

void OpticsEditor::setLight(Headlight light) {
    light.halfDepthMm = std::clamp(light.halfDepthMm, 0.01, 1e9);
    for (double* share : {&light.ambient, &light.diffuse, &light.specular})
        *share = std::clamp(*share, 0.0, 10.0);
    light.shininess = std::clamp(light.shininess, 1.0, 1000.0);
    change().light = light;
}

// ---- gradient rows --------------------------------------------------------------------------

void OpticsEditor::chooseRow(std::size_t row) {
    row_ = std::min(row, rows() - 1);
}

double OpticsEditor::gradientOf(std::size_t row) const {
    return row == 0 ? 0.0 : optics().transferFunction.rows[row - 1].gradientHuPerMm;
}

void OpticsEditor::setGradient(std::size_t row, double huPerMm) {
    if (row == 0 || row >= rows() || !std::isfinite(huPerMm)) return;
    const double low = gradientOf(row - 1) + leastRowStepHuPerMm;
    const double high =
        row + 1 < rows() ? gradientOf(row + 1) - leastRowStepHuPerMm : steepestHuPerMm;
    if (low <= high)
        change().transferFunction.rows[row - 1].gradientHuPerMm = std::clamp(huPerMm, low, high);
}

bool OpticsEditor::addRow() {
    const TransferFunction& function = optics().transferFunction;
    const auto points = curve().points();
    std::size_t inAll = function.points.size() + points.size();
    for (const GradientRow& row : function.rows)
        inAll += row.points.size();
    const double here = gradientOf(row_);
    const double there =
        row_ + 1 < rows() ? 0.5 * (here + gradientOf(row_ + 1)) : std::max(here + 50.0, 1.5 * here);
    if (inAll > mostTransferPointsInAll || function.rows.size() >= mostGradientRows ||
        there > steepestHuPerMm || there < here + leastRowStepHuPerMm)
        return false;
    GradientRow added{there, points};
    Optics& optics = change();
    optics.preIntegrated = false;
    auto& rows = optics.transferFunction.rows;
    rows.insert(rows.begin() + std::ptrdiff_t(row_), std::move(added));
    ++row_;
    return true;
}

bool OpticsEditor::removeRow() {
    if (row_ == 0) return false;
    auto& rows = change().transferFunction.rows;
    rows.erase(rows.begin() + std::ptrdiff_t(row_) - 1);
    --row_;
    return true;
}

TransferCurve OpticsEditor::curve() const {
    const TransferFunction& function = optics().transferFunction;
    return TransferCurve(row_ == 0 ? function.points : function.rows[row_ - 1].points);
}

void OpticsEditor::setCurve(const TransferCurve& curve) {
    TransferFunction function = optics().transferFunction;
    (row_ == 0 ? function.points : function.rows[row_ - 1].points) = curve.points();
    if (checkTransferFunction(function)) change().transferFunction = std::move(function);
}

// ---- files ----------------------------------------------------------------------------------

// In the place of one of this name that came from a file, else a new one.
void OpticsEditor::take(OpticsPreset preset) {
    const auto same = std::find_if(drafts_.begin(), drafts_.end(), [&](const Draft& d) {
        return !d.served && d.preset.name == preset.name;
    });
    const Optics optics = preset.optics;
    const auto n = std::size_t(same - drafts_.begin());
    if (same == drafts_.end())
        drafts_.push_back({std::move(preset), optics, false});
    else
        *same = {std::move(preset), optics, false};
    const std::size_t row = row_;
    choose(n);
    chooseRow(row);
}

Result<void> OpticsEditor::save(const std::filesystem::path& file) {
    OpticsPreset preset{file.stem().string(), draft().preset.description, optics()};
    if (file.extension() != ".json" || !isPresetName(preset.name))
        return fail(ErrorKind::badInput,
                    "a preset's file is named by letters, digits, '-' and '_', and ends in .json",
                    file.string());
    TRY(writePresetFile(file, preset));
    take(std::move(preset));
    return {};
}

Result<void> OpticsEditor::open(const std::filesystem::path& file) {
    auto preset = TRY(readPresetFile(file));
    take(std::move(preset));
    chooseRow(0);
    return {};
}

}  // namespace haustra::reader
