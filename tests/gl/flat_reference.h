// The flattened wall again, plainly, in double precision on the CPU.
#pragma once

#include "core/flat_lookup.h"
#include "reference_marcher.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace haustra::tests {

/// How one place of the wall is drawn.
struct ReferencePlace {
    glm::dvec3 positionMm{0.0}, cameraMm{0.0}, intoLumen{0.0};
    glm::dvec3 direction{0.0}, light{0.0};  // unit
    double stepsBack = 0.0;
};

/// Turned towards the wall as FlatRay says.
inline glm::dvec3 turned(glm::dvec3 direction, glm::dvec3 intoLumen, double most) {
    const double angle = std::acos(std::clamp(-glm::dot(direction, intoLumen), -1.0, 1.0));
    const double less = angle / std::pow(1.0 + std::pow(angle / most, 4.0), 0.25);
    const glm::dvec3 along = direction + std::cos(angle) * intoLumen;
    if (glm::length(along) < 1e-9) return -intoLumen;
    return std::sin(less) * glm::normalize(along) - std::cos(less) * intoLumen;
}

/// A tube's flat map with what its pictures are drawn from. The cameras stand on the z axis.
struct ReferenceWall {
    FlatLookup lookup;
    std::vector<glm::dvec3> intoLumen;  ///< per vertex: mean of its triangles', by their angles

    explicit ReferenceWall(const FlatMap& map) : lookup(std::make_shared<const FlatMap>(map)) {
        using Place = std::array<double, 3>;
        const auto placeOf = [&](int vertex) {
            const glm::dvec3 p = map.surface.vertices[std::size_t(vertex)];
            return Place{p.x, p.y, p.z};
        };
        // The two vertices of a place on the seam share one.
        std::map<Place, glm::dvec3> sums;
        for (const glm::ivec3 t : map.surface.triangles) {
            const auto corner = [&](int c) { return map.surface.vertices[std::size_t(t[c % 3])]; };
            for (int c = 0; c < 3; ++c) {
                const glm::dvec3 a = glm::normalize(corner(c + 1) - corner(c));
                const glm::dvec3 b = glm::normalize(corner(c + 2) - corner(c));
                const auto at = sums.emplace(placeOf(t[c]), glm::dvec3(0.0)).first;
                at->second -= std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b));
            }
        }
        for (int vertex = 0; vertex < int(map.flat.size()); ++vertex)
            intoLumen.push_back(glm::normalize(sums.at(placeOf(vertex))));
    }
};

/// The place at a flat coordinate; empty beyond the strip.
inline std::optional<ReferencePlace> referencePlace(const ReferenceWall& reference,
                                                    const Volume<std::int16_t>& volume,
                                                    double stepMm, glm::dvec2 flat) {
    const std::optional<WallPlace> wall = reference.lookup.at(flat);
    if (!wall) return std::nullopt;
    const FlatMap& map = reference.lookup.map();
    const glm::ivec3 corners = map.surface.triangles[std::size_t(wall->flatTriangle)];
    glm::dvec3 inward(0.0);
    double camera = 0.0;
    for (int c = 0; c < 3; ++c) {
        const std::size_t vertex = std::size_t(corners[c]);
        inward += wall->barycentric[c] * reference.intoLumen[vertex];
        camera += wall->barycentric[c] * map.camera[vertex];
    }
    inward = glm::normalize(inward);
    const std::size_t before = std::size_t(camera);
    const std::size_t after = std::min(before + 1, map.cameras.size() - 1);
    ReferencePlace place;
    place.positionMm = wall->positionMm;
    place.intoLumen = inward;
    place.cameraMm = glm::mix(map.cameras[before].positionMm, map.cameras[after].positionMm,
                              camera - double(before));
    const render::FlatRay& rule = render::flatRay;
    const glm::dvec3 sight = glm::normalize(place.positionMm - place.cameraMm);
    place.direction = turned(sight, inward, rule.mostRayAngle);
    place.light = turned(glm::normalize(sight - rule.lampAhead * glm::dvec3(0.0, 0.0, 1.0)), inward,
                         rule.mostLightAngle);

    const auto hu = [&](double n) {
        return trilinear(volume, volume.grid().voxelFromPatientPoint(place.positionMm -
                                                                     n * stepMm * place.direction));
    };
    double darkest = hu(0.0);
    for (double n = 1.0; n <= std::ceil(rule.backMm / stepMm); n += 1.0) {
        const double here = hu(n);
        if (here >= darkest + rule.riseHu) break;
        if (here < darkest) place.stepsBack = n;
        darkest = std::min(darkest, here);
    }
    return place;
}

inline Image referenceFlat(const ReferenceWall& reference, const Volume<std::int16_t>& volume,
                           const render::FlatView& view, glm::ivec2 size) {
    const glm::dvec3 spacing = volume.grid().spacingMm();
    const double stepMm = view.march.stepVoxels * std::min({spacing.x, spacing.y, spacing.z});
    const glm::dmat3 linear(volume.grid().voxelFromPatient());
    Image image{size.x, size.y, {}};
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec2 flat = view.window.flatFromPixel(glm::dvec2(x, y) + 0.5, size);
            const auto place = referencePlace(reference, volume, stepMm, flat);
            if (!place) {
                append(image, glm::dvec3(0.0));
                continue;
            }
            const glm::dvec3 step = stepMm * place->direction;
            const glm::dvec3 origin = place->positionMm - place->stepsBack * step;
            const ReferenceMarcher marcher(
                volume, {volume.grid().voxelFromPatientPoint(origin), linear * step, place->light},
                view.optics, stepMm);
            append(image,
                   marcher.pixel(place->stepsBack + std::ceil(render::flatRay.depthMm / stepMm)));
        }
    }
    return image;
}

}  // namespace haustra::tests
