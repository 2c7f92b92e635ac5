// The optics of the wall, changed by hand: presets, points, composition and light.
#include "core/printed_text.h"
#include "window/transfer_graph.h"
#include "window/ui.h"
#include "window/widgets.h"

#include <algorithm>

namespace haustra::window {
namespace {

using reader::OpticsEditor, reader::TransferCurve;

void mutedText(Ui& ui, const std::string& text) {
    ImGui::PushFont(ui.fonts.small);
    ImGui::PushStyleColor(ImGuiCol_Text, color::muted);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
    ImGui::PopFont();
}

// "mucosa *" where it has been changed.
std::string nameOf(const OpticsEditor& optics, std::size_t n) {
    return optics.preset(n).name + (optics.isChanged(n) ? " *" : "");
}

void choosePreset(Ui& ui) {
    OpticsEditor& optics = ui.reader.optics();
    ImGui::SetNextItemWidth(ui.px(240));
    if (ImGui::BeginCombo("##preset", nameOf(optics, optics.chosen()).c_str())) {
        for (std::size_t n = 0; n < optics.presets(); ++n) {
            ImGui::PushID(int(n));
            if (ImGui::Selectable(nameOf(optics, n).c_str(), n == optics.chosen()))
                optics.choose(n);
            tooltip(optics.preset(n).description.c_str());
            ImGui::PopID();
        }
        ImGui::EndCombo();
    }
    sameRow(ui);
    ImGui::BeginDisabled(!optics.isChanged(optics.chosen()));
    if (ImGui::Button("Back to the preset")) {
        optics.backToPreset();
        fitTransferAxis(ui);
    }
    ImGui::EndDisabled();
    sameRow(ui);
    if (ImGui::Button("Fit")) fitTransferAxis(ui);
    tooltip("The axis as wide as the points");
    mutedText(ui, optics.preset(optics.chosen()).description);
}

// A tab for each row of a 2-D transfer function, by its gradient magnitude.
void chooseRow(Ui& ui) {
    OpticsEditor& optics = ui.reader.optics();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("gradient magnitude");
    const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
    for (std::size_t row = 0; row < optics.rows(); ++row) {
        sameRow(ui, 6);
        if (ImGui::GetCursorScreenPos().x > right - ui.px(190)) ImGui::NewLine();
        const std::string label =
            row == 0 && optics.rows() == 1 ? "any" : printed("%.0f", optics.gradientOf(row));
        const bool chosen = row == optics.row();
        ImGui::PushID(int(row));
        if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, color::accentDim);
        if (ImGui::Button(label.c_str())) {
            optics.chooseRow(row);
            ui.transfer.point = -1;
        }
        if (chosen) ImGui::PopStyleColor();
        ImGui::PopID();
    }
    tooltip("HU per mm: how quickly the scan's values change there");
    sameRow(ui, 6);
    if (ImGui::Button("+") && !optics.addRow()) ui.tell("no room for another row", true);
    tooltip("Other colours where the gradient is greater: a row more");
    if (optics.row() == 0) return;
    sameRow(ui, 6);
    if (ImGui::Button("−")) {
        optics.removeRow();
        ui.transfer.point = -1;
        return;
    }
    tooltip("Take this row away");
    sameRow(ui, 10);
    float steep = float(optics.gradientOf(optics.row()));
    ImGui::SetNextItemWidth(ui.px(110));
    if (ImGui::DragFloat("##steep", &steep, 1.0f, 1.0f, 65536.0f, "from %.0f HU/mm"))
        optics.setGradient(optics.row(), steep);
}

void editPoint(Ui& ui) {
    OpticsEditor& optics = ui.reader.optics();
    TransferCurve curve = optics.curve();
    if (ui.transfer.point < 0 || ui.transfer.point >= int(curve.points().size())) {
        ImGui::AlignTextToFramePadding();
        mutedText(ui,
                  "Drag a point. Double click adds one, right click takes one. The wheel "
                  "enlarges, a drag beside the points moves the axis.");
        return;
    }
    const auto n = std::size_t(ui.transfer.point);
    const TransferFunctionPoint point = curve.points()[n];
    float rgb[3] = {float(point.color.r), float(point.color.g), float(point.color.b)};
    float hu = float(point.hu), opacity = float(point.opacity);
    bool changed = false;
    if (ImGui::ColorEdit3("##colour", rgb, ImGuiColorEditFlags_NoInputs)) {
        curve.setColor(n, {rgb[0], rgb[1], rgb[2]});
        changed = true;
    }
    tooltip("Colour");
    sameRow(ui);
    ImGui::SetNextItemWidth(ui.px(120));
    const bool moved = ImGui::DragFloat("##hu", &hu, 1.0f, 0.0f, 0.0f, "%.0f HU");
    sameRow(ui);
    ImGui::SetNextItemWidth(ui.px(150));
    const bool faded = ImGui::DragFloat("##opacity", &opacity, 0.002f, 0.0f, 1.0f, "opacity %.4f",
                                        ImGuiSliderFlags_AlwaysClamp);
    tooltip("Of a millimetre");
    if (moved || faded) {
        curve.move(n, moved ? double(hu) : point.hu, faded ? double(opacity) : point.opacity);
        changed = true;
    }
    sameRow(ui);
    if (ImGui::Button("Remove") && curve.remove(n)) {
        ui.transfer.point = -1;
        changed = true;
    }
    if (changed) optics.setCurve(curve);
}

void chooseComposition(Ui& ui) {
    OpticsEditor& optics = ui.reader.optics();
    constexpr const char* names[] = {"emission and absorption", "maximum intensity", "first hit"};
    int composition = int(optics.optics().composition);
    ImGui::SetNextItemWidth(ui.px(240));
    if (ImGui::Combo("##composition", &composition, names, 3))
        optics.setComposition(Composition(composition));
    tooltip(
        "What a ray makes of its samples: all of them front to back, the greatest, or the "
        "first that is half opaque");
    const bool absorbs = optics.optics().composition == Composition::emissionAbsorption;
    sameRow(ui, 14);
    bool integrated = optics.optics().preIntegrated;
    ImGui::BeginDisabled(!absorbs || optics.rows() > 1);
    if (ImGui::Checkbox("pre-integrated", &integrated)) optics.setPreIntegrated(integrated);
    ImGui::EndDisabled();
    tooltip("Smooth where opacity changes quickly; not with rows by gradient magnitude");
    sameRow(ui, 14);
    bool lit = optics.optics().shading;
    ImGui::BeginDisabled(optics.optics().composition == Composition::maximumIntensity);
    if (ImGui::Checkbox("lit", &lit)) optics.setShading(lit);
    ImGui::EndDisabled();
}

void chooseLight(Ui& ui) {
    OpticsEditor& optics = ui.reader.optics();
    const bool shines =
        optics.optics().shading && optics.optics().composition != Composition::maximumIntensity;
    const Headlight before = optics.optics().light;
    Headlight light = before;
    const float wide = (ImGui::GetContentRegionAvail().x - 4 * ui.px(6)) / 5;
    const auto drag = [&](const char* id, double& value, float low, float high, const char* form,
                          const char* hint, bool logarithmic) {
        float shown = float(value);
        ImGui::SetNextItemWidth(wide);
        const ImGuiSliderFlags flags =
            ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
        if (ImGui::SliderFloat(id, &shown, low, high, form, flags)) value = double(shown);
        tooltip(hint);
    };
    ImGui::BeginDisabled(!shines);
    ImGui::PushFont(ui.fonts.small);
    ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, ui.px(4));
    const bool far = light.halfDepthMm >= 9999.5;
    drag("##reach", light.halfDepthMm, 5.0f, 10000.0f, far ? "reach: all" : "reach %.0f mm",
         "Where the lamp's light has fallen to a half", true);
    sameRow(ui, 6);
    drag("##ambient", light.ambient, 0.0f, 1.0f, "ambient %.2f", "Light from everywhere", false);
    sameRow(ui, 6);
    drag("##diffuse", light.diffuse, 0.0f, 2.0f, "diffuse %.2f", "What faces the lamp is brighter",
         false);
    sameRow(ui, 6);
    drag("##gloss", light.specular, 0.0f, 1.0f, "gloss %.2f", "Highlights, as of a moist wall",
         false);
    sameRow(ui, 6);
    drag("##sharp", light.shininess, 1.0f, 200.0f, "sharp %.0f", "How small highlights are", true);
    ImGui::PopStyleVar();
    ImGui::PopFont();
    ImGui::EndDisabled();
    if (!(light == before)) optics.setLight(light);
}

