// Laws of the core nouns: grids, volumes, meshes, loops over threads.
#include "core/durable_file.h"
#include "core/flood_fill.h"
#include "core/grid.h"
#include "core/optics.h"
#include "core/parallel.h"
#include "core/srgb.h"
#include "core/text_file.h"
#include "core/tri_mesh.h"
#include "core/volume.h"
#include "core/zeroed_array.h"
#include "temporary_folder.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace haustra {
namespace {

Grid obliqueGrid() {
    Grid grid = axisAlignedGrid({5, 7, 3}, {0.7, 0.9, 2.0}, {-10, 20, -30});
    const double a = 0.3;
    const glm::dmat4 turn(std::cos(a), std::sin(a), 0, 0, -std::sin(a), std::cos(a), 0, 0, 0, 0, 1,
                          0, 0, 0, 0, 1);
    grid.patientFromVoxel = turn * grid.patientFromVoxel;
    return grid;
}

TEST(Grid, IndexAndVoxelAreInverse) {
    const Grid grid = obliqueGrid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n)
        EXPECT_EQ(grid.index(grid.voxelAt(n)), n);
}

TEST(Grid, NeighboursAreThoseWithinOneStep) {
    const Grid grid = obliqueGrid();
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        std::vector<std::size_t> faces, corners, facesWanted, cornersWanted;
        visitFaces(grid, n, [&](std::size_t m, int axis) {
            const glm::ivec3 step = grid.voxelAt(m) - grid.voxelAt(n);
            EXPECT_EQ(std::abs(step[axis]), 1);
            faces.push_back(m);
        });
        visitCorners(grid, n, [&](std::size_t m) { corners.push_back(m); });
        for (std::size_t m = 0; m < grid.voxelCount(); ++m) {
            const glm::ivec3 step = glm::abs(grid.voxelAt(m) - grid.voxelAt(n));
            if (std::max({step.x, step.y, step.z}) == 1) cornersWanted.push_back(m);
            if (step.x + step.y + step.z == 1) facesWanted.push_back(m);
        }
        std::sort(faces.begin(), faces.end());
        EXPECT_EQ(faces, facesWanted);
        EXPECT_EQ(corners, cornersWanted);  // in memory order
    }
}

TEST(FloodFill, ReachesEachVoxelOnceByTheFewestSteps) {
    // A wall through the middle slice of i but for one voxel.
    const Grid grid = axisAlignedGrid({7, 5, 3}, {1, 1, 1});
    const auto isOpen = [&](std::size_t n) {
        const glm::ivec3 v = grid.voxelAt(n);
        return v.x != 3 || v == glm::ivec3(3, 4, 2);
    };
    std::vector<int> steps(grid.voxelCount(), -1);
    std::vector<std::size_t> reached{0};
    steps[0] = 0;
    const auto neighbours = [&](std::size_t n, const auto& visit) {
        visitFaces(grid, n, [&](std::size_t m, int) { visit(m, steps[n] + 1); });
    };
    floodFill(reached, neighbours, [&](std::size_t m, int count) {
        if (!isOpen(m) || steps[m] >= 0) return false;
        steps[m] = count;
        return true;
    });
    const glm::ivec3 door(3, 4, 2);
    const auto apart = [](glm::ivec3 a, glm::ivec3 b) {
        const glm::ivec3 d = glm::abs(a - b);
        return d.x + d.y + d.z;
    };
    std::size_t open = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        open += isOpen(n);
        const int wanted = v.x < 3 ? apart(v, {0, 0, 0}) : apart(v, door) + apart(door, {0, 0, 0});
        EXPECT_EQ(steps[n], isOpen(n) ? wanted : -1);
    }
    EXPECT_EQ(reached.size(), open);
    EXPECT_TRUE(std::is_sorted(reached.begin(), reached.end(),
                               [&](std::size_t a, std::size_t b) { return steps[a] < steps[b]; }));
}

TEST(Grid, PatientAndVoxelAreInverse) {
    const Grid grid = obliqueGrid();
    const glm::dvec3 voxel(1.25, 5.5, 0.75);
    EXPECT_LT(glm::distance(grid.voxelFromPatientPoint(grid.patientFromVoxelPoint(voxel)), voxel),
              1e-12);
    EXPECT_NEAR(grid.voxelVolumeMm3(), 0.7 * 0.9 * 2.0, 1e-12);
    EXPECT_LT(glm::distance(grid.spacingMm(), glm::dvec3(0.7, 0.9, 2.0)), 1e-12);
}

