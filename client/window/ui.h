// What the window's parts share while they draw, and the parts themselves. All of it lives on the
// main thread.
#pragma once

#include "reader/reader.h"
#include "window/gl_window.h"
#include "window/picture_texture.h"
#include "window/theme.h"

#include <array>
#include <deque>
#include <string>
#include <vector>

namespace haustra::window {

/// A message that fades: a refusal, a lost link, a bookmark saved.
struct Notice {
    std::string text;
    double untilSeconds;
    bool trouble;
};

/// `none`: a drag moves the picture.
enum class DrawingTool { none, line, outline };

/// What the hand has chosen there.
struct TransferPanel {
    std::string preset{};              ///< that the axis was fitted to
    int point = -1;                    ///< of the row being edited
    double lowHu = 0.0, highHu = 1.0;  ///< the graph's axis
    std::array<char, 512> file{};
};

struct Ui {
    reader::Reader& reader;
    Fonts fonts;
    float scale = 1.0f;
    std::string serverName;
    std::array<PictureTexture, viewCount> textures{};
    std::deque<Notice> notices{};
    bool showHelp = false, showBookmarks = true, focusNote = false, showTransfer = false;
    TransferPanel transfer{};
    std::array<char, 256> note{};
    double drag = 0.0;  ///< pixels that the mouse moved since it was pressed on a pane
    DrawingTool tool = DrawingTool::none;  ///< what a drag on the flattened wall does
    std::vector<glm::dvec2> drawing{};     ///< flat, while the mouse draws a line or an outline
    bool drawsOutline = false;

    float px(float length) const { return length * scale; }
    void tell(std::string text, bool trouble = false);
};

struct Rect {
    ImVec2 min, max;
    ImVec2 size() const { return {max.x - min.x, max.y - min.y}; }
    bool empty() const { return max.x <= min.x || max.y <= min.y; }
};

/// Each draws one part within `area` (screen coordinates) and acts on what the hand does there.
void drawTopBar(Ui& ui, Rect area);
void drawEndoscopicPane(Ui& ui, Rect area);
void drawSlicePane(Ui& ui, View view, Rect area);
/// The whole flattened strip, and the window onto it.
void drawStripPane(Ui& ui, Rect area);
void drawZoomPane(Ui& ui, Rect area);
/// The colon from outside, and the slice across the gaze.
void drawOverviewPane(Ui& ui, Rect area);
void drawObliquePane(Ui& ui, Rect area);
/// A window of its own, at first in the corner of `area` that leaves the endoscopic view in sight;
/// while Ui::showTransfer.
void drawTransferPanel(Ui& ui, Rect area);
void drawTransportBar(Ui& ui, Rect area);
void drawBookmarkPanel(Ui& ui, Rect area);
void drawNotices(Ui& ui, Rect area);
/// The keys and what this program is; over everything.
void drawHelp(Ui& ui, Rect area);
/// The list of the server's cases, or the state of the link, where no case is open.
void drawStart(Ui& ui, Rect area);

/// Acts on the keyboard. False: the reader asked to quit.
bool handleKeys(Ui& ui, const std::vector<KeyPress>& presses, double seconds);

/// The next item goes beside the last one.
inline void sameRow(Ui& ui, float gap = 8) {
    ImGui::SameLine(0, ui.px(gap));
}

}  // namespace haustra::window
