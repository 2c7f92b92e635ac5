// The flattened strip and the window onto it: pictures, what is drawn on them, the mouse.
#include "core/bridges.h"
#include "core/printed_text.h"
#include "window/pane.h"
#include "window/widgets.h"

#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

constexpr ImU32 pale = IM_COL32(200, 208, 216, 255);
constexpr ImU32 measured = IM_COL32(255, 221, 87, 255);

// A stretch of the screen that shows a window of the strip.
struct FlatArea {
    Rect area;
    FlatWindow window;
    glm::ivec2 size;  ///< of the window's picture

    double pixels() const { return area.size().x / size.x; }
    ImVec2 screen(glm::dvec2 flat) const {
        const glm::dvec2 pixel = window.pixelFromFlat(flat, size);
        return {area.min.x + float(pixel.x * pixels()), area.min.y + float(pixel.y * pixels())};
    }
    glm::dvec2 flat(ImVec2 screen) const {
        return window.flatFromPixel(
            {(screen.x - area.min.x) / pixels(), (screen.y - area.min.y) / pixels()}, size);
    }
    // Calls visit(screen position) for each copy of a place that may be seen.
    template <class Visit>
    void forEachCopy(glm::dvec2 flat, const Visit& visit) const {
        const double half = 0.5 * size.x / window.pixelsPerUnit + 0.1;
        const double first = std::ceil(window.center.x - half - flat.x);
        for (double turn = first; flat.x + turn <= window.center.x + half; turn += 1.0)
            visit(screen({flat.x + turn, flat.y}));
    }
};

void drawFlag(Ui& ui, ImDrawList* list, ImVec2 p) {
    list->AddLine(p, {p.x, p.y - ui.px(12)}, color::bookmark, ui.px(1.5f));
    list->AddTriangleFilled({p.x, p.y - ui.px(13)}, {p.x + ui.px(8), p.y - ui.px(9.5f)},
                            {p.x, p.y - ui.px(6)}, color::bookmark);
    list->AddCircleFilled(p, ui.px(2), color::bookmark);
}

// Their lengths beside the hatched bridges: what the strip makes long or short is not to be read
// off.
void drawBridges(Ui& ui, const FlatArea& flat, ImDrawList* list) {
    const reader::FlatStrip& strip = ui.reader.flat().tour().strip();
    for (const Bridge& bridge : bridgesOf(ui.reader.session().caseInfo()->centerline)) {
        const double y = strip.yAtArc(0.5 * (bridge.fromArcMm + bridge.toArcMm));
        const float row = flat.screen({0.0, y}).y - ui.fonts.small->FontSize / 2;
        outlinedText(list, ui.fonts.small, {flat.area.min.x + ui.px(8), row}, color::bookmark,
                     printed("bridge %.0f mm", bridge.lengthMm()));
    }
}

// The row of the camera, bookmarks, and the place that was picked.
void drawMarks(Ui& ui, const FlatArea& flat, ImDrawList* list) {
    const reader::Reader& reader = ui.reader;
    const double y = reader.flat().tour().strip().yAtArc(reader.flight().placeArcMm());
    const float row = flat.screen({0.0, y}).y, tip = ui.px(6);
    const Rect& area = flat.area;
    list->AddLine({area.min.x, row}, {area.max.x, row}, IM_COL32(72, 190, 199, 110));
    list->AddTriangleFilled({area.min.x, row - tip}, {area.min.x + tip, row},
                            {area.min.x, row + tip}, color::accent);
    list->AddTriangleFilled({area.max.x, row - tip}, {area.max.x, row + tip},
                            {area.max.x - tip, row}, color::accent);
    for (const auto& [key, place] : reader.flat().wall().bookmarkPlaces())
        if (place.flat) flat.forEachCopy(*place.flat, [&](ImVec2 p) { drawFlag(ui, list, p); });
    if (const auto& picked = reader.flat().picked(); picked && picked->flat)
        flat.forEachCopy(*picked->flat, [&](ImVec2 p) { drawPickedCross(ui, list, p); });
}

