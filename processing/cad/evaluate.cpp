#include "cad/evaluate.h"

#include "core/quantile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>

namespace haustra::cad {
namespace {

bool blamed(const EvaluatedCase& each, const ToldPlace& place) {
    return place.lesion < 0 || each.truth[std::size_t(place.lesion)].isPolyp() == false;
}

bool isHyperplastic(const EvaluatedCase& each, const ToldPlace& place) {
    return place.lesion >= 0 && each.truth[std::size_t(place.lesion)].hyperplastic();
}

// What a place that is no polyp is.
const std::string& kindOf(const EvaluatedCase& each, const ToldPlace& place) {
    return place.lesion >= 0 ? each.truth[std::size_t(place.lesion)].kind : place.looksLike;
}

// The best score that each lesion was told with; below 0: not told.
std::vector<double> bestScores(const EvaluatedCase& each) {
    std::vector<double> best(each.truth.size(), -1.0);
    for (const ToldPlace& place : each.places)
        if (place.lesion >= 0)
            best[std::size_t(place.lesion)] =
                std::max(best[std::size_t(place.lesion)], place.score);
    return best;
}

void count(Share& share, bool hit) {
    ++share.of;
    share.hit += hit;
}

bool holdPolyps(const std::vector<const EvaluatedCase*>& cases) {
    return std::ranges::any_of(cases, [](const EvaluatedCase* each) {
        return std::ranges::any_of(each->truth, countsInCurve);
    });
}

// Thresholds at which the false positives a scan are at most as asked, and the sensitivity there.
// Needs cases that hold polyps.
std::vector<std::pair<double, double>> sensitivities(const std::vector<const EvaluatedCase*>& cases,
                                                     const std::vector<double>& falsePositives) {
    std::vector<double> wrong, right;
    int lesions = 0;
    for (const EvaluatedCase* each : cases) {
        for (const ToldPlace& place : each->places)
            if (blamed(*each, place)) wrong.push_back(place.score);
        const std::vector<double> best = bestScores(*each);
        for (std::size_t l = 0; l < best.size(); ++l) {
            if (!countsInCurve(each->truth[l])) continue;
            ++lesions;
            if (best[l] >= 0.0) right.push_back(best[l]);
        }
    }
    // Of many wrong ones only the best can be asked for.
    const auto most = std::size_t(*std::ranges::max_element(falsePositives) * double(cases.size()));
    if (most + 1 < wrong.size()) {
        std::ranges::nth_element(wrong, wrong.begin() + std::ptrdiff_t(most), std::greater());
        wrong.resize(most + 1);
    }
    std::sort(wrong.rbegin(), wrong.rend());
    std::sort(right.rbegin(), right.rend());
    std::vector<std::pair<double, double>> points;
    for (const double wanted : falsePositives) {
        const auto allowed = std::size_t(wanted * double(cases.size()));
        // What scores more than the first wrong one too many is told.
        const double limit = allowed < wrong.size() ? wrong[allowed] : -1.0;
        const auto told = std::partition_point(right.begin(), right.end(),
                                               [&](double score) { return score > limit; });
        points.emplace_back(limit, double(told - right.begin()) / lesions);
    }
    return points;
}

}  // namespace

bool countsInCurve(const TrueLesion& lesion) {
    return lesion.neoplastic && lesion.diameterMm >= 6.0;
}

EvaluatedCase evaluateCase(std::string name, std::string group,
                           const std::vector<Candidate>& weighed,
                           const std::vector<TrueLesion>& truth) {
    EvaluatedCase result{std::move(name), std::move(group), truth, {}};
    std::vector<glm::dvec3> places;
    for (const Candidate& candidate : weighed)
        places.push_back(candidate.lesion.centerMm);
    const std::vector<int> meant = matched(places, truth);
    for (std::size_t n = 0; n < weighed.size(); ++n) {
        const Candidate& candidate = weighed[n];
        const char* looks = candidate.features[featureNumber("wet_share")] > 0.5 ? "under fluid"
                            : candidate.features[featureNumber("reentry_share")] > 0.5 ||
                                    candidate.features[featureNumber("ring_ridge_share")] > 0.3
                                ? "fold"
                                : "wall";
        result.places.push_back({candidate.probability, candidate.lesion.diameter.mm, meant[n],
                                 meant[n] < 0 ? looks : "", candidate.lesion.centerMm});
    }
    return result;
}

Evaluation evaluate(const std::vector<const EvaluatedCase*>& cases, double operatingPoint) {
    Evaluation sum;
    sum.cases = int(cases.size());
    std::vector<double> errors, submerged, pedunculated;
    double bias = 0.0;
    for (const EvaluatedCase* each : cases) {
        std::vector<const ToldPlace*> best(each->truth.size(), nullptr);
        for (const ToldPlace& place : each->places) {
            sum.falseBefore += blamed(*each, place);
            if (place.score < operatingPoint) continue;
            if (blamed(*each, place)) {
                ++sum.falsePositives;
                ++sum.falseKinds[kindOf(*each, place)];
                continue;
            }
            const ToldPlace*& told = best[std::size_t(place.lesion)];
            if (!told || place.score > told->score) told = &place;
            sum.hyperplastic += isHyperplastic(*each, place);
        }
        for (std::size_t l = 0; l < best.size(); ++l) {
            const TrueLesion& lesion = each->truth[l];
            if (!lesion.neoplastic) continue;
            const bool hit = best[l] != nullptr;
            if (lesion.diameterMm >= 5.0 && lesion.diameterMm < 6.0) count(sum.from5To6Mm, hit);
            if (hit) {
                const double error = best[l]->diameterMm - lesion.diameterMm;
                errors.push_back(std::abs(error));
                bias += error;
                if (lesion.submerged()) submerged.push_back(std::abs(error));
                if (lesion.kind == "pedunculated") pedunculated.push_back(std::abs(error));
            }
            if (lesion.diameterMm < 6.0) continue;
            count(sum.from6Mm, hit);
            if (lesion.diameterMm >= 10.0) count(sum.from10Mm, hit);
            if (lesion.coreHu) count(*lesion.coreHu < 5.0 ? sum.plain : sum.dense, hit);
            if (lesion.hidden())
                count(sum.hidden, hit);
            else if (lesion.submerged())
                count(sum.submerged, hit);
            else if (lesion.filmMm > 0.0)
                count(sum.coated, hit);
            count(sum.byKind[lesion.kind], hit);
        }
    }
    const double scans = std::max(1, sum.cases);
    sum.falsePositives /= scans, sum.falseBefore /= scans;
    const auto mean = [](const std::vector<double>& values) -> std::optional<double> {
        if (values.empty()) return std::nullopt;
        return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
    };
    sum.diameterMean = mean(errors);
    sum.submergedDiameterMean = mean(submerged), sum.pedunculatedDiameterMean = mean(pedunculated);
    if (!errors.empty()) {
        sum.diameterBias = bias / double(errors.size());
        std::sort(errors.begin(), errors.end());
        // The least that 95 % of them do not exceed.
        sum.diameter95 = errors[std::size_t(std::ceil(0.95 * double(errors.size()))) - 1];
    }
    return sum;
}

namespace {

void sortFrom(std::vector<JudgedPlace>& places, std::size_t first) {
    std::stable_sort(places.begin() + std::ptrdiff_t(first), places.end(),
                     [](const JudgedPlace& a, const JudgedPlace& b) { return a.score > b.score; });
}

}  // namespace

std::vector<JudgedPlace> missedLesions(const std::vector<const EvaluatedCase*>& cases,
                                       double operatingPoint) {
    std::vector<JudgedPlace> missed;
    for (const EvaluatedCase* each : cases) {
        const std::size_t first = missed.size();
        const std::vector<double> best = bestScores(*each);
        for (std::size_t l = 0; l < best.size(); ++l) {
            const TrueLesion& lesion = each->truth[l];
            if (!lesion.neoplastic || lesion.diameterMm < 5.0 || best[l] >= operatingPoint)
                continue;
            missed.push_back({each->name, lesion.positionMm, lesion.diameterMm, lesion.kind,
                              std::max(0.0, best[l])});
        }
        sortFrom(missed, first);
    }
    return missed;
}

namespace {

using IsMeant = bool (*)(const EvaluatedCase& each, const ToldPlace& place);

std::vector<JudgedPlace> told(const std::vector<const EvaluatedCase*>& cases, double operatingPoint,
                              IsMeant isMeant) {
    std::vector<JudgedPlace> found;
    for (const EvaluatedCase* each : cases) {
        const std::size_t first = found.size();
        for (const ToldPlace& place : each->places)
            if (place.score >= operatingPoint && isMeant(*each, place))
                found.push_back({each->name, place.centerMm, place.diameterMm, kindOf(*each, place),
                                 place.score});
        sortFrom(found, first);
    }
    return found;
}

}  // namespace

std::vector<JudgedPlace> falseFindings(const std::vector<const EvaluatedCase*>& cases,
                                       double operatingPoint) {
    return told(cases, operatingPoint, blamed);
}

std::vector<JudgedPlace> hyperplasticFindings(const std::vector<const EvaluatedCase*>& cases,
                                              double operatingPoint) {
    return told(cases, operatingPoint, isHyperplastic);
}

std::vector<FrocPoint> frocCurve(const std::vector<const EvaluatedCase*>& cases, int resamples) {
    if (!holdPolyps(cases)) return {};
    const auto holders =
        std::ranges::count_if(cases, [](const EvaluatedCase* each) { return holdPolyps({each}); });
    std::vector<double> wanted;
    for (double n = -3.0; n <= 4.0; n += 0.5)
        wanted.push_back(std::exp2(n));
    std::vector<FrocPoint> curve;
    for (const auto& [threshold, sensitivity] : sensitivities(cases, wanted))
        curve.push_back({wanted[curve.size()], sensitivity, 0.0, 1.0, threshold});
    if (holders < 2) return curve;
    std::mt19937 random(1);
    std::vector<std::vector<double>> drawn(wanted.size());
    for (int n = 0; n < resamples; ++n) {
        // The engine's numbers are the same everywhere; a distribution's need not be.
        std::vector<const EvaluatedCase*> sample;
        for (std::size_t c = 0; c < cases.size(); ++c)
            sample.push_back(cases[random() % cases.size()]);
        if (!holdPolyps(sample)) continue;  // nothing to be found or missed
        const auto points = sensitivities(sample, wanted);
        for (std::size_t p = 0; p < points.size(); ++p)
            drawn[p].push_back(points[p].second);
    }
    for (std::size_t p = 0; p < curve.size() && !drawn[p].empty(); ++p) {
        curve[p].low = quantileOf(drawn[p], 0.025);
        curve[p].high = quantileOf(drawn[p], 0.975);
    }
    return curve;
}

}  // namespace haustra::cad
