// Colours and opacities of the wall, changed by hand.
#include "window/ui.h"
#include "window/widgets.h"

#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

using panels::TransferCurve, panels::TransferPoint;

constexpr double shownLowHu = TransferCurve::minHu, shownHighHu = 1100.0;

ImU32 colourOf(glm::dvec3 c, double alpha = 1.0) {
    return ImGui::ColorConvertFloat4ToU32({float(c.r), float(c.g), float(c.b), float(alpha)});
}

/// The graph's scales: HU across, and opacity up by its root, so that veils of a hundredth can be
/// told apart.
struct Graph {
    Rect area;

    ImVec2 place(double hu, double opacity) const {
        const double x = (hu - shownLowHu) / (shownHighHu - shownLowHu);
        return {area.min.x + float(x) * area.size().x,
                area.max.y - float(std::sqrt(opacity)) * area.size().y};
    }
    double hu(ImVec2 p) const {
        return shownLowHu + (shownHighHu - shownLowHu) * double(p.x - area.min.x) / area.size().x;
    }
    double opacity(ImVec2 p) const {
        const double up = std::clamp(double(area.max.y - p.y) / area.size().y, 0.0, 1.0);
        return up * up;
    }
};

void drawGraph(Ui& ui, const Graph& graph, const TransferCurve& curve, int chosen,
               ImDrawList* list) {
    const Rect area = graph.area;
    list->AddRectFilled(area.min, area.max, color::background);
    for (const double hu : {-1000.0, -500.0, 0.0, 500.0, 1000.0}) {
        const float x = graph.place(hu, 0.0).x;
        list->AddLine({x, area.min.y}, {x, area.max.y}, color::border);
        const std::string text = format("%.0f", hu);
        const float wide = textSize(ui.fonts.small, text).x;
        list->AddText(
            ui.fonts.small, ui.fonts.small->FontSize,
            {std::clamp(x - wide / 2, area.min.x, area.max.x - wide), area.max.y + ui.px(3)},
            color::muted, text.c_str());
    }
    for (const double opacity : {0.01, 0.1, 0.5}) {
        const float y = graph.place(0.0, opacity).y;
        list->AddLine({area.min.x, y}, {area.max.x, y}, color::border);
        list->AddText(ui.fonts.small, ui.fonts.small->FontSize,
                      {area.min.x + ui.px(3), y - ui.fonts.small->FontSize}, color::muted,
                      format("%g", opacity).c_str());
    }
    // Under the curve its colours, column by column.
    list->PushClipRect(area.min, area.max, true);
    const float step = ui.px(2);
    ImVec2 before;
    for (float x = area.min.x; x <= area.max.x; x += step) {
        const TransferPoint here = curve.at(graph.hu({x, 0.0f}));
        const ImVec2 top = graph.place(here.hu, here.opacity);
        list->AddRectFilled({x, top.y}, {x + step, area.max.y}, colourOf(here.color, 0.55));
        if (x > area.min.x) list->AddLine(before, {x, top.y}, color::text, ui.px(1.4f));
        before = {x, top.y};
    }
    list->PopClipRect();
    for (std::size_t n = 0; n < curve.points().size(); ++n) {
        const TransferPoint& point = curve.points()[n];
        if (point.hu > shownHighHu) continue;
        const ImVec2 p = graph.place(point.hu, point.opacity);
        const bool isChosen = int(n) == chosen;
        list->AddCircleFilled(p, ui.px(isChosen ? 7.0f : 5.5f),
                              isChosen ? color::accent : color::text);
        list->AddCircleFilled(p, ui.px(4), colourOf(point.color));
    }
    list->AddRect(area.min, area.max, color::border);
}

std::optional<std::size_t> pointUnder(Ui& ui, const Graph& graph, const TransferCurve& curve,
                                      ImVec2 mouse) {
    std::optional<std::size_t> found;
    float nearest = ui.px(11);
    for (std::size_t n = 0; n < curve.points().size(); ++n) {
        const ImVec2 p = graph.place(curve.points()[n].hu, curve.points()[n].opacity);
        const float distance = std::hypot(p.x - mouse.x, p.y - mouse.y);
        if (distance < nearest) nearest = distance, found = n;
    }
    return found;
}