TEST(Grid, CheckRefusesWhatCannotBeAVolume) {
    EXPECT_TRUE(checkGrid(obliqueGrid(), "x"));
    Grid flat = obliqueGrid();
    flat.patientFromVoxel[2] = flat.patientFromVoxel[1];
    EXPECT_FALSE(checkGrid(flat, "x"));
    Grid nan = obliqueGrid();
    nan.patientFromVoxel[3][0] = std::nan("");
    EXPECT_FALSE(checkGrid(nan, "x"));
    Grid empty = obliqueGrid();
    empty.size.y = 0;
    EXPECT_FALSE(checkGrid(empty, "x"));
}

TEST(Grid, SameGridSeesAShiftOfATenthOfAMillimetre) {
    Grid a = obliqueGrid(), b = a;
    EXPECT_TRUE(sameGrid(a, b));
    b.patientFromVoxel[3][2] += 0.1;
    EXPECT_FALSE(sameGrid(a, b));
}

TEST(Volume, TrilinearIsExactOnALinearField) {
    const Grid grid = axisAlignedGrid({6, 5, 4}, {1, 1, 1});
    Volume<float> field(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        field.writable()[n] = float(2 * v.x - 3 * v.y + 5 * v.z);
    }
    EXPECT_NEAR(trilinear(field, {1.25, 2.5, 0.75}), 2 * 1.25 - 3 * 2.5 + 5 * 0.75, 1e-9);
    EXPECT_NEAR(trilinear(field, {-4, 0, 9}), 5 * 3, 1e-9);  // clamped to the edge
}

TEST(Volume, AViewOutlivesTheVolumeItCameFromAndCannotBeWritten) {
    Volume<std::int16_t> view;
    {
        Volume<std::int16_t> owner(axisAlignedGrid({4, 4, 4}, {1, 1, 1}), 7);
        view = owner.share();
    }
    EXPECT_EQ(view[63], 7);
    EXPECT_TRUE(view.writable().empty());
    EXPECT_EQ(view.clone().writable().size(), 64u);
}

TriMesh torus(int around, int along) {
    TriMesh mesh;
    for (int a = 0; a < along; ++a) {
        for (int b = 0; b < around; ++b) {
            const double u = 2 * M_PI * a / along, v = 2 * M_PI * b / around;
            mesh.vertices.push_back(
                {(3 + std::cos(v)) * std::cos(u), (3 + std::cos(v)) * std::sin(u), std::sin(v)});
            const int p = a * around + b, q = a * around + (b + 1) % around;
            const int r = (a + 1) % along * around + b,
                      s = (a + 1) % along * around + (b + 1) % around;
            mesh.triangles.push_back({p, r, q});
            mesh.triangles.push_back({q, r, s});
        }
    }
    return mesh;
}

TEST(TriMesh, TorusHasGenusOne) {
    const MeshTopology topology = meshTopology(torus(7, 11));
    EXPECT_TRUE(topology.closed());
    EXPECT_EQ(topology.components, 1);
    EXPECT_EQ(topology.eulerCharacteristic, 0);
    EXPECT_EQ(topology.genus(), 1);
}

TEST(TriMesh, AMissingTriangleIsABoundaryOfThreeEdges) {
    TriMesh mesh = torus(7, 11);
    mesh.triangles.pop_back();
    EXPECT_EQ(meshTopology(mesh).boundaryEdges, 3);
    EXPECT_FALSE(meshTopology(mesh).closed());
}

TEST(TriMesh, AFlippedTriangleIsNotManifold) {
    TriMesh mesh = torus(7, 11);
    std::swap(mesh.triangles[0].x, mesh.triangles[0].y);
    EXPECT_EQ(meshTopology(mesh).nonManifoldEdges, 3);
}

TEST(TransferFunction, IsLinearBetweenItsPointsAndGoesOnBeyondThem) {
    const std::vector<TransferFunctionPoint> points{{-100.0, {0.0, 0.5, 1.0}, 0.0},
                                                    {0.0, {1.0, 0.5, 0.0}, 0.2},
                                                    {0.0, {0.1, 0.1, 0.1}, 0.6},
                                                    {50.0, {0.3, 0.1, 0.5}, 1.0}};
    EXPECT_EQ(pointAt(points, -2000.0), points[0]);
    EXPECT_EQ(pointAt(points, -100.0), points[0]);
    EXPECT_EQ(pointAt(points, 50.0), points[3]);
    EXPECT_EQ(pointAt(points, 3000.0), points[3]);
    for (const double share : {0.25, 0.5, 0.9}) {
        const TransferFunctionPoint below = pointAt(points, -100.0 + 100.0 * share),
                                    above = pointAt(points, 50.0 * share);
        EXPECT_NEAR(glm::distance(below.color, glm::dvec3(share, 0.5, 1.0 - share)), 0.0, 1e-12);
        EXPECT_NEAR(below.opacity, 0.2 * share, 1e-12);
        EXPECT_NEAR(glm::distance(above.color, {0.1 + 0.2 * share, 0.1, 0.1 + 0.4 * share}), 0.0,
                    1e-12);
        EXPECT_NEAR(above.opacity, 0.6 + 0.4 * share, 1e-12);
    }
    // A step: before it the first holds, at it the second.
    EXPECT_NEAR(pointAt(points, -1e-9).opacity, 0.2, 1e-9);
    EXPECT_EQ(pointAt(points, 0.0), points[2]);
}

