#include "window/transfer_graph.h"

#include "core/printed_text.h"
#include "window/widgets.h"

#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

using reader::TransferCurve;

constexpr double leastAxisHu = 8.0, mostAxisHu = 70'000.0;

ImU32 colourOf(glm::dvec3 c, double alpha = 1.0) {
    return ImGui::ColorConvertFloat4ToU32({float(c.r), float(c.g), float(c.b), float(alpha)});
}

/// The graph's scales: HU across, and opacity up by its root, so that veils of a hundredth can be
/// told apart.
struct Graph {
    Rect area;
    double lowHu, highHu;

    ImVec2 place(double hu, double opacity) const {
        const double x = (hu - lowHu) / (highHu - lowHu);
        return {area.min.x + float(x) * area.size().x,
                area.max.y - float(std::sqrt(opacity)) * area.size().y};
    }
    double huPerPixel() const { return (highHu - lowHu) / std::max(area.size().x, 1.0f); }
    double hu(ImVec2 p) const { return lowHu + huPerPixel() * double(p.x - area.min.x); }
    double opacity(ImVec2 p) const {
        const double up = std::clamp(double(area.max.y - p.y) / area.size().y, 0.0, 1.0);
        return up * up;
    }
};

// By its logarithm: air is most of a scan, and what matters is little of it.
void drawHistogram(const Histogram& histogram, const Graph& graph, ImDrawList* list) {
    std::uint64_t most = 0;
    for (const std::uint64_t voxels : histogram.voxels)
        most = std::max(most, voxels);
    if (most == 0) return;
    const double scale = 0.9 / std::log1p(double(most));
    for (std::size_t n = 0; n < histogram.voxels.size(); ++n) {
        const double low = histogram.firstHu + double(n) * histogram.huPerBin;
        const double tall = std::log1p(double(histogram.voxels[n])) * scale;
        const ImVec2 a = graph.place(low, tall * tall),
                     b = graph.place(low + histogram.huPerBin, 0.0);
        if (b.x >= graph.area.min.x && a.x <= graph.area.max.x)
            list->AddRectFilled(a, b, color::raised);
    }
}

double roundStep(double atLeast) {
    const double ten = std::pow(10.0, std::floor(std::log10(atLeast)));
    for (const double times : {1.0, 2.0, 5.0})
        if (ten * times >= atLeast) return ten * times;
    return 10.0 * ten;
}

void drawScales(Ui& ui, const Graph& graph, ImDrawList* list) {
    const Rect area = graph.area;
    ImFont* font = ui.fonts.small;
    const double step = roundStep(graph.huPerPixel() * ui.px(64));
    for (double n = std::ceil(graph.lowHu / step); n * step <= graph.highHu; ++n) {
        const float x = graph.place(n * step, 0.0).x;
        list->AddLine({x, area.min.y}, {x, area.max.y}, color::border);
        const std::string text = printed("%.0f", n * step + 0.0);
        const float wide = textSize(font, text).x;
        const float left = std::clamp(x - wide / 2, area.min.x, area.max.x - wide);
        list->AddText(font, font->FontSize, {left, area.max.y + ui.px(3)}, color::muted,
                      text.c_str());
    }
    for (const double opacity : {0.01, 0.1, 0.5, 1.0}) {
        const float y = graph.place(0.0, opacity).y;
        if (opacity < 1.0) list->AddLine({area.min.x, y}, {area.max.x, y}, color::border);
        const std::string text = printed("%g", opacity);
        list->AddText(font, font->FontSize,
                      {area.min.x - ui.px(6) - textSize(font, text).x, y - font->FontSize / 2},
                      color::muted, text.c_str());
    }
}

// Under the curve its colours, column by column.
void drawCurve(Ui& ui, const Graph& graph, const TransferCurve& curve, ImDrawList* list) {
    const float step = std::max(ui.px(2), 1.0f);
    ImVec2 before;
    for (float x = graph.area.min.x; x <= graph.area.max.x; x += step) {
        const TransferFunctionPoint here = curve.at(graph.hu({x, 0.0f}));
        const ImVec2 top = graph.place(here.hu, here.opacity);
        list->AddRectFilled({x, top.y}, {x + step, graph.area.max.y}, colourOf(here.color, 0.62));
        if (x > graph.area.min.x) list->AddLine(before, {x, top.y}, color::text, ui.px(1.4f));
        before = {x, top.y};
    }
}

