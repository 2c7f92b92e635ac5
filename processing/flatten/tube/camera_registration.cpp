#include "flatten/tube/camera_registration.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <queue>
#include <unordered_map>

namespace haustra::flatten {
namespace {

// Between the B-spline's control points. It rounds what is shorter than they are apart.
constexpr double controlSpacingMm = 4.0;
constexpr double segmentMm = 20.0;

/// Samples of the uniform cubic B-spline whose control points lie on the centerline at equal steps
/// of arc. Such a spline gives back linear functions, so the sample at a share of its parameter is
/// at that share of the centerline's arc.
std::vector<FlatCamera> placeCameras(const Centerline& centerline, double spacingMm) {
    const double startMm = centerline.points.front().arcMm,
                 lengthMm = centerline.points.back().arcMm - startMm;
    const int spans = std::max(1, int(std::lround(lengthMm / controlSpacingMm)));
    std::vector<glm::dvec3> controls(std::size_t(spans) + 3);
    for (int i = 0; i <= spans; ++i) {
        controls[std::size_t(i) + 1] =
            poseAtArc(centerline, startMm + lengthMm * i / spans).point.positionMm;
    }
    // So that the spline begins and ends where the centerline does.
    controls.front() = 2.0 * controls[1] - controls[2];
    controls.back() = 2.0 * controls[controls.size() - 2] - controls[controls.size() - 3];

    const int steps = std::max(1, int(std::lround(lengthMm / spacingMm)));
    std::vector<FlatCamera> cameras;
    cameras.reserve(std::size_t(steps) + 1);
    for (int n = 0; n <= steps; ++n) {
        const double at = double(spans) * n / steps;
        const auto span = std::size_t(std::min(int(at), spans - 1));
        const double t = at - double(span), s = 1.0 - t;
        const glm::dvec3 place = (s * s * s * controls[span] +
                                  (3.0 * t * t * t - 6.0 * t * t + 4.0) * controls[span + 1] +
                                  (3.0 * s * s * s - 6.0 * s * s + 4.0) * controls[span + 2] +
                                  t * t * t * controls[span + 3]) /
                                 6.0;
        cameras.push_back({place, startMm + lengthMm * n / steps});
    }
    return cameras;
}

/// Where the contours at the heights between segments have their centroids, weighted by length;
/// nothing counts where a contour has none.
struct Contours {
    std::vector<glm::dvec3> sumMm;
    std::vector<double> lengthMm;
};

Contours traceContours(const FlatMap& map, int segments, const std::vector<char>& isPouch) {
    Contours contours{std::vector<glm::dvec3>(std::size_t(segments), glm::dvec3(0.0)),
                      std::vector<double>(std::size_t(segments), 0.0)};
    for (std::size_t n = 0; n < map.surface.triangles.size(); ++n) {
        if (!isPouch.empty() && isPouch[n]) continue;
        const glm::ivec3& t = map.surface.triangles[n];
        std::array<double, 3> level{};  // in segments
        for (int c = 0; c < 3; ++c)
            level[std::size_t(c)] = map.flat[std::size_t(t[c])].y / map.height * segments;
        const auto [low, high] = std::minmax_element(level.begin(), level.end());
        for (int k = std::max(1, int(std::ceil(*low))); k < std::min(double(segments), *high);
             ++k) {
            glm::dvec3 ends[2];
            int found = 0;
            for (std::size_t c = 0; c < 3 && found < 2; ++c) {
                const double from = level[c], to = level[(c + 1) % 3];
                if ((from <= k) == (to <= k)) continue;
                ends[found++] = glm::mix(map.surface.vertices[std::size_t(t[int(c)])],
                                         map.surface.vertices[std::size_t(t[int(c + 1) % 3])],
                                         (k - from) / (to - from));
            }
            if (found < 2) continue;
            const double length = glm::distance(ends[0], ends[1]);
            contours.sumMm[std::size_t(k)] += 0.5 * length * (ends[0] + ends[1]);
            contours.lengthMm[std::size_t(k)] += length;
        }
    }
    return contours;
}

/// The cameras that the segments begin with, and the last camera: the sequence that never falls and
/// has the least sum of squared distances to the contours' centroids.
std::vector<int> divideCenterline(const std::vector<FlatCamera>& cameras,
                                  const Contours& contours) {
    const int count = int(cameras.size()), segments = int(contours.sumMm.size());
    std::vector<double> cost(cameras.size(), 0.0);  // of ending at or before each camera
    std::vector<std::vector<int>> chosen;           // by contour, then by the next one's camera
    for (int k = 1; k < segments; ++k) {
        const double length = contours.lengthMm[std::size_t(k)];
        std::vector<int>& choice = chosen.emplace_back(cameras.size(), 0);
        int best = 0;
        double least = std::numeric_limits<double>::infinity();
        for (int c = 0; c < count; ++c) {
            double here = cost[std::size_t(c)];
            if (length > 0.0) {
                const glm::dvec3 away =
                    contours.sumMm[std::size_t(k)] / length - cameras[std::size_t(c)].positionMm;
                here += glm::dot(away, away);
            }
            if (here < least) least = here, best = c;
            choice[std::size_t(c)] = best;
            cost[std::size_t(c)] = least;
        }
    }
    std::vector<int> starts(std::size_t(segments) + 1, 0);
    starts.back() = count - 1;
    for (int k = segments - 1; k >= 1; --k)
        starts[std::size_t(k)] =
            chosen[std::size_t(k) - 1][std::size_t(starts[std::size_t(k) + 1])];
    return starts;
}

void registerNearest(FlatMap& map, const std::vector<int>& starts, int threads) {
    const int segments = int(starts.size()) - 1;
    map.camera.assign(map.flat.size(), 0);
    parallelFor(map.flat.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v) {
            const int segment =
                std::clamp(int(map.flat[v].y / map.height * segments), 0, segments - 1);
            const int first = starts[std::size_t(std::max(segment - 1, 0))],
                      last = starts[std::size_t(std::min(segment + 2, segments))];
            double least = std::numeric_limits<double>::infinity();
            for (int c = first; c <= last; ++c) {
                const glm::dvec3 away =
                    map.cameras[std::size_t(c)].positionMm - map.surface.vertices[v];
                const double square = glm::dot(away, away);
                if (square < least) least = square, map.camera[v] = c;
            }
        }
    });
}