// Where the curve's two parts meet the standard's own constants leave a step of 4e-8.
TEST(Srgb, IsItsInversesInverseAndAnchoredWhereTheStandardSaysSo) {
    double before = -1.0;
    for (int n = 0; n <= 1000; ++n) {
        const double displayed = n / 1000.0, linear = linearLight(displayed);
        EXPECT_GT(linear, before);
        EXPECT_NEAR(displayedLight(linear), displayed, 1e-6);
        before = linear;
    }
    EXPECT_EQ(linearLight(0.0), 0.0);
    EXPECT_NEAR(linearLight(1.0), 1.0, 1e-12);
    EXPECT_NEAR(linearLight(0.5), 0.2140, 5e-5);  // the well-known middle grey
}

TEST(TextFile, IsReadWholeOrToldWhatIsWrong) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "file";
    const std::string bytes("a\0\x89\r\n", 5);
    std::string much;
    while (much.size() < 200000)
        much += bytes;
    for (const std::string& content : {std::string(), bytes, much}) {
        std::ofstream(file, std::ios::binary) << content;
        EXPECT_EQ(readTextFile(file), content);
    }
    const auto refused = [](const std::filesystem::path& path) {
        const auto read = readTextFile(path);
        EXPECT_FALSE(read) << path;
        return read ? Error{} : read.error();
    };
    EXPECT_EQ(refused(folder.path()).message, "this is a folder, not a file to read");
    EXPECT_EQ(refused(folder.path() / "none").kind, ErrorKind::notFound);
    EXPECT_EQ(refused(file / "within").kind, ErrorKind::notFound);
    // It opens, and cannot be read.
    EXPECT_EQ(refused("/proc/self/mem").kind, ErrorKind::io);
    EXPECT_EQ(refused("/proc/self/mem").place, "/proc/self/mem");
    // Of a bound no byte more.
    EXPECT_EQ(readTextFile(file, much.size()), much);
    const auto large = readTextFile(file, much.size() - 1);
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().kind, ErrorKind::badInput);
    const auto endless = readTextFile("/dev/zero", 100'000);
    ASSERT_FALSE(endless);
    EXPECT_EQ(endless.error().message, "is larger than 100000 bytes");
}