// ---- the strip --------------------------------------------------------------------------------

// What of the strip the zoom view shows, in one of the columns.
void drawZoomFrame(Ui& ui, const FlatArea& column, ImDrawList* list) {
    const reader::StripTour& tour = ui.reader.flat().tour();
    const glm::dvec2 half = 0.5 * glm::dvec2(tour.paneSize()) / tour.window().pixelsPerUnit;
    const float left = column.area.min.x + ui.px(1), right = column.area.max.x - ui.px(1);
    const bool allAround = half.x >= 0.5;
    for (const double turn : {-1.0, 0.0, 1.0}) {
        const glm::dvec2 center = tour.window().center + glm::dvec2(turn, 0.0);
        ImVec2 min = column.screen(center + half), max = column.screen(center - half);
        min.x = allAround ? left : std::max(min.x, left);
        max.x = allAround ? right : std::min(max.x, right);
        if (min.x >= max.x || (allAround && turn != 0.0)) continue;
        list->AddRect(min, max, IM_COL32(0, 0, 0, 150), 0, 0, ui.px(3));
        list->AddRect(min, max, IM_COL32(255, 255, 255, 220), 0, 0, ui.px(1.2f));
    }
}

void handleStripMouse(Ui& ui, const StripLayout& layout, Rect area, double pixels, bool hovered) {
    reader::Reader& reader = ui.reader;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const auto flat =
        layout.flatFromPixel({(mouse.x - area.min.x) / pixels, (mouse.y - area.min.y) / pixels},
                             reader.flat().tour().strip().height);
    if (!flat) return;
    if (ImGui::IsItemActive() && ui.drag > ui.px(4)) reader.flat().tour().centerOn(*flat);
    if (ImGui::IsItemDeactivated()) {
        reader.setMotion(reader::Motion::paused);
        reader.flat().goTo(*flat, true);
    }
    if (hovered && !ImGui::IsItemActive())
        tooltip(printed("%.0f mm", reader.flat().tour().strip().arcAtY(flat->y)).c_str());
}

// ---- the window onto it -----------------------------------------------------------------------

// The newest picture where it belongs: it lags behind the window that the hand moves.
void drawZoomPicture(Ui& ui, const FlatArea& flat, ImDrawList* list) {
    if (!preparePicture(ui, View::flattenedZoom, flat.area, list)) return;
    FlatArea shown = flat;
    if (const auto* window = ui.reader.panes().shown<FlatWindow>(View::flattenedZoom))
        shown.window = *window;
    shown.window.center.x += std::round(flat.window.center.x - shown.window.center.x);
    list->AddImage(ui.textures[std::size_t(View::flattenedZoom)].id(),
                   flat.screen(shown.flat(flat.area.min)), flat.screen(shown.flat(flat.area.max)));
    dimOldPicture(ui, View::flattenedZoom, flat.area, list);
}

void drawMeasurement(Ui& ui, const FlatArea& flat, ImDrawList* list) {
    const auto& measurement = ui.reader.flat().wall().measurement();
    if (!measurement || measurement->points.size() < 2) return;
    // The copy that is nearest to the window's middle.
    const double turn = std::round(flat.window.center.x - measurement->points.front().x);
    std::vector<ImVec2> points;
    for (const glm::dvec2 point : measurement->points)
        points.push_back(flat.screen(point + glm::dvec2(turn, 0.0)));
    const ImDrawFlags closed = measurement->closed ? ImDrawFlags_Closed : ImDrawFlags_None;
    list->AddPolyline(points.data(), int(points.size()), IM_COL32(0, 0, 0, 170), closed,
                      ui.px(3.5f));
    list->AddPolyline(points.data(), int(points.size()), measured, closed, ui.px(1.6f));
    ImVec2 low = points.front();
    for (const ImVec2 p : points)
        if (p.y > low.y) low = p;
    if (!measurement->closed)
        for (const ImVec2 p : {points.front(), points.back()})
            list->AddCircleFilled(p, ui.px(3), measured);
    const bool inSight = std::any_of(points.begin(), points.end(), [&](ImVec2 p) {
        return p.x >= flat.area.min.x && p.x <= flat.area.max.x && p.y >= flat.area.min.y &&
               p.y <= flat.area.max.y;
    });
    if (!measurement->result || !inSight) return;
    const reader::FlatMeasure& result = *measurement->result;
    const std::string text =
        measurement->closed
            ? printed("%.1f mm across   %.0f mm²", result.largestDiameterMm, result.areaMm2)
            : printed("%.1f mm   straight %.1f mm", result.lengthMm, result.straightMm);
    const ImVec2 size = textSize(ui.fonts.normal, text);
    const ImVec2 corner(
        std::clamp(low.x - size.x / 2, flat.area.min.x + ui.px(6),
                   std::max(flat.area.min.x + ui.px(6), flat.area.max.x - size.x - ui.px(6))),
        std::min(low.y + ui.px(8), flat.area.max.y - size.y - ui.px(6)));
    outlinedText(list, ui.fonts.normal, corner, measured, text);
}

