// Times simulated colonoscopies of a prepared case; holds the search against every ray, and the
// GPU's item buffer and occlusion queries against rays. usage: coverage_bench STORE CASE [CAMERAS
// [CHECKED [GPU_CAMERAS]]]
#include "core/bridges.h"
#include "coverage/corner_path.h"
#include "coverage/fine_wall.h"
#include "coverage/sight.h"
#include "gpu/context.h"
#include "occlusion_queries.h"
#include "render/gl/flat_surface.h"
#include "render/wall/item_buffer.h"
#include "render/wall/wall_coverage.h"
#include "render/wall/wall_index.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

namespace {

using namespace haustra;
using namespace haustra::coverage;

struct Clock {
    double wall = bench::milliseconds(), cpu = bench::cpuMilliseconds();
    void print(const char* what, double per = 0.0) const {
        const double w = bench::milliseconds() - wall, c = bench::cpuMilliseconds() - cpu;
        std::printf("%-44s %8.2f s, processor %8.2f s", what, w / 1e3, c / 1e3);
        if (per > 0.0) std::printf("  %7.2f ms, processor %7.2f ms each", w / per, c / per);
        std::printf("\n");
        std::fflush(stdout);
    }
};

void print(const char* what, const TriMesh& mesh, const std::vector<std::uint8_t>& bridged,
           const std::vector<Visibility>& seen) {
    double all = 0.0, part = 0.0, full = 0.0;
    long triangles = 0, observed = 0;
    for (std::size_t n = 0; n < seen.size(); ++n) {
        if (bridged[n]) continue;
        const glm::ivec3 t = mesh.triangles[n];
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
        const double area = 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - a,
                                                         mesh.vertices[std::size_t(t.z)] - a));
        all += area, ++triangles;
        if (seen[n] == Visibility::unseen) continue;
        part += area, ++observed;
        if (seen[n] == Visibility::fully) full += area;
    }
    std::printf("  %s: %.2f %% of area, %.2f %% of triangles; fully %.2f %%\n", what,
                100.0 * part / all, 100.0 * observed / triangles, 100.0 * full / all);
}

/// Whether rays that start a hair beside the pixels' centres tell of a triangle what the other way
/// to see tells: in each pixel that shows it to rays one of them misses it, or, where rays do not
/// see it, one of them meets it in some pixel. So only where a silhouette or a triangle's edge runs
/// through the pixel's centre.
bool isSilhouette(const WallRays& rays, const Eyepiece& eyepiece, const PinholePicture& picture,
                  std::span<const CenterlineCamera> cameras, std::size_t triangle,
                  bool seenByRays) {
    // Rasters round corners to 1/256 of a pixel: an edge moves by a little less than this.
    constexpr double hair = 1.0 / 256.0;
    const double pixel = 2.0 * std::tan(glm::radians(0.5 * picture.fovDegrees)) / picture.side;
    for (const CenterlineCamera& camera : cameras) {
        const Pose pose(camera, rays.originMm());
        if (!rays.faces(triangle, pose.eye)) continue;
        std::array<glm::vec3, 3> corners;
        for (int n = 0; n < 3; ++n)
            corners[std::size_t(n)] = pose.toCamera(rays.facet(triangle).corners[n] - pose.eye);
        const glm::vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0f;
        if (!eyepiece.mayShow(
                middle, glm::distance(middle, corners[0]) + glm::distance(middle, corners[1])))
            continue;
        const PixelBox box = eyepiece.boxOf(corners);
        for (int y = box.low.y - 1; y <= box.high.y + 1; ++y) {
            for (int x = box.low.x - 1; x <= box.high.x + 1; ++x) {
                if (x < 0 || y < 0 || x >= picture.side || y >= picture.side) continue;
                const auto meets = [&](double dx, double dy) {
                    const glm::dvec3 along((x + 0.5 + dx - 0.5 * picture.side) * pixel,
                                           (y + 0.5 + dy - 0.5 * picture.side) * pixel, 1.0);
                    return rays.firstMet(pose.eye, pose.toWorld(glm::vec3(glm::normalize(along))),
                                         eyepiece.nearestMm(), eyepiece.farthestMm())
                               .triangle == int(triangle);
                };
                bool any = false, all = true;
                for (int n = 0; n < 8; ++n) {
                    const double turn = 0.25 * std::numbers::pi * n;
                    const bool met = meets(hair * std::cos(turn), hair * std::sin(turn));
                    any |= met, all &= met;
                }
                if (seenByRays && meets(0.0, 0.0) && all) return false;
                if (!seenByRays && any) return true;
            }
        }
    }
    return seenByRays;
}

