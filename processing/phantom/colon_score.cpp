#include "phantom/colon_score.h"

#include "core/disjoint_sets.h"
#include "core/flood_fill.h"
#include "core/voxel_sweep.h"
#include "phantom/score.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

namespace haustra::phantom {
namespace {

constexpr double leapSlackMm = 20.0, pathSlackMm = 30.0, cordMm = 12.0;

struct Stretch {
    double beginMm = 0.0, endMm = 0.0;
    double middleMm() const { return 0.5 * (beginMm + endMm); }
};

/// The true lumen, each voxel with its sample of the axis.
class TrueCourse {
public:
    explicit TrueCourse(const Phantom& truth)
        : truth_(truth),
          axis_(truth.centerline.points),
          grid_(truth.lumen.grid()),
          sampleAt_(grid_, std::int16_t(-1)),
          partOf_(axis_.size()),
          voxels_(axis_.size(), 0) {
        std::iota(partOf_.begin(), partOf_.end(), 0);
        fill();
        findClosures();
    }

    double arcMm(int sample) const { return axis_[std::size_t(sample)].arcMm; }
    const std::vector<Stretch>& closures() const { return closures_; }
    /// Closures, and fluid without tagging.
    const std::vector<Stretch>& hidden() const { return hidden_; }

    /// Sample of the lumen's voxel nearest to a point, not farther than `reachMm`; else −1.
    int sampleNear(glm::dvec3 p, double reachMm) const {
        const glm::dvec3 spacing = grid_.spacingMm(), at = grid_.voxelFromPatientPoint(p);
        const glm::ivec3 lo = glm::max(glm::ivec3(glm::ceil(at - reachMm / spacing)), 0),
                         hi = glm::min(glm::ivec3(glm::floor(at + reachMm / spacing)),
                                       grid_.size - 1);
        double nearest = reachMm;
        int sample = -1;
        visitBox(lo, hi, [&](glm::ivec3 v) {
            if (sampleAt_.at(v) < 0) return;
            const double d = glm::length((glm::dvec3(v) - at) * spacing);
            if (d <= nearest) nearest = d, sample = sampleAt_.at(v);
        });
        return sample;
    }

    /// Whether a point lies on a closed stretch of the colon, within its cord of muscle.
    bool onClosure(glm::dvec3 p) const {
        return std::any_of(axis_.begin(), axis_.end(), [&](const CenterlinePoint& point) {
            return glm::distance(point.positionMm, p) <= cordMm &&
                   std::any_of(hidden_.begin(), hidden_.end(), [&](const Stretch& s) {
                       return point.arcMm >= s.beginMm - 3.0 && point.arcMm <= s.endMm + 3.0;
                   });
        });
    }

private:
    int part(int sample) { return rootOf(partOf_, sample); }

    void fill() {
        const auto samples = sampleAt_.writable();
        std::vector<std::size_t> front;
        for (std::size_t n = 0; n < axis_.size(); ++n) {
            const glm::ivec3 v(glm::round(grid_.voxelFromPatientPoint(axis_[n].positionMm)));
            if (axis_[n].gap || !grid_.contains(v)) continue;
            const std::size_t at = grid_.index(v);
            if (samples[at] >= 0) {
                partOf_[std::size_t(part(int(n)))] = part(samples[at]);
                continue;
            }
            samples[at] = std::int16_t(n);
            front.push_back(at);
        }
        const auto neighbours = [&](std::size_t at, const auto& visit) {
            visitFaces(grid_, at, [&](std::size_t next, int) { visit(next, int(samples[at])); });
        };
        floodFill(front, neighbours, [&](std::size_t at, int from) {
            if (truth_.lumen[at] == 0) return false;
            if (samples[at] < 0) {
                samples[at] = std::int16_t(from);
                return true;
            }
            if (part(samples[at]) != part(from))
                partOf_[std::size_t(part(samples[at]))] = part(from);
            return false;
        });
        for (const std::size_t at : front)
            ++voxels_[std::size_t(samples[at])];
    }

    void findClosures() {
        constexpr double leastMl = 0.5, leastFluidMm = 3.0;
        std::vector<double> ml(axis_.size(), 0.0);
        for (std::size_t n = 0; n < axis_.size(); ++n)
            ml[std::size_t(part(int(n)))] += double(voxels_[n]) * grid_.voxelVolumeMm3() * 1e-3;
        int last = -1;
        for (std::size_t n = 0; n < axis_.size(); ++n) {
            if (axis_[n].gap || ml[std::size_t(part(int(n)))] < leastMl) continue;
            if (last >= 0 && part(int(n)) != part(last))
                closures_.push_back({axis_[std::size_t(last)].arcMm, axis_[n].arcMm});
            last = int(n);
        }
        hidden_ = closures_;
        for (std::size_t n = 0; n < axis_.size(); ++n) {
            std::size_t end = n;
            while (end < axis_.size() && untagged(axis_[end].positionMm))
                ++end;
            if (end > n && axis_[end - 1].arcMm - axis_[n].arcMm >= leastFluidMm)
                hidden_.push_back({axis_[n].arcMm, axis_[end - 1].arcMm});
            n = std::max(n, end);
        }
    }

