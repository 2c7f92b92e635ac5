#include "flatten_meshes.h"

#include "contouring/dual_contouring.h"
#include "core/parallel.h"
#include "flatten/tube/end_holes.h"
#include "mesh/halfedge_mesh.h"
#include "mesh/mesh_file.h"
#include "simplification/simplification.h"
#include "store/case_store.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <queue>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace haustra::bench {
namespace {

constexpr double isoHu = -475.0;  // midway between the generated air and wall

/// The coil's tube: signed distance-like, negative inside.
double outsideCoil(const glm::dvec3& at) {
    constexpr double coilMm = 60.0, pitchMm = 75.0, turns = 2.0;
    const double rho = std::hypot(at.x, at.y), angle = std::atan2(at.y, at.x);
    double nearest = std::numeric_limits<double>::max();
    for (int turn = -1; turn <= 2; ++turn) {
        const double s = std::clamp(angle / (2.0 * std::numbers::pi) + turn, 0.0, turns);
        const double theta = 2.0 * std::numbers::pi * s;
        const glm::dvec3 center(coilMm * std::cos(theta), coilMm * std::sin(theta),
                                pitchMm * (s - 0.5 * turns));
        const double phi = std::atan2(at.z - center.z, rho - coilMm);
        // The ends are half balls.
        const double relief = std::min(1.0, 20.0 * std::min(s, turns - s));
        const double folds =
            relief * std::pow(0.5 + 0.5 * std::cos(2.0 * std::numbers::pi * 12.0 * s), 4.0);
        const double taeniae = relief * (0.5 + 0.5 * std::cos(3.0 * phi));
        const double radius = 24.0 - 5.0 * folds * (1.0 - taeniae) - 2.0 * taeniae;
        nearest = std::min(nearest, glm::distance(at, center) - radius);
    }
    return nearest;
}

Result<Tube> punched(std::string name, const TriMesh& closed, const glm::dvec3 ends[2],
                     const glm::dvec3 outwards[2]) {
    auto made = TRY(flatten::punchEnds(closed, ends, outwards));
    return Tube{std::move(name), std::move(made.tube)};
}

/// The vertex farthest from `start` along the edges.
int farthestFrom(const TriMesh& mesh, const mesh::HalfedgeMesh& edges, int start) {
    std::vector<double> distance(mesh.vertices.size(), std::numeric_limits<double>::max());
    using Reached = std::pair<double, int>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> front;
    front.push({distance[std::size_t(start)] = 0.0, start});
    int farthest = start;
    while (!front.empty()) {
        const auto [mm, v] = front.top();
        front.pop();
        if (mm > distance[std::size_t(v)]) continue;
        farthest = v;
        const int first = edges.outgoing(v);
        int h = first;
        do {
            const int w = edges.target(h);
            const double there = mm + edges.lengthMm(h);
            if (there < distance[std::size_t(w)]) front.push({distance[std::size_t(w)] = there, w});
            h = edges.turnLeft(h);
        } while (h >= 0 && h != first);
    }
    return farthest;
}

/// Signed distance-like, negative inside: 150 diverticula on the coil's wall, balls of 2.5 to 5 mm
/// behind necks of 1.5 mm (Ferzoco et al. 1998: most measure 5 to 10 mm), and a blind ileum of
/// 300 mm, 20 mm wide, in the coil's middle, which opens into its end.
class Pouches {
public:
    Pouches() {
        for (int n = 0; n < 150; ++n) {
            const double s = 0.05 + 1.85 * (n + 0.5) / 150, theta = 2.0 * std::numbers::pi * s;
            // Outwards, up and down in turn, by the golden angle.
            const double phi = std::remainder(2.399963 * n, 2.0 * std::numbers::pi) * 0.6;
            const double radius = 2.5 + 2.5 * ((n * 7) % 16) / 15.0;
            const glm::dvec3 out(std::cos(theta), std::sin(theta), 0.0), up(0.0, 0.0, 1.0);
            const glm::dvec3 center = 60.0 * out + glm::dvec3(0.0, 0.0, 75.0 * (s - 1.0));
            const glm::dvec3 away = std::cos(phi) * out + std::sin(phi) * up;
            balls_.push_back({center + (25.0 + radius) * away, radius});
            capsules_.push_back({center + 15.0 * away, center + (25.0 + radius) * away, 1.5});
        }
        glm::dvec3 before(46.0, 0.0, 75.0);
        for (double mm = 0.0; mm <= 300.0; mm += 2.0) {
            const double turn = 2.0 * std::numbers::pi * mm / 105.0;
            const double across = std::max(16.0, 46.0 - mm);
            const glm::dvec3 at(across * std::cos(turn), across * std::sin(turn), 75.0 - 0.42 * mm);
            capsules_.push_back({before, at, 10.0});
            before = at;
        }
    }
    double outside(const glm::dvec3& at) const {
        double nearest = std::numeric_limits<double>::max();
        for (const auto& [center, radius] : balls_)
            nearest = std::min(nearest, glm::distance(at, center) - radius);
        for (const auto& [a, b, radius] : capsules_) {
            const glm::dvec3 along = b - a;
            const double share = std::clamp(
                glm::dot(at - a, along) / std::max(glm::dot(along, along), 1e-9), 0.0, 1.0);
            nearest = std::min(nearest, glm::distance(at, a + share * along) - radius);
        }
        return nearest;
    }

private:
    struct Ball {
        glm::dvec3 center;
        double radius;
    };
    struct Capsule {
        glm::dvec3 a, b;
        double radius;
    };
    std::vector<Ball> balls_;
    std::vector<Capsule> capsules_;
};

}  // namespace

