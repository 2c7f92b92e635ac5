#include "cleansing/thin_films.h"

#include "cleansing/ball.h"
#include "cleansing/film_profile.h"
#include "core/parallel.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr double thickestMm = 2.5;  // beyond, the film has an inside that shows its HU
constexpr double lineMm = 4.0;      // to either side of a crest
constexpr double alongMm = 0.7;     // how far along a film one profile is taken to hold

struct Crest {
    glm::dvec3 voxel;
    glm::dvec3 across;  ///< unit, along the grid's axes, from wall to air
    FilmProfile profile;
};

/// Finds the crests of films, voxel by voxel.
class Films {
public:
    Films(const CtScan& scan, const Volume<std::uint8_t>& segmentation, const LocalMeans& means,
          const PointSpread& spread)
        : hu_(scan.hu),
          segmentation_(segmentation),
          means_(means),
          spread_(spread),
          spacingMm_(scan.hu.grid().spacingMm()),
          look_(neighbourStep(scan.hu.grid())) {}

    std::optional<Crest> crestAt(glm::ivec3 v) const {
        const Grid& grid = hu_.grid();
        if (!grid.contains(v - look_) || !grid.contains(v + look_)) return std::nullopt;
        FilmProfile start;
        start.softHu = means_.softHu.at(v.x, v.y, v.z);
        start.airHu = means_.airHu.at(v.x, v.y, v.z);
        const double taggedHu = std::max<double>(means_.taggedHu.at(v), start.softHu + 60.0);
        const double here = hu_.at(v);
        const double least = std::max(2.0 * means_.noise.tagged, 0.08 * (taggedHu - start.softHu));
        if (here < start.softHu + least || !airNear(v)) return std::nullopt;
        const auto normal = crestNormal(v);
        if (!normal) return std::nullopt;
        start.taggedHu = std::max(taggedHu, here);
        start.blurMm = spread_.drawnMm(*normal);
        std::optional<Crest> best;
        for (const double side : {-1.0, 1.0}) {
            const glm::dvec3 across = side * *normal;
            const auto profile = fitFilm(line(v, across), start, means_.noise.tagged, thickestMm);
            if (profile && (!best || profile->misfitHu < best->profile.misfitHu))
                best = Crest{glm::dvec3(v), across, *profile};
        }
        if (!best) return std::nullopt;
        const double parallel = facesParallel(*best);
        const double thinning = thinningAlong(*best);
        const bool film = besidePool(v) ? parallel > 0.988 && thinning < 0.3 &&
                                              best->profile.taggedHu > 0.97 * taggedHu
                                        : parallel > 0.94;
        return film ? best : std::nullopt;
    }

private:
    double sample(glm::dvec3 p) const {
        return trilinear(hu_, glm::clamp(p, glm::dvec3(0.0), glm::dvec3(hu_.grid().size - 1)));
    }

    LineSamples line(glm::ivec3 v, glm::dvec3 across) const {
        LineSamples samples;
        const int steps = int(lineMm / samples.strideMm);
        for (int n = -steps; n <= steps; ++n)
            samples.hu.push_back(
                sample(glm::dvec3(v) + n * samples.strideMm * across / spacingMm_));
        return samples;
    }

    bool airNear(glm::ivec3 v) const {
        const glm::ivec3 reach(glm::ceil(thickestMm / spacingMm_));
        for (int axis = 0; axis < 3; ++axis) {
            for (int n = -reach[axis]; n <= reach[axis]; ++n) {
                glm::ivec3 at = v;
                at[axis] += n;
                if (hu_.grid().contains(at) && LumenLabel(segmentation_.at(at)) == LumenLabel::air)
                    return true;
            }
        }
        return false;
    }

    /// Whether fluid deep enough to show its own HU is near.
    bool besidePool(glm::ivec3 v) const {
        const glm::ivec3 depth = glm::max(glm::ivec3(glm::round(1.6 / spacingMm_)), glm::ivec3(1));
        const auto tagged = [&](glm::ivec3 n) {
            return hu_.grid().contains(n) && LumenLabel(segmentation_.at(n)) == LumenLabel::tagged;
        };
        const auto deep = [&](glm::ivec3 n) {
            for (int axis = 0; axis < 3; ++axis) {
                glm::ivec3 step(0);
                step[axis] = depth[axis];
                if (!tagged(n + step) || !tagged(n - step)) return false;
            }
            return tagged(n);
        };
        bool found = false;
        eachStep(hu_.grid(), v, voxelsIn(hu_.grid(), 4.5), look_,
                 [&](glm::ivec3 n) { found = found || deep(n); });
        return found;
    }

