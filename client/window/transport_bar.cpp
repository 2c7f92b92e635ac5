// The bar along the bottom: the centerline from rectum to cecum, and the controls of the flight.
#include "core/bridges.h"
#include "core/printed_text.h"
#include "window/ui.h"
#include "window/widgets.h"

#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

using reader::Flight;
using reader::Motion;

constexpr float controlSide = 32;  // height of all controls

// The whole path as one track: gaps hatched, bookmarks as flags, the camera as a knob that shows
// its direction. Press or drag to go there.
void drawTrack(Ui& ui, Rect area) {
    Flight& flight = ui.reader.flight();
    const Centerline& path = flight.centerline();
    const double length = std::max(path.lengthMm(), 1e-6);
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float middle = (area.min.y + area.max.y) / 2, thick = ui.px(3);
    const auto xOf = [&](double arcMm) {
        return area.min.x + float(arcMm / length) * area.size().x;
    };

    ImGui::SetCursorScreenPos(area.min);
    ImGui::InvisibleButton("track", area.size());
    const float mouseX = ImGui::GetIO().MousePos.x;
    const double mouseArc =
        std::clamp(double(mouseX - area.min.x) / area.size().x, 0.0, 1.0) * length;
    if (ImGui::IsItemActive()) {
        ui.reader.setMotion(Motion::paused);
        flight.goTo(mouseArc);
    }
    const bool hovered = ImGui::IsItemHovered();

    list->AddRectFilled({area.min.x, middle - thick}, {area.max.x, middle + thick}, color::raised,
                        thick);
    list->AddRectFilled({area.min.x, middle - thick}, {xOf(flight.arcMm()), middle + thick},
                        color::accentDim, thick);
    for (const Bridge& bridge : bridgesOf(path))
        list->AddRectFilled({xOf(bridge.fromArcMm), middle - thick},
                            {xOf(bridge.toArcMm) + 1, middle + thick}, color::trouble);
    for (const reader::Bookmark& bookmark : ui.reader.session().bookmarks()) {
        const float x = xOf(bookmark.arcMm);
        list->AddLine({x, middle - ui.px(9)}, {x, middle + thick}, color::bookmark, ui.px(1.5f));
        list->AddTriangleFilled({x, middle - ui.px(10)}, {x + ui.px(6), middle - ui.px(7.5f)},
                                {x, middle - ui.px(5)}, color::bookmark);
    }
    const float knob = ui.px(8);
    const ImVec2 center(xOf(flight.arcMm()), middle);
    list->AddCircleFilled(center, knob, hovered ? IM_COL32_WHITE : color::accent, 24);
    const bool antegrade = flight.direction() == FlightDirection::antegrade;
    drawIcon(list, antegrade ? Icon::forward : Icon::backward, center, knob * 0.9f,
             color::background);
    if (hovered) tooltip(printed("%.0f mm", mouseArc).c_str());
}

// A small grey label, centred on the row of controls.
void label(Ui& ui, const char* text) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const ImVec2 size = textSize(ui.fonts.small, text);
    ImGui::GetWindowDrawList()->AddText(
        ui.fonts.small, ui.fonts.small->FontSize,
        {corner.x, corner.y + (ImGui::GetFrameHeight() - size.y) / 2}, color::muted, text);
    ImGui::Dummy({size.x, ImGui::GetFrameHeight()});
    sameRow(ui);
}

void combo(Ui& ui, const char* id, const char* title, float width, const std::string& current,
           const std::vector<std::string>& names, const auto& choose) {
    label(ui, title);
    ImGui::SetNextItemWidth(ui.px(width));
    if (!ImGui::BeginCombo(id, current.c_str())) return;
    for (const std::string& name : names)
        if (ImGui::Selectable(name.c_str(), name == current)) choose(name);
    ImGui::EndCombo();
}

struct WindowPreset {
    const char* name;
    WindowLevel window;
};
constexpr WindowPreset windowPresets[] = {{"colon", {0, 2000}},
                                          {"soft tissue", {40, 400}},
                                          {"lung", {-600, 1600}},
                                          {"bone", {400, 1800}}};

// The fly-over, and the tools of the flattened wall.
void drawStripControls(Ui& ui, float side) {
    reader::Reader& reader = ui.reader;
    const bool flyingOver = reader.flat().tour().flyingOver();
    sameRow(ui, 12);
    if (iconButton("over", Icon::flyOver, side, "Fly over the flattened wall (V)", flyingOver))
        reader.flat().setFlyingOver(!flyingOver);
    const auto toolButton = [&](const char* id, Icon icon, const char* hint, DrawingTool tool) {
        sameRow(ui, 4);
        if (iconButton(id, icon, side, hint, ui.tool == tool))
            ui.tool = ui.tool == tool ? DrawingTool::none : tool;
    };
    toolButton("line", Icon::line, "Measure a line on the flattened wall (L)", DrawingTool::line);
    toolButton("outline", Icon::outline, "Measure an outline on the flattened wall (O)",
               DrawingTool::outline);
}

// What colours the wall. Greyed out where there is no flat map to colour it by.
void drawPaintControls(Ui& ui) {
    reader::Reader& reader = ui.reader;
    WallPaintChoice paint = reader.flat().paint();
    const bool can = reader.flat().hasStrip();
    const char* const cannot = "This case has not been flattened: its wall cannot be coloured";
    ImGui::BeginDisabled(!can);
    sameRow(ui, 12);
    bool changed = ImGui::Checkbox("marks", &paint.marks);
    tooltip(can ? "Colour the wall around bookmarks (K)" : cannot);
    sameRow(ui);
    changed |= ImGui::Checkbox("unseen", &paint.unseen);
    tooltip(can ? "Colour what has not been seen yet (U); Shift U: begin anew" : cannot);
    ImGui::EndDisabled();
    if (changed) reader.flat().setPaint(paint);
}

