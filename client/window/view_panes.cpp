// The endoscopic view and the slices: pictures, what is written on them, the mouse.
#include "core/bridges.h"
#include "core/printed_text.h"
#include "core/slice_placement.h"
#include "window/pane.h"
#include "window/widgets.h"

#include <algorithm>
#include <cmath>

namespace haustra::window {
namespace {

// Where the picked place is seen, or would be but for what is in front of it.
void drawPicked(Ui& ui, const reader::WallPlace& place, Rect area, ImDrawList* list) {
    const auto seen = reader::seenAt(ui.reader.flight().camera(), place.positionMm);
    if (!seen) return;
    const float high = area.size().y;
    list->PushClipRect(area.min, area.max, true);
    drawPickedCross(ui, list,
                    {(area.min.x + area.max.x) / 2 + float(seen->x) * high,
                     (area.min.y + area.max.y) / 2 + float(seen->y) * high});
    list->PopClipRect();
}

/// What the four edges of a slice picture are called: left, right, top, bottom.
struct EdgeLetters {
    const char *left, *right, *top, *bottom;
};
EdgeLetters edgeLetters(View view) {
    switch (view) {
        case View::coronal:
            return {"R", "L", "H", "F"};
        case View::sagittal:
            return {"A", "P", "H", "F"};
        default:
            return {"R", "L", "A", "P"};
    }
}

void drawEdgeLetters(Ui& ui, View view, Rect area, ImDrawList* list) {
    const EdgeLetters letters = edgeLetters(view);
    ImFont* font = ui.fonts.small;
    const float middleX = (area.min.x + area.max.x) / 2, middleY = (area.min.y + area.max.y) / 2;
    const float margin = ui.px(5), high = font->FontSize, wide = textSize(font, "R").x;
    const ImU32 colour = IM_COL32(190, 200, 210, 220);
    outlinedText(list, font, {area.min.x + margin, middleY - high / 2}, colour, letters.left);
    outlinedText(list, font, {area.max.x - margin - wide, middleY - high / 2}, colour,
                 letters.right);
    outlinedText(list, font, {middleX - wide / 2, area.min.y + margin}, colour, letters.top);
    outlinedText(list, font, {middleX - wide / 2, area.max.y - margin - high}, colour,
                 letters.bottom);
}

// A cross with an open middle where the camera is, and an arrow along its gaze.
void drawCrosshair(Ui& ui, const SlicePlacement& slice, double pixelsPerPicturePixel, Rect area,
                   ImDrawList* list) {
    const Camera camera = ui.reader.flight().camera();
    const glm::dvec2 pixel = slice.pixelFromPatient(camera.positionMm);
    const ImVec2 p(area.min.x + float((pixel.x + 0.5) * pixelsPerPicturePixel),
                   area.min.y + float((pixel.y + 0.5) * pixelsPerPicturePixel));
    const float gap = ui.px(9);
    const ImU32 line = IM_COL32(72, 190, 199, 120);
    list->AddLine({area.min.x, p.y}, {p.x - gap, p.y}, line);
    list->AddLine({p.x + gap, p.y}, {area.max.x, p.y}, line);
    list->AddLine({p.x, area.min.y}, {p.x, p.y - gap}, line);
    list->AddLine({p.x, p.y + gap}, {p.x, area.max.y}, line);
    const glm::dvec2 ahead =
        slice.pixelFromPatient(camera.positionMm + camera.forward * slice.pixelMm()) - pixel;
    const float length = float(glm::length(ahead));
    list->AddCircleFilled(p, ui.px(2.5f), color::accent);
    if (length < 0.15f) return;  // looking along the slice's normal
    const ImVec2 along(float(ahead.x) / length, float(ahead.y) / length), across(-along.y, along.x);
    const float tip = ui.px(4) + ui.px(16) * length, head = ui.px(4);
    const ImVec2 end(p.x + along.x * tip, p.y + along.y * tip);
    list->AddLine(p, end, color::accent, ui.px(1.5f));
    list->AddTriangleFilled({end.x + along.x * head, end.y + along.y * head},
                            {end.x + across.x * head * 0.8f, end.y + across.y * head * 0.8f},
                            {end.x - across.x * head * 0.8f, end.y - across.y * head * 0.8f},
                            color::accent);
}

const char* axisName(View view) {
    return view == View::axial ? "z" : view == View::coronal ? "y" : "x";
}
const char* title(View view) {
    return view == View::axial ? "Axial" : view == View::coronal ? "Coronal" : "Sagittal";
}

void handleSliceMouse(Ui& ui, View view, const SlicePlacement& slice, double pixelsPerPicturePixel,
                      Rect area, bool hovered) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActive() && ui.drag > ui.px(3)) dragWindow(ui.reader, io.MouseDelta);
    if (!hovered) return;
    if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
        const glm::dvec2 pixel((io.MousePos.x - area.min.x) / pixelsPerPicturePixel - 0.5,
                               (io.MousePos.y - area.min.y) / pixelsPerPicturePixel - 0.5);
        ui.reader.goNear(slice.patientFromPixel(pixel));
    }
    if (io.MouseWheel == 0.0f) return;
    if (io.KeyCtrl) {
        ui.reader.slices().zoom(std::pow(1.2, io.MouseWheel));
    } else {
        const glm::dvec3 spacing = ui.reader.session().caseInfo()->grid.spacingMm();
        const double step = view == View::axial     ? spacing.z
                            : view == View::coronal ? spacing.y
                                                    : spacing.x;
        ui.reader.slices().scroll(view, io.MouseWheel * step * (io.KeyShift ? 10.0 : 1.0));
    }
}

}  // namespace

