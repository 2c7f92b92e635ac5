#include "window/pane.h"

#include "window/widgets.h"

#include <algorithm>
#include <cmath>

namespace haustra::window {

bool preparePicture(Ui& ui, View view, Rect area, ImDrawList* list) {
    PictureTexture& texture = ui.textures[std::size_t(view)];
    texture.show(ui.reader.panes().picture(view), ui.reader.panes().pictureCount(view));
    list->AddRectFilled(area.min, area.max, IM_COL32_BLACK);
    if (!texture.empty()) return true;
    const std::string waiting = "waiting for the picture…";
    const ImVec2 size = textSize(ui.fonts.small, waiting);
    list->AddText(ui.fonts.small, ui.fonts.small->FontSize,
                  {(area.min.x + area.max.x - size.x) / 2, (area.min.y + area.max.y - size.y) / 2},
                  color::muted, waiting.c_str());
    return false;
}

void drawPicture(Ui& ui, View view, Rect area, ImDrawList* list) {
    if (!preparePicture(ui, view, area, list)) return;
    list->AddImage(ui.textures[std::size_t(view)].id(), area.min, area.max);
    dimOldPicture(ui, view, area, list);
}

void dimOldPicture(Ui& ui, View view, Rect area, ImDrawList* list) {
    if (ui.reader.freshness(view) == reader::Freshness::old)
        list->AddRectFilled(area.min, area.max, color::veil);
}

bool pane(Ui& ui, const char* id, Rect area) {
    ImGui::SetCursorScreenPos(area.min);
    ImGui::InvisibleButton(id, area.size());
    const ImVec2 moved = ImGui::GetIO().MouseDelta;
    if (ImGui::IsItemActivated())
        ui.drag = 0.0;  // what the mouse moved in this frame was before it was pressed
    else if (ImGui::IsItemActive())
        ui.drag += std::hypot(moved.x, moved.y);
    return ImGui::IsItemHovered();
}

glm::ivec2 framebufferSize(Rect area) {
    const ImVec2 scale = ImGui::GetIO().DisplayFramebufferScale;
    return {std::max(1, int(area.size().x * scale.x)), std::max(1, int(area.size().y * scale.y))};
}

void dragWindow(reader::Reader& reader, ImVec2 moved) {
    WindowLevel window = reader.slices().window();
    const double stepHu = std::max(1.0, window.widthHu / 400.0);
    window.widthHu += moved.x * stepHu;
    window.centerHu += moved.y * stepHu;
    reader.slices().setWindow(window);
}

void drawPickedCross(Ui& ui, ImDrawList* list, ImVec2 p) {
    const float inner = ui.px(4), outer = ui.px(10);
    for (const ImVec2 way : {ImVec2(1, 0), ImVec2(-1, 0), ImVec2(0, 1), ImVec2(0, -1)}) {
        const ImVec2 from(p.x + inner * way.x, p.y + inner * way.y),
            to(p.x + outer * way.x, p.y + outer * way.y);
        list->AddLine(from, to, IM_COL32(0, 0, 0, 180), ui.px(3.5f));
        list->AddLine(from, to, color::accent, ui.px(1.6f));
    }
}

}  // namespace haustra::window