    bool untagged(glm::dvec3 p) const {
        const glm::ivec3 v(glm::round(grid_.voxelFromPatientPoint(p)));
        return grid_.contains(v) && truth_.sites.at(v) == std::uint8_t(Site::untaggedFluid);
    }

    const Phantom& truth_;
    const std::vector<CenterlinePoint>& axis_;
    const Grid grid_;
    Volume<std::int16_t> sampleAt_;
    std::vector<int> partOf_;
    std::vector<std::size_t> voxels_;
    std::vector<Stretch> closures_, hidden_;
};

std::vector<glm::dvec3> placesOf(const std::vector<std::string>& lines) {
    std::vector<glm::dvec3> places;
    for (const std::string& line : lines) {
        for (std::size_t at = line.find('('); at != std::string::npos;
             at = line.find('(', at + 1)) {
            glm::dvec3 p;
            if (std::sscanf(line.c_str() + at, "(%lf, %lf, %lf) mm", &p.x, &p.y, &p.z) == 3)
                places.push_back(p);
        }
    }
    return places;
}

void scoreFalse(const Phantom& truth, const Volume<std::uint8_t>& lumen, ColonScore& score) {
    const Grid& grid = lumen.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::ivec3 reach(glm::floor(falseBeyondMm / spacing));
    const double ml = grid.voxelVolumeMm3() * 1e-3;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        if (!lumen[n] || truth.lumen[n]) continue;
        const glm::ivec3 v = grid.voxelAt(n), lo = glm::max(v - reach, 0),
                         hi = glm::min(v + reach, grid.size - 1);
        const bool near = anyInBox(lo, hi, [&](glm::ivec3 w) {
            return truth.lumen.at(w) && glm::length(glm::dvec3(w - v) * spacing) <= falseBeyondMm;
        });
        if (near) continue;
        const Site site = Site(truth.sites[n]);
        (site == Site::ileum        ? score.falseIleumMl
         : site == Site::otherBowel ? score.falseOtherBowelMl
                                    : score.falseElsewhereMl) += ml;
    }
}

/// Each sample of a line stands for half of each span beside it.
double spanMm(const std::vector<CenterlinePoint>& line, std::size_t n) {
    const double before = n > 0 ? line[n].arcMm - line[n - 1].arcMm : 0.0,
                 after = n + 1 < line.size() ? line[n + 1].arcMm - line[n].arcMm : 0.0;
    return 0.5 * (before + after);
}

class Scorer {
public:
    Scorer(const Phantom& truth, const Centerline& path, const ColonRecord& record)
        : course_(truth),
          truth_(truth),
          path_(path),
          record_(record),
          voxelMm_(glm::length(truth.lumen.grid().spacingMm())) {}

    void scoreLines(ColonScore& score) const {
        const auto& axis = truth_.centerline.points;
        score.trueMm = truth_.centerline.lengthMm();
        for (std::size_t n = 0; n < axis.size(); ++n) {
            if (axis[n].gap) continue;
            const double reachMm = std::max(5.0, axis[n].radiusMm);
            const bool covered =
                std::any_of(path_.points.begin(), path_.points.end(), [&](const auto& p) {
                    return glm::distance(p.positionMm, axis[n].positionMm) <= reachMm;
                });
            score.openMm += spanMm(axis, n);
            if (!covered) score.missedMm += spanMm(axis, n);
        }
        score.pathMm = path_.lengthMm();
        for (std::size_t n = 0; n < path_.points.size(); ++n) {
            const glm::dvec3 p = path_.points[n].positionMm;
            if (course_.sampleNear(p, voxelMm_) < 0 && !course_.onClosure(p))
                score.wrongMm += spanMm(path_.points, n);
        }
    }