// Follows the hand with a line or an outline, of at most as many points as a server measures.
void draw(Ui& ui, DrawingTool tool, const FlatArea& flat) {
    constexpr std::size_t mostPoints = 120;
    const glm::dvec2 here = flat.flat(ImGui::GetIO().MousePos);
    std::vector<glm::dvec2>& points = ui.drawing;
    if (tool == DrawingTool::line) {
        points.resize(std::min<std::size_t>(points.size(), 1));
        points.push_back(here);
    } else if (points.empty() || glm::distance(points.back(), here) * flat.window.pixelsPerUnit >
                                     4.0 / flat.pixels()) {
        points.push_back(here);
        if (points.size() > mostPoints) {  // every other one is enough
            for (std::size_t n = 0; 2 * n < points.size(); ++n)
                points[n] = points[2 * n];
            points.resize((points.size() + 1) / 2);
        }
    }
    const bool closed = tool == DrawingTool::outline;
    if (points.size() >= (closed ? 3u : 2u)) ui.reader.flat().wall().measure(points, closed);
}

void handleZoomMouse(Ui& ui, const FlatArea& flat, bool hovered) {
    reader::Reader& reader = ui.reader;
    const ImGuiIO& io = ImGui::GetIO();
    const double pixels = flat.pixels();
    if (ImGui::IsItemActivated()) {
        const DrawingTool held = io.KeyShift  ? DrawingTool::line
                                 : io.KeyCtrl ? DrawingTool::outline
                                              : ui.tool;
        ui.drawing.clear();
        if (held != DrawingTool::none) ui.drawing.push_back(flat.flat(io.MousePos));
        ui.drawsOutline = held == DrawingTool::outline;
    }
    const bool draws = !ui.drawing.empty();
    if (ImGui::IsItemActive() && ui.drag > ui.px(4)) {
        if (draws)
            draw(ui, ui.drawsOutline ? DrawingTool::outline : DrawingTool::line, flat);
        else
            reader.flat().tour().drag({io.MouseDelta.x / pixels, io.MouseDelta.y / pixels});
    }
    if (ImGui::IsItemDeactivated()) {
        if (!draws && ui.drag <= ui.px(4)) {
            reader.flat().wall().clearMeasurement();
            reader.setMotion(reader::Motion::paused);
            reader.flat().goTo(flat.flat(io.MousePos), false);
        }
        ui.drawing.clear();
    }
    if (hovered && io.MouseWheel != 0.0f)
        reader.flat().tour().zoom(std::pow(1.2, io.MouseWheel),
                                  {(io.MousePos.x - flat.area.min.x) / pixels,
                                   (io.MousePos.y - flat.area.min.y) / pixels});
}

