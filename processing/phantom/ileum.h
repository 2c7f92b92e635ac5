// The gas-filled ileum, from the ileocecal valve on.
#pragma once

#include "phantom/colon_shape.h"
#include "phantom/tube.h"

#include <optional>

namespace haustra::phantom {

/// The last part of the small bowel: a tube that begins behind the valve, runs mostly wall to wall
/// with the colon, and ends blind: the bowel beyond is not part of the phantom.
class Ileum {
public:
    static constexpr double wallMm = 1.5;
    /// How far outside the lumen `at` is meaningful.
    static constexpr double reachMm = 6.0;

    double levelMm = -1e9;  ///< height of its fluid: −gravity · p
    double fluidHu = 15.0;

    Ileum(Tube tube, const Valve& valve, double septumMm, std::uint64_t seed);

    const Tube& tube() const { return tube_; }
    const Valve& valve() const { return valve_; }
    /// Signed distance to its lumen where the colon's lumen is `colonLumenMm` away: a septum stays
    /// between the two, but for the slit of an open valve. Large beyond reach.
    double lumenMm(glm::dvec3 p, double colonLumenMm) const;
    /// Signed distance to the outside of its wall.
    double outerMm(glm::dvec3 p) const;

private:
    double bare(glm::dvec3 p) const;

    Tube tube_;
    Valve valve_;
    double septumMm_;
    std::uint64_t roughness_;
};

/// Finds a place for the valve on the cecum's inner side, 50 to 75 mm above its end, sets it in the
/// shape, and lays the ileum out from there: a walk that hugs the colon's wall for runs of 60 to
/// 160 mm, keeps out of bones, abdominal wall and itself, and is `bowel.ileumMm` long, or as long
/// as there is room. Nothing where not even a short one fits.
std::optional<Ileum> addIleum(ColonShape& shape, std::uint64_t seed, const BodyPlan& body,
                              const BowelOptions& bowel);

}  // namespace haustra::phantom
