#include "phantom/polyline.h"

#include <algorithm>
#include <cmath>

namespace haustra::phantom {

glm::dvec3 catmullRom(const Points& p, double u) {
    const int last = int(p.size()) - 1;
    const int n = std::clamp(int(std::floor(u)), 0, last - 1);
    const double t = std::clamp(u - n, 0.0, 1.0);
    const glm::dvec3 &b = p[n], &c = p[n + 1];
    const glm::dvec3 a = n > 0 ? p[n - 1] : 2.0 * b - c, d = n + 2 <= last ? p[n + 2] : 2.0 * c - b;
    return 0.5 * (2.0 * b + (c - a) * t + (2.0 * a - 5.0 * b + 4.0 * c - d) * (t * t) +
                  (3.0 * b - a - 3.0 * c + d) * (t * t * t));
}

double lengthOf(const Points& p) {
    double sum = 0.0;
    for (std::size_t n = 1; n < p.size(); ++n)
        sum += glm::distance(p[n - 1], p[n]);
    return sum;
}

Points resample(const Points& fine, double stepMm, std::vector<double>* place) {
    std::vector<double> arc(fine.size(), 0.0);
    for (std::size_t n = 1; n < fine.size(); ++n)
        arc[n] = arc[n - 1] + glm::distance(fine[n - 1], fine[n]);
    const int count = std::max(2, int(std::lround(arc.back() / stepMm)) + 1);
    Points even;
    if (place) place->clear();
    std::size_t n = 1;
    for (int k = 0; k < count; ++k) {
        const double s = arc.back() * k / (count - 1);
        while (n + 1 < fine.size() && arc[n] < s)
            ++n;
        const double t =
            std::clamp((s - arc[n - 1]) / std::max(1e-12, arc[n] - arc[n - 1]), 0.0, 1.0);
        even.push_back(glm::mix(fine[n - 1], fine[n], t));
        if (place) place->push_back(double(n - 1) + t);
    }
    return even;
}

}  // namespace haustra::phantom
