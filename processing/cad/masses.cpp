#include "cad/masses.h"

#include <algorithm>

namespace haustra::cad {
namespace {

constexpr double leastMassMm = 20.0, mostGapMm = 3.0;
constexpr std::size_t leastFindings = 3;

// Between the rims, and across both.
double gapMm(const Finding& a, const Finding& b) {
    return glm::distance(a.positionMm, b.positionMm) - 0.5 * (a.diameterMm + b.diameterMm);
}
double acrossMm(const Finding& a, const Finding& b) {
    return glm::distance(a.positionMm, b.positionMm) + 0.5 * (a.diameterMm + b.diameterMm);
}

}  // namespace

std::vector<MassOfFindings> massesOf(std::span<const Finding> findings) {
    std::vector<MassOfFindings> masses;
    std::vector<bool> taken(findings.size(), false);
    for (std::size_t n = 0; n < findings.size(); ++n)
        taken[n] = findings[n].kind == annularKind;
    for (std::size_t first = 0; first < findings.size(); ++first) {
        if (taken[first]) continue;
        taken[first] = true;
        MassOfFindings mass{{first}};
        for (std::size_t n = 0; n < mass.findings.size(); ++n) {
            for (std::size_t other = 0; other < findings.size(); ++other) {
                if (taken[other] || gapMm(findings[mass.findings[n]], findings[other]) > mostGapMm)
                    continue;
                taken[other] = true;
                mass.findings.push_back(other);
            }
        }
        if (mass.findings.size() < leastFindings) continue;
        std::ranges::sort(mass.findings);
        for (const std::size_t a : mass.findings)
            for (const std::size_t b : mass.findings)
                if (a != b)
                    mass.widthMm = std::max(mass.widthMm, acrossMm(findings[a], findings[b]));
        if (mass.widthMm >= leastMassMm) masses.push_back(std::move(mass));
    }
    return masses;
}

}  // namespace haustra::cad
