// What lies over the views: notices, the help, and the start page while no case is open.
#include "core/printed_text.h"
#include "window/ui.h"
#include "window/widgets.h"

#include <algorithm>

namespace haustra::window {
namespace {

struct Key {
    const char* keys;
    const char* meaning;
};
constexpr Key flightKeys[] = {
    {"Space", "fly forward, pause"},
    {"Backspace", "fly backward, pause"},
    {"← →", "1 mm along the path; with Shift 10 mm"},
    {"Home  End", "to the rectum, to the cecum"},
    {"+  −", "faster, slower"},
    {"R", "turn round"},
    {"C", "back to the path, straight ahead"},
    {"F", "free flight: W A S D, Q E up and down"},
    {"B", "bookmark this place"},
    {"Shift B", "bookmark with a note"},
    {"P  N", "previous, next bookmark"},
    {"T  G", "next look of the wall; its colours, opacities and light"},
    {"I", "fisheye, which sees all around, or not"},
    {"Y", "overview: with the body, or the colon alone"},
    {"V", "fly over the flattened wall, or along the path"},
    {"K", "colour the wall around bookmarks"},
    {"U  Shift U", "colour what has not been seen yet; begin anew"},
    {"L  O", "measure a line, an outline on the flattened wall"},
    {"X", "slices: as scanned, or cleansed"},
    {"M", "show or hide the bookmarks"},
    {"Esc", "stop measuring, clear it"},
    {"?  F1", "this page"},
    {"Ctrl Q", "quit"},
};
constexpr Key mouseKeys[] = {
    {"drag the view", "look around; double-click: straight ahead"},
    {"wheel on the view", "move along the path"},
    {"drag a slice", "window (across) and centre (up, down)"},
    {"wheel on a slice", "scroll; with Ctrl zoom; with Shift ×10"},
    {"double-click a slice", "fly to the nearest point of the path"},
    {"drag the overview", "turn it; wheel: enlarge; right: from the front"},
    {"click the overview", "go to that place, or bookmark"},
    {"wheel across the gaze", "the slice ahead; with Ctrl zoom"},
    {"track below", "go to that place"},
    {"click the strip", "go to that place of the wall; drag: look it over"},
    {"click the wall", "look at that place in all views"},
    {"drag the wall", "move it; wheel: enlarge"},
    {"Shift, Ctrl drag", "on the wall: measure a line, an outline"},
};

float drawKeys(Ui& ui, ImDrawList* list, ImVec2 corner, float column, const char* heading,
               const Key* keys, std::size_t count) {
    list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, corner, color::accent, heading);
    float y = corner.y + ui.px(28);
    for (std::size_t n = 0; n < count; ++n, y += ui.px(23)) {
        list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, {corner.x, y}, color::text,
                      keys[n].keys);
        list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, {corner.x + column, y},
                      color::muted, keys[n].meaning);
    }
    return y;
}

void centered(Ui& ui, ImDrawList* list, ImFont* font, float x, float y, ImU32 colour,
              const std::string& text) {
    (void)ui;
    list->AddText(font, font->FontSize, {x - textSize(font, text).x / 2, y}, colour, text.c_str());
}

}  // namespace

void Ui::tell(std::string text, bool trouble) {
    notices.push_back({std::move(text), ImGui::GetTime() + (trouble ? 8.0 : 3.0), trouble});
    if (notices.size() > 4) notices.pop_front();
}

void drawNotices(Ui& ui, Rect area) {
    ImDrawList* list = ImGui::GetForegroundDrawList();
    const reader::Session& session = ui.reader.session();
    std::erase_if(ui.notices,
                  [](const Notice& notice) { return notice.untilSeconds < ImGui::GetTime(); });
    float bottom = area.max.y - ui.px(16);
    const float middle = (area.min.x + area.max.x) / 2;
    const float wrap = std::min(area.size().x - ui.px(80), ui.px(640));
    const auto draw = [&](const std::string& text, bool trouble) {
        ImFont* font = ui.fonts.normal;
        const ImVec2 size = font->CalcTextSizeA(font->FontSize, 1e6f, wrap, text.c_str());
        const ImVec2 pad(ui.px(14), ui.px(8));
        const ImVec2 min(middle - size.x / 2 - pad.x, bottom - size.y - 2 * pad.y),
            max(middle + size.x / 2 + pad.x, bottom);
        list->AddRectFilled(min, max, IM_COL32(21, 25, 31, 240), ui.px(6));
        list->AddRect(min, max, trouble ? color::trouble : color::accentDim, ui.px(6), 0,
                      ui.px(1.2f));
        list->AddText(font, font->FontSize, {min.x + pad.x, min.y + pad.y},
                      trouble ? color::trouble : color::text, text.c_str(), nullptr, wrap);
        bottom = min.y - ui.px(8);
    };
    if (ui.reader.isOpen() &&
        (session.phase() == reader::Phase::lost || session.phase() == reader::Phase::failed)) {
        const bool final = session.phase() == reader::Phase::failed;
        draw(describe(session.failure()) + (final ? "" : "  Trying again…"), true);
        if (session.owedBookmarks() > 0)
            draw(printed("%zu bookmark%s will be saved when the server is back",
                         session.owedBookmarks(), session.owedBookmarks() == 1 ? "" : "s"),
                 true);
    }
    for (const Notice& notice : ui.notices)
        draw(notice.text, notice.trouble);
}

