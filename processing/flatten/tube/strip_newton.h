// One Newton step of a strip energy.
#pragma once

#include "core/result.h"
#include "flatten/tube/strip_energy.h"

#include <memory>
#include <vector>

namespace haustra::flatten {

/// Which coordinates move: x of all vertices but one, y of those inside, and one y for the whole
/// upper rim; and the sparse system that they share. The pattern is analysed once.
///
/// In a blind pouch the map shrinks by a constant factor each time its depth grows by its width,
/// and a triangle's stiffness is one over its flat area: its range can exceed a double's. The
/// smallest places are therefore eliminated first, so that what holds them, which is their larger
/// neighbours, is never lost in the rounding of what they hold.
class StripNewton {
public:
    struct Step {
        std::vector<glm::dvec2> move;  ///< per vertex
        double slope = 0.0;            ///< of the energy along it, ≤ 0
    };

    /// `lower` and `upper` are the rims' vertices, `stretch` per triangle its flat area over its
    /// area at the start.
    StripNewton(const TriMesh& tube, const std::vector<int>& lower, const std::vector<int>& upper,
                const std::vector<double>& stretch);
    ~StripNewton();

    /// Solves for the step; the scale, which is always at its best, is taken out of the system by
    /// its Schur complement. Fails (noResult) where the system is singular to rounding or memory
    /// runs out. One thread.
    Result<Step> step(const std::vector<StripEnergy::Derivatives>& triangles,
                      double scaleCurvature);

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace haustra::flatten
