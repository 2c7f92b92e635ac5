// The arithmetic of a lens for numbers of any kind: plain ones, and those that carry derivatives.
#pragma once

#include "coverage/fisheye_lens.h"

#include <cmath>

namespace haustra::coverage {

/// s(θ)/sin θ · 1/|d| of the direction (x, y, z): times (x, y) it is s(θ)·(cos φ, sin φ), smooth on
/// the axis too. The projections but equidistance need no angle: half-angle formulas.
template <class T>
T raisedPerAside(Projection projection, const T& x, const T& y, const T& z) {
    using std::atan2, std::sqrt;
    const T aside2 = x * x + y * y, length = sqrt(aside2 + z * z);
    const T forward =
        z > T(0.0) ? length + z : aside2 / (length - z);  // length + z, no digits lost
    switch (projection) {
        case Projection::stereographic:
            return T(2.0) / forward;
        case Projection::equisolid:
            return sqrt(T(2.0) / (length * forward));
        case Projection::orthogonal:
            return T(1.0) / length;
        case Projection::perspective:
            return T(1.0) / z;
        case Projection::equidistance:
            break;
    }
    // On the axis the square root has no derivative; θ/tan θ = 1 − θ²/3 there.
    if (z > T(0.0) && aside2 < T(1e-12) * z * z) return (T(1.0) - aside2 / (T(3.0) * z * z)) / z;
    const T aside = sqrt(aside2);
    return atan2(aside, z) / aside;
}

/// The pixel of equations 2.6 to 2.8 with FisheyeLens' decentring; `k` has five numbers, the others
/// two. Says nothing of whether the direction is seen.
template <class T>
void projectTo(Projection projection, const T* k, const T* pixelsPerMm, const T* center,
               const T* decentring, const T& x, const T& y, const T& z, T* pixel) {
    const T raised = raisedPerAside(projection, x, y, z);
    const T a = x * raised, b = y * raised, t = a * a + b * b;
    const T radial = k[0] + t * (k[1] + t * (k[2] + t * (k[3] + t * k[4])));
    const T &p = decentring[0], &q = decentring[1];
    const T sideways = T(2.0) * p * a * b + q * (t + T(2.0) * a * a),
            upright = p * (t + T(2.0) * b * b) + T(2.0) * q * a * b;
    pixel[0] = pixelsPerMm[0] * (a * radial + k[0] * sideways) + center[0];
    pixel[1] = pixelsPerMm[1] * (b * radial + k[0] * upright) + center[1];
}

}  // namespace haustra::coverage