void drawControls(Ui& ui) {
    reader::Reader& reader = ui.reader;
    Flight& flight = reader.flight();
    const float side = ui.px(controlSide);
    const Motion motion = reader.motion();

    if (iconButton("rectum", Icon::toRectum, side, "To the rectum (Home)"))
        reader.setMotion(Motion::paused), flight.goTo(0.0);
    sameRow(ui, 4);
    if (iconButton("back", Icon::backward, side, "Fly backward (Backspace)",
                   motion == Motion::backward))
        reader.setMotion(motion == Motion::backward ? Motion::paused : Motion::backward);
    sameRow(ui, 4);
    if (iconButton("pause", Icon::pause, side, "Pause (Space)", motion == Motion::paused))
        reader.setMotion(Motion::paused);
    sameRow(ui, 4);
    if (iconButton("play", Icon::forward, side, "Fly forward (Space)", motion == Motion::forward))
        reader.setMotion(motion == Motion::forward ? Motion::paused : Motion::forward);
    sameRow(ui, 4);
    if (iconButton("cecum", Icon::toCecum, side, "To the cecum (End)"))
        reader.setMotion(Motion::paused), flight.goTo(flight.centerline().lengthMm());
    sameRow(ui, 12);
    if (iconButton("turn", Icon::turnRound, side, "Turn round (R)"))
        flight.setDirection(flight.direction() == FlightDirection::antegrade
                                ? FlightDirection::retrograde
                                : FlightDirection::antegrade);
    sameRow(ui, 4);
    if (iconButton("center", Icon::center, side, "Back to the path, straight ahead (C)"))
        flight.returnToCenterline(), flight.resetLook();
    sameRow(ui, 4);
    if (iconButton("bookmark", Icon::bookmark, side, "Bookmark this place (B)"))
        reader.addBookmark("");
    if (reader.flat().hasStrip()) drawStripControls(ui, side);
    drawPaintControls(ui);

    sameRow(ui, 20);
    label(ui, "speed");
    float speed = float(flight.speedMmPerS());
    const float wide = ImGui::GetIO().DisplaySize.x < ui.px(1060) ? 84.0f : 130.0f;
    ImGui::SetNextItemWidth(ui.px(wide));
    if (ImGui::SliderFloat("##speed", &speed, float(Flight::minSpeedMmPerS),
                           float(Flight::maxSpeedMmPerS), "", ImGuiSliderFlags_Logarithmic))
        flight.setSpeed(speed);
    tooltip("Speed (+ and −)");
    sameRow(ui);
    label(ui, printed("%.0f mm/s", flight.speedMmPerS()).c_str());

    sameRow(ui, 20);
    reader::OpticsEditor& optics = reader.optics();
    std::vector<std::string> presets;
    for (std::size_t n = 0; n < optics.presets(); ++n)
        presets.push_back(optics.preset(n).name);
    combo(ui, "##transfer", "wall", wide, presets[optics.chosen()], presets,
          [&](const std::string& name) { optics.choose(name); });
    sameRow(ui);
    if (ImGui::Button("…##curve")) ui.showTransfer = !ui.showTransfer;
    tooltip("Colours, opacities and light (G)");
    sameRow(ui, 20);
    std::vector<std::string> names;
    std::string current = "own";
    for (const WindowPreset& preset : windowPresets) {
        names.push_back(preset.name);
        if (preset.window == reader.slices().window()) current = preset.name;
    }
    combo(ui, "##window", "slices", wide, current, names, [&](const std::string& name) {
        for (const WindowPreset& preset : windowPresets)
            if (name == preset.name) reader.slices().setWindow(preset.window);
    });
}

}  // namespace

void drawTransportBar(Ui& ui, Rect area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(area.min, area.max, color::bar);
    list->AddLine(area.min, {area.max.x, area.min.y}, color::border);
    const float margin = ui.px(16), trackHigh = ui.px(36), row = area.min.y + ui.px(6);
    const ImVec2 rectum = textSize(ui.fonts.small, "rectum"),
                 cecum = textSize(ui.fonts.small, "cecum");
    const float textY = row + (trackHigh - rectum.y) / 2;
    list->AddText(ui.fonts.small, ui.fonts.small->FontSize, {area.min.x + margin, textY},
                  color::muted, "rectum");
    list->AddText(ui.fonts.small, ui.fonts.small->FontSize, {area.max.x - margin - cecum.x, textY},
                  color::muted, "cecum");
    if (!ui.reader.flight().centerline().points.empty())
        drawTrack(ui, {{area.min.x + margin + rectum.x + ui.px(16), row},
                       {area.max.x - margin - cecum.x - ui.px(16), row + trackHigh}});
    ImGui::SetCursorScreenPos({area.min.x + margin, row + trackHigh + ui.px(4)});
    const float padding = (ui.px(controlSide) - ImGui::GetFontSize()) / 2;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.px(10), padding});
    ImGui::BeginGroup();
    drawControls(ui);
    ImGui::EndGroup();
    ImGui::PopStyleVar();
}

}  // namespace haustra::window