void drawPoints(Ui& ui, const Graph& graph, const TransferCurve& curve, ImDrawList* list) {
    for (std::size_t n = 0; n < curve.points().size(); ++n) {
        const TransferFunctionPoint& point = curve.points()[n];
        if (point.hu < graph.lowHu || point.hu > graph.highHu) continue;
        const ImVec2 p = graph.place(point.hu, point.opacity);
        const bool chosen = int(n) == ui.transfer.point;
        list->AddCircleFilled(p, ui.px(chosen ? 8.0f : 6.0f), chosen ? color::accent : color::text);
        list->AddCircleFilled(p, ui.px(chosen ? 5.0f : 4.2f), colourOf(point.color));
    }
}

std::optional<std::size_t> pointUnder(Ui& ui, const Graph& graph, const TransferCurve& curve,
                                      ImVec2 mouse) {
    std::optional<std::size_t> found;
    float nearest = ui.px(12);
    for (std::size_t n = 0; n < curve.points().size(); ++n) {
        const ImVec2 p = graph.place(curve.points()[n].hu, curve.points()[n].opacity);
        const float distance = std::hypot(p.x - mouse.x, p.y - mouse.y);
        if (distance < nearest) nearest = distance, found = n;
    }
    return found;
}

void setAxis(Ui& ui, double lowHu, double highHu) {
    const double wide = std::clamp(highHu - lowHu, leastAxisHu, mostAxisHu);
    const double middle = std::clamp(0.5 * (lowHu + highHu), lowestTransferHu, highestTransferHu);
    ui.transfer.lowHu = middle - 0.5 * wide;
    ui.transfer.highHu = middle + 0.5 * wide;
}

// Whether the mouse is over a point.
bool handleMouse(Ui& ui, const Graph& graph) {
    ImGui::SetCursorScreenPos(graph.area.min);
    ImGui::InvisibleButton("graph", graph.area.size(),
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
    const ImGuiIO& io = ImGui::GetIO();
    const ImVec2 mouse = io.MousePos;
    reader::OpticsEditor& optics = ui.reader.optics();
    TransferCurve curve = optics.curve();
    const auto under = pointUnder(ui, graph, curve, mouse);
    const bool hovered = ImGui::IsItemHovered();
    if (hovered && io.MouseWheel != 0.0f) {
        const double shrink = std::pow(0.85, double(io.MouseWheel)), at = graph.hu(mouse);
        setAxis(ui, at - (at - graph.lowHu) * shrink, at + (graph.highHu - at) * shrink);
    }
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) {
        if (under && curve.remove(*under)) {
            ui.transfer.point = -1;
            optics.setCurve(curve);
        }
    } else if (hovered && !under && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        ui.transfer.point = int(curve.add(graph.hu(mouse), graph.opacity(mouse)));
        optics.setCurve(curve);
    } else if (ImGui::IsItemActivated() && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        ui.transfer.point = under ? int(*under) : -1;
    } else if (ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) &&
               (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f)) {
        if (ui.transfer.point >= 0) {
            curve.move(std::size_t(ui.transfer.point), graph.hu(mouse), graph.opacity(mouse));
            optics.setCurve(curve);
        } else {
            const double moved = -double(io.MouseDelta.x) * graph.huPerPixel();
            setAxis(ui, graph.lowHu + moved, graph.highHu + moved);
        }
    }
    return hovered && under;
}

}  // namespace

void fitTransferAxis(Ui& ui) {
    double low = highestTransferHu, high = lowestTransferHu;
    const auto take = [&](const std::vector<TransferFunctionPoint>& points) {
        low = std::min(low, points.front().hu);
        high = std::max(high, points.back().hu);
    };
    const TransferFunction& function = ui.reader.optics().optics().transferFunction;
    take(function.points);
    for (const GradientRow& row : function.rows)
        take(row.points);
    const double margin = 0.12 * (high - low);
    setAxis(ui, low - margin, high + margin);
}

void drawTransferGraph(Ui& ui, Rect area) {
    const TransferCurve before = ui.reader.optics().curve();
    if (ui.transfer.point >= int(before.points().size())) ui.transfer.point = -1;
    const Graph graph{area, ui.transfer.lowHu, ui.transfer.highHu};
    if (handleMouse(ui, graph)) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    const TransferCurve curve = ui.reader.optics().curve();
    ImDrawList* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(area.min, area.max, color::background);
    list->PushClipRect(area.min, area.max, true);
    drawHistogram(ui.reader.session().caseInfo()->histogram, graph, list);
    drawCurve(ui, graph, curve, list);
    list->PopClipRect();
    drawScales(ui, graph, list);
    drawPoints(ui, graph, curve, list);
    list->AddRect(area.min, area.max, color::border);
}

}  // namespace haustra::window