Result<Tube> generatedTube(double voxelMm, bool pouched) {
    const double halfMm = pouched ? 106.0 : 88.0, halfHeightMm = pouched ? 122.0 : 104.0;
    constexpr double blurMm = 1.0;
    const Pouches pouches;
    Grid grid;
    grid.size = {int(2.0 * halfMm / voxelMm), int(2.0 * halfMm / voxelMm),
                 int(2.0 * halfHeightMm / voxelMm)};
    for (int axis = 0; axis < 3; ++axis)
        grid.patientFromVoxel[axis][axis] = voxelMm;
    grid.patientFromVoxel[3] = {-halfMm, -halfMm, -halfHeightMm, 1.0};
    Volume<std::int16_t> hu(grid);
    Volume<std::uint8_t> lumen(grid);
    const auto huVoxels = hu.writable();
    const auto lumenVoxels = lumen.writable();
    parallelFor(std::size_t(grid.size.z), 1, 0, [&](std::size_t begin, std::size_t end) {
        for (int k = int(begin); k < int(end); ++k) {
            for (int j = 0; j < grid.size.y; ++j) {
                for (int i = 0; i < grid.size.x; ++i) {
                    const glm::dvec3 at =
                        grid.patientFromVoxelPoint({double(i), double(j), double(k)});
                    const double coil = outsideCoil(at);
                    const double outside = pouched ? std::min(coil, pouches.outside(at)) : coil;
                    const double value = isoHu + 525.0 * std::tanh(outside / blurMm);
                    huVoxels[grid.index(i, j, k)] = std::int16_t(std::lround(value));
                    lumenVoxels[grid.index(i, j, k)] = outside < 0.0;
                }
            }
        }
    });
    auto closed = contouring::contourLumen(hu, lumen, isoHu);
    if (closed && pouched) closed = simplification::simplify(*closed, {0.1});
    if (!closed) return tl::make_unexpected(closed.error());
    const glm::dvec3 ends[2] = {{60.0, 0.0, -75.0}, {60.0, 0.0, 75.0}};
    const glm::dvec3 outwards[2] = {{0.0, -1.0, 0.0}, {0.0, 1.0, 0.0}};
    return punched(pouched ? "generated coil with pouches, 0.1 mm" : "generated coil", *closed,
                   ends, outwards);
}

