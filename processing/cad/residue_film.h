// Films and crumbs of tagged residue that cleansing has left on the wall, told by their brightness.
#pragma once

#include "cad/lesion.h"
#include "cad/wall_evidence.h"

#include <vector>

namespace haustra::cad {

/// What tagged residue would do to the wall's surface and to the HU behind it: of one scan.
///
/// A film about as thin as the scanner's blur never shows its own HU, and cleansing leaves some of
/// those that noise breaks up. Yet in the mean over a patch the HU behind the surface rise above
/// any soft tissue's and fall back to the wall's, which tissue alone cannot do: across an edge of
/// gas and tissue the blurred HU come up to the tissue's from below.
class ResidueFilms {
public:
    /// Measures on the scan the HU of tagging, where fluid lies deep, and the blur, on the wall's
    /// own edge. Without such fluid every patch has none.
    ResidueFilms(const PreparedColon& colon, const WallEvidence& evidence);

    /// How much farther in the lumen the surface of a patch lies for the tagging on it, mm, in the
    /// mean. With Φ the standard normal distribution, a film of thickness e and HU T between gas
    /// (G) and tissue (S), blurred by σ, has at x behind its face
    /// G + (T − G) Φ(x/σ) − (T − S) Φ((x − e)/σ): its greatest value tells e, and where it crosses
    /// the surface's HU tells how far that is from the tissue's edge. What is thick enough to come
    /// near T ends where the HU fall below (S + T)/2. 0 where the HU behind the surface are not
    /// more than 60 HU above soft tissue's: enhanced carcinomas are denser than muscle by 30 to 40
    /// (Oto et al., Eur Radiol 2003; 13: 1657). And 0 where they are so only from 2.5 σ on, or as
    /// far as 6 mm: bone or an opacified loop behind the wall.
    double liftMm(const PreparedColon& colon, const WallEvidence& evidence,
                  const Patch& patch) const;

private:
    double softHu_ = 0.0, blurMm_ = 0.0, taggedHu_ = 0.0;  ///< taggedHu_ 0: no tagging
    std::vector<double> peakHu_;   ///< the greatest HU of films of 0, 0.1, 0.2 mm …
    std::vector<double> liftsMm_;  ///< and how far they lift the surface
};

/// What would be left of an elevation `topMm` high, `meanMm` in the mean, without residue that
/// lifts its surface by `residueMm` in the mean and is spread as the elevation is.
double heightWithoutResidue(double topMm, double meanMm, double residueMm);

}  // namespace haustra::cad
