#include "cleansing/film_profile.h"

#include "core/normal_distribution.h"

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

namespace haustra::cleansing {
namespace {

constexpr double thinnestWallMm = 1.2;  // that holds a film, with air behind it

/// Of the samples `first` to `last`.
class Fit {
public:
    Fit(const LineSamples& samples, int first, int last, const FilmProfile& start, double noiseSd)
        : samples_(samples),
          first_(first),
          last_(last),
          priorHu_(start.taggedHu),
          priorSdHu_(0.25 * (start.taggedHu - start.softHu)),
          sdHu_(std::max(noiseSd, 0.03 * (start.taggedHu - start.airHu))) {}

    FilmProfile from(FilmProfile p) const {
        double now = cost(p), damping = 0.1;
        for (int iteration = 0; iteration < 12 && damping < 1e4; ++iteration) {
            const FilmProfile next = stepped(p, damping);
            const double then = cost(next);
            if (!(then < now)) {
                damping *= 8.0;
                continue;
            }
            const bool settled = now - then < 1e-3 * now;
            p = next, now = then, damping *= 0.3;
            if (settled) break;
        }
        const double prior = (p.taggedHu - priorHu_) / priorSdHu_;
        p.misfitHu = sdHu_ * std::sqrt(std::max(0.0, now - prior * prior) / (last_ - first_ + 1));
        return p;
    }

private:
    double residual(const FilmProfile& p, int n) const {
        const double mm = samples_.mm(n);
        return (samples_.hu[std::size_t(n)] - p.withoutFilm(mm) - p.film(mm)) / sdHu_;
    }

    double cost(const FilmProfile& p) const {
        const double prior = (p.taggedHu - priorHu_) / priorSdHu_;
        double sum = prior * prior;
        for (int n = first_; n <= last_; ++n)
            sum += residual(p, n) * residual(p, n);
        return sum;
    }

    FilmProfile stepped(const FilmProfile& p, double damping) const {
        glm::dmat4 normal(0.0);
        glm::dvec4 gradient(0.0);
        for (int n = first_; n <= last_; ++n) {
            const double mm = samples_.mm(n);
            const double outer = (mm - p.outerMm) / p.blurMm, wall = (mm - p.wallMm) / p.blurMm,
                         film = (mm - p.filmMm) / p.blurMm;
            const glm::dvec4 slope =
                glm::dvec4(-(p.softHu - p.outerHu) * normalDensity(outer) / p.blurMm,
                           -(p.taggedHu - p.softHu) * normalDensity(wall) / p.blurMm,
                           (p.taggedHu - p.airHu) * normalDensity(film) / p.blurMm,
                           normalCdf(wall) - normalCdf(film)) /
                sdHu_;
            normal += glm::outerProduct(slope, slope);
            gradient += residual(p, n) * slope;
        }
        normal[3][3] += 1.0 / (priorSdHu_ * priorSdHu_);
        gradient[3] -= (p.taggedHu - priorHu_) / (priorSdHu_ * priorSdHu_);
        for (int d = 0; d < 4; ++d)
            normal[d][d] += damping * normal[d][d] + 1e-6;
        const glm::dvec4 step = glm::inverse(normal) * gradient;
        FilmProfile next = p;
        next.filmMm += std::clamp(step[2], -1.0, 1.0);
        next.wallMm = std::min(p.wallMm + std::clamp(step[1], -1.0, 1.0), next.filmMm);
        next.outerMm = std::min(p.outerMm + std::clamp(step[0], -1.0, 1.0), next.wallMm);
        next.taggedHu = std::max(p.taggedHu + step[3], p.softHu + 0.8 * (priorHu_ - p.softHu));
        return next;
    }

    const LineSamples& samples_;
    int first_, last_;
    double priorHu_, priorSdHu_, sdHu_;
};

}  // namespace

double FilmProfile::withoutFilm(double mm) const {
    return outerHu + (softHu - outerHu) * normalCdf((mm - outerMm) / blurMm) -
           (softHu - airHu) * normalCdf((mm - wallMm) / blurMm);
}

double FilmProfile::film(double mm) const {
    return (taggedHu - airHu) *
           (normalCdf((mm - wallMm) / blurMm) - normalCdf((mm - filmMm) / blurMm));
}

std::optional<FilmProfile> fitFilm(const LineSamples& samples, const FilmProfile& start,
                                   double noiseSd, double thickestMm) {
    FilmProfile p = start;
    const auto& hu = samples.hu;
    const int crest = samples.middle();
    const double half = 0.5 * (p.softHu + p.airHu);
    const double most = hu[std::size_t(crest)] + noiseSd;
    int last = crest, open = -1;
    while (last + 1 < int(hu.size()) && hu[std::size_t(last + 1)] <= most) {
        ++last;
        if (open < 0 && hu[std::size_t(last)] < half) open = last;
        if (hu[std::size_t(last)] < p.airHu + 2.0 * noiseSd) break;
    }
    if (open < 0 || samples.mm(open) > thickestMm) return std::nullopt;
    int first = crest;
    while (first > 0 && hu[std::size_t(first - 1)] <= most) {
        --first;
        if (hu[std::size_t(first)] < half) break;
    }
    if (first == crest) return std::nullopt;
    const double deepest = *std::min_element(hu.begin() + first, hu.begin() + crest);
    if (deepest > 0.5 * (p.softHu + p.taggedHu)) return std::nullopt;
    p.outerHu = deepest < half ? p.airHu : std::min(deepest, p.softHu);
    p.outerMm = samples.mm(first);
    p.filmMm = samples.mm(open - 1);
    // The fit begins with the thickness d whose film adds the area d (μ_tagged − μ_soft).
    double excess = 0.0;
    for (int n = first; n < open; ++n)
        excess += std::max(0.0, hu[std::size_t(n)] - p.softHu) * samples.strideMm;
    p.wallMm = p.filmMm - std::min(thickestMm, excess / (p.taggedHu - p.softHu) + 0.2);
    p = Fit(samples, first, last, p, noiseSd).from(p);
    const bool explained = std::isfinite(p.misfitHu) &&
                           p.misfitHu < std::max(3.0 * noiseSd, 0.06 * (p.taggedHu - p.airHu));
    if (!explained || p.thicknessMm() < 0.05 || p.thicknessMm() > thickestMm) return std::nullopt;
    // Fluid lies on something: a dense sheet between air and air is a tube's wall, or a tablet's.
    if (p.outerHu < half && p.wallMm - p.outerMm < thinnestWallMm) return std::nullopt;
    return p;
}

}  // namespace haustra::cleansing
