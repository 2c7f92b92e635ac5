#include "flatten/tube/tube_systems.h"

namespace haustra::flatten {

TubeSolution heldValues(const TubeTopology& topology, std::size_t vertices) {
    TubeSolution held{std::vector<double>(vertices, 0.0), std::vector<double>(vertices, 0.0)};
    for (const int v : topology.rims[1])
        held.u[std::size_t(v)] = 1.0;
    return held;
}

void TubeSystem::place(const std::vector<double>& x, std::vector<double>& values) const {
    for (std::size_t n = 0; n < vertexOf.size(); ++n)
        values[std::size_t(vertexOf[n])] = x[n];
}

TubeSystem tubeSystem(const IntrinsicMesh& mesh, const TubeTopology& topology, std::size_t vertices,
                      TubeFunction which) {
    std::vector<char> isHeld(vertices, 0);
    isHeld[std::size_t(topology.rims[1].back())] = 1;
    for (const auto& rim : topology.rims) {
        for (const int v : rim)
            if (which == TubeFunction::u) isHeld[std::size_t(v)] = 1;
    }
    TubeSystem system;
    std::vector<int> unknownOf(vertices, -1);
    for (const int v : topology.breadthFirst) {
        if (isHeld[std::size_t(v)] != 0) continue;
        unknownOf[std::size_t(v)] = int(system.vertexOf.size());
        system.vertexOf.push_back(v);
    }
    const int size = int(system.vertexOf.size());
    system.matrix = cotangentLaplacian(mesh, unknownOf, size);
    system.right = which == TubeFunction::u
                       ? pullOfFixed(mesh, unknownOf, size, heldValues(topology, vertices).u)
                       : pullOfTurns(mesh, unknownOf, size);
    return system;
}

}  // namespace haustra::flatten