/// The surface's edges; copies on the far side of the seam count as their originals.
struct Neighbours {
    std::vector<int> original;  ///< per vertex
    std::vector<int> first;     ///< per vertex, into the others; one more at the end
    std::vector<int> to;
    std::vector<double> lengthMm;
};

struct PlaceHash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& bits) const {
        std::uint64_t hash = 0;
        for (const std::uint64_t b : bits)
            hash = (hash ^ b) * 0x9e3779b97f4a7c15u, hash ^= hash >> 29;
        return std::size_t(hash);
    }
};

Neighbours neighboursOf(const FlatMap& map) {
    const std::size_t vertices = map.flat.size();
    Neighbours made;
    std::unordered_map<std::array<std::uint64_t, 3>, int, PlaceHash> left;
    const auto bitsOf = [&](std::size_t v) {
        std::array<std::uint64_t, 3> bits;
        std::memcpy(bits.data(), &map.surface.vertices[v], sizeof bits);
        return bits;
    };
    for (std::size_t v = 0; v < vertices; ++v) {
        if (map.flat[v].x == 0.0) left.emplace(bitsOf(v), int(v));
    }
    made.original.resize(vertices);
    for (std::size_t v = 0; v < vertices; ++v) {
        made.original[v] = int(v);
        if (map.flat[v].x != 1.0) continue;
        const auto found = left.find(bitsOf(v));
        if (found != left.end()) made.original[v] = found->second;
    }
    made.first.assign(vertices + 1, 0);
    const auto eachHalfedge = [&](const auto& visit) {
        for (const glm::ivec3& t : map.surface.triangles) {
            for (int c = 0; c < 3; ++c) {
                const int a = made.original[std::size_t(t[c])],
                          b = made.original[std::size_t(t[(c + 1) % 3])];
                visit(a, b);
                visit(b, a);  // twice, but at the rims
            }
        }
    };
    eachHalfedge([&](int a, int) { ++made.first[std::size_t(a) + 1]; });
    for (std::size_t v = 0; v < vertices; ++v)
        made.first[v + 1] += made.first[v];
    made.to.resize(std::size_t(made.first.back()));
    made.lengthMm.resize(made.to.size());
    std::vector<int> at(made.first.begin(), made.first.end() - 1);
    eachHalfedge([&](int a, int b) {
        const auto slot = std::size_t(at[std::size_t(a)]++);
        made.to[slot] = b;
        made.lengthMm[slot] = glm::distance(map.surface.vertices[std::size_t(a)],
                                            map.surface.vertices[std::size_t(b)]);
    });
    return made;
}

