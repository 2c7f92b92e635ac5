#include "cad/train.h"

#include "cad/places.h"
#include "cad/wall_frames.h"
#include "core/parallel.h"
#include "core/printed_text.h"
#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace haustra::cad {
namespace {

constexpr std::size_t wallVectors = 6000, polypVectors = 4000;  // of one case, about

std::pair<double, double> middleRange(std::vector<double> values) {
    // All but the outermost fortieth on either side.
    const double low = quantileOf(values, 0.025);
    return {low, quantileOf(values, 0.975)};
}

// What has learnt from the same cases.
struct Judges {
    BoostedTrees boosted;
    NeuralNetworks networks;
};

Judges judgesOn(const std::vector<const TrainingCase*>& cases) {
    std::vector<float> rows, responses;
    for (const TrainingCase* each : cases) {
        for (const Example& example : each->examples) {
            if (!example.weighed) continue;
            const FeatureVector weighed = asDenseAsTheWall(example.features);
            rows.insert(rows.end(), weighed.begin(), weighed.end());
            responses.push_back(example.polyp ? 1.0f : 0.0f);
        }
    }
    NetworkTraining training;
    training.threads = 1;
    return {boostTrees(rows, responses, featureCount),
            trainNetworks(rows, responses, featureCount, training)};
}

// Examples as witnesses, each with what `probability` makes of its features; nothing's where it
// does not rise.
template <class Probability>
std::vector<PlaceWitness> witnessesOf(const TrainingCase& each, const Probability& probability,
                                      double nothing) {
    std::vector<PlaceWitness> witnesses;
    for (const Example& example : each.examples)
        witnesses.push_back({example.placeMm, example.diameterMm, example.areaMm2,
                             rises(example.features) ? probability(example.features) : nothing,
                             example.levelOf});
    return witnesses;
}

// As TrueLesion::isPolyp; bare wall (−1) is none.
std::optional<bool> truthOf(const TrainingCase& each, int lesion) {
    return lesion < 0 ? false : each.truth[std::size_t(lesion)].isPolyp();
}

// Of each case the number of its study, from 0 on.
std::vector<std::size_t> studiesOf(const std::vector<TrainingCase>& cases) {
    std::map<std::string, std::size_t> known;
    std::vector<std::size_t> studies;
    std::size_t count = 0;
    for (const TrainingCase& each : cases) {
        const auto found = each.study.empty() ? known.end() : known.find(each.study);
        studies.push_back(found == known.end() ? count++ : found->second);
        if (!each.study.empty()) known.emplace(each.study, studies.back());
    }
    return studies;
}

// Whether polyps and others are among them, so that they can be told apart.
bool hasBoth(const std::vector<int>& truths) {
    return std::ranges::count(truths, 1) > 0 && std::ranges::count(truths, 0) > 0;
}

// What a part of the cases teaches: of the places that are weighed, whether there are polyps and
// others among them.
bool teaches(const std::vector<const TrainingCase*>& cases) {
    std::vector<int> truths;
    for (const TrainingCase* each : cases)
        for (const Example& example : each->examples)
            if (example.weighed) truths.push_back(example.polyp);
    return hasBoth(truths);
}

// How probable a place of a score is, and the operating point, of candidates of case n that are
// polyps with `probability(n, features)`; each case as it is then told.
template <class Probability>
Result<std::vector<EvaluatedCase>> calibratePlaces(CadModel& model,
                                                   const std::vector<TrainingCase>& cases,
                                                   const Probability& probability,
                                                   double falsePositives) {
    std::vector<double> scores;
    std::vector<int> truths;
    std::vector<EvaluatedCase> told;
    for (std::size_t n = 0; n < cases.size(); ++n) {
        const auto witnesses = witnessesOf(
            cases[n], [&](const FeatureVector& features) { return probability(n, features); }, 0.0);
        told.push_back({cases[n].name, cases[n].name, cases[n].truth, {}});
        for (const WitnessedPlace& place : placesOf(witnesses)) {
            const Example& best = cases[n].examples[place.best];
            told.back().places.push_back({place.score, best.diameterMm, best.lesion, ""});
            const auto polyp = truthOf(cases[n], best.lesion);
            if (!polyp || !rises(best.features)) continue;
            scores.push_back(logit(place.score));
            truths.push_back(*polyp);
        }
    }
    if (!hasBoth(truths))
        return fail(ErrorKind::badInput,
                    "among the candidates that rise above the wall is no polyp, or nothing else: "
                    "there is nothing to calibrate by");
    std::tie(model.placeA, model.placeB) = fitLogistic(scores, truths);
    if (!(model.placeB > 0.0))
        return fail(ErrorKind::badInput,
                    "polyps that neither trees nor networks had seen score no higher than other "
                    "places: there is nothing to calibrate by");
    std::vector<double> blamed;
    for (std::size_t n = 0; n < cases.size(); ++n) {
        for (ToldPlace& place : told[n].places) {
            place.score = model.placeProbability(place.score);
            if (truthOf(cases[n], place.lesion) == false) blamed.push_back(place.score);
        }
    }
    std::sort(blamed.rbegin(), blamed.rend());
    // 2.3 a scan of 50 scans are 115, and 2.3 · 50 a hair less.
    const auto allowed = std::size_t(falsePositives * double(cases.size()) + 1e-9);
    // What scores more than the first wrong one too many is told.
    model.operatingPoint = allowed < blamed.size() ? std::nextafter(blamed[allowed], 1.0) : 0.0;
    return told;
}

}  // namespace

