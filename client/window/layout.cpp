#include "window/layout.h"

#include <algorithm>

namespace haustra::window {

Layout layOut(const Ui& ui, ImVec2 size) {
    const float topHigh = ui.px(44), bottomHigh = ui.px(88), gap = ui.px(3);
    const float top = topHigh, bottom = size.y - bottomHigh, high = bottom - top;
    Layout layout;
    layout.top = {{0, 0}, {size.x, top}};
    layout.transport = {{0, bottom}, size};
    layout.middle = {{0, top}, {size.x, bottom}};

    const float sliceHigh = (high - 2 * gap) / 3;
    const float sliceWide = std::clamp(sliceHigh * 1.15f, ui.px(180), size.x * 0.22f);
    Rect* slices[] = {&layout.axial, &layout.coronal, &layout.sagittal};
    for (int n = 0; n < 3; ++n) {
        const float y = top + float(n) * (sliceHigh + gap);
        *slices[n] = {{0, y}, {sliceWide, y + sliceHigh}};
    }
    float right = size.x - std::clamp(size.x * 0.19f, ui.px(200), ui.px(460));
    const float listHigh = ui.showBookmarks ? high * 0.28f : 0.0f;
    const float overviewHigh = (high - listHigh) * 0.56f;
    const float obliqueTop = top + overviewHigh + gap;
    const float obliqueBottom = bottom - listHigh - (ui.showBookmarks ? gap : 0);
    layout.overview = {{right, top}, {size.x, top + overviewHigh}};
    layout.oblique = {{right, obliqueTop}, {size.x, obliqueBottom}};
    if (ui.showBookmarks) layout.bookmarks = {{right, bottom - listHigh}, {size.x, bottom}};
    const float left = sliceWide + gap;
    right -= gap;
    if (!ui.reader.flat().hasStrip()) {
        layout.endoscopic = {{left, top}, {right, bottom}};
        return layout;
    }
    const float stripWide = std::clamp((right - left) * 0.34f, ui.px(200), ui.px(460));
    layout.strip = {{right - stripWide, top}, {right, bottom}};
    right -= stripWide + gap;
    // In a fly-over the reader looks at the wall, and at the lumen to make sure.
    const float zoomHigh = high * (ui.reader.flat().tour().flyingOver() ? 0.58f : 0.4f);
    layout.zoom = {{left, bottom - zoomHigh}, {right, bottom}};
    layout.endoscopic = {{left, top}, {right, bottom - zoomHigh - gap}};
    return layout;
}

}  // namespace haustra::window
