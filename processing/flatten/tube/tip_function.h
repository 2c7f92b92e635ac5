// A measure of how far a place is from a tip of the surface, whose level lines are single loops.
#pragma once

#include "core/tri_mesh.h"
#include "mesh/halfedge_mesh.h"

#include <optional>
#include <vector>

namespace haustra::flatten {

struct TipFunction {
    int tip = -1;               ///< a vertex
    std::vector<double> value;  ///< per vertex: 0 at the tip, 1 beyond its neighbourhood
};

/// exp(−2π G / flux) for the discrete Green's function G of the disc around `tip` that reaches
/// `radiusMm` along edges, pockets that it encloses included: on a flat disc, the distance over the
/// radius. The weights are cotangents, but none is negative, so that by the maximum principle what
/// is below any level hangs together, and what is above it too: on a closed surface of genus 0
/// every level line is one loop. Nothing where the disc would be the whole surface. O(n) and a
/// solve over the disc.
std::optional<TipFunction> tipFunction(const TriMesh& closed, const mesh::HalfedgeMesh& halfedges,
                                       int tip, double radiusMm);

/// Length of the level line.
double levelLengthMm(const TriMesh& closed, const TipFunction& function, double level);

}  // namespace haustra::flatten