// The law: whoever looks sees one of the contents, whole, whatever fails and whoever else writes.
TEST(DurableFile, IsThereWholeOrAsItWas) {
    const tests::TemporaryFolder folder;
    const std::filesystem::path file = folder.path() / "file";
    const auto names = [&] {
        const std::filesystem::directory_iterator all(folder.path());
        return std::distance(begin(all), end(all));
    };
    ASSERT_TRUE(writeDurably(file, "as it was", 0600));
    EXPECT_EQ(std::filesystem::status(file).permissions(), std::filesystem::perms(0600));
    const auto failed = writeDurably(file, [](int descriptor) {
        EXPECT_EQ(::write(descriptor, "half", 4), 4);
        errno = ENOSPC;
        return false;
    });
    ASSERT_FALSE(failed);
    EXPECT_EQ(describe(failed.error()), file.string() + ": cannot write: No space left on device");
    { const DurableFile leftAlone(file); }
    EXPECT_EQ(readTextFile(file), "as it was");
    EXPECT_EQ(names(), 1);
    const auto nowhere = writeDurably(folder.path() / "none" / "file", "text");
    ASSERT_FALSE(nowhere);
    EXPECT_EQ(nowhere.error().kind, ErrorKind::io);
    EXPECT_EQ(nowhere.error().place, (folder.path() / "none" / "file").string());
    const DurableFile unmade(folder.path() / "none" / "file");
    errno = 0;  // whatever happens in between
    const auto isMade = unmade.isMade();
    ASSERT_FALSE(isMade);
    EXPECT_EQ(isMade.error().message, "cannot create: No such file or directory");
    EXPECT_EQ(describe(isMade.error()), describe(nowhere.error()));

    // Where files can be dropped, and the folder not read (by whoever is not root).
    const std::filesystem::path drop = folder.path() / "drop";
    using std::filesystem::perms;
    std::filesystem::create_directory(drop);
    std::filesystem::permissions(drop, perms::owner_write | perms::owner_exec);
    EXPECT_TRUE(writeDurably(drop / "file", "text"));
    std::filesystem::permissions(drop, perms::owner_all);
    EXPECT_EQ(readTextFile(drop / "file"), "text");
    std::filesystem::remove_all(drop);

    {
        std::vector<std::jthread> writers;
        for (char letter : {'a', 'b', 'c'})
            writers.emplace_back([&, letter] {
                for (int n = 0; n < 50; ++n)
                    EXPECT_TRUE(writeDurably(file, std::string(10'000, letter)));
            });
        for (int n = 0; n < 200; ++n) {
            const std::string seen = readTextFile(file).value_or("");
            EXPECT_TRUE(seen == "as it was" || seen == std::string(10'000, seen[0]));
        }
    }
    EXPECT_EQ(names(), 1);
}

TEST(Parallel, CoversEachIndexOnce) {
    for (int threads : {1, 2, 5}) {
        std::vector<std::atomic<int>> hits(1003);
        parallelFor(hits.size(), 10, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n)
                ++hits[n];
        });
        for (const auto& hit : hits)
            EXPECT_EQ(hit, 1);
    }
}

TEST(Parallel, EachIsDoneOnceByAThreadWithItsOwnScratch) {
    for (const int threads : {1, 3, 40}) {
        std::vector<std::atomic<int>> hits(101);
        std::atomic<int> scratches = 0;
        parallelForEach(
            hits.size(), threads,
            [&] { return std::pair(++scratches, std::this_thread::get_id()); },
            [&](std::size_t n, auto& scratch) {
                EXPECT_EQ(scratch.second, std::this_thread::get_id());
                ++hits[n];
            });
        for (const auto& hit : hits)
            EXPECT_EQ(hit, 1);
        EXPECT_GE(scratches, 1);
        EXPECT_LE(scratches, threads);
    }
    EXPECT_THROW(parallelForEach(
                     9, 3, [] { return 0; },
                     [](std::size_t n, int) {
                         if (n == 5) throw std::runtime_error("five");
                     }),
                 std::runtime_error);
    parallelForEach(
        0, 3, []() -> int { throw std::logic_error("no scratch for nothing"); },
        [](std::size_t, int) {});
}

TEST(ZeroedArray, IsZeroUntilItIsWrittenTo) {
    ZeroedArray<std::uint32_t> array(1 << 20);
    for (std::size_t n = 0; n < std::size_t(1) << 20; ++n)
        ASSERT_EQ(array[n], 0u);
    array[5] = 7;
    EXPECT_EQ(array[5], 7u);
    array = ZeroedArray<std::uint32_t>(8);
    EXPECT_EQ(array[5], 0u);
    const ZeroedArray<std::uint8_t> none(0);
}

TEST(Parallel, PiecesOfWorkAreDoneOnceEach) {
    for (const int threads : {1, 2, 40}) {
        std::atomic<int> first = 0, second = 0, third = 0;
        parallelInvoke(
            threads, [&] { ++first; }, [&] { parallelInvoke(threads, [&] { ++second; }); },
            [&] { third += 10; });
        EXPECT_EQ(first, 1);
        EXPECT_EQ(second, 1);
        EXPECT_EQ(third, 10);
    }
    std::vector<int> order;
    parallelInvoke(
        1, [&] { order.push_back(1); }, [&] { order.push_back(2); }, [&] { order.push_back(3); });
    EXPECT_EQ(order, (std::vector{1, 2, 3}));
    EXPECT_THROW(parallelInvoke(
                     2, [] {}, [] { throw std::runtime_error("the second"); }),
                 std::runtime_error);
}

TEST(Parallel, AnExceptionReachesTheCaller) {
    EXPECT_THROW(parallelFor(100, 1, 3,
                             [](std::size_t begin, std::size_t) {
                                 if (begin == 50) throw std::runtime_error("50");
                             }),
                 std::runtime_error);
}

// Ends the process: 0 where all of a loop was done, though of 40 threads some could have no stack.
[[noreturn]] void loopWithFewThreads() {
    std::size_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    const rlim_t room = pages * rlim_t(sysconf(_SC_PAGESIZE)) + (rlim_t(20) << 20);
    const rlimit limit{room, room};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(2);
    std::atomic<int> hits = 0;
    parallelFor(1000, 1, 40, [&](std::size_t begin, std::size_t end) {
        usleep(100);
        hits += int(end - begin);
    });
    _exit(hits == 1000 ? 0 : 1);
}

TEST(ParallelDeathTest, GoesOnWithTheThreadsThatThereAre) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer's own memory goes far beyond any limit";
#endif
    testing::GTEST_FLAG(death_test_style) = "threadsafe";  // none is left over from other tests
    EXPECT_EXIT(loopWithFewThreads(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace haustra
