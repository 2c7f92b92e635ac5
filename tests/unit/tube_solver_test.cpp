// Laws of the steps from a tube's connectivity to its harmonic functions.
#include "flatten/tube/tube_solver.h"

#include "flatten/cotangent_laplacian.h"
#include "flatten/sparse_cholesky.h"
#include "flatten/tube/conjugate_gradient.h"
#include "flatten/tube/flip_repair.h"
#include "flatten/tube/shape_relaxation.h"
#include "tube_meshes.h"

#include <random>

#include <gtest/gtest.h>

using namespace haustra;
using namespace haustra::flatten;

namespace {

/// Irregular, with many obtuse angles.
TriMesh shakenTube(int around, int along, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shake(-0.4, 0.4);
    return tests::tubeMesh(around, along, [&](double a, double s) {
        if (s > 0.0 && s < 1.0) {
            a += shake(random) / around;
            s += shake(random) / along;
        }
        const double angle = 2.0 * std::numbers::pi * a;
        const double r = 10.0 + 2.0 * std::cos(3.0 * angle) + std::cos(17.0 * s);
        return glm::dvec3(r * std::cos(angle), r * std::sin(angle), 45.0 * s);
    });
}

struct Prepared {
    mesh::HalfedgeMesh edges;
    TubeTopology topology;
    IntrinsicMesh intrinsic;
};

Prepared prepare(const TriMesh& mesh) {
    auto edges = mesh::HalfedgeMesh::of(mesh);
    auto topology = tubeTopology(*edges, -1);
    IntrinsicMesh intrinsic = intrinsicMesh(*edges, topology->cornerTurns);
    return {std::move(*edges), std::move(*topology), std::move(intrinsic)};
}

/// The angle at the origin of each half-edge, summed per vertex.
std::vector<double> angleSums(const IntrinsicMesh& mesh, std::size_t vertices) {
    std::vector<double> sums(vertices, 0.0);
    for (int h = 0; h < mesh.halfedgeCount(); ++h)
        sums[std::size_t(mesh.origin[std::size_t(h)])] +=
            std::atan2(1.0, cotangent(mesh, mesh::HalfedgeMesh::next(h)));
    return sums;
}

void expectWholeTurns(const IntrinsicMesh& mesh) {
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        const int other = mesh.opposite[std::size_t(h)];
        if (h % 3 == 0) {
            EXPECT_EQ(mesh.turns[std::size_t(h)] + mesh.turns[std::size_t(h) + 1] +
                          mesh.turns[std::size_t(h) + 2],
                      0);
        }
        if (other < 0) continue;
        ASSERT_EQ(mesh.opposite[std::size_t(other)], h);
        EXPECT_EQ(mesh.turns[std::size_t(h)], -mesh.turns[std::size_t(other)]);
        EXPECT_EQ(mesh.length[std::size_t(h)], mesh.length[std::size_t(other)]);
        EXPECT_EQ(mesh.origin[std::size_t(h)], mesh.target(other));
    }
}

/// Turns along each rim, in the rim's own direction.
std::vector<int> rimTurns(const IntrinsicMesh& mesh, const TubeTopology& topology) {
    std::vector<int> rimOf(mesh.origin.size(), -1), turns(2, 0);
    for (int rim = 0; rim < 2; ++rim) {
        for (const int v : topology.rims[rim])
            rimOf[std::size_t(v)] = rim;
    }
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        if (mesh.opposite[std::size_t(h)] < 0)
            turns[std::size_t(rimOf[std::size_t(mesh.origin[std::size_t(h)])])] +=
                mesh.turns[std::size_t(h)];
    }
    return turns;
}

}  // namespace

TEST(TubeTopology, CutsOneTurnFromTheTube) {
    const Prepared tube = prepare(shakenTube(20, 15, 1));
    expectWholeTurns(tube.intrinsic);
    // The rims run against each other.
    const std::vector<int> turns = rimTurns(tube.intrinsic, tube.topology);
    EXPECT_EQ(std::abs(turns[0]), 1);
    EXPECT_EQ(turns[0], -turns[1]);
}

TEST(TubeTopology, LevelsAreEdgesApart) {
    const TriMesh mesh = shakenTube(20, 15, 1);
    const Prepared tube = prepare(mesh);
    const std::vector<int>& starts = tube.topology.levelStart;
    std::vector<int> levelOf(mesh.vertices.size(), -1);
    for (std::size_t level = 0; level + 1 < starts.size(); ++level) {
        EXPECT_LT(starts[level], starts[level + 1]);
        for (int n = starts[level]; n < starts[level + 1]; ++n)
            levelOf[std::size_t(tube.topology.breadthFirst[std::size_t(n)])] = int(level);
    }
    EXPECT_EQ(starts.back(), int(mesh.vertices.size()));
    std::vector<int> nearest(mesh.vertices.size(), 1 << 20);
    for (const glm::ivec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c) {
            const auto a = std::size_t(t[c]), b = std::size_t(t[(c + 1) % 3]);
            nearest[a] = std::min(nearest[a], levelOf[b]);
            nearest[b] = std::min(nearest[b], levelOf[a]);
        }
    }
    for (const int v : tube.topology.rims[0])
        EXPECT_EQ(levelOf[std::size_t(v)], 0);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        if (levelOf[v] > 0) {
            EXPECT_EQ(nearest[v], levelOf[v] - 1);
        }
    }
}

