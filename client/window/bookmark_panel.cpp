// The list of bookmarks at the right.
#include "core/printed_text.h"
#include "window/ui.h"
#include "window/widgets.h"

#include <algorithm>

namespace haustra::window {
namespace {

// One bookmark: its place, note and whether the server has it. A click goes there.
void drawRow(Ui& ui, const reader::Bookmark& bookmark, int number) {
    const float high = ui.px(46), wide = ImGui::GetContentRegionAvail().x;
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::PushID(number);
    if (ImGui::InvisibleButton("row", {wide, high})) ui.reader.goTo(bookmark);
    const bool hovered = ImGui::IsItemHovered();
    ImGui::PopID();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImVec2 end(corner.x + wide, corner.y + high);
    list->AddRectFilled(corner, end, hovered ? color::hovered : color::raised, ui.px(5));
    list->AddRectFilled(corner, {corner.x + ui.px(3), end.y},
                        bookmark.acknowledged() ? color::bookmark : color::muted, ui.px(2));
    list->PushClipRect(corner, {end.x - ui.px(8), end.y}, true);
    list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize,
                  {corner.x + ui.px(12), corner.y + ui.px(5)}, color::text,
                  bookmark.note.empty() ? "Bookmark" : bookmark.note.c_str());
    const std::string when =
        bookmark.createdUtc.size() >= 16
            ? bookmark.createdUtc.substr(0, 10) + "  " + bookmark.createdUtc.substr(11, 5)
            : "";
    const std::string where =
        printed("%.0f mm   %s", bookmark.arcMm, bookmark.acknowledged() ? when.c_str() : "saving…");
    list->AddText(ui.fonts.small, ui.fonts.small->FontSize,
                  {corner.x + ui.px(12), corner.y + ui.px(26)}, color::muted, where.c_str());
    list->PopClipRect();
    if (hovered && !bookmark.note.empty()) tooltip(bookmark.note.c_str());
}

}  // namespace

void drawBookmarkPanel(Ui& ui, Rect area) {
    ImGui::SetCursorScreenPos(area.min);
    ImGui::PushStyleVar(ImGuiStyleVar_ChildRounding, 0.0f);
    ImGui::BeginChild("bookmarks", area.size(), true, ImGuiWindowFlags_AlwaysUseWindowPadding);
    const auto bookmarks = ui.reader.session().bookmarks();
    ImGui::TextUnformatted("Bookmarks");
    ImGui::SameLine();
    ImGui::TextDisabled("%zu", bookmarks.size());

    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - ui.px(40));
    if (ui.focusNote) ImGui::SetKeyboardFocusHere();
    ui.focusNote = false;
    const bool entered =
        ImGui::InputTextWithHint("##note", "note, then Enter", ui.note.data(), ui.note.size(),
                                 ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine(0, ui.px(8));
    const bool pressed = iconButton("add", Icon::bookmark, ui.px(30), "Bookmark this place (B)");
    if (entered || pressed) {
        ui.reader.addBookmark(ui.note.data());
        ui.note.fill(0);
    }
    ImGui::Spacing();
    ImGui::BeginChild("list", {0, 0}, false);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, ui.px(6)});
    // Along the colon, as they are met in flight.
    auto sorted = bookmarks;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.arcMm < b.arcMm; });
    ImGuiListClipper clipper;
    clipper.Begin(int(sorted.size()), ui.px(52));
    while (clipper.Step())
        for (int n = clipper.DisplayStart; n < clipper.DisplayEnd; ++n)
            drawRow(ui, sorted[std::size_t(n)], n);
    ImGui::PopStyleVar();
    if (bookmarks.empty()) {
        ImGui::PushFont(ui.fonts.small);
        ImGui::TextDisabled("B marks the place in view.");
        ImGui::PopFont();
    }
    ImGui::EndChild();
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

}  // namespace haustra::window
