// The line along the top: which case, which server, how fast.
#include "core/printed_text.h"
#include "core/raycasters.h"
#include "window/ui.h"
#include "window/widgets.h"

namespace haustra::window {
namespace {

// Draws "label value" ending at `right`; returns where the next one to the left may end.
float drawFigure(Ui& ui, ImDrawList* list, float right, float middle, const char* label,
                 const std::string& value, ImU32 colour) {
    const ImVec2 valueSize = textSize(ui.fonts.normal, value),
                 labelSize = textSize(ui.fonts.small, label);
    const float x = right - valueSize.x;
    list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, {x, middle - valueSize.y / 2}, colour,
                  value.c_str());
    const float labelX = x - ui.px(6) - labelSize.x;
    list->AddText(ui.fonts.small, ui.fonts.small->FontSize, {labelX, middle - labelSize.y / 2},
                  color::muted, label);
    return labelX - ui.px(20);
}

}  // namespace

void drawTopBar(Ui& ui, Rect area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    const reader::Session& session = ui.reader.session();
    list->AddRectFilled(area.min, area.max, color::bar);
    list->AddLine({area.min.x, area.max.y}, area.max, color::border);
    const float middle = (area.min.y + area.max.y) / 2;
    float x = area.min.x + ui.px(16);

    const auto write = [&](ImFont* font, ImU32 colour, const std::string& text) {
        const ImVec2 size = textSize(font, text);
        list->AddText(font, font->FontSize, {x, middle - size.y / 2}, colour, text.c_str());
        x += size.x + ui.px(12);
    };
    write(ui.fonts.large, color::accent, "Haustra");
    if (ui.reader.isOpen()) {
        const reader::CaseInfo& info = *session.caseInfo();
        write(ui.fonts.normal, color::text, info.name);
        std::string about = toString(info.position);
        if (info.position == PatientPosition::unknown) about.clear();
        about += printed("%s%d×%d×%d", about.empty() ? "" : "   ", info.grid.size.x,
                         info.grid.size.y, info.grid.size.z);
        write(ui.fonts.small, color::muted, about);
        if (!info.cleansed) write(ui.fonts.small, color::bookmark, "not cleansed");
        if (info.trust) {
            const float from = x;
            const std::size_t places = info.trust->warnings.size();
            write(ui.fonts.small, places > 0 ? color::bookmark : color::muted,
                  printed("colon %.0f %% sure", 100.0 * info.trust->confidence) +
                      (places == 0   ? std::string()
                       : places == 1 ? std::string(", 1 place to look at")
                                     : printed(", %d places to look at", int(places))));
            if (places > 0 && ImGui::IsMouseHoveringRect({from, area.min.y}, {x, area.max.y})) {
                std::string all;
                for (const std::string& warning : info.trust->warnings)
                    all += (all.empty() ? "" : "\n") + warning;
                ImGui::SetTooltip("%s", all.c_str());
            }
        }
    }

    const float side = ui.px(28);
    float right = area.max.x - ui.px(12) - side;
    ImGui::SetCursorScreenPos({right, middle - side / 2});
    if (iconButton("help", Icon::help, side, "Keys and about (?)", ui.showHelp))
        ui.showHelp = !ui.showHelp;
    right -= side + ui.px(8);
    ImGui::SetCursorScreenPos({right, middle - side / 2});
    if (iconButton("bookmarks", Icon::bookmark, side, "Bookmarks panel (M)", ui.showBookmarks))
        ui.showBookmarks = !ui.showBookmarks;
    right -= ui.px(20);

    const reader::Summary latency = ui.reader.panes().latencyMs();
    const bool up =
        session.phase() == reader::Phase::open || session.phase() == reader::Phase::choosing;
    right = drawFigure(ui, list, right, middle, "server", ui.serverName,
                       up ? color::text : color::trouble);
    if (!ui.reader.isOpen()) return;
    right = drawFigure(ui, list, right, middle, "link", printed("%.1f ms", session.roundTripMs()),
                       color::text);
    if (latency.count > 0)
        right = drawFigure(ui, list, right, middle, "hand to picture",
                           printed("%.0f ms, p95 %.0f", latency.p50, latency.p95),
                           latency.p95 > 150.0 ? color::bookmark : color::text);
    right = drawFigure(ui, list, right, middle, "pictures/s",
                       printed("%.0f", ui.reader.panes().picturesPerSecond()), color::text);
    const tiles::Picture& shown = ui.reader.panes().picture(View::endoscopic);
    const std::string raycaster = raycasterName(shown.raycaster);
    if (!raycaster.empty())
        right = drawFigure(ui, list, right, middle, raycaster.c_str(),
                           printed("%.0f ms", 1e-3 * shown.renderMicroseconds), color::text);
    if (ui.reader.flat().hasStrip() && session.seenShare())
        drawFigure(ui, list, right, middle, "wall seen",
                   printed("%.1f %%", 100.0 * *session.seenShare()), color::text);
}

}  // namespace haustra::window