TEST(IntrinsicDelaunay, KeepsTheSurfaceAndItsTurns) {
    const TriMesh mesh = shakenTube(40, 30, 2);
    Prepared tube = prepare(mesh);
    const std::vector<double> before = angleSums(tube.intrinsic, mesh.vertices.size());
    const std::vector<int> turnsBefore = rimTurns(tube.intrinsic, tube.topology);
    EXPECT_GT(countNegative(tube.intrinsic), 100);
    EXPECT_GT(makeDelaunay(tube.intrinsic), 100);
    EXPECT_EQ(countNegative(tube.intrinsic), 0);
    expectWholeTurns(tube.intrinsic);
    EXPECT_EQ(rimTurns(tube.intrinsic, tube.topology), turnsBefore);
    const std::vector<double> after = angleSums(tube.intrinsic, mesh.vertices.size());
    for (std::size_t v = 0; v < before.size(); ++v)
        EXPECT_NEAR(after[v], before[v], 1e-9);
}

TEST(IntrinsicDelaunay, GivesTrianglesWithoutAreaSome) {
    TriMesh mesh = shakenTube(12, 10, 3);
    mesh.vertices[50] = mesh.vertices[51];
    const Prepared tube = prepare(mesh);
    for (int h = 0; h < tube.intrinsic.halfedgeCount(); ++h)
        EXPECT_TRUE(std::isfinite(cotangent(tube.intrinsic, h)));
    EXPECT_NEAR(tube.intrinsic.length[0], tube.edges.lengthMm(0), 1e-9);
}

TEST(SparseCholesky, SolvesAndGivesSchurComplements) {
    const TriMesh mesh = shakenTube(9, 12, 4);
    const Prepared tube = prepare(mesh);
    // One vertex is held, the rest is in groups.
    const int size = int(mesh.vertices.size()) - 1, first = 60;
    std::vector<int> unknownOf(mesh.vertices.size(), -1);
    for (int n = 0; n < size; ++n)
        unknownOf[std::size_t(n)] = (n * 37) % size;
    const SymmetricMatrix matrix = cotangentLaplacian(tube.intrinsic, unknownOf, size);
    const auto count = std::size_t(size);
    std::vector<std::vector<double>> dense(count, std::vector<double>(count, 0.0));
    for (int c = 0; c < size; ++c) {
        for (int n = matrix.columnStart[std::size_t(c)]; n < matrix.columnStart[std::size_t(c) + 1];
             ++n) {
            const int r = matrix.row[std::size_t(n)];
            dense[std::size_t(r)][std::size_t(c)] = dense[std::size_t(c)][std::size_t(r)] =
                matrix.value[std::size_t(n)];
        }
    }
    auto factor = SparseCholesky::of(matrix, {40, first});
    ASSERT_TRUE(factor);
    std::vector<double> right(std::size_t(size), 0.0);
    for (int n = 0; n < size; ++n)
        right[std::size_t(n)] = std::sin(double(n));
    const std::vector<double> x = factor->solve(right);
    for (std::size_t r = 0; r < std::size_t(size); ++r) {
        double sum = 0.0;
        for (std::size_t c = 0; c < std::size_t(size); ++c)
            sum += dense[r][c] * x[c];
        EXPECT_NEAR(sum, right[r], 1e-11);
    }
    // Gaussian elimination of all before `first` leaves what the trailing block squares to.
    for (std::size_t k = 0; k < std::size_t(first); ++k) {
        for (std::size_t r = k + 1; r < std::size_t(size); ++r) {
            const double share = dense[r][k] / dense[k][k];
            for (std::size_t c = k; c < std::size_t(size); ++c)
                dense[r][c] -= share * dense[k][c];
        }
    }
    const std::vector<double> block = factor->trailing(first);
    const auto side = std::size_t(size - first);
    for (std::size_t r = 0; r < side; ++r) {
        for (std::size_t c = 0; c < side; ++c) {
            double sum = 0.0;
            for (std::size_t k = 0; k < side; ++k)
                sum += block[k * side + r] * block[k * side + c];
            EXPECT_NEAR(sum, dense[r + std::size_t(first)][c + std::size_t(first)], 1e-11);
        }
    }
}