/// Where two ways to see differ, and whether they do so at silhouettes alone.
void compare(const char* what, const TriMesh& mesh, const std::vector<std::uint8_t>& bridged,
             const std::vector<Visibility>& a, const std::vector<Visibility>& byRays,
             const std::vector<int>& pictures, const auto& isSilhouette) {
    const auto observed = [](const std::vector<Visibility>& seen, std::size_t n) {
        return seen[n] != Visibility::unseen;
    };
    long all = 0, differ = 0, silhouettes = 0, otherwise = 0, mostPictures = 0;
    double allMm2 = 0.0, differMm2 = 0.0;
    for (std::size_t n = 0; n < a.size(); ++n) {
        if (bridged[n]) continue;
        const glm::ivec3 t = mesh.triangles[n];
        const glm::dvec3 v = mesh.vertices[std::size_t(t.x)];
        const double area = 0.5 * glm::length(glm::cross(mesh.vertices[std::size_t(t.y)] - v,
                                                         mesh.vertices[std::size_t(t.z)] - v));
        ++all, allMm2 += area;
        otherwise += a[n] != byRays[n];
        if (observed(a, n) == observed(byRays, n)) continue;
        ++differ, differMm2 += area;
        mostPictures = std::max(mostPictures, long(pictures[n]));
        silhouettes += isSilhouette(n, observed(byRays, n));
    }
    // That a triangle does not pass this by chance.
    constexpr std::size_t asked = 400;
    long others = 0, passed = 0;
    for (std::size_t n = 0; n < a.size(); n += std::max<std::size_t>(1, a.size() / asked)) {
        if (bridged[n] || observed(a, n) != observed(byRays, n)) continue;
        ++others;
        passed += isSilhouette(n, observed(byRays, n));
    }
    std::printf(
        "%s: agree on %.4f %% of triangles, %.4f %% of area; %ld differ, %ld of them at "
        "silhouettes (1/256 of a pixel beside the centre, rays agree; so do they of %ld in %ld on "
        "which both agree); none of them is seen in more than %ld pictures; partly against fully "
        "on %ld more\n",
        what, 100.0 * double(all - differ) / double(all), 100.0 * (1.0 - differMm2 / allMm2),
        differ, silhouettes, passed, others, mostPictures, otherwise - differ);
}

Result<void> compareWithGpu(const store::Case& source, const FineWall& fine,
                            const std::vector<std::uint8_t>& bridged, const SightTree& tree,
                            const std::vector<CenterlineCamera>& cameras) {
    const PinholePicture picture;
    const Eyepiece eyepiece = Eyepiece::of(picture);
    auto context = TRY(gpu::Context::create());
    std::printf("%s\n", context->renderer().c_str());
    Clock start;
    auto items = TRY(render::ItemBuffer::create(*context, fine.mesh, bridged, picture, true));
    start.print("item buffer: set up");
    start = {};
    for (const CenterlineCamera& camera : cameras)
        TRY(items->look(camera));
    const auto byItems = items->seen();
    start.print("item buffer", double(cameras.size()));
    std::vector<Visibility> byRays(byItems.size(), Visibility::unseen);
    start = {};
    TRY(look(tree, eyepiece, cameras, byRays, {.tellFully = true}));
    start.print("rays, the same pictures", double(cameras.size()));
    // In how many pictures each is seen, by the pixels' rays.
    const auto picturesOf = [&](std::span<const CenterlineCamera> some) {
        std::vector<int> pictures(byItems.size(), 0);
        for (const CenterlineCamera& camera : some)
            for (const std::int32_t triangle : trianglesSeen(tree.rays(), eyepiece, camera))
                ++pictures[std::size_t(triangle)];
        return pictures;
    };
    const auto atSilhouettesOf = [&](std::span<const CenterlineCamera> some) {
        return [&, some](std::size_t triangle, bool seenByRays) {
            return isSilhouette(tree.rays(), eyepiece, picture, some, triangle, seenByRays);
        };
    };
    compare("item buffer and rays", fine.mesh, bridged, byItems, byRays, picturesOf(cameras),
            atSilhouettesOf(cameras));

    const std::span few = std::span(cameras).first(std::min<std::size_t>(2, cameras.size()));
    std::vector<Visibility> byQueries(byItems.size(), Visibility::unseen),
        fewByRays(byItems.size(), Visibility::unseen);
    long queries = 0;
    start = {};
    for (const CenterlineCamera& camera : few)
        addSeen(byQueries, TRY(bench::queryTriangles(fine.mesh, picture, camera, queries)));
    start.print("occlusion queries", double(few.size()));
    std::printf("  %.0f queries a picture\n", double(queries) / double(few.size()));
    TRY(look(tree, eyepiece, few, fewByRays, {.tellFully = true}));
    compare("occlusion queries and rays", fine.mesh, bridged, byQueries, fewByRays, picturesOf(few),
            atSilhouettesOf(few));

    // What the server has for readers' pictures: its item buffer, and lines of sight by Embree.
    if (!source.find("flatmap")) return {};
    auto map = std::make_shared<const FlatMap>(TRY(source.readFlatMap()));
    const auto geometry = TRY(render::FlatGeometry::of(*map, tree.rays().originMm()));
    const auto surface = TRY(render::FlatSurface::upload(geometry));
    auto index = TRY(render::WallIndex::create());
    const render::Band whole = render::Band::whole(picture.side, picture.side);
    const auto viewOf = [&](const CenterlineCamera& camera) {
        return Camera{camera.positionMm, camera.forward, camera.up, picture.fovDegrees};
    };
    TRY(index.find(*context, surface, viewOf(cameras.front()), whole));
    start = {};
    for (const CenterlineCamera& camera : cameras)
        TRY(index.find(*context, surface, viewOf(camera), whole));
    start.print("the server's item buffer", double(cameras.size()));
    render::WallCoverage live(TRY(render::WallSight::of(map)), {});
    start = {};
    for (const CenterlineCamera& camera : cameras)
        live.show(viewOf(camera), glm::ivec2(picture.side), 1000);
    start.print("the server's lines of sight", double(cameras.size()));
    return {};
}

