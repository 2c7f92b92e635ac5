// The findings of an open case: in which order they are read, where on the wall they are, and which
// of them a reader is shown.
#pragma once

#include "core/camera.h"
#include "core/centerline.h"
#include "core/detection_choice.h"
#include "core/findings.h"
#include "core/flat_lookup.h"
#include "core/result.h"
#include "render/wall/finding_paint.h"
#include "session/wall.h"
#include "store/case_store.h"

#include <memory>
#include <optional>
#include <vector>

namespace haustra::session {

/// Immutable; any number of threads.
struct CaseFindings {
    struct Entry {
        int number = 0;  ///< from 1: findings, then candidates, each as the product has them
        bool candidate = false;  ///< below the operating point
        /// Its top on the wall, with what looks at it. Of a case that has not been flattened the
        /// camera is the nearest place of the path, and both triangles are −1.
        WallPlace wall;
        /// From where it is seen, where a look from the path at the wall's arc does not show it.
        std::optional<Camera> view = {};
    };
    Findings product;
    /// In the order of numbers: a finding's is its index and 1.
    std::vector<Entry> entries;
    std::vector<int> alongColon;              ///< the indices of entries by arc
    std::vector<render::FindingPixel> paint;  ///< of the wall's strip; finding: index of entries

    const Finding& finding(int index) const {
        const auto above = int(product.findings.size());
        return index < above ? product.findings[std::size_t(index)]
                             : product.candidates[std::size_t(index - above)];
    }
    /// Whether a reader who has made this choice is shown it.
    bool isShown(int index, const DetectionChoice& choice) const;
    /// Of each entry.
    std::vector<render::FindingShade> shades(const DetectionChoice& choice) const;
};

/// Reads product "findings". `wall` may be missing, the centerline empty. Fails where the product
/// is damaged, or is not of this grid. Some tenths of a second where there is a wall, and a
/// millisecond or two for each finding.
Result<std::shared_ptr<const CaseFindings>> readFindings(const store::Case& source,
                                                         const Grid& grid,
                                                         const Centerline& centerline,
                                                         const Wall* wall);

/// What is to be known of findings that have been read.
std::shared_ptr<const CaseFindings> placeFindings(Findings findings, const Centerline& centerline,
                                                  const Wall* wall);

}  // namespace haustra::session
