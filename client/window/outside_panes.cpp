// The colon from outside, and the slice across the gaze.
#include "core/printed_text.h"
#include "reader/overview_map.h"
#include "window/pane.h"
#include "window/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::window {
namespace {

constexpr ImU32 dim = IM_COL32(200, 208, 216, 255);

ImVec2 screenFrom(glm::dvec3 seen, Rect area) {
    return {area.min.x + float(seen.x), area.min.y + float(seen.y)};
}

glm::dvec2 sizeOf(Rect area) {
    return {area.size().x, area.size().y};
}

/// Towards which sides of the patient a direction goes: one letter, or two between them, the nearer
/// first.
std::string lettersOf(glm::dvec3 direction) {
    constexpr std::array<const char*, 3> low{"R", "A", "F"}, high{"L", "P", "H"};
    std::array<std::size_t, 3> axes{0, 1, 2};
    const auto share = [&](std::size_t axis) { return std::abs(direction[int(axis)]); };
    std::sort(axes.begin(), axes.end(),
              [&](std::size_t a, std::size_t b) { return share(a) > share(b); });
    const auto letter = [&](std::size_t axis) {
        return direction[int(axis)] > 0.0 ? high[axis] : low[axis];
    };
    std::string letters = letter(axes[0]);
    if (share(axes[1]) > 0.42 * glm::length(direction)) letters += letter(axes[1]);
    return letters;
}

void drawLetters(Ui& ui, glm::dvec3 right, glm::dvec3 up, Rect area, ImDrawList* list) {
    ImFont* font = ui.fonts.small;
    const float margin = ui.px(5), high = font->FontSize;
    const float middleX = (area.min.x + area.max.x) / 2, middleY = (area.min.y + area.max.y) / 2;
    const auto write = [&](glm::dvec3 way, glm::vec2 side) {
        const std::string letters = lettersOf(way);
        const float wide = textSize(font, letters).x;
        const float x = side.x < 0   ? area.min.x + margin
                        : side.x > 0 ? area.max.x - margin - wide
                                     : middleX - wide / 2;
        const float y = side.y < 0   ? area.min.y + margin
                        : side.y > 0 ? area.max.y - margin - high
                                     : middleY - high / 2;
        outlinedText(list, font, {x, y}, IM_COL32(190, 200, 210, 220), letters);
    };
    write(-right, {-1, 0});
    write(right, {1, 0});
    write(up, {0, -1});
    write(-up, {0, 1});
}

/// The reader's camera as a cone that opens to where it looks.
void drawReader(Ui& ui, const Camera& from, Rect area, ImDrawList* list) {
    const Camera camera = ui.reader.flight().camera();
    const glm::dvec2 size = sizeOf(area);
    const double lengthMm = ui.px(20) * from.heightMm / size.y, radiusMm = 0.42 * lengthMm;
    const glm::dvec3 right = glm::cross(camera.forward, camera.up);
    const auto seen = [&](glm::dvec3 mm) { return screenFrom(projected(from, mm, size), area); };
    constexpr int sides = 24;
    std::array<ImVec2, sides> rim;
    for (int side = 0; side < sides; ++side) {
        const double angle = 2.0 * M_PI * side / sides;
        rim[std::size_t(side)] =
            seen(camera.positionMm + lengthMm * camera.forward +
                 radiusMm * (std::cos(angle) * right + std::sin(angle) * camera.up));
    }
    const ImVec2 apex = seen(camera.positionMm);
    for (int side = 0; side < sides; ++side)
        list->AddTriangleFilled(apex, rim[std::size_t(side)], rim[std::size_t((side + 1) % sides)],
                                IM_COL32(60, 205, 235, 235));
    // Seen from where it looks to, the opening is darker than the mantle.
    const bool open = glm::dot(camera.forward, from.forward) < 0.0;
    list->AddConvexPolyFilled(rim.data(), sides,
                              open ? IM_COL32(120, 230, 250, 255) : IM_COL32(40, 165, 195, 235));
    list->AddPolyline(rim.data(), sides, IM_COL32(8, 30, 38, 200), ImDrawFlags_Closed, ui.px(1));
    list->AddCircleFilled(apex, ui.px(2.5f), IM_COL32(230, 250, 255, 255));
}

void drawBookmarks(Ui& ui, const Camera& from, const std::vector<reader::Bookmark>& bookmarks,
                   std::optional<std::size_t> under, Rect area, ImDrawList* list) {
    for (std::size_t n = 0; n < bookmarks.size(); ++n) {
        const ImVec2 p =
            screenFrom(projected(from, bookmarks[n].camera.positionMm, sizeOf(area)), area);
        const float radius = ui.px(under == n ? 6.0f : 4.5f);
        list->AddCircleFilled(p, radius + ui.px(1.2f), IM_COL32(20, 14, 4, 220));
        list->AddCircleFilled(p, radius, color::bookmark);
    }
}

void handleOverviewMouse(Ui& ui, const std::vector<reader::Bookmark>& bookmarks,
                         std::optional<std::size_t> under, glm::dvec2 pixel, Rect area,
                         bool hovered) {
    reader::Reader& reader = ui.reader;
    const ImGuiIO& io = ImGui::GetIO();
    // The near side follows the hand.
    if (ImGui::IsItemActive() && ui.drag > ui.px(3))
        reader.outside().turn(-0.5 * io.MouseDelta.x / ui.scale, 0.5 * io.MouseDelta.y / ui.scale);
    if (hovered && io.MouseWheel != 0.0f) reader.outside().zoom(std::pow(1.15, io.MouseWheel));
    if (hovered && ImGui::IsMouseClicked(ImGuiMouseButton_Right)) reader.outside().reset();
    if (!hovered || !ImGui::IsItemDeactivated() || ui.drag > ui.px(3)) return;
    if (under) return reader.goTo(bookmarks[*under]);
    const auto arc = reader::arcAt(reader.outside().orbit(), reader.flight().centerline(), pixel,
                                   sizeOf(area), ui.px(40));
    if (!arc) return;
    reader.setMotion(reader::Motion::paused);
    reader.flight().goTo(*arc);
}

void drawScaleBar(Ui& ui, double pixelsPerMm, Rect area, ImDrawList* list) {
    double mm = 10.0;
    while (mm * pixelsPerMm > area.size().x / 3)
        mm /= 2.0;
    const float long_ = float(mm * pixelsPerMm), margin = ui.px(10);
    const ImVec2 to(area.max.x - margin, area.max.y - margin), from(to.x - long_, to.y);
    list->AddLine(from, to, IM_COL32(0, 0, 0, 200), ui.px(4));
    list->AddLine(from, to, color::text, ui.px(1.5f));
    const std::string text = printed("%g mm", mm);
    outlinedText(list, ui.fonts.small,
                 {(from.x + to.x - textSize(ui.fonts.small, text).x) / 2,
                  to.y - ui.fonts.small->FontSize - ui.px(4)},
                 dim, text);
}

}  // namespace

