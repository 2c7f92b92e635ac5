#include "window/widgets.h"

namespace haustra::window {

ImVec2 textSize(ImFont* font, const std::string& text) {
    return font->CalcTextSizeA(font->FontSize, 1e6f, 0.0f, text.c_str());
}

ImVec2 outlinedText(ImDrawList* list, ImFont* font, ImVec2 position, ImU32 colour,
                    const std::string& text) {
    constexpr ImU32 outline = IM_COL32(0, 0, 0, 200);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            list->AddText(font, font->FontSize, {position.x + float(dx), position.y + float(dy)},
                          outline, text.c_str());
    list->AddText(font, font->FontSize, position, colour, text.c_str());
    return textSize(font, text);
}

void tooltip(const char* text) {
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled) && text && *text) {
        ImGui::BeginTooltip();
        ImGui::TextUnformatted(text);
        ImGui::EndTooltip();
    }
}

void drawIcon(ImDrawList* list, Icon icon, ImVec2 c, float side, ImU32 colour) {
    const float r = side * 0.5f;
    const auto at = [&](float x, float y) { return ImVec2(c.x + x * r, c.y + y * r); };
    const float line = side * 0.11f;
    switch (icon) {
        case Icon::forward:
            list->AddTriangleFilled(at(-0.6f, -0.8f), at(0.85f, 0), at(-0.6f, 0.8f), colour);
            break;
        case Icon::backward:
            list->AddTriangleFilled(at(0.6f, -0.8f), at(-0.85f, 0), at(0.6f, 0.8f), colour);
            break;
        case Icon::pause:
            list->AddRectFilled(at(-0.65f, -0.75f), at(-0.15f, 0.75f), colour, 1.0f);
            list->AddRectFilled(at(0.15f, -0.75f), at(0.65f, 0.75f), colour, 1.0f);
            break;
        case Icon::toRectum:
            list->AddRectFilled(at(-0.8f, -0.7f), at(-0.55f, 0.7f), colour);
            list->AddTriangleFilled(at(0.7f, -0.7f), at(-0.45f, 0), at(0.7f, 0.7f), colour);
            break;
        case Icon::toCecum:
            list->AddRectFilled(at(0.55f, -0.7f), at(0.8f, 0.7f), colour);
            list->AddTriangleFilled(at(-0.7f, -0.7f), at(0.45f, 0), at(-0.7f, 0.7f), colour);
            break;
        case Icon::turnRound:
            list->AddLine(at(-0.5f, -0.4f), at(0.8f, -0.4f), colour, line);
            list->AddTriangleFilled(at(-0.9f, -0.4f), at(-0.35f, -0.85f), at(-0.35f, 0.05f),
                                    colour);
            list->AddLine(at(-0.8f, 0.45f), at(0.5f, 0.45f), colour, line);
            list->AddTriangleFilled(at(0.9f, 0.45f), at(0.35f, 0.0f), at(0.35f, 0.9f), colour);
            break;
        case Icon::bookmark:  // a ribbon with a notch, of a rectangle and two triangles
            list->AddRectFilled(at(-0.55f, -0.85f), at(0.55f, 0.3f), colour, side * 0.06f);
            list->AddTriangleFilled(at(-0.55f, 0.2f), at(0.05f, 0.25f), at(-0.55f, 0.9f), colour);
            list->AddTriangleFilled(at(0.55f, 0.2f), at(0.55f, 0.9f), at(-0.05f, 0.25f), colour);
            break;
        case Icon::help: {
            const ImVec2 size = ImGui::CalcTextSize("?");
            list->AddText({c.x - size.x * 0.5f, c.y - size.y * 0.5f}, colour, "?");
            break;
        }
        case Icon::center:
            list->AddCircle(c, r * 0.55f, colour, 0, line);
            list->AddLine(at(-1, 0), at(-0.3f, 0), colour, line);
            list->AddLine(at(0.3f, 0), at(1, 0), colour, line);
            list->AddLine(at(0, -1), at(0, -0.3f), colour, line);
            list->AddLine(at(0, 0.3f), at(0, 1), colour, line);
            break;
        case Icon::flyOver:  // a strip with an arrow along it
            list->AddRect(at(-0.75f, -0.9f), at(0.75f, 0.9f), colour, 0, 0, line * 0.8f);
            list->AddLine(at(0, 0.7f), at(0, -0.2f), colour, line);
            list->AddTriangleFilled(at(-0.4f, -0.05f), at(0, -0.65f), at(0.4f, -0.05f), colour);
            break;
        case Icon::line:
            list->AddLine(at(-0.7f, 0.7f), at(0.7f, -0.7f), colour, line);
            list->AddCircleFilled(at(-0.7f, 0.7f), r * 0.24f, colour);
            list->AddCircleFilled(at(0.7f, -0.7f), r * 0.24f, colour);
            break;
        case Icon::outline:
            list->AddCircle(c, r * 0.75f, colour, 0, line);
            list->AddLine(at(-0.35f, 0), at(0.35f, 0), colour, line * 0.8f);
            break;
        case Icon::cross:
            list->AddLine(at(-0.6f, -0.6f), at(0.6f, 0.6f), colour, line);
            list->AddLine(at(-0.6f, 0.6f), at(0.6f, -0.6f), colour, line);
            break;
    }
}

bool iconButton(const char* id, Icon icon, float side, const char* hint, bool active) {
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(id, {side, side});
    const bool hovered = ImGui::IsItemHovered();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const ImU32 fill = active                  ? color::accentDim
                       : ImGui::IsItemActive() ? color::accentDim
                       : hovered               ? color::hovered
                                               : color::raised;
    list->AddRectFilled(corner, {corner.x + side, corner.y + side}, fill, side * 0.16f);
    drawIcon(list, icon, {corner.x + side * 0.5f, corner.y + side * 0.5f}, side * 0.42f,
             active || hovered ? IM_COL32_WHITE : color::text);
    tooltip(hint);
    return pressed;
}

}  // namespace haustra::window
