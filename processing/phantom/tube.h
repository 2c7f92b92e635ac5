// A tube about a curve through space.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::phantom {

/// The union, over each two nodes that follow one another, of the convex hull of their spheres:
/// round in section, its radius linear between nodes. Immutable, so any thread may ask.
class Tube {
public:
    struct Node {
        glm::dvec3 position{0.0};
        double radiusMm = 1.0;
    };
    struct Place {
        /// Signed distance to its surface, negative inside; infinite beyond the tube's reach.
        double distanceMm = std::numeric_limits<double>::infinity();
        double arcMm = 0.0;  ///< of the nearest place on the axis
    };

    Tube() = default;
    /// Distances of up to `reachMm` outside the surface can be asked for.
    Tube(std::vector<Node> nodes, double reachMm);

    const std::vector<Node>& nodes() const { return nodes_; }
    double lengthMm() const { return arcs_.empty() ? 0.0 : arcs_.back(); }
    Place at(glm::dvec3 p) const;

private:
    std::size_t indexOf(glm::ivec3 cell) const {
        return std::size_t(cell.x) +
               std::size_t(cells_.x) * (std::size_t(cell.y) + std::size_t(cells_.y) * cell.z);
    }

    static constexpr double cellMm = 12.0;
    std::vector<Node> nodes_;
    std::vector<double> arcs_;
    glm::dvec3 lowMm_{0.0};
    glm::ivec3 cells_{0};
    std::vector<std::vector<std::uint32_t>> segments_;  ///< by cell
};

}  // namespace haustra::phantom