/// The greatest function below `values` that rises by no more than `slope` a millimetre.
std::vector<double> levelledFromBelow(std::vector<double> values, const Neighbours& graph,
                                      double slope) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> front;
    const auto lowerAround = [&](int v) {
        for (int n = graph.first[std::size_t(v)]; n < graph.first[std::size_t(v) + 1]; ++n) {
            const int to = graph.to[std::size_t(n)];
            const double most = values[std::size_t(v)] + slope * graph.lengthMm[std::size_t(n)];
            if (values[std::size_t(to)] <= most) continue;
            values[std::size_t(to)] = most;
            front.push({most, to});
        }
    };
    for (int v = 0; v < int(values.size()); ++v)
        lowerAround(v);
    while (!front.empty()) {
        const auto [value, v] = front.top();
        front.pop();
        if (value == values[std::size_t(v)]) lowerAround(v);
    }
    return values;
}

void level(FlatMap& map) {
    const Neighbours graph = neighboursOf(map);
    const double spacingMm = map.cameras[1].arcMm - map.cameras[0].arcMm;
    const double slope = steepestRegistration / spacingMm;
    std::vector<double> values(map.camera.begin(), map.camera.end());
    const std::vector<double> below = levelledFromBelow(values, graph, slope);
    for (double& value : values)
        value = -value;
    const std::vector<double> above = levelledFromBelow(std::move(values), graph, slope);
    for (std::size_t v = 0; v < map.camera.size(); ++v) {
        const auto from = std::size_t(graph.original[v]);
        map.camera[v] = std::int32_t(std::lround(0.5 * (below[from] - above[from])));
    }
}

}  // namespace

Result<void> registerCameras(FlatMap& map, const Centerline& centerline,
                             const CameraRegistrationOptions& options) {
    if (map.surface.triangles.empty() || !(map.height > 0.0))
        return fail(ErrorKind::badInput, "the flat map is empty");
    if (!(options.cameraSpacingMm > 0.0))
        return fail(ErrorKind::badInput, "the cameras must have a distance");
    if (centerline.points.size() < 2 ||
        !(centerline.points.back().arcMm > centerline.points.front().arcMm)) {
        return fail(ErrorKind::badInput, "the centerline has no length to see the wall from");
    }
    map.cameras = placeCameras(centerline, options.cameraSpacingMm);
    const int segments = options.segments > 0
                             ? options.segments
                             : std::max(1, int(std::lround(map.cameras.back().arcMm / segmentMm)));
    registerNearest(map,
                    divideCenterline(map.cameras, traceContours(map, segments, options.isPouch)),
                    options.threads);
    level(map);
    return {};
}

}  // namespace haustra::flatten
