#include "cad/places.h"

#include <algorithm>
#include <cmath>

namespace haustra::cad {

std::vector<WitnessedPlace> placesOf(std::span<const PlaceWitness> witnesses) {
    constexpr int asked = 3;
    std::vector<std::size_t> order;
    for (std::size_t n = 0; n < witnesses.size(); ++n) {
        const std::int32_t of = witnesses[n].levelOf;
        if (of < 0 || witnesses[std::size_t(of)].probability >= worthAnotherLook)
            order.push_back(n);
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const PlaceWitness &x = witnesses[a], &y = witnesses[b];
        return x.probability != y.probability ? x.probability > y.probability
                                              : x.areaMm2 > y.areaMm2;
    });
    std::vector<WitnessedPlace> places;
    std::vector<int> heard;  // witnesses of each
    for (const std::size_t n : order) {
        const PlaceWitness& witness = witnesses[n];
        auto told = std::find_if(places.begin(), places.end(), [&](const WitnessedPlace& place) {
            const PlaceWitness& best = witnesses[place.best];
            return isSamePlace(best.centerMm, best.diameterMm, witness.centerMm,
                               witness.diameterMm);
        });
        if (told == places.end()) {
            told = places.insert(places.end(), {n, 0.0});
            heard.push_back(0);
        }
        if (heard[std::size_t(told - places.begin())]++ < asked)
            told->score += witness.probability / asked;
    }
    return places;
}

bool isSamePlace(glm::dvec3 oneMm, double oneDiameterMm, glm::dvec3 otherMm,
                 double otherDiameterMm) {
    return glm::distance(oneMm, otherMm) < 0.5 * std::max(oneDiameterMm, otherDiameterMm);
}

double logit(double probability) {
    const double p = std::clamp(probability, 1e-6, 1.0 - 1e-6);
    return std::log(p / (1.0 - p));
}

double logistic(double x) {
    return 1.0 / (1.0 + std::exp(-x));
}

}  // namespace haustra::cad
