// The colon's inner and outer surface as an implicit function.
#pragma once

#include "phantom/colon_path.h"

#include <array>
#include <span>
#include <vector>

namespace haustra::phantom {

/// A semilunar fold: a crescent in one sector between two taeniae.
struct Fold {
    double arcMm = 0.0;
    double heightMm = 0.0;  ///< at the sector's middle; 0 at the taeniae
    double thicknessMm = 2.4;
    double slantMm = 0.0;  ///< how far its two ends lie apart along the axis
};

/// Something that grows from the wall into the lumen, or lies on it.
struct Growth {
    enum class Kind { sessile, pedunculated, flat, hyperplastic, untaggedStool, taggedStool };
    Kind kind = Kind::sessile;
    glm::dvec3 centre{0.0};       ///< of the head
    glm::dvec3 inward{0, 0, 1};   ///< unit, from the wall into the lumen
    glm::dvec3 root{0.0};         ///< where a stalk meets the wall
    glm::dvec3 semiAxes{3.0};     ///< along two tangents of the wall, and along `inward`
    glm::dvec3 tangent{1, 0, 0};  ///< direction of the first semi-axis
    double stalkRadiusMm = 0.0;
    std::uint64_t seed = 0;  ///< of its irregular outline and core
    double hu = 0.0;         ///< of stool

    /// Signed distance to its surface (first order).
    double distance(glm::dvec3 p) const;
    /// No part lies farther than this from `centre`.
    double reachMm() const;
    bool stool() const { return kind == Kind::untaggedStool || kind == Kind::taggedStool; }
    bool polyp() const { return !stool() && kind != Kind::hyperplastic; }
};

/// The geometry at one point.
struct ColonPoint {
    double lumenMm =
        1e9;  ///< signed distance to the lumen's boundary (first order), negative inside
    double outerMm = 1e9;  ///< signed distance to the outer surface of the wall
    double arcMm = 0.0;    ///< of the nearest place on the axis
    int growth = -1;       ///< the growth whose tissue this is, if any (tagged stool excepted)
};

/// The colon of one patient: a tube about the path, flattened at three taeniae, sacculated between
/// its folds. Where loops touch, a septum of wall stays between them, however close they come.
class ColonShape {
public:
    static constexpr double wallMm = 2.5;
    static constexpr double septumMm = 3.2;  ///< least distance between the lumens of two loops
    static constexpr double reachMm = 9.0;   ///< how far outside the wall `evaluate` is meaningful

    ColonShape(ColonPath path, std::uint64_t seed);

    const ColonPath& path() const { return path_; }
    const std::vector<Growth>& growths() const { return growths_; }
    void add(const Growth& growth) { growths_.push_back(growth); }

    /// What a block of space needs to know: segments of the axis and growths within reach of a
    /// ball.
    struct Nearby {
        std::vector<int> segments;
        std::vector<int> growths;
    };
    void findNearby(glm::dvec3 centre, double radiusMm, Nearby& nearby) const;

    /// Geometry at p with any `nearby` found for a ball that contains p. Thread-safe.
    ColonPoint evaluate(glm::dvec3 p, const Nearby& nearby) const;
    /// The same for a single point; slow.
    ColonPoint evaluate(glm::dvec3 p) const;

private:
    struct Axial;
    void addFolds(std::uint64_t seed);
    double tube(glm::dvec3 p, const PathSample& s, double arcMm) const;

    ColonPath path_;
    std::array<std::vector<Fold>, 3> folds_;
    std::array<std::vector<int>, 3> foldAfter_;  ///< first fold at or beyond each sample
    std::uint64_t roughness_;
    std::vector<Growth> growths_;
};

}  // namespace haustra::phantom