void drawEndoscopicPane(Ui& ui, Rect area) {
    reader::Reader& reader = ui.reader;
    reader::Flight& flight = reader.flight();
    ImDrawList* list = ImGui::GetWindowDrawList();
    reader.setPaneSize(View::endoscopic, framebufferSize(area));
    drawPicture(ui, View::endoscopic, area, list);

    const bool hovered = pane(ui, "endoscopic", area);
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActive() && (io.MouseDelta.x != 0 || io.MouseDelta.y != 0)) {
        // A drag across the pane's height turns by the field of view, towards the hand.
        const double degreesPerPixel = flight.camera().fovDegrees / area.size().y;
        flight.look(io.MouseDelta.x * degreesPerPixel, -io.MouseDelta.y * degreesPerPixel);
    }
    if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) flight.resetLook();
    if (hovered && io.MouseWheel != 0.0f) {
        const double stepMm = io.MouseWheel * (io.KeyShift ? 10.0 : 3.0);
        if (flight.isFree())
            flight.moveFreely({0, 0, stepMm});
        else
            flight.goTo(flight.arcMm() +
                        (flight.direction() == FlightDirection::antegrade ? stepMm : -stepMm));
    }

    if (const auto& picked = reader.flat().picked()) drawPicked(ui, *picked, area, list);
    const float margin = ui.px(12);
    const double length = flight.centerline().lengthMm();
    const bool antegrade = flight.direction() == FlightDirection::antegrade;
    outlinedText(list, ui.fonts.large, {area.min.x + margin, area.min.y + margin}, color::text,
                 flight.isFree() ? std::string("Free flight") : printed("%.0f mm", flight.arcMm()));
    outlinedText(list, ui.fonts.small,
                 {area.min.x + margin, area.min.y + margin + ui.fonts.large->FontSize + ui.px(4)},
                 IM_COL32(200, 208, 216, 255),
                 flight.isFree() ? std::string("W A S D move, drag to look, C returns to the path")
                                 : printed("of %.0f mm, %s", length,
                                           antegrade ? "towards the cecum" : "towards the rectum"));
    for (const Bridge& bridge : bridgesOf(flight.centerline())) {
        if (flight.isFree() || flight.arcMm() < bridge.fromArcMm || flight.arcMm() > bridge.toArcMm)
            continue;
        outlinedText(list, ui.fonts.small, {area.min.x + margin, area.min.y + margin + ui.px(46)},
                     color::bookmark,
                     printed("bridge of %.0f mm: the colon is collapsed or filled, no wall is seen",
                             bridge.lengthMm()));
    }
    if (flight.yawDegrees() != 0.0 || flight.pitchDegrees() != 0.0) {
        const std::string look = printed("look %+.0f°  %+.0f°   double-click: straight ahead",
                                         flight.yawDegrees(), flight.pitchDegrees());
        outlinedText(list, ui.fonts.small,
                     {area.min.x + margin, area.max.y - margin - ui.fonts.small->FontSize},
                     IM_COL32(200, 208, 216, 255), look);
    }
    const reader::Freshness freshness = reader.freshness(View::endoscopic);
    const bool exact = freshness == reader::Freshness::exact,
               old = freshness == reader::Freshness::old;
    const std::string badge = old ? "old" : exact ? "exact" : "moving";
    const ImVec2 size = textSize(ui.fonts.small, badge);
    const float dot = ui.px(4);
    const ImVec2 corner(area.max.x - margin - size.x, area.max.y - margin - size.y);
    if (freshness != reader::Freshness::none) {
        list->AddCircleFilled({corner.x - 2.2f * dot, corner.y + size.y / 2}, dot,
                              old     ? color::trouble
                              : exact ? color::accent
                                      : color::bookmark);
        outlinedText(list, ui.fonts.small, corner,
                     old ? color::trouble : IM_COL32(200, 208, 216, 255), badge);
    }
}

