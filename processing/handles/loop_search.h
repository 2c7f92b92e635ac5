// The shortest loop of a fine mesh whose cutting removes a handle.
#pragma once

#include "mesh/halfedge_mesh.h"

#include <cstdint>
#include <vector>

namespace haustra::handles {

struct LoopSearchOptions {
    int threads = 0;
    /// Loops whose marks add up to one of these are passed over, as if they separated.
    std::vector<std::uint64_t> passOver;
};

/// The shortest loop along edges that does not separate the surface (by `marks`, see
/// homologyMarks). `near` are vertices that loops of a coarser mesh pass, best first: what is found
/// through them bounds the search, which then visits the vertices where marked edges start, since
/// every loop that counts crosses such an edge. A front that closes nothing within 1.25 times
/// the bound rules out the base vertices close round its own. Empty where every loop separates, or
/// none is short of infinity. Where the shortest is some hundreds of edges long, the best that has
/// been found by then may be taken as it is. The same loop for any number of threads.
mesh::Loop shortestLoop(const mesh::HalfedgeMesh& mesh, const std::vector<std::uint64_t>& marks,
                        const std::vector<int>& near, const LoopSearchOptions& options = {});

}  // namespace haustra::handles
