// What `haustra render` can be told.
#pragma once

#include "core/flat_map.h"
#include "render/scene/picture.h"
#include "render/scene/raycaster.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace CLI {
class App;
}

namespace haustra::cli {

/// As parsed and checked by themselves; what depends on the input is checked when it is read.
struct RenderArguments {
    std::string input;  ///< a case's name, or a scan's path
    std::filesystem::path store, out;
    std::string view;     ///< empty: endoscopic of a case, camera of a scan
    std::string product;  ///< empty: what the view shows by itself
    bool compare = false;

    std::optional<double> arcMm;
    std::vector<glm::dvec3> positionMm;
    std::optional<glm::dvec2> flat;
    std::string direction = "antegrade";
    double pixelsPerCircumference = FlatWindow{}.pixelsPerUnit;

    std::vector<glm::dvec3> eyeMm, lookMm, up;  ///< at most one each
    double azimuthDegrees = 0.0, elevationDegrees = 0.0;
    Lens lens = Lens::perspective;
    std::optional<double> fovDegrees, heightMm;

    std::vector<glm::dvec3> marksMm;
    bool body = true;

    std::string optics;                      ///< a preset's name or a file; empty: the view's own
    std::filesystem::path paint;             ///< a picture's file, or "findings"
    std::optional<double> leastProbability;  ///< of candidates that are painted, too
    RaycasterKind raycaster = RaycasterKind::singlePass;
    double gpuBudgetMiB = 0.0;
    std::filesystem::path labels;      ///< of a colour volume's voxels
    std::vector<int> shownLabels;      ///< empty: all
    std::optional<double> stepVoxels;  ///< empty: the view's own

    std::optional<WindowLevel> window;
    double zoom = 1.0;
    glm::ivec2 size{512, 512};
    bool caption = false;
    std::optional<glm::dvec3> spacingMm;  ///< of a scan in pictures; empty: 1,1,1
    int threads = 0;

    /// The input is a file or folder: it has a slash, or ends in .nii or .nii.gz.
    bool isScan() const;
    /// The view, with its default.
    View shown() const;
    bool isSlice() const;  ///< axial, coronal or sagittal
    bool isFlattened() const;
    bool paintsFindings() const;  ///< the case's own, not a picture
    bool castsRays() const;       ///< the raycaster draws at least a part of it
};

/// Adds all options to `command`; wrong usage throws CLI's errors when it is parsed, or when
/// checkUsage is called after that.
void addRenderOptions(CLI::App& command, RenderArguments& arguments);
void checkUsage(const CLI::App& command, const RenderArguments& arguments);

}  // namespace haustra::cli