TEST(SparseCholesky, RefusesASingularMatrix) {
    const TriMesh mesh = shakenTube(9, 5, 4);
    const Prepared tube = prepare(mesh);
    SymmetricMatrix matrix{2, {0, 2, 3}, {0, 1, 1}, {1.0, -1.0, -3.0}};
    const auto factor = SparseCholesky::of(matrix);
    ASSERT_FALSE(factor);
    EXPECT_EQ(factor.error().kind, ErrorKind::noResult);
}

/// Long tubes are solved in halves, short ones whole; with edges flipped across the cut or not.
TEST(TubeSolver, AgreesWithIteration) {
    for (const int along : {1, 2, 3, 4, 8, 50}) {
        for (const bool delaunay : {false, true}) {
            const TriMesh mesh = shakenTube(24, along, unsigned(along));
            Prepared tube = prepare(mesh);
            if (delaunay) makeDelaunay(tube.intrinsic);
            const auto direct = solveTube(tube.intrinsic, tube.topology, mesh.vertices.size(), 2);
            ASSERT_TRUE(direct) << describe(direct.error());
            IterationOptions options;
            options.tolerance = 1e-13;
            const auto iterated =
                iterateTube(tube.intrinsic, tube.topology, mesh.vertices.size(), options);
            for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
                EXPECT_NEAR(direct->u[v], iterated.values.u[v], 1e-10) << along;
                EXPECT_NEAR(direct->v[v], iterated.values.v[v], 1e-10) << along;
            }
            for (const int v : tube.topology.rims[1])
                EXPECT_EQ(direct->u[std::size_t(v)], 1.0);
        }
    }
}

TEST(TubeSolver, SolvesTubesWithLongRimsAsItDoesOthers) {
    struct Tube {
        int around, along;
    };
    for (const auto [around, along] : {Tube{40, 60}, Tube{300, 20}, Tube{2100, 2}, Tube{7, 1}}) {
        const TriMesh mesh = shakenTube(around, along, 5);
        Prepared tube = prepare(mesh);
        makeDelaunay(tube.intrinsic);
        const auto solved = [&](Elimination elimination, int threads) {
            return solveTube(tube.intrinsic, tube.topology, mesh.vertices.size(), threads, {},
                             elimination);
        };
        const auto halves = solved(Elimination::byHalves, 2),
                   separate = solved(Elimination::separately, 2);
        ASSERT_TRUE(halves && separate);
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
            EXPECT_NEAR(separate->u[v], halves->u[v], 1e-11) << around;
            EXPECT_NEAR(separate->v[v], halves->v[v], 1e-10) << around;
        }
        const auto alone = solved(Elimination::separately, 1);
        EXPECT_EQ(alone->u, separate->u);
        EXPECT_EQ(alone->v, separate->v);
        const auto suited = solved(Elimination::suited, 2);
        EXPECT_EQ(suited->v, (around > 1000 ? separate : halves)->v) << around;
    }
}

/// A cylinder unrolled, of which some vertices are pulled away.
TEST(FlipRepair, RestoresAMapThatKeepsShapes) {
    const int around = 20, along = 20;
    const TriMesh mesh = tests::revolvedMesh(around, along, 12.0, [](double) { return 3.0; });
    PeriodicMap exact;
    const double girth = 2.0 * around * 3.0 * std::sin(std::numbers::pi / around);
    exact.height = 12.0 / girth;
    exact.turns.assign(mesh.triangles.size(), {0, 0, 0});
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
        exact.flat.push_back({double(int(v) % around) / around, mesh.vertices[v].z / girth});
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int c = 0; c < 3; ++c) {
            if (int(t / 2) % around == around - 1 && mesh.triangles[t][c] % around == 0)
                exact.turns[t][std::size_t(c)] = 1;
        }
    }
    PeriodicMap folded = exact;
    for (const int v : {90, 105, 119, 200, 201, 222})
        folded.flat[std::size_t(v)] += glm::dvec2(0.08, -0.06);
    const VertexStars stars(mesh);
    const std::vector<int> moved = unfold(folded, mesh, stars);
    EXPECT_FALSE(moved.empty());
    std::vector<int> inside;
    for (int v = around; v < around * along; ++v)
        inside.push_back(v);
    EXPECT_TRUE(stretchedVertices(exact, mesh, stars, 1.001).empty());
    relaxShapes(folded, mesh, stars, inside, 600);
    for (std::size_t v = 0; v < exact.flat.size(); ++v) {
        EXPECT_NEAR(folded.flat[v].x, exact.flat[v].x, 1e-4);
        EXPECT_NEAR(folded.flat[v].y, exact.flat[v].y, 1e-4);
    }
}
