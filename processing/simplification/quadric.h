// The quadric error of Garland and Heckbert (SIGGRAPH 1997).
#pragma once

#include <glm/glm.hpp>

namespace haustra::simplification {

/// The weighted sum of squared distances to planes, xᵀAx + 2 bᵀx + c.
struct Quadric {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  ///< A
    glm::dvec3 b{0.0};
    double c = 0;
    double weight = 0;  ///< of the planes, together

    /// Adds the plane through `point` with the unit `normal`.
    void addPlane(const glm::dvec3& point, const glm::dvec3& normal, double planeWeight) {
        const glm::dvec3 n = normal * planeWeight;
        const double d = -glm::dot(normal, point);
        xx += n.x * normal.x;
        xy += n.x * normal.y;
        xz += n.x * normal.z;
        yy += n.y * normal.y;
        yz += n.y * normal.z;
        zz += n.z * normal.z;
        b += n * d;
        c += planeWeight * d * d;
        weight += planeWeight;
    }

    friend Quadric operator+(Quadric q, const Quadric& r) {
        q.xx += r.xx;
        q.xy += r.xy;
        q.xz += r.xz;
        q.yy += r.yy;
        q.yz += r.yz;
        q.zz += r.zz;
        q.b += r.b;
        q.c += r.c;
        q.weight += r.weight;
        return q;
    }

    glm::dvec3 timesA(const glm::dvec3& x) const {
        return {xx * x.x + xy * x.y + xz * x.z, xy * x.x + yy * x.y + yz * x.z,
                xz * x.x + yz * x.y + zz * x.z};
    }

    double operator()(const glm::dvec3& x) const { return glm::dot(x, timesA(x) + 2.0 * b) + c; }

    /// The place of least error, drawn to `anchor` in the directions that the planes leave open.
    glm::dvec3 minimiser(const glm::dvec3& anchor) const {
        // (A + λI) y = −(A anchor + b), x = anchor + y, with λ a thousandth of A's trace.
        const double open = 1e-3 * (xx + yy + zz) + 1e-12;
        const double a = xx + open, e = yy + open, i = zz + open;
        const glm::dvec3 r = -(timesA(anchor) + b);
        const double c00 = e * i - yz * yz, c01 = xz * yz - xy * i, c02 = xy * yz - xz * e;
        const double c11 = a * i - xz * xz, c12 = xy * xz - a * yz, c22 = a * e - xy * xy;
        const double determinant = a * c00 + xy * c01 + xz * c02;
        return anchor + glm::dvec3(c00 * r.x + c01 * r.y + c02 * r.z,
                                   c01 * r.x + c11 * r.y + c12 * r.z,
                                   c02 * r.x + c12 * r.y + c22 * r.z) /
                            determinant;
    }
};

}  // namespace haustra::simplification
