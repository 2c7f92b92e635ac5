#include "cad/train.h"

#include "cad/wall_frames.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace haustra::cad {
namespace {

constexpr std::size_t wallVectors = 6000, polypVectors = 4000;  // of one case, about

std::size_t featureNumber(std::string_view name) {
    return std::size_t(std::find(featureNames.begin(), featureNames.end(), name) -
                       featureNames.begin());
}

std::pair<double, double> middleRange(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    // All but the outermost fortieth on either side.
    const auto at = [&](double share) {
        return values[std::size_t(share * double(values.size() - 1))];
    };
    return {at(0.025), at(0.975)};
}

Forest forestOf(const std::vector<const TrainingCase*>& cases) {
    std::vector<float> rows, responses;
    for (const TrainingCase* each : cases) {
        for (const Example& example : each->examples) {
            if (!example.weighed) continue;
            rows.insert(rows.end(), example.features.begin(), example.features.end());
            responses.push_back(example.polyp ? 1.0f : 0.0f);
        }
    }
    return trainForest(rows, responses, featureCount);
}

// One place of a case that would be told, with its score by a forest that has not seen the case.
struct Scored {
    double score = 0.0;
    int lesion = -1;
    bool polyp = false, blamed = true;
    std::size_t caseNumber = 0;
};

// As weigh() does: the best of those of one place.
std::vector<Scored> scoredPlaces(const TrainingCase& each, std::size_t number,
                                 const Forest& forest) {
    std::vector<std::pair<double, const Example*>> order;
    for (const Example& example : each.examples)
        order.emplace_back(forest.at(example.features), &example);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
        return a.first != b.first ? a.first > b.first : a.second->areaMm2 > b.second->areaMm2;
    });
    std::vector<const Example*> kept;
    std::vector<Scored> places;
    for (const auto& [score, example] : order) {
        const bool told = std::any_of(kept.begin(), kept.end(), [&](const Example* other) {
            return glm::distance(example->placeMm, other->placeMm) <
                   0.5 * std::max(example->diameterMm, other->diameterMm);
        });
        if (told) continue;
        kept.push_back(example);
        const bool neoplastic =
            example->lesion >= 0 && each.truth[std::size_t(example->lesion)].neoplastic;
        const bool benign =
            example->lesion >= 0 && each.truth[std::size_t(example->lesion)].hyperplastic();
        places.push_back({score, example->lesion, neoplastic, !neoplastic && !benign, number});
    }
    return places;
}

}  // namespace

TextureExamples textureExamples(const PreparedColon& colon, const EvidenceOptions& options,
                                const std::vector<TrueLesion>& truth) {
    const WallSamples samples = sampleWall(colon.surface, sampleSpacingMm);
    const std::size_t count = samples.mesh.vertices.size();
    std::vector<std::uint32_t> chosen, inside;
    for (std::size_t v = 0; v < count; v += std::max<std::size_t>(1, count / wallVectors))
        chosen.push_back(std::uint32_t(v));
    const std::size_t walls = chosen.size();
    for (std::size_t v = 0; v < count; ++v) {
        const glm::dvec3 p = samples.mesh.vertices[v];
        const bool polyp = std::any_of(truth.begin(), truth.end(), [&](const TrueLesion& lesion) {
            return lesion.neoplastic &&
                   glm::distance(p, lesion.positionMm) < 0.5 * lesion.diameterMm + 0.5;
        });
        if (polyp) inside.push_back(std::uint32_t(v));
    }
    const std::size_t step = std::max<std::size_t>(1, inside.size() / polypVectors);
    for (std::size_t n = 0; n < inside.size(); n += step)
        chosen.push_back(inside[n]);

    const SmoothScan smooth = smoothedAround(colon, shapeSigmaMm, options.threads);
    const BiopsyTable table(transferFunctionFor(options, wallStatistics(colon, smooth)));
    const BiopsyScan scan{smooth, colon.lumen, colon.tissue.airBelowHu};
    std::vector<WallShape> shapes(count);
    std::vector<std::uint8_t> looked(count, 0);
    std::vector<glm::vec3> colors(count);
    const auto measure = [&](std::uint32_t v) {
        shapes[v] = shapeOf(smooth.derivatives(samples.mesh.vertices[v]));
    };
    const auto look = [&](std::uint32_t v) {
        if (std::exchange(looked[v], 1)) return;
        measure(v);
        colors[v] = castBiopsyRay(scan, table, samples.mesh.vertices[v],
                                  glm::dvec3(shapes[v].intoWall), RayEnd::opaque)
                        .color;
    };
    for (const std::uint32_t v : chosen)
        measure(v);
    const TextureStencil stencil(samples, chosen, shapes, stripDirections(samples, colon.flat),
                                 options.threads);
    TextureExamples examples;
    for (std::size_t n = 0; n < chosen.size(); ++n) {
        look(chosen[n]);
        for (const std::uint32_t v : stencil.neighbours(n))
            look(v);
        (n < walls ? examples.all : examples.polyps).push_back(stencil.at(n, colors));
    }
    return examples;
}