void drawHelp(Ui& ui, Rect area) {
    ImDrawList* list = ImGui::GetForegroundDrawList();
    list->AddRectFilled(area.min, area.max, color::shade);
    const ImVec2 size(ui.px(960), ui.px(660));
    const ImVec2 min((area.min.x + area.max.x - size.x) / 2,
                     (area.min.y + area.max.y - size.y) / 2);
    const ImVec2 max(min.x + size.x, min.y + size.y);
    list->AddRectFilled(min, max, color::bar, ui.px(10));
    list->AddRect(min, max, color::border, ui.px(10));
    const float margin = ui.px(28);
    list->AddText(ui.fonts.large, ui.fonts.large->FontSize, {min.x + margin, min.y + ui.px(22)},
                  color::text, "Haustra, virtual colonoscopy");
    const float top = min.y + ui.px(66);
    drawKeys(ui, list, {min.x + margin, top}, ui.px(96), "Keys", flightKeys, std::size(flightKeys));
    const float right = min.x + ui.px(490);
    float y =
        drawKeys(ui, list, {right, top}, ui.px(150), "Mouse", mouseKeys, std::size(mouseKeys));
    y += ui.px(22);
    const reader::Session& session = ui.reader.session();
    list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, {right, y}, color::accent, "About");
    const auto line = [&](const std::string& text) {
        y += ui.px(23);
        list->AddText(ui.fonts.small, ui.fonts.small->FontSize, {right, y + ui.px(4)}, color::muted,
                      text.c_str());
    };
    line("server: " + ui.serverName +
         (session.server().serverSoftware.empty() ? "" : ", " + session.server().serverSoftware));
    if (!session.server().renderer.empty())
        line("renderer: " + session.server().renderer.substr(0, 60));
    if (!session.server().fingerprint.empty())
        line("certificate: " + session.server().fingerprint.substr(0, 32) + "…");
    y += ui.px(30);
    list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, {right, y}, color::bookmark,
                  "For a physician's judgement;");
    list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize, {right, y + ui.px(21)},
                  color::bookmark, "not a certified medical device.");
    list->AddText(ui.fonts.small, ui.fonts.small->FontSize, {min.x + margin, max.y - ui.px(34)},
                  color::muted, "Esc closes this page");
}

void drawStart(Ui& ui, Rect area) {
    ImDrawList* list = ImGui::GetWindowDrawList();
    reader::Session& session = ui.reader.session();
    const float middle = (area.min.x + area.max.x) / 2;
    float y = area.min.y + area.size().y * 0.3f;
    if (session.phase() != reader::Phase::choosing) {
        const bool trouble =
            session.phase() == reader::Phase::lost || session.phase() == reader::Phase::failed;
        const std::string heading = session.phase() == reader::Phase::failed ? "No connection"
                                    : trouble ? "Waiting for the server"
                                    : session.server().fingerprint.empty() ? "Connecting"
                                                                           : "Opening the case";
        centered(ui, list, ui.fonts.large, middle, y, color::text,
                 heading + (trouble && session.phase() == reader::Phase::failed ? "" : "…"));
        const std::string detail = trouble ? describe(session.failure()) : ui.serverName;
        const float wide = std::min(area.size().x - ui.px(80), ui.px(760));
        const ImVec2 size =
            ui.fonts.normal->CalcTextSizeA(ui.fonts.normal->FontSize, 1e6f, wide, detail.c_str());
        list->AddText(ui.fonts.normal, ui.fonts.normal->FontSize,
                      {middle - size.x / 2, y + ui.px(38)}, trouble ? color::trouble : color::muted,
                      detail.c_str(), nullptr, wide);
        return;
    }
    centered(ui, list, ui.fonts.large, middle, y, color::text,
             session.caseNames().empty() ? "The server has no case yet" : "Choose a case");
    y += ui.px(44);
    const ImVec2 size(ui.px(360), ui.px(40));
    for (const std::string& name : session.caseNames()) {
        ImGui::SetCursorScreenPos({middle - size.x / 2, y});
        if (ImGui::Button(name.c_str(), size)) session.openCase(name);
        y += size.y + ui.px(8);
        if (y > area.max.y - size.y) break;
    }
}

}  // namespace haustra::window