void drawZoomTexts(Ui& ui, const FlatArea& flat, ImDrawList* list) {
    const reader::Reader& reader = ui.reader;
    const reader::StripTour& tour = reader.flat().tour();
    const Rect& area = flat.area;
    const float margin = ui.px(10), high = ui.fonts.small->FontSize;
    const ImVec2 corner(area.min.x + margin, area.min.y + ui.px(8));
    if (tour.flyingOver())
        outlinedText(list, ui.fonts.normal, corner, color::accent,
                     printed("Fly-over   %.0f mm", tour.arcMm()));
    else
        outlinedText(list, ui.fonts.small, corner, color::text, "Flattened wall");
    const double zoom = tour.window().pixelsPerUnit / reader::wholeCircumference(flat.size.x);
    const std::string right =
        std::abs(zoom - 1.0) < 0.01 ? std::string("cecum ↑") : printed("×%.1f   cecum ↑", zoom);
    outlinedText(list, ui.fonts.small,
                 {area.max.x - margin - textSize(ui.fonts.small, right).x, corner.y}, pale, right);
    if (ui.tool == DrawingTool::none) return;
    const char* hint = ui.tool == DrawingTool::line ? "drag a line to measure it   Esc ends"
                                                    : "drag around a polyp   Esc ends";
    outlinedText(list, ui.fonts.small, {corner.x, area.max.y - ui.px(8) - high}, measured, hint);
}

}  // namespace

void drawStripPane(Ui& ui, Rect area) {
    reader::Reader& reader = ui.reader;
    ImDrawList* list = ImGui::GetWindowDrawList();
    reader.setPaneSize(View::flattened, framebufferSize(area));
    drawPicture(ui, View::flattened, area, list);
    const bool hovered = pane(ui, "strip", area);
    const glm::ivec2 size = reader.panes().size(View::flattened);
    const double pixels = area.size().x / size.x;
    const double height = reader.flat().tour().strip().height;
    const StripLayout layout = layOutStrip(height, size);
    handleStripMouse(ui, layout, area, pixels, hovered);

    for (std::size_t n = 0; n < layout.columns.size(); ++n) {
        const StripColumn& column = layout.columns[n];
        const auto x = [&](double pixel) { return area.min.x + float(pixel * pixels); };
        const FlatArea flat{
            {{x(column.left), area.min.y}, {x(column.left + column.size.x), area.max.y}},
            column.window,
            column.size};
        list->PushClipRect(flat.area.min, flat.area.max, true);
        drawZoomFrame(ui, flat, list);
        drawBridges(ui, flat, list);
        drawMarks(ui, flat, list);
        list->PopClipRect();
    }
    const float margin = ui.px(6), high = ui.fonts.small->FontSize;
    const ImVec2 bottom(area.min.x + float(layout.columns.front().left * pixels) + margin,
                        area.max.y - margin - high);
    outlinedText(list, ui.fonts.small, bottom, pale, "rectum");
    glm::dvec2 top = layout.pixelFromFlat({0.5, height});
    const float textY =
        std::max(area.min.y + margin, area.min.y + float(top.y * pixels) - high - margin);
    outlinedText(
        list, ui.fonts.small,
        {area.min.x + float(top.x * pixels) - textSize(ui.fonts.small, "cecum").x / 2, textY}, pale,
        "cecum");
    list->AddRect(area.min, area.max, hovered ? color::muted : color::border);
}

void drawZoomPane(Ui& ui, Rect area) {
    reader::Reader& reader = ui.reader;
    ImDrawList* list = ImGui::GetWindowDrawList();
    reader.setPaneSize(View::flattenedZoom, framebufferSize(area));
    const bool hovered = pane(ui, "zoom", area);
    const auto here = [&] {
        return FlatArea{area, reader.flat().tour().window(), reader.flat().tour().paneSize()};
    };
    handleZoomMouse(ui, here(), hovered);
    const FlatArea flat = here();  // as the hand has left it
    list->PushClipRect(area.min, area.max, true);
    drawZoomPicture(ui, flat, list);
    drawBridges(ui, flat, list);
    drawMarks(ui, flat, list);
    drawMeasurement(ui, flat, list);
    drawZoomTexts(ui, flat, list);
    list->PopClipRect();
    list->AddRect(area.min, area.max, hovered ? color::muted : color::border);
}

}  // namespace haustra::window
