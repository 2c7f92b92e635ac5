// The colon's inner and outer surface as an implicit function.
#pragma once

#include "phantom/colon_path.h"

#include <algorithm>
#include <array>
#include <optional>
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
    glm::dvec3 center{0.0};       ///< of the head
    glm::dvec3 inward{0, 0, 1};   ///< unit, from the wall into the lumen
    glm::dvec3 root{0.0};         ///< its foot on the wall; of a stalk, a little beneath
    double rootDepthMm = 0.0;     ///< how far the root lies beneath the wall
    glm::dvec3 semiAxes{3.0};     ///< along two tangents of the wall, and along `inward`
    glm::dvec3 tangent{1, 0, 0};  ///< direction of the first semi-axis
    double stalkRadiusMm = 0.0;
    double footMm = 0.8;     ///< over this distance a lesion's side goes over into the wall
    std::uint64_t seed = 0;  ///< of its irregular outline and core
    double hu = 0.0;         ///< of stool

    /// Signed distance to its surface (first order).
    double distance(glm::dvec3 p) const;
    /// No part lies farther than this from `center`.
    double reachMm() const;
    bool stool() const { return kind == Kind::untaggedStool || kind == Kind::taggedStool; }
    bool polyp() const { return !stool() && kind != Kind::hyperplastic; }
};

/// A pouch of mucosa through the wall: a neck and a sac.
struct Diverticulum {
    glm::dvec3 mouth{0.0};   ///< on the lumen's boundary
    glm::dvec3 center{0.0};  ///< of the sac
    double sacRadiusMm = 3.0, neckRadiusMm = 1.4;

    static constexpr double wallMm = 1.2;
    /// Signed distance to its lumen.
    double distance(glm::dvec3 p) const;
};

/// The ileocecal valve: two lips about a slit, which stand out into the cecum.
struct Valve {
    glm::dvec3 at{0.0};          ///< middle of the orifice, on the colon's wall
    glm::dvec3 inward{0, 0, 1};  ///< unit, into the cecum
    glm::dvec3 along{1, 0, 0};   ///< unit, along the slit
    double arcMm = 0.0;
    bool open = false;
    double slitMm = 4.0;                  ///< width of the open slit
    glm::dvec3 semiAxes{14.0, 8.5, 9.0};  ///< of the mound: along the slit, across, inward

    /// Signed distance to the lips' tissue.
    double lips(glm::dvec3 p) const;
    /// Signed distance to the slit, which has no end in either direction.
    double slit(glm::dvec3 p) const;
    double heightMm(glm::dvec3 p) const { return glm::dot(p - at, inward); }
    double reachMm() const { return std::max({semiAxes.x, semiAxes.y, semiAxes.z}) + 1.0; }
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
    static constexpr double reachMm = 9.0;  ///< how far outside the wall `evaluate` is meaningful

    /// `septumMm`: the least distance between the lumens of two loops.
    ColonShape(ColonPath path, std::uint64_t seed, double septumMm = BowelOptions{}.septumMm);

    const ColonPath& path() const { return path_; }
    const std::vector<Growth>& growths() const { return growths_; }
    void add(const Growth& growth) { growths_.push_back(growth); }
    const std::vector<Diverticulum>& diverticula() const { return diverticula_; }
    void add(const Diverticulum& pouch) { diverticula_.push_back(pouch); }
    const std::optional<Valve>& valve() const { return valve_; }
    void setValve(const Valve& valve) { valve_ = valve; }
    double septumMm() const { return septumMm_; }

    /// Signed distance to the smooth tube about the axis, collapsed stretches as thick as their
    /// muscle; samples nearer along the axis than `beyondMm` to `arcMm` do not count. Slow.
    double smoothTubeMm(glm::dvec3 p, double arcMm = 0.0, double beyondMm = -1.0) const;

    /// What a block of space needs to know: segments of the axis and growths within reach of a
    /// ball.
    struct Nearby {
        std::vector<int> segments;
        std::vector<int> growths;
        std::vector<int> diverticula;
    };
    void findNearby(glm::dvec3 center, double radiusMm, Nearby& nearby) const;

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
    double septumMm_;
    std::vector<Growth> growths_;
    std::vector<Diverticulum> diverticula_;
    std::optional<Valve> valve_;
};

}  // namespace haustra::phantom