    void scoreSteps(ColonScore& score) const {
        std::vector<char> crossed(course_.closures().size(), 0);
        for (std::size_t n = 0; n < record_.junctions.size(); ++n)
            scoreJunction(n, crossed, score);
        scorePath(score);
        score.collapses = int(crossed.size());
        score.collapsesCrossed = int(std::count(crossed.begin(), crossed.end(), 1));
        for (std::size_t c = 0; c < crossed.size(); ++c) {
            const Stretch& closure = course_.closures()[c];
            const bool within = std::any_of(
                score.wrongSteps.begin(), score.wrongSteps.end(), [&](const WrongStep& s) {
                    return std::min(s.fromArcMm, s.toArcMm) >= 0.0 &&
                           std::min(s.fromArcMm, s.toArcMm) <= closure.middleMm() &&
                           std::max(s.fromArcMm, s.toArcMm) >= closure.middleMm();
                });
            if (crossed[c] || within) continue;
            const glm::dvec3 place =
                poseAtArc(truth_.centerline, closure.middleMm()).point.positionMm;
            score.wrongSteps.push_back(
                {WrongStep::Kind::notBridged, place, closure.beginMm, closure.endMm, false});
        }
    }

private:
    int sampleOf(const ColonPiece& piece) const {
        return course_.sampleNear(piece.centerMm, std::max(3.0, 0.5 * piece.radiusMm));
    }

    void scoreJunction(std::size_t n, std::vector<char>& crossed, ColonScore& score) const {
        using Kind = WrongStep::Kind;
        const ColonJunction& junction = record_.junctions[n];
        const ColonPiece &a = record_.pieces[n], &b = record_.pieces[n + 1];
        const bool bridge = junction.kind == JunctionKind::collapse;
        score.bridges += bridge;
        const int from = sampleOf(a), to = sampleOf(b);
        const double fromMm = from < 0 ? -1.0 : course_.arcMm(from),
                     toMm = to < 0 ? -1.0 : course_.arcMm(to);
        const auto wrong = [&](Kind kind) {
            score.wrongSteps.push_back({kind, junction.placeMm, fromMm, toMm, false});
        };
        if (from < 0 || to < 0) return wrong(Kind::foreign);
        const double wayMm = glm::distance(a.centerMm, junction.placeMm) +
                             glm::distance(junction.placeMm, b.centerMm);
        if (std::abs(fromMm - toMm) > 2.0 * wayMm + leapSlackMm) return wrong(Kind::leap);
        const double lo = std::min(fromMm, toMm), hi = std::max(fromMm, toMm);
        const auto& closures = course_.closures();
        for (std::size_t c = 0; c < closures.size(); ++c) {
            if (closures[c].middleMm() >= lo && closures[c].middleMm() <= hi) crossed[c] = 1;
        }
        const auto& hidden = course_.hidden();
        if (bridge && std::none_of(hidden.begin(), hidden.end(), [&](const Stretch& s) {
                return s.beginMm <= hi + 5.0 && s.endMm >= lo - 5.0;
            }))
            wrong(Kind::bridge);
    }

    /// What the path does that no step of the chain is to blame for.
    void scorePath(ColonScore& score) const {
        double pathMm = -1.0, trueMm = 0.0;
        for (const CenterlinePoint& point : path_.points) {
            // A bridge may pass beside another loop, not through it.
            const double reachMm = point.gap ? 0.5 * voxelMm_ : voxelMm_;
            const int sample = course_.sampleNear(point.positionMm, reachMm);
            if (sample < 0) continue;
            const double now = course_.arcMm(sample);
            const bool leaps = pathMm >= 0.0 &&
                               std::abs(now - trueMm) > 2.0 * (point.arcMm - pathMm) + pathSlackMm;
            const bool told = std::any_of(
                score.wrongSteps.begin(), score.wrongSteps.end(), [&](const WrongStep& s) {
                    return glm::distance(s.placeMm, point.positionMm) <= pathSlackMm;
                });
            if (leaps && !told)
                score.wrongSteps.push_back(
                    {WrongStep::Kind::pathLeap, point.positionMm, trueMm, now, false});
            pathMm = point.arcMm, trueMm = now;
        }
    }

    const TrueCourse course_;
    const Phantom& truth_;
    const Centerline& path_;
    const ColonRecord& record_;
    double voxelMm_;
};

}  // namespace

const char* toString(WrongStep::Kind kind) {
    static const char* const names[] = {"foreign", "leap", "bridge", "not bridged", "path leap"};
    return names[std::size_t(kind)];
}

ColonScore scoreColon(const Phantom& truth, const Volume<std::uint8_t>& lumen,
                      const Centerline& path, const ColonRecord& record,
                      const std::vector<std::string>& warnings) {
    ColonScore score;
    scoreFalse(truth, lumen, score);
    const Scorer scorer(truth, path, record);
    scorer.scoreLines(score);
    scorer.scoreSteps(score);
    const std::vector<glm::dvec3> places = placesOf(warnings);
    for (WrongStep& step : score.wrongSteps) {
        step.warned = std::any_of(places.begin(), places.end(), [&](glm::dvec3 p) {
            return glm::distance(p, step.placeMm) <= warnedWithinMm;
        });
    }
    return score;
}

}  // namespace haustra::phantom
