#include "cad/places.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haustra::cad {

std::vector<WitnessedPlace> placesOf(std::span<const PlaceWitness> witnesses) {
    std::vector<std::size_t> order(witnesses.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const PlaceWitness &x = witnesses[a], &y = witnesses[b];
        return x.probability != y.probability ? x.probability > y.probability
                                              : x.areaMm2 > y.areaMm2;
    });
    std::vector<WitnessedPlace> places;
    std::vector<bool> seconded;
    for (const std::size_t n : order) {
        const PlaceWitness& witness = witnesses[n];
        const auto told =
            std::find_if(places.begin(), places.end(), [&](const WitnessedPlace& place) {
                const PlaceWitness& best = witnesses[place.best];
                return glm::distance(best.centreMm, witness.centreMm) <
                       0.5 * std::max(best.diameterMm, witness.diameterMm);
            });
        if (told == places.end()) {
            places.push_back({n, 0.5 * witness.probability});
            seconded.push_back(false);
        } else if (const auto at = std::size_t(told - places.begin()); !seconded[at]) {
            told->score += 0.5 * witness.probability;
            seconded[at] = true;
        }
    }
    return places;
}

double logit(double probability) {
    const double p = std::clamp(probability, 1e-6, 1.0 - 1e-6);
    return std::log(p / (1.0 - p));
}

double logistic(double x) {
    return 1.0 / (1.0 + std::exp(-x));
}

}  // namespace haustra::cad
