// Colours, sizes and fonts of the window.
#pragma once

#include <imgui.h>

namespace haustra::window {

/// Dark and nearly colourless, so that nothing competes with the pictures; teal for what is
/// active, amber for bookmarks, red for trouble.
namespace color {
inline constexpr ImU32 background = IM_COL32(13, 16, 20, 255);
inline constexpr ImU32 bar = IM_COL32(21, 25, 31, 255);
inline constexpr ImU32 raised = IM_COL32(32, 38, 46, 255);
inline constexpr ImU32 hovered = IM_COL32(45, 53, 64, 255);
inline constexpr ImU32 border = IM_COL32(42, 49, 59, 255);
inline constexpr ImU32 text = IM_COL32(222, 228, 235, 255);
inline constexpr ImU32 muted = IM_COL32(138, 149, 163, 255);
inline constexpr ImU32 accent = IM_COL32(72, 190, 199, 255);
inline constexpr ImU32 accentDim = IM_COL32(37, 98, 105, 255);
inline constexpr ImU32 bookmark = IM_COL32(235, 176, 88, 255);
inline constexpr ImU32 trouble = IM_COL32(240, 106, 98, 255);
inline constexpr ImU32 veil = IM_COL32(8, 10, 13, 130);  // over a picture that is old
inline constexpr ImU32 shade = IM_COL32(8, 10, 13, 200);
}  // namespace color

struct Fonts {
    ImFont* normal = nullptr;
    ImFont* small = nullptr;
    ImFont* large = nullptr;
};

/// Sets ImGui's style and loads the fonts for `scale` (1: a 96-dpi display). Where DejaVu Sans is
/// not installed, ImGui's own font serves. Needs a current ImGui context.
Fonts applyTheme(double scale);

}  // namespace haustra::window