void drawFiles(Ui& ui) {
    OpticsEditor& optics = ui.reader.optics();
    ImGui::SetNextItemWidth(ui.px(240));
    ImGui::InputTextWithHint("##file", "my-look.json", ui.transfer.file.data(),
                             ui.transfer.file.size());
    const std::string file = ui.transfer.file.data();
    sameRow(ui);
    ImGui::BeginDisabled(file.empty());
    if (ImGui::Button("Save as a file")) {
        if (const auto saved = optics.save(file); !saved)
            ui.tell(describe(saved.error()), true);
        else
            ui.tell("Saved " + std::filesystem::absolute(file).string());
    }
    tooltip("For haustra render --tf, or a server's --presets folder");
    sameRow(ui);
    if (ImGui::Button("Open")) {
        if (const auto opened = optics.open(file); !opened) ui.tell(describe(opened.error()), true);
    }
    ImGui::EndDisabled();
}

}  // namespace

void drawTransferPanel(Ui& ui, Rect area) {
    const ImVec2 size(ui.px(560), ui.px(484));
    ImGui::SetNextWindowPos({area.max.x - size.x - ui.px(12), area.max.y - size.y - ui.px(12)},
                            ImGuiCond_Appearing);
    ImGui::SetNextWindowSize(size);
    const bool drawn =
        ImGui::Begin("Colours, opacities and light", &ui.showTransfer,
                     ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar);
    if (drawn) {
        const std::string& name = ui.reader.optics().preset(ui.reader.optics().chosen()).name;
        if (ui.transfer.preset != name) {
            ui.transfer.preset = name;
            ui.transfer.point = -1;
            fitTransferAxis(ui);
        }
        choosePreset(ui);
        ImGui::Spacing();
        chooseRow(ui);
        const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
        const float row = ImGui::GetFrameHeightWithSpacing();
        const Rect graph{{corner.x + ui.px(34), corner.y + ui.px(8)},
                         {corner.x + room.x, corner.y + room.y - 4 * row - ui.px(34)}};
        drawTransferGraph(ui, graph);
        ImGui::SetCursorScreenPos({corner.x, graph.max.y + ui.px(26)});
        editPoint(ui);
        ImGui::SetCursorScreenPos({corner.x, graph.max.y + ui.px(26) + row});
        chooseComposition(ui);
        chooseLight(ui);
        drawFiles(ui);
    }
    ImGui::End();
}

}  // namespace haustra::window
