// A square lattice, however bent, among points of a picture.
#pragma once

#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::coverage {

struct LatticePoint {
    glm::dvec2 at{0.0};
    /// Of a corner of squares: the direction of a light quarter, radians modulo π; that of a
    /// neighbour is about at a right angle to it.
    std::optional<double> lightAngle;
    double area = 0.0;  ///< of a dot: its neighbours' are within a factor of 2.5
};

struct LatticeCell {
    glm::ivec2 cell{0};
    glm::dvec2 at{0.0};
    double area = 0.0;
};

/// Lattices that grow from points and their nearest neighbours: each next place is foretold from up
/// to three before it in its row, or from the step beside it, and the point nearest to it within a
/// third of a step taken. A cell stays where its neighbours agree with it on where it is. Lattices
/// that are at random are none, and growth ends at four times `enough`. The largest
/// first, of different sizes; the search ends at one of exactly `enough` cells.
/// Cost: 120 lattices of a few searches among the points a cell.
std::vector<std::vector<LatticeCell>> growLattices(std::vector<LatticePoint> points,
                                                   std::size_t enough);

}  // namespace haustra::coverage