void drawOverviewPane(Ui& ui, Rect area) {
    reader::Reader& reader = ui.reader;
    ImDrawList* list = ImGui::GetWindowDrawList();
    reader.setPaneSize(View::overview, framebufferSize(area));
    drawPicture(ui, View::overview, area, list);
    const bool hovered = pane(ui, "overview", area);
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::dvec2 pixel(mouse.x - area.min.x, mouse.y - area.min.y);
    const auto bookmarks = reader.session().bookmarks();
    std::vector<glm::dvec3> places;
    for (const reader::Bookmark& bookmark : bookmarks)
        places.push_back(bookmark.camera.positionMm);
    const auto under =
        hovered ? reader::placeAt(reader.outside().orbit(), places, pixel, sizeOf(area), ui.px(9))
                : std::nullopt;
    handleOverviewMouse(ui, bookmarks, under, pixel, area, hovered);

    list->PushClipRect(area.min, area.max, true);
    if (const Overview* pictured = reader.panes().shown<Overview>(View::overview)) {
        const Camera& from = pictured->camera;
        drawBookmarks(ui, from, bookmarks, under, area, list);
        drawReader(ui, from, area, list);
        drawLetters(ui, glm::cross(from.forward, from.up), from.up, area, list);
    }
    outlinedText(list, ui.fonts.small, {area.min.x + ui.px(8), area.min.y + ui.px(8)}, color::text,
                 "Overview");
    list->PopClipRect();
    if (under)
        tooltip(bookmarks[*under].note.empty() ? "Bookmark" : bookmarks[*under].note.c_str());
    list->AddRect(area.min, area.max, hovered ? color::muted : color::border);
}

void drawObliquePane(Ui& ui, Rect area) {
    reader::Reader& reader = ui.reader;
    ImDrawList* list = ImGui::GetWindowDrawList();
    reader.setPaneSize(View::oblique, framebufferSize(area));
    drawPicture(ui, View::oblique, area, list);
    const bool hovered = pane(ui, "oblique", area);
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemActive() && ui.drag > ui.px(3)) dragWindow(reader, io.MouseDelta);
    if (hovered && io.MouseWheel != 0.0f) {
        if (io.KeyCtrl)
            reader.slices().zoomOblique(std::pow(1.2, io.MouseWheel));
        else
            reader.slices().scrollOblique(io.MouseWheel * (io.KeyShift ? 10.0 : 1.0));
    }

    const ObliqueView* pictured = reader.panes().shown<ObliqueView>(View::oblique);
    const ObliqueView shown =
        pictured ? *pictured : reader.slices().oblique(reader.flight().camera());
    const double pixelsPerMm = area.size().y / shown.heightMm;
    const ImVec2 middle((area.min.x + area.max.x) / 2, (area.min.y + area.max.y) / 2);
    list->PushClipRect(area.min, area.max, true);
    const float inner = ui.px(4), outer = ui.px(9);
    for (const ImVec2 way : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)})
        list->AddLine({middle.x + inner * way.x, middle.y + inner * way.y},
                      {middle.x + outer * way.x, middle.y + outer * way.y}, color::accent,
                      ui.px(1.2f));
    drawLetters(ui, glm::cross(shown.forward, shown.up), shown.up, area, list);
    drawScaleBar(ui, pixelsPerMm, area, list);
    const float margin = ui.px(8);
    outlinedText(list, ui.fonts.small, {area.min.x + margin, area.min.y + margin}, color::text,
                 shown.scan == Scan::cleansed ? "Across the gaze, cleansed" : "Across the gaze");
    const double ahead =
        glm::dot(shown.positionMm - reader.flight().camera().positionMm, shown.forward);
    if (std::abs(ahead) >= 0.5) {
        const std::string text = printed("%+.0f mm ahead", ahead);
        outlinedText(list, ui.fonts.small,
                     {area.min.x + margin, area.max.y - margin - ui.fonts.small->FontSize}, dim,
                     text);
    }
    list->PopClipRect();
    list->AddRect(area.min, area.max, hovered ? color::muted : color::border);
}

}  // namespace haustra::window
