#include "cover_iteration.h"

#include "core/parallel.h"
#include "flatten/general/double_cover.h"
#include "flatten/general/hodge_star.h"
#include "flatten/general/homology_basis.h"

#include <cstdio>
#include <cstdlib>
#include <utility>

namespace haustra::bench {
namespace {

template <class Value>
Value need(Result<Value> made) {
    if (made) return std::move(*made);
    std::fprintf(stderr, "%s\n", describe(made.error()).c_str());
    std::exit(EXIT_FAILURE);
}

}  // namespace

CoverIteration iterateCover(const TriMesh& tube, const flatten::IterationOptions& options) {
    const flatten::DoubleCover cover = need(flatten::doubleCover(tube));
    const flatten::HomologyBasis homology = need(flatten::homologyBasis(cover.halfedges));
    flatten::IntrinsicMesh mesh =
        flatten::intrinsicMesh(cover.halfedges, std::vector<std::int8_t>(homology.dual[0].size()));
    const int size = cover.halfedges.vertexCount();
    std::vector<int> unknownOf(std::size_t(size), -1);
    int used = 0;
    for (int v = 0; v < size; ++v) {
        if (cover.halfedges.outgoing(v) >= 0) unknownOf[std::size_t(v)] = used++;
    }

    const Stopwatch watch;
    CoverIteration made;
    flatten::IntrinsicMesh wound[] = {mesh, mesh};
    flatten::IteratedVector found[2];
    parallelFor(2, 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) {
            wound[k].turns = homology.dual[k];
            found[k] = flatten::conjugateGradient(
                flatten::cotangentLaplacian(mesh, unknownOf, used),
                flatten::pullOfTurns(wound[k], unknownOf, used), options);
        }
    });
    made.cost = watch.read();

    flatten::Matrix product(2, std::vector<double>(2)), wedge(2);
    for (std::size_t i = 0; i < 2; ++i) {
        made.iterations += found[i].iterations;
        made.converged = made.converged && found[i].converged;
        wedge[i].assign(homology.wedge[i].begin(), homology.wedge[i].end());
        const auto value = [&](std::size_t k, int h) {
            const auto at = [&](int v) {
                return found[k].x[std::size_t(unknownOf[std::size_t(v)])];
            };
            return double(homology.dual[k][std::size_t(h)]) + at(mesh.target(h)) -
                   at(mesh.origin[std::size_t(h)]);
        };
        for (std::size_t j = 0; j < 2; ++j) {
            for (int h = 0; h < mesh.halfedgeCount(); ++h)
                product[i][j] += 0.5 * flatten::cotangent(mesh, h) * value(i, h) * value(j, h);
        }
    }
    made.certificate = flatten::hodgeStar(product, wedge).certificate;
    return made;
}

}  // namespace haustra::bench