    /// HU per mm, by differences of `reachMm` to either side.
    glm::dvec3 gradientAt(glm::dvec3 p, double reachMm) const {
        glm::dvec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 step(0.0);
            step[axis] = reachMm / spacingMm_[axis];
            gradient[axis] = (sample(p + step) - sample(p - step)) / (2.0 * reachMm);
        }
        return gradient;
    }

    /// Cosine between the normals of the crest and of the face to the air.
    double facesParallel(const Crest& crest) const {
        const glm::dvec3 gradient =
            gradientAt(crest.voxel + crest.profile.filmMm * crest.across / spacingMm_, 0.7);
        return -glm::dot(gradient, crest.across) / (glm::length(gradient) + 1e-9);
    }

    /// How much thinner the film gets along itself, mm per mm, by its HU at the crest.
    double thinningAlong(const Crest& crest) const {
        const glm::dvec3 gradient = gradientAt(crest.voxel, 1.0);
        const glm::dvec3 along = gradient - glm::dot(gradient, crest.across) * crest.across;
        const FilmProfile& p = crest.profile;
        return glm::length(along) * std::sqrt(2.0 * M_PI) * p.blurMm / (p.taggedHu - p.softHu);
    }

    /// The direction in which the HU bend down the most, where they are highest within about half a
    /// voxel.
    std::optional<glm::dvec3> crestNormal(glm::ivec3 v) const {
        glm::dmat3 hessian;
        glm::dvec3 gradient;
        const glm::dvec3 h = spacingMm_ * glm::dvec3(look_);
        for (int a = 0; a < 3; ++a) {
            glm::ivec3 u(0);
            u[a] = look_[a];
            const double before = hu_.at(v - u), after = hu_.at(v + u);
            gradient[a] = (after - before) / (2.0 * h[a]);
            hessian[a][a] = (after - 2.0 * hu_.at(v) + before) / (h[a] * h[a]);
            for (int b = 0; b < a; ++b) {
                glm::ivec3 w(0);
                w[b] = look_[b];
                hessian[a][b] = hessian[b][a] = (hu_.at(v + u + w) - hu_.at(v + u - w) -
                                                 hu_.at(v - u + w) + hu_.at(v - u - w)) /
                                                (4.0 * h[a] * h[b]);
            }
        }
        glm::dvec3 n = hessian[0];
        for (int axis = 1; axis < 3; ++axis) {
            if (glm::dot(hessian[axis], hessian[axis]) > glm::dot(n, n)) n = hessian[axis];
        }
        for (int iteration = 0; iteration < 6; ++iteration) {
            if (glm::dot(n, n) < 1e-6) return std::nullopt;
            n = hessian * glm::normalize(n);
        }
        n = glm::normalize(n);
        const double bend = glm::dot(n, hessian * n);
        if (bend > -4.0 * means_.noise.tagged) return std::nullopt;
        const double topMm = -glm::dot(gradient, n) / bend;
        if (std::abs(topMm) * glm::length(n / spacingMm_) > 0.6) return std::nullopt;
        return n;
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& segmentation_;
    const LocalMeans& means_;
    const PointSpread& spread_;
    glm::dvec3 spacingMm_;
    glm::ivec3 look_;
};

std::vector<Crest> findCrests(const Films& films, const Grid& grid,
                              const TaggedSurroundings& around, int threads) {
    constexpr std::size_t blockSize = 1 << 12;
    std::vector<Crest> crests;
    // The outer third of the surroundings holds no crest whose film reaches the tagging.
    for (std::size_t shell = 0; 3 * shell < 2 * around.shells.size(); ++shell) {
        const auto& voxels = around.shells[shell];
        std::vector<std::vector<Crest>> found((voxels.size() + blockSize - 1) / blockSize);
        parallelFor(found.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t block = begin; block < end; ++block) {
                const std::size_t last = std::min(voxels.size(), (block + 1) * blockSize);
                for (std::size_t m = block * blockSize; m < last; ++m) {
                    if (const auto crest = films.crestAt(grid.voxelAt(voxels[m])))
                        found[block].push_back(*crest);
                }
            }
        });
        for (const auto& block : found)
            crests.insert(crests.end(), block.begin(), block.end());
    }
    return crests;
}