void handleGraph(Ui& ui, const Graph& graph) {
    ImGui::SetCursorScreenPos(graph.area.min);
    ImGui::InvisibleButton("graph", graph.area.size(),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    TransferCurve curve = ui.reader.curve();
    if (ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        if (const auto point = pointUnder(ui, graph, curve, mouse); point && curve.remove(*point)) {
            ui.curvePoint = -1;
            ui.reader.setCurve(std::move(curve));
        }
        return;
    }
    if (ImGui::IsItemActivated() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        const auto point = pointUnder(ui, graph, curve, mouse);
        ui.curvePoint = int(point ? *point : curve.add(graph.hu(mouse), graph.opacity(mouse)));
        if (!point) ui.reader.setCurve(std::move(curve));
        return;
    }
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (!ImGui::IsItemActive() || !ImGui::IsMouseDown(ImGuiMouseButton_Left) || ui.curvePoint < 0 ||
        (moved.x == 0.0f && moved.y == 0.0f))
        return;
    curve.move(std::size_t(ui.curvePoint), graph.hu(mouse), graph.opacity(mouse));
    ui.reader.setCurve(std::move(curve));
}

void choosePreset(Ui& ui) {
    const auto& names = ui.reader.session().caseInfo()->transferFunctions;
    const std::string shown =
        ui.reader.transferFunction().empty() ? "own" : ui.reader.transferFunction();
    ImGui::SetNextItemWidth(ui.px(190));
    if (!ImGui::BeginCombo("##preset", shown.c_str())) return;
    for (const std::string& name : names)
        if (ImGui::Selectable(name.c_str(), name == ui.reader.transferFunction()))
            ui.reader.setTransferFunction(name);
    if (ImGui::Selectable("own", ui.reader.transferFunction().empty()))
        ui.reader.setCurve(ui.reader.curve());
    ImGui::EndCombo();
}

void chooseColour(Ui& ui) {
    TransferCurve curve = ui.reader.curve();
    if (ui.curvePoint >= int(curve.points().size())) ui.curvePoint = -1;
    if (ui.curvePoint < 0) {
        ImGui::TextDisabled("click adds, right click takes");
        return;
    }
    const TransferPoint& point = curve.points()[std::size_t(ui.curvePoint)];
    float rgb[3] = {float(point.color.r), float(point.color.g), float(point.color.b)};
    const bool changed = ImGui::ColorEdit3("##colour", rgb, ImGuiColorEditFlags_NoInputs);
    ImGui::SameLine();
    ImGui::Text("%.0f HU   %.3g a mm", point.hu, point.opacity);
    if (!changed) return;
    curve.setColor(std::size_t(ui.curvePoint), {rgb[0], rgb[1], rgb[2]});
    ui.reader.setCurve(std::move(curve));
}

}  // namespace

void drawTransferPanel(Ui& ui, Rect area) {
    const ImVec2 size(ui.px(440), ui.px(264));
    ImGui::SetNextWindowPos({area.min.x + ui.px(12), area.max.y - size.y - ui.px(40)},
                            ImGuiCond_Appearing);
    ImGui::SetNextWindowSize(size);
    const bool drawn =
        ImGui::Begin("Colours and opacities of the wall", &ui.showTransfer,
                     ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                         ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar);
    if (drawn) {
        choosePreset(ui);
        ImGui::SameLine(0, ui.px(14));
        chooseColour(ui);
        const ImVec2 corner = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
        const Graph graph{
            {{corner.x, corner.y + ui.px(4)}, {corner.x + room.x, corner.y + room.y - ui.px(18)}}};
        handleGraph(ui, graph);
        drawGraph(ui, graph, ui.reader.curve(), ui.curvePoint, ImGui::GetWindowDrawList());
    }
    ImGui::End();
}

}  // namespace haustra::window
