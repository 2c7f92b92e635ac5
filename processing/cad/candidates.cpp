#include "cad/candidates.h"

#include <algorithm>
#include <array>
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

std::vector<Patch> patchesOf(const WallSamples& wall,
                             std::vector<std::vector<std::uint32_t>> components, double mostMm2) {
    std::vector<Patch> patches;
    std::vector<std::uint32_t> mark(wall.mesh.vertices.size(), 0);
    std::uint32_t generation = 0;
    for (auto& component : components) {
        if (areaOf(wall, component) > mostMm2) continue;
        fillHoles(wall, component, mark, generation);
        std::sort(component.begin(), component.end());
        patches.push_back({std::move(component)});
    }
    return patches;
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
                                  const ShapeLimits& limits) {
    const WallSamples& wall = evidence.samples;
    auto components = componentsWhere(wall, [&](std::uint32_t v) {
        return shapes[v].k2 >= float(limits.growCurvature) && !evidence.unseen[v];
    });
    std::erase_if(components, [&](const std::vector<std::uint32_t>& component) {
        return areaOf(wall, component) < limits.leastMm2 ||
               std::none_of(component.begin(), component.end(), [&](std::uint32_t v) {
                   return shapes[v].k2 >= float(limits.seedCurvature) &&
                          shapes[v].shapeIndex() >= float(limits.seedShapeIndex);
               });
    });
    auto patches = patchesOf(wall, std::move(components), limits.mostMm2);
    for (Patch& patch : patches)
        patch.byShape = true;
    return patches;
}

std::vector<Patch> patchesByTexture(const WallEvidence& evidence,
                                    std::span<const float> textureDistance, double leastMm) {
    const WallSamples& wall = evidence.samples;
    auto components = componentsWhere(
        wall, [&](std::uint32_t v) { return textureDistance[v] < 1.0f && !evidence.unseen[v]; });
    std::erase_if(components, [&](const std::vector<std::uint32_t>& component) {
        return diameterOf(wall, component).mm < leastMm;
    });
    auto patches = patchesOf(wall, std::move(components), ShapeLimits().mostMm2);
    for (Patch& patch : patches)
        patch.byTexture = true;
    return patches;
}

}  // namespace haustra::cad
