#include "phantom/growth_truth.h"

#include "phantom/filled_colon.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace haustra::phantom {
namespace {

// What painters add to the wall's HU in the middle of a dense core.
constexpr double denseCoreHu = 22.0, bumpHu = 3.0;

const char* kindOf(const Growth& growth) {
    switch (growth.kind) {
        case Growth::Kind::sessile:
            return "sessile";
        case Growth::Kind::pedunculated:
            return "pedunculated";
        case Growth::Kind::flat:
            return "flat";
        case Growth::Kind::hyperplastic:
            return "hyperplastic";
        case Growth::Kind::untaggedStool:
            return "untagged_stool";
        case Growth::Kind::taggedStool:
            return "tagged_stool";
    }
    return "";
}

// How much of what stands from `low` to `high` mm is in a pool's fluid that took no tagging, 0…1.
double untaggedShareOf(const Pool& pool, double low, double high) {
    constexpr int steps = 64;
    double sum = 0.0;
    for (int n = 0; n < steps; ++n) {
        const double height = low + (n + 0.5) / steps * (high - low);
        if (height < pool.levelMm) sum += 1.0 - pool.taggedShareAt(height);
    }
    return sum / steps;
}

}  // namespace

bool isPlain(const Growth& polyp, const GrowthOptions& options) {
    return options.plainCores > 0.0 && Random(polyp.seed, 60).chance(options.plainCores);
}

double densityOf(const Growth& polyp, const GrowthOptions& options) {
    if (options.polypHu == 0.0 && options.polypSdHu == 0.0) return 0.0;
    return options.polypHu + options.polypSdHu * Random(polyp.seed, 61).normal();
}

std::vector<GrowthTruth> growthTruths(const FilledColon& colon, const GrowthOptions& options) {
    std::vector<GrowthTruth> truths;
    for (const Growth& growth : colon.shape.growths()) {
        GrowthTruth truth;
        truth.kind = kindOf(growth);
        truth.neoplastic = growth.polyp();
        truth.positionMm = growth.center;
        truth.wallMm = growth.root + growth.rootDepthMm * growth.inward;
        const glm::dvec3 axes = growth.semiAxes;
        truth.diameterMm = 2.0 * std::max({axes.x, axes.y, axes.z});
        truth.heightMm = glm::dot(growth.center - truth.wallMm, growth.inward) + axes.z;
        truth.coreHu = growth.kind == Growth::Kind::hyperplastic     ? bumpHu
                       : growth.polyp() && !isPlain(growth, options) ? denseCoreHu
                                                                     : 0.0;
        if (growth.polyp()) truth.densityHu = densityOf(growth, options);
        const auto at = colon.shape.evaluate(growth.center);
        const PathSample axis = colon.shape.path().at(at.arcMm);
        truth.onFold = glm::distance(growth.root, axis.position) < 0.8 * axis.radiusMm;
        // How much of the head's height is below the level.
        const Pool& pool = colon.fluid.poolAt(at.arcMm);
        const double height = colon.fluid.heightMm(growth.center),
                     half = std::max(0.5, std::min({axes.x, axes.y, axes.z}));
        truth.submergedShare = std::clamp(0.5 + 0.5 * (pool.levelMm - height) / half, 0.0, 1.0);
        truth.untaggedShare = untaggedShareOf(pool, height - half, height + half);
        // Whosever film it is: one may reach over a neighbour.
        for (const Film& film : colon.films) {
            if (!growth.stool())
                truth.filmMm = std::max(truth.filmMm,
                                        film.thicknessAt(growth.center + axes.z * growth.inward));
        }
        truths.push_back(truth);
    }
    for (const Film& film : colon.films) {
        const double level = colon.fluid.poolAt(colon.shape.evaluate(film.center).arcMm).levelMm;
        const bool drowned = colon.fluid.heightMm(film.center) + film.reachMm() < level;
        if (film.growth >= 0 || drowned) continue;
        GrowthTruth truth;
        truth.kind = "film";
        truth.positionMm = truth.wallMm = film.center;
        truth.diameterMm = 2.0 * film.radiusMm;
        truth.heightMm = truth.filmMm = film.thicknessAt(film.center);
        truths.push_back(truth);
    }
    return truths;
}

std::string growthsJson(const std::vector<GrowthTruth>& growths) {
    const auto rounded = [](double value) { return std::round(value * 1e3) / 1e3; };
    const auto place = [](glm::dvec3 p) { return nlohmann::ordered_json{p.x, p.y, p.z}; };
    std::string text = "{\"growths\": [";
    for (std::size_t n = 0; n < growths.size(); ++n) {
        const GrowthTruth& g = growths[n];
        nlohmann::ordered_json json{{"kind", g.kind},
                                    {"neoplastic", g.neoplastic},
                                    {"position_mm", place(g.positionMm)},
                                    {"wall_mm", place(g.wallMm)},
                                    {"diameter_mm", rounded(g.diameterMm)},
                                    {"height_mm", rounded(g.heightMm)},
                                    {"core_hu", g.coreHu},
                                    {"on_fold", g.onFold},
                                    {"submerged_share", rounded(g.submergedShare)}};
        if (g.densityHu != 0.0) json["density_hu"] = rounded(g.densityHu);
        if (g.untaggedShare > 0.0) json["untagged_share"] = rounded(g.untaggedShare);
        if (g.filmMm > 0.0) json["film_mm"] = rounded(g.filmMm);
        text += (n ? ",\n" : "\n") + json.dump();
    }
    return text + "]}\n";
}

}  // namespace haustra::phantom