Result<Tube> tubeOfFile(const std::string& file) {
    auto read = TRY(mesh::readMesh(file));
    const auto edges = TRY(mesh::HalfedgeMesh::of(read));
    const std::string name = std::filesystem::path(file).stem().string();
    if (!edges.closed()) return Tube{name, std::move(read)};
    const int first = farthestFrom(read, edges, read.triangles[0].x);
    const int second = farthestFrom(read, edges, first);
    const glm::dvec3 ends[2] = {read.vertices[std::size_t(first)],
                                read.vertices[std::size_t(second)]};
    const glm::dvec3 outwards[2] = {glm::dvec3(0.0), glm::dvec3(0.0)};
    return punched(name, read, ends, outwards);
}

Result<Tube> tubeOfCase(const std::string& storeFolder, const std::string& caseName,
                        const SurfaceChoice& choice) {
    const auto opened =
        TRY(store::CaseStore::open(storeFolder, false).and_then([&](const auto& store) {
            return store.openCase(caseName);
        }));
    const auto centerline = TRY(opened.readCenterline());
    Result<TriMesh> closed;
    if (choice.product) {
        closed = opened.readMesh("surface");
    } else {
        const auto lumen = TRY(opened.readVolume<std::uint8_t>("lumen"));
        const std::string scan = opened.find("cleansed") ? "cleansed" : "ct";
        // A mask alone is contoured as the smoothest sheet that it allows.
        const auto hu = TRY(opened.find(scan) ? opened.readVolume<std::int16_t>(scan)
                                              : Volume<std::int16_t>(lumen.grid(), 0));
        closed = contouring::contourLumen(hu, lumen, -400.0);
        if (closed && choice.errorMm > 0.0)
            closed = simplification::simplify(*closed, {choice.errorMm});
    }
    if (!closed) return tl::make_unexpected(closed.error());
    const CenterlinePose first = poseAtArc(centerline, 0.0, 6.0),
                         last = poseAtArc(centerline, choice.until * centerline.lengthMm(), 6.0);
    const glm::dvec3 ends[2] = {first.point.positionMm, last.point.positionMm};
    const glm::dvec3 aside =
        glm::cross(last.tangent, std::abs(last.tangent.z) < 0.7 ? glm::dvec3(0.0, 0.0, 1.0)
                                                                : glm::dvec3(1.0, 0.0, 0.0));
    const glm::dvec3 outwards[2] = {-first.tangent,
                                    choice.until < 1.0 ? glm::normalize(aside) : last.tangent};
    const std::string which = choice.product         ? ", product"
                              : choice.errorMm > 0.0 ? fmt::format(", {} mm", choice.errorMm)
                                                     : ", finest";
    const std::string blind =
        choice.until < 1.0 ? fmt::format(", blind from {} of its length", choice.until) : "";
    return punched(caseName + which + blind, *closed, ends, outwards);
}

Tube subdivided(const Tube& tube) {
    Tube finer{tube.name + ", subdivided", {tube.mesh.vertices, {}}};
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
        const auto [at, isNew] =
            middles.try_emplace(std::minmax(a, b), int(finer.mesh.vertices.size()));
        if (isNew) {
            finer.mesh.vertices.push_back(
                0.5 * (tube.mesh.vertices[std::size_t(a)] + tube.mesh.vertices[std::size_t(b)]));
        }
        return at->second;
    };
    for (const glm::ivec3& t : tube.mesh.triangles) {
        const glm::ivec3 m{middle(t.x, t.y), middle(t.y, t.z), middle(t.z, t.x)};
        for (const glm::ivec3& quarter :
             {glm::ivec3(t.x, m.x, m.z), glm::ivec3(t.y, m.y, m.x), glm::ivec3(t.z, m.z, m.y), m})
            finer.mesh.triangles.push_back(quarter);
    }
    return finer;
}

}  // namespace haustra::bench