TextureExamples textureExamples(const WallEvidence& evidence, const FlatMap& flat,
                                const std::vector<TrueLesion>& truth) {
    const auto& places = evidence.samples.mesh.vertices;
    std::vector<std::uint32_t> walls, inside;
    const std::size_t wallStep = std::max<std::size_t>(1, places.size() / wallVectors);
    for (std::uint32_t v = 0; v < places.size(); ++v) {
        if (v % wallStep == 0) walls.push_back(v);
        if (std::ranges::any_of(truth, [&](const TrueLesion& lesion) {
                return lesion.neoplastic &&
                       glm::distance(places[v], lesion.positionMm) < 0.5 * lesion.diameterMm + 0.5;
            }))
            inside.push_back(v);
    }
    const auto along = stripDirections(evidence.samples, flat, 1);
    const TextureStencil stencil(evidence.samples, along);
    std::vector<glm::vec3> colors;
    for (const BiopsyRay& ray : evidence.rays)
        colors.push_back(ray.color);
    const auto vectorAt = [&](std::uint32_t v) {
        return textureVector(v, stencil.around(v, evidence.shapes[v].intoWall), colors);
    };
    TextureExamples examples;
    for (const std::uint32_t v : walls)
        examples.all.push_back(vectorAt(v));
    const std::size_t step = std::max<std::size_t>(1, inside.size() / polypVectors);
    for (std::size_t n = 0; n < inside.size(); n += step)
        examples.polyps.push_back(vectorAt(inside[n]));
    return examples;
}

