#include "phantom/film.h"

#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/wall_place.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haustra::phantom {
namespace {

Film filmAt(glm::dvec3 center, double radiusMm, Random& random) {
    Film film;
    film.center = center;
    film.radiusMm = radiusMm;
    film.thicknessMm = std::clamp(1.5 + 0.6 * random.normal(), 0.4, 3.0);
    film.hu = random.uniform(200.0, 900.0);
    film.seed = random.bits();
    return film;
}

}  // namespace

double Film::thicknessAt(glm::dvec3 p) const {
    const double outline = radiusMm * (1.0 + 0.3 * valueNoise(seed, p, 6.0)),
                 inward = 1.0 - glm::distance(p, center) / outline;
    if (inward <= 0.0) return 0.0;
    const double uneven = 1.0 + 0.5 * valueNoise(seed + 1, p, 4.0);
    return thicknessMm * uneven * smoothstep(0.0, 0.4, inward);
}

double Film::share(glm::dvec3 p, double lumenMm, double widthMm) const {
    const double thickness = thicknessAt(p), lumen = coverage(lumenMm, widthMm);
    if (thickness <= 0.0 || lumen <= 0.0) return 0.0;
    return 1.0 - coverage(lumenMm + thickness, widthMm) / lumen;
}

std::vector<Film> makeFilms(const ColonShape& shape, std::uint64_t seed,
                            const GrowthOptions& options) {
    std::vector<Film> films;
    const std::vector<Growth>& growths = shape.growths();
    for (std::size_t n = 0; n < growths.size(); ++n) {
        const Growth& growth = growths[n];
        Random random(growth.seed, 63);
        if (growth.stool() || !random.chance(options.coated)) continue;
        const double reach = std::max({growth.semiAxes.x, growth.semiAxes.y, growth.semiAxes.z});
        // Some leave a part of the head bare.
        const double aside = random.uniform(0.0, 0.6) * reach,
                     turn = random.uniform(0.0, 2.0 * std::numbers::pi);
        const glm::dvec3 across = glm::cross(growth.inward, growth.tangent);
        films.push_back(filmAt(
            growth.center + aside * (std::cos(turn) * growth.tangent + std::sin(turn) * across),
            reach + random.uniform(1.0, 5.0), random));
        films.back().growth = int(n);
    }
    Random random(seed, 64);
    for (int n = 0, attempt = 0; n < options.films && attempt < 40 * options.films; ++attempt) {
        const double arc = random.uniform(45.0, shape.path().lengthMm() - 20.0);
        const auto place = castToWall(shape, arc, random.uniform(0.0, 2.0 * std::numbers::pi));
        const double radius = random.uniform(4.0, 11.0);
        if (!place) continue;
        if (std::any_of(growths.begin(), growths.end(), [&](const Growth& growth) {
                return glm::distance(growth.center, place->at) < growth.reachMm() + radius;
            }))
            continue;
        films.push_back(filmAt(place->at, radius, random));
        ++n;
    }
    return films;
}

}  // namespace haustra::phantom
