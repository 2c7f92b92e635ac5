// A tube's conformal map by the general algorithm, over its double cover.
#pragma once

#include "flatten/general/holomorphic_forms.h"
#include "flatten/periodic_map.h"

namespace haustra::flatten {

struct DoubleCoverMap {
    PeriodicMap map;
    double modulus = 0.0;      ///< length over circumference, the map's height
    double certificate = 0.0;  ///< as in HolomorphicBasis: E(u)·E(v) − 1
};

/// The half of the double cover's rectangle that is the tube (dissertation §4.2.2): holomorphic
/// forms of the torus, the one whose period around the tube is 1, and its integral over the tube.
/// By symmetry its imaginary part vanishes along both boundary loops. It is what conformalTube
/// finds by the symmetric reduction, to solver precision, at several times the cost. `firstLoop` is
/// as there; of `options`, `kept` is set here, so that the intrinsic triangulation stays symmetric.
/// Fails as conformalTube.
Result<DoubleCoverMap> tubeMapFromDoubleCover(const TriMesh& tube, int firstLoop = -1,
                                              HolomorphicOptions options = {});

}  // namespace haustra::flatten
