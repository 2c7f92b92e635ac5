// Small controls that the window's parts share.
#pragma once

#include "window/theme.h"

#include <string>

#include <imgui.h>

namespace haustra::window {

enum class Icon {
    forward,
    backward,
    pause,
    toRectum,
    toCecum,
    turnRound,
    bookmark,
    help,
    center,
    cross,
    flyOver,
    line,
    outline
};

/// A square button with a drawn symbol. True when pressed.
bool iconButton(const char* id, Icon icon, float side, const char* tooltip, bool active = false);

/// Draws `icon` within the square around `center`.
void drawIcon(ImDrawList* list, Icon icon, ImVec2 center, float side, ImU32 colour);

/// Text with a dark outline, readable on any picture. Returns its size.
ImVec2 outlinedText(ImDrawList* list, ImFont* font, ImVec2 position, ImU32 colour,
                    const std::string& text);

/// Size of `text` in `font`.
ImVec2 textSize(ImFont* font, const std::string& text);

/// A tooltip for the last item, after a moment's hovering.
void tooltip(const char* text);

}  // namespace haustra::window
