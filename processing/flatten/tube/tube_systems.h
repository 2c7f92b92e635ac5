// A tube's two harmonic problems as sparse systems.
#pragma once

#include "flatten/cotangent_laplacian.h"
#include "flatten/tube/tube_topology.h"

#include <cstddef>
#include <vector>

namespace haustra::flatten {

/// Values per vertex of the mesh.
struct TubeSolution {
    std::vector<double> u;  ///< 0 on the first rim, 1 on the second
    std::vector<double> v;  ///< with the turns, of period 1; one rim vertex is at 0
};

/// What is held: u on the second rim is 1, all else 0.
TubeSolution heldValues(const TubeTopology& topology, std::size_t vertices);

enum class TubeFunction { u, v };

struct TubeSystem {
    std::vector<int> vertexOf;  ///< per unknown, breadth first from the first rim
    SymmetricMatrix matrix;     ///< positive definite: of u both rims are held, of v a rim vertex
    std::vector<double> right;

    /// Of the unknowns, into the values per vertex.
    void place(const std::vector<double>& x, std::vector<double>& values) const;
};

/// `vertices` is the mesh's number of them.
TubeSystem tubeSystem(const IntrinsicMesh& mesh, const TubeTopology& topology, std::size_t vertices,
                      TubeFunction which);

}  // namespace haustra::flatten
