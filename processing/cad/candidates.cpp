#include "cad/candidates.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

namespace haustra::cad {
namespace {

// Connected sets of samples that hold.
template <class Holds>
std::vector<std::vector<std::uint32_t>> componentsWhere(const WallSamples& wall,
                                                        const Holds& holds) {
    std::vector<std::vector<std::uint32_t>> components;
    std::vector<std::uint8_t> taken(wall.mesh.vertices.size(), 0);
    for (std::uint32_t seed = 0; seed < taken.size(); ++seed) {
        if (taken[seed] || !holds(seed)) continue;
        std::vector<std::uint32_t> component{seed};
        taken[seed] = 1;
        for (std::size_t head = 0; head < component.size(); ++head) {
            const std::uint32_t v = component[head];
            for (std::uint32_t e = wall.begin[v]; e < wall.begin[v + 1]; ++e) {
                const std::uint32_t next = wall.neighbours[e];
                if (taken[next] || !holds(next)) continue;
                taken[next] = 1;
                component.push_back(next);
            }
        }
        components.push_back(std::move(component));
    }
    return components;
}

double areaOf(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    double area = 0.0;
    for (const std::uint32_t v : samples)
        area += wall.areaMm2[v];
    return area;
}

// What the patch encloses is part of it: what is around it, as far as it is wide, is walked
// through, and what cannot be left is inside.
void fillHoles(const WallSamples& wall, std::vector<std::uint32_t>& patch,
               std::vector<std::uint32_t>& mark, std::uint32_t& generation) {
    const std::uint32_t inPatch = ++generation, around = ++generation, outside = ++generation;
    for (const std::uint32_t v : patch)
        mark[v] = inPatch;
    const double reachMm = 0.6 * diameterOf(wall, patch).mm + 1.0;
    glm::dvec3 middle(0.0);
    for (const std::uint32_t v : patch)
        middle += wall.mesh.vertices[v];
    middle /= double(patch.size());
    double farthest = 0.0;
    for (const std::uint32_t v : patch)
        farthest = std::max(farthest, glm::distance(middle, wall.mesh.vertices[v]));
    std::vector<std::uint32_t> ring, open;
    const auto visit = [&](std::uint32_t v) {
        for (std::uint32_t e = wall.begin[v]; e < wall.begin[v + 1]; ++e) {
            const std::uint32_t next = wall.neighbours[e];
            if (mark[next] == inPatch || mark[next] == around) continue;
            mark[next] = around;
            ring.push_back(next);
        }
    };
    for (const std::uint32_t v : patch)
        visit(v);
    for (std::size_t head = 0; head < ring.size(); ++head) {
        if (glm::distance(middle, wall.mesh.vertices[ring[head]]) > farthest + reachMm)
            open.push_back(ring[head]);
        else
            visit(ring[head]);
    }
    for (const std::uint32_t v : open)
        mark[v] = outside;
    for (std::size_t head = 0; head < open.size(); ++head) {
        for (std::uint32_t e = wall.begin[open[head]]; e < wall.begin[open[head] + 1]; ++e) {
            const std::uint32_t next = wall.neighbours[e];
            if (mark[next] != around) continue;
            mark[next] = outside;
            open.push_back(next);
        }
    }
    if (open.empty()) return;  // all the wall there is
    for (const std::uint32_t v : ring)
        if (mark[v] == around) patch.push_back(v);
}

// Of components that are kept, by their number.
template <class Keeps>
std::vector<Patch> patchesOf(const WallSamples& wall,
                             std::vector<std::vector<std::uint32_t>> components, int threads,
                             const Keeps& keeps) {
    std::vector<Patch> made(components.size());
    // Each thread takes one after the other, as they differ in size by a thousand times.
    std::atomic<std::size_t> next = 0;
    parallelFor(std::size_t(threadCount(threads)), 1, threads, [&](std::size_t, std::size_t) {
        std::vector<std::uint32_t> mark(wall.mesh.vertices.size(), 0);
        std::uint32_t generation = 0;
        for (std::size_t n; (n = next++) < components.size();) {
            if (!keeps(components[n])) continue;
            fillHoles(wall, components[n], mark, generation);
            std::sort(components[n].begin(), components[n].end());
            made[n].samples = std::move(components[n]);
        }
    });
    std::erase_if(made, [](const Patch& patch) { return patch.samples.empty(); });
    return made;
}

// The diagonal of the box around them: not less than their diameter.
double boxMm(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    glm::dvec3 low(1e30), high(-1e30);
    for (const std::uint32_t v : samples)
        low = glm::min(low, wall.mesh.vertices[v]), high = glm::max(high, wall.mesh.vertices[v]);
    return glm::distance(low, high);
}

}  // namespace

Diameter diameterOf(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    // The farthest two are extreme along the line between them: those along many lines are asked.
    constexpr int lines = 64;
    std::array<std::uint32_t, 2 * lines> extremes{};
    for (int n = 0; n < lines; ++n) {
        // Evenly over the half sphere.
        const double z = (n + 0.5) / lines, turn = 2.399963229728653 * n,
                     r = std::sqrt(1.0 - z * z);
        const glm::dvec3 line(r * std::cos(turn), r * std::sin(turn), z);
        double least = 1e30, most = -1e30;
        for (const std::uint32_t v : samples) {
            const double along = glm::dot(line, wall.mesh.vertices[v]);
            if (along < least) least = along, extremes[std::size_t(2 * n)] = v;
            if (along > most) most = along, extremes[std::size_t(2 * n + 1)] = v;
        }
    }
    Diameter best;
    for (const std::uint32_t a : extremes) {
        for (const std::uint32_t b : extremes) {
            const double mm = glm::distance(wall.mesh.vertices[a], wall.mesh.vertices[b]);
            if (mm > best.mm) best = {mm, a, b};
        }
    }
    return best;
}

std::vector<Patch> patchesByShape(const WallEvidence& evidence, std::span<const WallShape> shapes,
                                  const ShapeLimits& limits, int threads) {
    const WallSamples& wall = evidence.samples;
    auto patches =
        patchesOf(wall,
                  componentsWhere(wall,
                                  [&](std::uint32_t v) {
                                      return shapes[v].k2 >= float(limits.growCurvature) &&
                                             !evidence.unseen[v];
                                  }),
                  threads, [&](const std::vector<std::uint32_t>& component) {
                      const double area = areaOf(wall, component);
                      return area >= limits.leastMm2 && area <= limits.mostMm2 &&
                             std::any_of(component.begin(), component.end(), [&](std::uint32_t v) {
                                 return shapes[v].k2 >= float(limits.seedCurvature) &&
                                        shapes[v].shapeIndex() >= float(limits.seedShapeIndex);
                             });
                  });
    for (Patch& patch : patches)
        patch.byShape = true;
    return patches;
}

std::vector<Patch> patchesByTexture(const WallEvidence& evidence,
                                    std::span<const float> textureDistance, int threads,
                                    double leastMm) {
    const WallSamples& wall = evidence.samples;
    auto patches = patchesOf(
        wall,
        componentsWhere(
            wall,
            [&](std::uint32_t v) { return textureDistance[v] < 1.0f && !evidence.unseen[v]; }),
        threads, [&](const std::vector<std::uint32_t>& component) {
            return boxMm(wall, component) >= leastMm &&
                   areaOf(wall, component) <= ShapeLimits().mostMm2 &&
                   diameterOf(wall, component).mm >= leastMm;
        });
    for (Patch& patch : patches)
        patch.byTexture = true;
    return patches;
}

}  // namespace haustra::cad
