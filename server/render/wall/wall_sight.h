// The wall as lines of sight meet it: on the CPU, without a picture.
#pragma once

#include "core/flat_map.h"
#include "core/result.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// A flat map's cut surface with a tree of its triangles (Embree). Immutable; any number of
/// threads. Patient space, mm.
class WallSight {
public:
    /// The map must be sound, as store::Case::readFlatMap gives it. Fails (device) where there is
    /// not enough memory. O(n log n), about a second for a million triangles, and some 200 bytes
    /// each. Equal maps give equal answers.
    /// `bridged`, for each triangle of the map, is not 0 where it is no wall but a bridge's
    /// (core/bridges.h); empty where there is no bridge.
    static Result<std::shared_ptr<const WallSight>> of(std::shared_ptr<const FlatMap> map,
                                                       std::vector<std::uint8_t> bridged = {});
    ~WallSight();
    WallSight(const WallSight&) = delete;
    WallSight& operator=(const WallSight&) = delete;

    /// What a triangle is to an eye.
    struct Facet {
        glm::vec3 middleMm{0.0f};  ///< from originMm()
        glm::vec3 inward{0.0f};    ///< unit, into the lumen; zero where it has no area
        float areaMm2 = 0.0f;
        glm::vec2 flat{0.0f};  ///< of its middle
        /// How long a millimetre on it is in the strip, in circumferences, in the direction in
        /// which it is the shortest; 0 where it has no area.
        float circumferencesPerMm = 0.0f;
    };
    const FlatMap& map() const { return *map_; }
    glm::dvec3 originMm() const { return originMm_; }
    const std::vector<Facet>& facets() const { return facets_; }
    double areaMm2() const { return areaMm2_; }  ///< of all triangles but bridges'
    bool isBridge(int triangle) const {
        return !bridged_.empty() && bridged_[std::size_t(triangle)] != 0;
    }
    bool hasBridges() const { return !bridged_.empty(); }
    /// For each triangle whether it is a bridge's; empty: none is.
    const std::vector<std::uint8_t>& bridges() const { return bridged_; }
    /// Across the edges of each triangle (core/missed_patches.h), the seam too.
    const std::vector<glm::ivec3>& neighbours() const { return neighbours_; }

    /// Where a ray first meets the surface, from whichever side.
    struct Place {
        int triangle = -1;
        glm::dvec2 flat{0.0};  ///< x in [0, 1)
        glm::dvec3 positionMm{0.0};
        double distanceMm = 0.0;
    };
    /// Empty where it meets nothing. `direction` is finite and not zero. Some microseconds.
    std::optional<Place> firstMet(glm::dvec3 fromMm, glm::dvec3 direction) const;

    /// Whether the surface stands between an eye and a triangle's middle. What lies within
    /// standOffMm of the middle does not count: it is the place itself. A microsecond.
    bool hides(glm::dvec3 eyeMm, int triangle) const;
    static constexpr float standOffMm = 0.3f;

private:
    struct Tree;
    explicit WallSight(std::shared_ptr<const FlatMap> map);
    std::shared_ptr<const FlatMap> map_;
    glm::dvec3 originMm_{0.0};
    std::vector<std::uint8_t> bridged_;  // empty: none is
    std::vector<Facet> facets_;
    std::vector<glm::ivec3> neighbours_;
    double areaMm2_ = 0.0;
    std::unique_ptr<Tree> tree_;
};

}  // namespace haustra::render