std::vector<Example> examplesOf(const std::vector<Candidate>& candidates,
                                const std::vector<TrueLesion>& truth) {
    std::vector<glm::dvec3> places;
    std::vector<Example> examples;
    for (const Candidate& candidate : candidates) {
        places.push_back(candidate.lesion.centerMm);
        examples.push_back({candidate.features, candidate.lesion.centerMm,
                            candidate.lesion.diameter.mm, candidate.lesion.areaMm2});
        examples.back().levelOf = candidate.levelOf;
    }
    const std::vector<int> meant = matched(places, truth);
    std::vector<double> largest(truth.size(), 0.0);
    for (std::size_t n = 0; n < examples.size(); ++n)
        if (meant[n] >= 0 && examples[n].levelOf < 0)
            largest[std::size_t(meant[n])] =
                std::max(largest[std::size_t(meant[n])], examples[n].areaMm2);
    for (std::size_t n = 0; n < examples.size(); ++n) {
        Example& example = examples[n];
        example.lesion = meant[n];
        if (example.levelOf >= 0) example.weighed = false;
        if (meant[n] < 0 || example.levelOf >= 0) continue;
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

Result<TrainedModel> trainModel(const TextureModel& texture, const std::vector<TrainingCase>& cases,
                                const TrainOptions& options) {
    const std::vector<std::size_t> studies = studiesOf(cases);
    const std::size_t count = studies.empty() ? 0 : *std::ranges::max_element(studies) + 1;
    if (count < std::size_t(trainingFolds))
        return fail(ErrorKind::badInput, printed("the training cases are of %zu studies; it takes "
                                                 "%d, which are left out in turns",
                                                 count, trainingFolds));
    const auto foldOf = [&](std::size_t n) { return studies[n] % std::size_t(trainingFolds); };
    CadModel model;
    model.name = options.name, model.trainedOn = options.trainedOn;
    model.trainingSha256 = options.trainingSha256;
    model.trainingScans = options.trainingScans;
    model.textureFrom = options.textureFrom;
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

    // The last have seen all cases, each others all but those of a fold.
    std::vector<Judges> judges(std::size_t(trainingFolds) + 1);
    std::vector<std::vector<const TrainingCase*>> seen(judges.size());
    for (std::size_t fold = 0; fold < judges.size(); ++fold) {
        for (std::size_t n = 0; n < cases.size(); ++n)
            if (foldOf(n) != fold || fold + 1 == judges.size()) seen[fold].push_back(all[n]);
        if (!teaches(seen[fold]))
            return fail(ErrorKind::badInput,
                        "nothing can be learnt: all polyps, or all other places, are of the same "
                        "few studies, and those without them have none to tell apart; more cases "
                        "with polyps are needed");
    }
    parallelFor(judges.size(), 1, options.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t fold = begin; fold < end; ++fold)
            judges[fold] = judgesOn(seen[fold]);
    });
    // The trees by themselves first, the best of each place; then what places make of both.
    std::vector<double> sums;
    std::vector<int> truths;
    const auto ofFold = [&](std::size_t n) -> const Judges& { return judges[foldOf(n)]; };
    for (std::size_t n = 0; n < cases.size(); ++n) {
        auto witnesses = witnessesOf(
            cases[n],
            [&](const FeatureVector& features) {
                return ofFold(n).boosted.at(asDenseAsTheWall(features));
            },
            std::numeric_limits<double>::lowest());
        // They come after all others.
        std::erase_if(witnesses, [](const PlaceWitness& each) { return each.levelOf >= 0; });
        for (const WitnessedPlace& place : placesOf(witnesses)) {
            const Example& best = cases[n].examples[place.best];
            const auto polyp = truthOf(cases[n], best.lesion);
            if (!polyp || !rises(best.features)) continue;
            sums.push_back(witnesses[place.best].probability);
            truths.push_back(*polyp);
        }
    }
    if (!hasBoth(truths))
        return fail(
            ErrorKind::badInput,
            "nothing was learnt: what rises above the wall holds no polyp, or nothing else");
    std::tie(model.calibrationA, model.calibrationB) = fitLogistic(sums, truths);
    if (!(model.calibrationB > 0.0))
        return fail(ErrorKind::badInput,
                    "nothing was learnt: polyps that the trees had not seen score no higher than "
                    "other places; more training cases, or ones with more polyps, are needed");
    TrainedModel trained;
    trained.crossValidated = TRY(calibratePlaces(
        model, cases,
        [&](std::size_t n, const FeatureVector& features) {
            return candidateProbability(ofFold(n).boosted, ofFold(n).networks, model.calibrationA,
                                        model.calibrationB, features);
        },
        options.falsePositives));
    model.boosted = std::move(judges.back().boosted);
    model.networks = std::move(judges.back().networks);
    trained.model = std::move(model);
    return trained;
}

Result<std::vector<EvaluatedCase>> calibrate(CadModel& model,
                                             const std::vector<TrainingCase>& cases,
                                             double falsePositives) {
    return calibratePlaces(
        model, cases,
        [&](std::size_t, const FeatureVector& features) { return model.probability(features); },
        falsePositives);
}

}  // namespace haustra::cad