/// Calls visit(index, mm across, squared mm along) for the voxels around a crest that the blur of
/// the air beyond the film reaches.
template <class Visit>
void eachAround(const Grid& grid, const Crest& crest, const Visit& visit) {
    const FilmProfile& p = crest.profile;
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 reach(glm::ceil((thickestMm + 2.5 * p.blurMm) / spacing)), v(crest.voxel);
    const glm::ivec3 lo = glm::max(v - reach, glm::ivec3(0)),
                     hi = glm::min(v + reach, grid.size - 1);
    visitBox(lo, hi, [&](glm::ivec3 w) {
        const glm::dvec3 d = (glm::dvec3(w) - crest.voxel) * spacing;
        const double mm = glm::dot(d, crest.across), along2 = glm::dot(d, d) - mm * mm;
        if (mm < p.filmMm - 2.0 * p.blurMm || mm > p.filmMm + 2.5 * p.blurMm ||
            along2 > alongMm * alongMm)
            return;
        visit(grid.index(w), mm, along2);
    });
}

}  // namespace

Volume<std::uint8_t> settleFilms(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                                 const LocalMeans& means, const PointSpread& spread,
                                 const TaggedSurroundings& around, Volume<TissueFractions>& mixture,
                                 int threads) {
    const Grid& grid = scan.hu.grid();
    const auto crests = findCrests(Films(scan, segmentation, means, spread), grid, around, threads);
    Volume<std::uint8_t> settled(grid, std::uint8_t(0));
    const auto mark = settled.writable();
    std::vector<std::uint32_t> places;
    for (const Crest& crest : crests) {
        eachAround(grid, crest, [&](std::size_t n, double, double) {
            if (mark[n] == 0) places.push_back(std::uint32_t(n)), mark[n] = 1;
        });
    }
    std::sort(places.begin(), places.end());

    // HU of the film, and of the rest above air, by the profiles nearby.
    struct Sums {
        double weight = 0.0, film = 0.0, rest = 0.0;
    };
    std::vector<Sums> sums(places.size());
    for (const Crest& crest : crests) {
        const FilmProfile& p = crest.profile;
        const double misfit = p.misfitHu / means.noise.tagged;
        eachAround(grid, crest, [&](std::size_t n, double mm, double along2) {
            const auto at = std::lower_bound(places.begin(), places.end(), std::uint32_t(n));
            Sums& sum = sums[std::size_t(at - places.begin())];
            const double w =
                std::exp(-2.0 * along2 / (alongMm * alongMm)) / (1.0 + misfit * misfit);
            sum.weight += w;
            sum.film += w * p.film(mm), sum.rest += w * (p.withoutFilm(mm) - p.airHu);
        });
    }
    const auto out = mixture.writable();
    for (std::size_t m = 0; m < places.size(); ++m) {
        const std::uint32_t n = places[m];
        const glm::ivec3 v = grid.voxelAt(n);
        const double air = means.airHu.at(v.x, v.y, v.z), soft = means.softHu.at(v.x, v.y, v.z);
        const double taggedHu = means.taggedHu.at(v), y = scan.hu[n];
        const double film = sums[m].film / sums[m].weight,
                     rest = std::max(0.0, sums[m].rest / sums[m].weight);
        const double unexplained = y - air - film - rest;
        if (taggedHu <= soft || std::abs(unexplained) > 0.15 * film + 3.0 * means.noise.tagged) {
            mark[n] = 0;
            continue;
        }
        // Film and rest each take their part of what is unexplained.
        const double taken = film + unexplained * film / (film + rest + 1.0);
        const double tagged = std::clamp(taken / (taggedHu - air), 0.0, 1.0);
        const double hu = y - tagged * (taggedHu - air);
        const double open = std::clamp((soft - hu) / (soft - air), 0.0, 1.0);
        out[n] = roundedFractions(std::clamp(open - tagged, 0.0, 1.0 - tagged), tagged);
    }
    return settled;
}

}  // namespace haustra::cleansing
