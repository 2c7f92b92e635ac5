#include "handles/covering_loops.h"

#include "handles/covering_space.h"
#include "handles/loop_front.h"

#include <algorithm>
#include <limits>

namespace haustra::handles {

std::vector<mesh::Loop> coveringLoops(const mesh::HalfedgeMesh& mesh,
                                      const std::vector<std::uint64_t>& marks, double slack) {
    std::vector<mesh::Loop> loops;
    int root = 0;
    while (root < mesh.vertexCount() && mesh.outgoing(root) < 0)
        ++root;
    if (root == mesh.vertexCount()) return loops;
    const mesh::CutGraph graph = mesh::makeCutGraph(mesh, root);
    if (graph.basis.empty()) return loops;
    const FundamentalDomain domain = slice(mesh, graph);
    CoveringSpace cover(mesh, domain);

    struct Lift {
        int copy = 0;
        std::uint64_t marks = 0;
    };
    std::vector<Lift> lifts(std::size_t(mesh.vertexCount()));
    LoopFront front(mesh);
    double shortestMm = std::numeric_limits<double>::infinity();
    for (int base = 0; base < mesh.vertexCount(); ++base) {
        int h = mesh.outgoing(base);
        if (h < 0) continue;
        do {
            h = mesh.turnLeft(h);
        } while (!graph.cut[h] && h != mesh.outgoing(base));
        if (!graph.cut[h]) continue;

        lifts[base] = {};
        const auto reach = [&](int into) {
            const Lift& from = lifts[mesh.origin(into)];
            lifts[mesh.target(into)] = {cover.along(from.copy, into), from.marks ^ marks[into]};
        };
        const auto closes = [&](int over) {
            const Lift &from = lifts[mesh.origin(over)], &to = lifts[mesh.target(over)];
            return cover.along(from.copy, over) != to.copy &&
                   (from.marks ^ marks[over]) != to.marks;
        };
        const int closing = front.run(base, slack * shortestMm, reach, closes);
        if (closing < 0) continue;
        loops.push_back(front.loopOver(closing));
        shortestMm = std::min(shortestMm, loops.back().lengthMm);
    }
    std::stable_sort(loops.begin(), loops.end(), [](const mesh::Loop& a, const mesh::Loop& b) {
        return a.lengthMm < b.lengthMm;
    });
    return loops;
}

}  // namespace haustra::handles
