// NIfTI's patient space is RAS; everywhere else it is LPS.
#pragma once

#include <glm/glm.hpp>

namespace haustra::nifti {

/// An affine to LPS as one to RAS, and back.
inline glm::dmat4 flipped(const glm::dmat4& affine) {
    const glm::dmat4 flip(-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    return flip * affine;
}

}  // namespace haustra::nifti