std::vector<Example> examplesOf(const std::vector<Candidate>& candidates,
                                const std::vector<TrueLesion>& truth) {
    std::vector<glm::dvec3> places;
    std::vector<Example> examples;
    for (const Candidate& candidate : candidates) {
        places.push_back(candidate.lesion.centreMm);
        examples.push_back({candidate.features, candidate.lesion.centreMm,
                            candidate.lesion.diameter.mm, candidate.lesion.areaMm2});
    }
    const std::vector<int> meant = matched(places, truth);
    std::vector<double> largest(truth.size(), 0.0);
    for (std::size_t n = 0; n < examples.size(); ++n)
        if (meant[n] >= 0)
            largest[std::size_t(meant[n])] =
                std::max(largest[std::size_t(meant[n])], examples[n].areaMm2);
    for (std::size_t n = 0; n < examples.size(); ++n) {
        Example& example = examples[n];
        example.lesion = meant[n];
        if (meant[n] < 0) continue;
        const TrueLesion& lesion = truth[std::size_t(meant[n])];
        if (lesion.neoplastic) {
            example.polyp = example.diameterMm >= 0.5 * lesion.diameterMm ||
                            example.areaMm2 >= largest[std::size_t(meant[n])];
            example.weighed = example.polyp;
        } else {
            example.weighed = !lesion.hyperplastic();
        }
    }
    return examples;
}

Result<CadModel> trainModel(const TextureModel& texture, const std::vector<TrainingCase>& cases,
                            const TrainOptions& options) {
    if (int(cases.size()) < options.folds)
        return fail(ErrorKind::badInput, "there are fewer training cases than folds");
    CadModel model;
    model.name = options.name, model.trainedOn = options.trainedOn;
    model.trainingSha256 = options.trainingSha256;
    model.texture = texture;
    std::vector<double> indices, curvedness, concentration;
    std::vector<const TrainingCase*> all;
    for (const TrainingCase& each : cases) {
        all.push_back(&each);
        for (const Example& example : each.examples) {
            if (!example.polyp) continue;
            indices.push_back(example.features[featureNumber("shape_index_mean")]);
            curvedness.push_back(example.features[featureNumber("curvedness_mean")]);
            concentration.push_back(example.features[featureNumber("gradient_concentration")]);
        }
    }
    if (indices.empty())
        return fail(ErrorKind::badInput, "no polyp of the training cases was a candidate");
    model.thresholds = {middleRange(indices), middleRange(curvedness), middleRange(concentration)};

    // The last forest has seen all cases, each other one all but those of its fold.
    std::vector<Forest> forests(std::size_t(options.folds) + 1);
    parallelFor(forests.size(), 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t fold = begin; fold < end; ++fold) {
            std::vector<const TrainingCase*> seen;
            for (std::size_t n = 0; n < cases.size(); ++n)
                if (n % std::size_t(options.folds) != fold || fold + 1 == forests.size())
                    seen.push_back(all[n]);
            forests[fold] = forestOf(seen);
        }
    });
    std::vector<Scored> scored;
    for (int fold = 0; fold < options.folds; ++fold) {
        const Forest& forest = forests[std::size_t(fold)];
        for (std::size_t n = std::size_t(fold); n < cases.size(); n += std::size_t(options.folds)) {
            const auto places = scoredPlaces(cases[n], n, forest);
            scored.insert(scored.end(), places.begin(), places.end());
        }
    }
    model.forest = std::move(forests.back());
    std::vector<double> x, blamed;
    std::vector<int> truths;
    for (const Scored& place : scored) {
        if (place.polyp || place.blamed) {
            x.push_back(logit(place.score));
            truths.push_back(place.polyp);
        }
        if (place.blamed) blamed.push_back(place.score);
    }
    std::tie(model.calibrationA, model.calibrationB) = fitLogistic(x, truths);
    std::sort(blamed.rbegin(), blamed.rend());
    const std::size_t allowed = std::size_t(options.falsePositives * double(cases.size()));
    const double score = allowed < blamed.size() ? blamed[allowed] : 0.0;
    model.operatingPoint =
        1.0 / (1.0 + std::exp(-(model.calibrationA + model.calibrationB * logit(score))));
    return model;
}

}  // namespace haustra::cad
