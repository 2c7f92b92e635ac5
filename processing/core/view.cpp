#include "core/view.h"

#include <algorithm>
#include <cmath>

namespace haustra {
namespace {

constexpr std::array names = {"endoscopic", "axial",          "coronal", "sagittal",
                              "flattened",  "flattened-zoom", "oblique", "overview"};
static_assert(names.size() == viewCount);

View kindOf(const Camera&) {
    return View::endoscopic;
}
View kindOf(const SliceView& slice) {
    return slice.plane;
}
View kindOf(const ObliqueView&) {
    return View::oblique;
}
View kindOf(const Overview&) {
    return View::overview;
}
View kindOf(const FlatWindow&) {
    return View::flattenedZoom;
}
View kindOf(const WholeStrip&) {
    return View::flattened;
}

}  // namespace

const char* toString(View view) {
    return names[std::size_t(view)];
}

Result<View> viewFromString(const std::string& text) {
    std::string all;
    for (const View view : allViews) {
        if (text == toString(view)) return view;
        all += (all.empty() ? "" : ", ") + std::string(toString(view));
    }
    return fail(ErrorKind::badInput, "no view named '" + text + "' (" + all + ")");
}

bool isSlice(View view) {
    return view == View::axial || view == View::coronal || view == View::sagittal;
}

bool isFlat(View view) {
    return view == View::flattened || view == View::flattenedZoom;
}

bool isGrey(View view) {
    return isSlice(view) || view == View::oblique;
}

bool showsWall(View view) {
    return !isGrey(view);
}

View viewOf(const ViewState& state) {
    return std::visit([](const auto& shown) { return kindOf(shown); }, state);
}

bool showsCleansed(const ViewState& state) {
    return std::visit(
        [](const auto& shown) {
            if constexpr (requires { shown.scan; })
                return shown.scan == Scan::cleansed;
            else
                return false;
        },
        state);
}

Result<void> checkWindow(const WindowLevel& window) {
    if (window.widthHu >= 1.0 && window.widthHu <= 65536.0 && std::abs(window.centerHu) <= 65536.0)
        return {};
    return fail(ErrorKind::badInput, "the window is not of 1 to 65536 HU around -65536 to 65536 HU",
                "slice");
}

Result<void> checkSlab(const Slab& slab) {
    if (slab.thicknessMm >= 0.0 && slab.thicknessMm <= maxSlabMm) return {};
    return fail(ErrorKind::badInput, "the slab's thickness is not within 0 to 100 mm", "slice");
}

Result<void> checkSlice(const SliceView& view) {
    if (!isSlice(view.plane))
        return fail(ErrorKind::badInput,
                    std::string("the view ") + toString(view.plane) + " is no slice", "slice");
    if (!isFinite(view.positionMm))
        return fail(ErrorKind::badInput, "the position is not finite", "slice");
    if (!(view.zoom >= 1.0 && view.zoom <= maxSliceZoom))
        return fail(ErrorKind::badInput, "the zoom is not within 1 to 64", "slice");
    if (!(std::abs(view.panMm.x) <= maxPanMm && std::abs(view.panMm.y) <= maxPanMm))
        return fail(ErrorKind::badInput, "the slice is moved by more than 10000 mm", "slice");
    TRY(checkSlab(view.slab));
    return checkWindow(view.window);
}

Result<void> checkOblique(const ObliqueView& view) {
    Camera plane{view.positionMm, view.forward, view.up};
    plane.lens = Lens::orthographic;
    TRY(checkCamera(plane));
    if (!(view.heightMm >= minObliqueMm && view.heightMm <= maxObliqueMm))
        return fail(ErrorKind::badInput, "the slice's height is not within 1 to 2000 mm", "slice");
    TRY(checkSlab(view.slab));
    return checkWindow(view.window);
}

Result<void> checkOverview(const Overview& view) {
    TRY(checkCamera(view.camera));
    if (view.camera.lens == Lens::fisheye)
        return fail(ErrorKind::badInput, "an overview is not seen through a fisheye lens",
                    "overview");
    if (view.reader) TRY(checkCamera(*view.reader));
    if (view.bookmarksMm.size() > maxOverviewBookmarks)
        return fail(ErrorKind::badInput,
                    "more than " + std::to_string(maxOverviewBookmarks) + " bookmarks", "overview");
    if (!std::all_of(view.bookmarksMm.begin(), view.bookmarksMm.end(), isFinite))
        return fail(ErrorKind::badInput, "a bookmark's coordinate is not a finite number",
                    "overview");
    return {};
}

}  // namespace haustra