Result<void> run(const std::string& folder, const std::string& name, int count, int checked,
                 int onGpu) {
    const auto source = TRY(store::CaseStore::open(folder, false).and_then([&](const auto& s) {
        return s.openCase(name);
    }));
    const auto surface = TRY(source.readMesh());
    const auto centerline = TRY(source.readCenterline());
    const auto distance = TRY(source.readVolume<float>("distance"));
    const auto lumen = TRY(source.readVolume<std::uint8_t>("lumen"));
    Clock start;
    const FineWall fine = fineWall(surface);
    start.print("fine wall");
    std::printf("%zu triangles, %zu fine ones; centerline %.0f mm\n", surface.triangles.size(),
                fine.mesh.triangles.size(), centerline.lengthMm());
    const auto bridged = bridgedTriangles(fine.mesh, lumen);
    start = {};
    const auto rays = TRY(WallRays::of(fine.mesh, bridged));
    start.print("rays");
    start = {};
    const SightTree tree(rays);
    start.print("tree");
    start = {};
    const auto corner = TRY(cornerPath(distance, centerline, olympusCfQ160l().tipRadiusMm));
    start.print("path");
    std::printf("path %.1f mm, %.1f mm narrow\n", corner.path.lengthMm(), corner.narrowMm);

    struct Mode {
        std::string name;
        Eyepiece eyepiece;
        std::vector<CenterlineCamera> cameras;
        bool tellFully;
    };
    const auto both = [&](auto cameras, const Centerline& path, int places) {
        auto all = cameras(path, places, FlightDirection::antegrade);
        const auto back = cameras(path, places, FlightDirection::retrograde);
        all.insert(all.end(), back.begin(), back.end());
        return all;
    };
    const Eyepiece scope = Eyepiece::of(olympusCfQ160l()), pinhole = Eyepiece::of(PinholePicture{});
    const auto ante = FlightDirection::antegrade, retro = FlightDirection::retrograde;
    const Mode modes[] = {
        {"oc towards cecum", scope, scopeCameras(corner.path, count, ante), false},
        {"oc towards rectum", scope, scopeCameras(corner.path, count, retro), false},
        {"vc antegrade", pinhole, flightCameras(centerline, count, ante), true},
        {"vc retrograde", pinhole, flightCameras(centerline, count, retro), true},
        {"vc both", pinhole, both(flightCameras, centerline, count), true},
        {"vc both, tangents", pinhole, both(scopeCameras, centerline, count), true},
    };
    for (const Mode& mode : modes) {
        if (count == 0) break;
        std::vector<Visibility> seen(fine.mesh.triangles.size(), Visibility::unseen);
        start = {};
        TRY(look(tree, mode.eyepiece, mode.cameras, seen, {.tellFully = mode.tellFully}));
        start.print(mode.name.c_str(), double(mode.cameras.size()));
        print("seen", fine.mesh, bridged, seen);
        if (checked == 0) continue;
        std::vector<CenterlineCamera> few;
        for (int n = 0; n < checked; ++n)
            few.push_back(
                mode.cameras[mode.cameras.size() * std::size_t(n) / std::size_t(checked)]);
        std::vector<Visibility> fast(seen.size()), every(seen.size());
        start = {};
        TRY(look(tree, mode.eyepiece, few, fast, {.tellFully = mode.tellFully, .threads = 1}));
        start.print("  few, searched", checked);
        start = {};
        lookByEveryRay(*rays, mode.eyepiece, few, every, mode.tellFully);
        start.print("  few, every ray", checked);
        start = {};
        for (const CenterlineCamera& camera : few)
            trianglesSeen(*rays, mode.eyepiece, camera);
        start.print("  few, packets", checked);
        long differ = 0;
        for (std::size_t n = 0; n < seen.size(); ++n)
            differ += fast[n] != every[n];
        std::printf("  %ld triangles differ\n", differ);
    }
    if (onGpu == 0) return {};
    return compareWithGpu(source, fine, bridged, tree, both(flightCameras, centerline, onGpu / 2));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr,
                     "usage: coverage_bench STORE CASE [CAMERAS [CHECKED [GPU_CAMERAS]]]\n");
        return 2;
    }
    const auto done = run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 1000,
                          argc > 4 ? std::atoi(argv[4]) : 8, argc > 5 ? std::atoi(argv[5]) : 40);
    if (!done) std::fprintf(stderr, "%s\n", describe(done.error()).c_str());
    return done ? 0 : 1;
}
