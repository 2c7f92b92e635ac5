#include "window/theme.h"

#include <filesystem>

namespace haustra::window {
namespace {

ImFont* load(const char* file, double pixels) {
    // Latin with its supplements, punctuation, arrows and mathematical signs.
    static constexpr ImWchar ranges[] = {0x0020, 0x024F, 0x2010, 0x2027, 0x2190,
                                         0x21FF, 0x2200, 0x22FF, 0};
    ImGuiIO& io = ImGui::GetIO();
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        ImFontConfig config;
        config.SizePixels = float(pixels);
        return io.Fonts->AddFontDefault(&config);
    }
    return io.Fonts->AddFontFromFileTTF(file, float(pixels), nullptr, ranges);
}

ImVec4 asVector(ImU32 packed) {
    return ImGui::ColorConvertU32ToFloat4(packed);
}

}  // namespace

Fonts applyTheme(double scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowPadding = {12, 10};
    style.FramePadding = {10, 6};
    style.ItemSpacing = {8, 8};
    style.FrameRounding = 5;
    style.GrabRounding = 5;
    style.GrabMinSize = 12;
    style.PopupRounding = 6;
    style.WindowRounding = 0;
    style.ChildRounding = 6;
    style.ScrollbarSize = 10;
    style.ScrollbarRounding = 5;
    style.WindowBorderSize = 0;
    style.FrameBorderSize = 0;
    style.PopupBorderSize = 1;
    style.ScaleAllSizes(float(scale));

    const auto set = [&](ImGuiCol what, ImU32 value) { style.Colors[what] = asVector(value); };
    set(ImGuiCol_WindowBg, color::background);
    set(ImGuiCol_ChildBg, color::bar);
    set(ImGuiCol_PopupBg, color::bar);
    set(ImGuiCol_TitleBg, color::bar);
    set(ImGuiCol_TitleBgActive, color::raised);
    set(ImGuiCol_Border, color::border);
    set(ImGuiCol_Text, color::text);
    set(ImGuiCol_TextDisabled, color::muted);
    set(ImGuiCol_FrameBg, color::raised);
    set(ImGuiCol_FrameBgHovered, color::hovered);
    set(ImGuiCol_FrameBgActive, color::hovered);
    set(ImGuiCol_Button, color::raised);
    set(ImGuiCol_ButtonHovered, color::hovered);
    set(ImGuiCol_ButtonActive, color::accentDim);
    set(ImGuiCol_Header, color::raised);
    set(ImGuiCol_HeaderHovered, color::hovered);
    set(ImGuiCol_HeaderActive, color::accentDim);
    set(ImGuiCol_SliderGrab, color::accent);
    set(ImGuiCol_SliderGrabActive, color::accent);
    set(ImGuiCol_CheckMark, color::accent);
    set(ImGuiCol_Separator, color::border);
    set(ImGuiCol_TextSelectedBg, color::accentDim);
    set(ImGuiCol_NavHighlight, color::accent);
    set(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0));
    set(ImGuiCol_ScrollbarGrab, color::hovered);
    set(ImGuiCol_ScrollbarGrabHovered, color::muted);
    set(ImGuiCol_ScrollbarGrabActive, color::muted);

    constexpr const char* sans = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    constexpr const char* bold = "/usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf";
    Fonts fonts;
    fonts.normal = load(sans, 15.0 * scale);
    fonts.small = load(sans, 12.5 * scale);
    fonts.large = load(bold, 18.0 * scale);
    return fonts;
}

}  // namespace haustra::window