void drawSlicePane(Ui& ui, View view, Rect area) {
    reader::Reader& reader = ui.reader;
    ImDrawList* list = ImGui::GetWindowDrawList();
    const glm::ivec2 size = framebufferSize(area);
    reader.setPaneSize(view, size);
    drawPicture(ui, view, area, list);
    const bool hovered = pane(ui, title(view), area);

    const SliceView* pictured = reader.panes().shown<SliceView>(view);
    const SliceView shown = pictured ? *pictured : reader.slices().slice(view);
    const double pixels = area.size().x / size.x;
    const auto placed = placeSlice(shown, reader.session().caseInfo()->grid, size.x, size.y);
    if (!placed) return;
    handleSliceMouse(ui, view, *placed, pixels, area, hovered);

    list->PushClipRect(area.min, area.max, true);
    drawCrosshair(ui, *placed, pixels, area, list);
    if (const auto& picked = reader.flat().picked()) {
        const glm::dvec2 pixel = placed->pixelFromPatient(picked->positionMm);
        drawPickedCross(ui, list,
                        {area.min.x + float((pixel.x + 0.5) * pixels),
                         area.min.y + float((pixel.y + 0.5) * pixels)});
    }
    drawEdgeLetters(ui, view, area, list);
    const float margin = ui.px(8);
    const double coordinate = glm::dot(shown.positionMm, reader::sliceNormal(view));
    outlinedText(
        list, ui.fonts.small, {area.min.x + margin, area.min.y + margin}, color::text,
        shown.scan == Scan::cleansed ? std::string(title(view)) + ", cleansed" : title(view));
    const std::string place = printed("%s %.1f mm", axisName(view), coordinate);
    outlinedText(list, ui.fonts.small,
                 {area.max.x - margin - textSize(ui.fonts.small, place).x, area.min.y + margin},
                 IM_COL32(200, 208, 216, 255), place);
    if (view == View::axial) {
        const WindowLevel& window = reader.slices().window();
        outlinedText(list, ui.fonts.small,
                     {area.min.x + margin, area.max.y - margin - ui.fonts.small->FontSize},
                     IM_COL32(200, 208, 216, 255),
                     printed("C %.0f  W %.0f HU", window.centerHu, window.widthHu));
    }
    if (shown.zoom > 1.001) {
        const std::string zoom = printed("×%.1f", shown.zoom);
        outlinedText(list, ui.fonts.small,
                     {area.max.x - margin - textSize(ui.fonts.small, zoom).x,
                      area.max.y - margin - ui.fonts.small->FontSize},
                     IM_COL32(200, 208, 216, 255), zoom);
    }
    list->PopClipRect();
    list->AddRect(area.min, area.max, hovered ? color::muted : color::border);
}

}  // namespace haustra::window
