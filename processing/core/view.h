// The views of a case, and what each of them can show. How it is drawn (colours, steps, paint) is
// the renderer's; how it crosses the network is protocol/view_message.h's.
#pragma once

#include "core/camera.h"
#include "core/result.h"
#include "core/strip_layout.h"

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

enum class View {
    endoscopic,
    axial,
    coronal,
    sagittal,
    flattened,      ///< the whole strip, in columns
    flattenedZoom,  ///< a window onto it
    oblique,        ///< a slice in any direction
    overview,       ///< the colon from outside
};
inline constexpr std::array allViews = {View::endoscopic, View::axial,     View::coronal,
                                        View::sagittal,   View::flattened, View::flattenedZoom,
                                        View::oblique,    View::overview};
inline constexpr std::size_t viewCount = allViews.size();

const char* toString(View view);
/// Fails (badInput), naming them all.
Result<View> viewFromString(const std::string& text);

/// Axial, coronal or sagittal.
bool isSlice(View view);
/// Of cases that have been flattened alone.
bool isFlat(View view);
/// Grey values through a window, oblique slices too; all others have a transfer function.
bool isGrey(View view);
/// Views of the wall, which paint colours.
bool showsWall(View view);

struct WindowLevel {
    double centerHu = 0.0;    ///< within ±65 536
    double widthHu = 2000.0;  ///< 1…65 536; wide enough for colon reading: −1000…1000
    bool operator==(const WindowLevel&) const = default;
};
Result<void> checkWindow(const WindowLevel& window);

/// Which of a case's two scans a slice shows.
enum class Scan { original, cleansed };

/// How the samples of a slab become one value.
enum class Projection { mean, maximum };

/// A slice of some thickness: `thicknessMm` of the scan along the slice's normal, half of it on
/// either side of the plane, by its mean or its greatest value. 0: the plane alone.
struct Slab {
    double thicknessMm = 0.0;  ///< 0…maxSlabMm
    Projection projection = Projection::mean;
    bool operator==(const Slab&) const = default;
};
inline constexpr double maxSlabMm = 100.0;
Result<void> checkSlab(const Slab& slab);

/// A slice through `positionMm`, radiological convention: axial seen from the feet (patient's
/// left on the picture's right), coronal from the front, sagittal from the patient's left.
/// At zoom 1 the whole slice fits the picture, centred, with square millimetres; zooming holds
/// `positionMm` where it is in the picture. Then the picture's content is moved by `panMm`, to the
/// right and down.
struct SliceView {
    View plane = View::axial;
    glm::dvec3 positionMm{0.0};
    double zoom = 1.0;  ///< 1…maxSliceZoom
    WindowLevel window{};
    Scan scan = Scan::original;
    glm::dvec2 panMm{0.0};  ///< of the patient; each within ±maxPanMm
    Slab slab{};
    bool operator==(const SliceView&) const = default;
};
inline constexpr double maxSliceZoom = 64.0, maxPanMm = 10'000.0;

/// A slice in any direction, as an orthographic camera at `positionMm` sees the plane before it:
/// `positionMm` is in the picture's middle, the picture's right is forward × up. Looking along the
/// colon's path it is the lumen's cross-section, the way the endoscopic view shows it.
struct ObliqueView {
    glm::dvec3 positionMm{0.0};
    glm::dvec3 forward{0.0, 0.0, 1.0};  ///< as of a camera: not parallel to `up`, any length
    glm::dvec3 up{0.0, -1.0, 0.0};
    double heightMm = 60.0;  ///< of the picture, minObliqueMm…maxObliqueMm
    WindowLevel window{};
    Scan scan = Scan::original;
    Slab slab{};
    bool operator==(const ObliqueView&) const = default;
};
inline constexpr double minObliqueMm = 1.0, maxObliqueMm = 2000.0;

/// The colon from outside (dissertation §6.3.2), within the body: the wall; the path in it, where
/// the reader is, and bookmarks, which show through what stands before them; the scan around it.
struct Overview {
    Camera camera;  ///< perspective or orthographic
    /// The reader's camera: a cone that opens forwards.
    std::optional<Camera> reader;
    std::vector<glm::dvec3> bookmarksMm;  ///< balls; at most maxOverviewBookmarks
    bool path = true;
    bool body = true;
    bool operator==(const Overview&) const = default;
};
inline constexpr std::size_t maxOverviewBookmarks = 1024;

/// All of the flattened strip: there is nothing to choose.
struct WholeStrip {
    bool operator==(const WholeStrip&) const = default;
};

/// What a view shows, one alternative for each kind of view; the endoscopic view's is its camera.
using ViewState = std::variant<Camera, SliceView, ObliqueView, Overview, FlatWindow, WholeStrip>;

/// What colours the wall, in all views that show it.
struct WallPaintChoice {
    bool marks = false;         ///< discs around the places that bookmarks mean, whoever added them
    bool unseen = false;        ///< what the reader has not seen
    double markRadiusMm = 5.0;  ///< minMarkRadiusMm…maxMarkRadiusMm
    bool any() const { return marks || unseen; }
    bool operator==(const WallPaintChoice&) const = default;
};
inline constexpr double minMarkRadiusMm = 1.0, maxMarkRadiusMm = 20.0;

/// Which view shows such a thing.
View viewOf(const ViewState& state);
/// Whether it needs the scan after digital cleansing.
bool showsCleansed(const ViewState& state);

// Each fails (badInput), saying which value is out of its bounds above, or is not finite.
Result<void> checkSlice(const SliceView& view);
Result<void> checkOblique(const ObliqueView& view);
Result<void> checkOverview(const Overview& view);

}  // namespace haustra
