#include "cad/candidates.h"

#include "cad/fours.h"
#include "cad/lesion.h"
#include "core/disjoint_sets.h"
#include "core/parallel.h"
#include "core/zeroed_array.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::cad {
namespace {

// Those samples and all that hold and hang together with them, but for those `taken` before.
template <class Holds>
std::vector<std::uint32_t> connected(const WallSamples& wall, std::vector<std::uint32_t> samples,
                                     SampleNumbers& taken, const Holds& holds) {
    for (std::size_t head = 0; head < samples.size(); ++head) {
        const std::uint32_t v = samples[head];
        for (const std::uint32_t next : wall.around(v)) {
            if (taken.has(next) || !holds(next)) continue;
            taken.add(next);
            samples.push_back(next);
        }
    }
    return samples;
}

// Connected sets of samples that hold.
template <class Holds>
std::vector<std::vector<std::uint32_t>> componentsWhere(const WallSamples& wall,
                                                        const Holds& holds) {
    std::vector<std::vector<std::uint32_t>> components;
    SampleNumbers taken(wall.mesh.vertices.size());
    for (std::uint32_t seed = 0; seed < wall.mesh.vertices.size(); ++seed) {
        if (!holds(seed) || taken.has(seed)) continue;
        taken.add(seed);
        components.push_back(connected(wall, {seed}, taken, holds));
    }
    return components;
}

double areaOf(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    double area = 0.0;
    for (const std::uint32_t v : samples)
        area += wall.areaMm2[v];
    return area;
}

std::span<const WallShape> shapesOf(const WallEvidence& evidence, Generator scale) {
    return scale == Generator::broadShape ? evidence.broadShapes : evidence.shapes;
}
ShapeLimits limitsOf(Generator scale) {
    return scale == Generator::broadShape ? broadLimits : ShapeLimits();
}

bool mayBePatch(const WallSamples& wall, std::span<const WallShape> shapes,
                const ShapeLimits& limits, std::span<const std::uint32_t> samples) {
    const double area = areaOf(wall, samples);
    return area >= limits.leastMm2 && area <= limits.mostMm2 &&
           std::any_of(samples.begin(), samples.end(), [&](std::uint32_t v) {
               return shapes[v].k2 >= float(limits.seedCurvature) &&
                      shapes[v].shapeIndex() >= float(limits.seedShapeIndex);
           });
}

// What the patch encloses is part of it. From each of its rims a flood goes out over the wall, all
// at one pace; floods that meet are one. One that dries up has filled a hole; one that gets as far
// as the patch is wide is outside, and so is the last that still goes on. Belongs to one thread.
class HoleFiller {
public:
    explicit HoleFiller(const WallSamples& wall) : wall_(wall), mark_(wall.mesh.vertices.size()) {}

    void fill(std::vector<std::uint32_t>& patch) {
        inPatch_ = marks_ + 1, beside_ = marks_ + 2, firstFlood_ = marks_ + 3;
        for (const std::uint32_t v : patch)
            mark_[v] = inPatch_;
        findRims(patch);
        marks_ += 2 + std::uint32_t(floods_.size());
        if (floods_.size() < 2) return;
        measure(patch);
        while (goesOn())
            for (std::size_t f = 0; f < floods_.size(); ++f)
                step(f);
        // The last of all is outside.
        const bool anyOpen = std::any_of(floods_.begin(), floods_.end(),
                                         [](const Flood& flood) { return flood.open; });
        for (std::size_t f = 0; f < floods_.size(); ++f) {
            const std::size_t root = rootOf(met_, f);
            if (floods_[root].open || (!anyOpen && root == rootOf(met_, last_))) continue;
            patch.insert(patch.end(), floods_[f].samples.begin(), floods_[f].samples.end());
        }
    }

private:
    struct Flood {
        std::vector<std::uint32_t> samples;
        std::size_t head = 0;  // samples before it are done with
        bool open = false;     // of the one that stands for all that met
    };

    // Samples beside the patch, those that hang together as one flood's first.
    void findRims(const std::vector<std::uint32_t>& patch) {
        std::vector<std::uint32_t> beside;
        for (const std::uint32_t v : patch) {
            for (const std::uint32_t next : wall_.around(v)) {
                if (mark_[next] == inPatch_ || mark_[next] == beside_) continue;
                mark_[next] = beside_;
                beside.push_back(next);
            }
        }
        floods_.clear(), met_.clear();
        for (const std::uint32_t first : beside) {
            if (mark_[first] != beside_) continue;
            const auto own = firstFlood_ + std::uint32_t(floods_.size());
            Flood flood;
            flood.samples.push_back(first);
            mark_[first] = own;
            for (std::size_t head = 0; head < flood.samples.size(); ++head) {
                const std::uint32_t v = flood.samples[head];
                for (const std::uint32_t next : wall_.around(v)) {
                    if (mark_[next] != beside_) continue;
                    mark_[next] = own;
                    flood.samples.push_back(next);
                }
            }
            met_.push_back(floods_.size());
            floods_.push_back(std::move(flood));
        }
    }

    void measure(const std::vector<std::uint32_t>& patch) {
        middle_ = glm::dvec3(0.0);
        for (const std::uint32_t v : patch)
            middle_ += wall_.mesh.vertices[v];
        middle_ /= double(patch.size());
        double farthest = 0.0;
        for (const std::uint32_t v : patch)
            farthest = std::max(farthest, glm::distance(middle_, wall_.mesh.vertices[v]));
        reachMm_ = 2.0 * farthest + 1.0;
    }

    // Whether it is still to be seen which of the floods are outside.
    bool goesOn() {
        std::size_t going = 0;
        bool anyOpen = false;
        for (std::size_t f = 0; f < floods_.size(); ++f) {
            const std::size_t root = rootOf(met_, f);
            anyOpen |= floods_[root].open;
            if (floods_[root].open || floods_[f].head == floods_[f].samples.size()) continue;
            if (going == 0 || root != last_) ++going;
            last_ = root;
        }
        return going > 1 || (going == 1 && anyOpen);
    }

    void step(std::size_t f) {
        if (floods_[rootOf(met_, f)].open || floods_[f].head == floods_[f].samples.size()) return;
        const std::uint32_t v = floods_[f].samples[floods_[f].head++];
        if (glm::distance(middle_, wall_.mesh.vertices[v]) > reachMm_) {
            floods_[rootOf(met_, f)].open = true;
            return;
        }
        for (const std::uint32_t next : wall_.around(v)) {
            if (mark_[next] == inPatch_) continue;
            if (mark_[next] < firstFlood_) {
                mark_[next] = firstFlood_ + std::uint32_t(f);
                floods_[f].samples.push_back(next);
                continue;
            }
            const std::size_t mine = rootOf(met_, f),
                              other = rootOf(met_, std::size_t(mark_[next] - firstFlood_));
            if (mine == other) continue;
            unite(met_, mine, other);
            floods_[rootOf(met_, f)].open = floods_[mine].open || floods_[other].open;
        }
    }

    const WallSamples& wall_;
    // Of each sample: in the patch, beside it, or in which flood. Marks only grow from patch to
    // patch, so that those of earlier ones need not be taken off.
    ZeroedArray<std::uint32_t> mark_;
    std::uint32_t marks_ = 0, inPatch_ = 0, beside_ = 0, firstFlood_ = 0;
    std::vector<Flood> floods_;
    std::vector<std::size_t> met_;  // floods that are one, as disjoint sets
    std::size_t last_ = 0;
    glm::dvec3 middle_{0.0};
    double reachMm_ = 0.0;
};

// Of components that are kept, by their number.
template <class Keeps>
std::vector<Patch> patchesOf(const WallSamples& wall,
                             std::vector<std::vector<std::uint32_t>> components, int threads,
                             const Keeps& keeps) {
    std::vector<Patch> made(components.size());
    // Components differ in size by a thousand times.
    parallelForEach(
        components.size(), threads, [&] { return HoleFiller(wall); },
        [&](std::size_t n, HoleFiller& holes) {
            if (!keeps(components[n])) return;
            holes.fill(components[n]);
            std::sort(components[n].begin(), components[n].end());
            made[n].samples = std::move(components[n]);
        });
    std::erase_if(made, [](const Patch& patch) { return patch.samples.empty(); });
    return made;
}

// The diagonal of the box around them: not less than their diameter.
double boxMm(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    glm::dvec3 low(1e30), high(-1e30);
    for (const std::uint32_t v : samples)
        low = glm::min(low, wall.mesh.vertices[v]), high = glm::max(high, wall.mesh.vertices[v]);
    return glm::distance(low, high);
}

}  // namespace

Diameter diameterOf(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    if (samples.empty()) return {};
    // The farthest two are extreme along the line between them: those along many lines are asked.
    // In single precision about the first sample, four lines at once.
    constexpr int lines = 64;
    std::vector<glm::dvec3> places;
    std::vector<glm::vec3> near;
    places.reserve(samples.size()), near.reserve(samples.size());
    for (const std::uint32_t v : samples) {
        places.push_back(wall.mesh.vertices[v]);
        near.push_back(glm::vec3(places.back() - places.front()));
    }
    std::array<std::size_t, 2 * lines> extremes{};
    for (int first = 0; first < lines; first += 4) {
        FourFloats x{}, y{}, z{};
        for (int n = 0; n < 4; ++n) {
            // Evenly over the half sphere.
            const double up = (first + n + 0.5) / lines, turn = 2.399963229728653 * (first + n),
                         r = std::sqrt(1.0 - up * up);
            x[n] = float(r * std::cos(turn)), y[n] = float(r * std::sin(turn)), z[n] = float(up);
        }
        FourFloats least{}, most{};
        FourInts lowest{}, highest{};
        for (int p = 1; p < int(near.size()); ++p) {
            const glm::vec3 place = near[std::size_t(p)];
            const FourFloats along = place.x * x + place.y * y + place.z * z;
            const FourInts own = p - FourInts{};
            const FourInts lower = (along < least);
            const FourInts higher = (along > most);
            least = lower ? along : least, lowest = lower ? own : lowest;
            most = higher ? along : most, highest = higher ? own : highest;
        }
        for (int n = 0; n < 4; ++n) {
            extremes[std::size_t(2 * (first + n))] = std::size_t(lowest[n]);
            extremes[std::size_t(2 * (first + n) + 1)] = std::size_t(highest[n]);
        }
    }
    double mostMm2 = 0.0;
    std::size_t from = 0, to = 0;
    for (auto a = extremes.begin(); a != extremes.end(); ++a) {
        for (auto b = a + 1; b != extremes.end(); ++b) {
            const glm::dvec3 off = places[*a] - places[*b];
            const double mm2 = glm::dot(off, off);
            if (mm2 > mostMm2) mostMm2 = mm2, from = *a, to = *b;
        }
    }
    if (mostMm2 == 0.0) return {};
    return {std::sqrt(mostMm2), samples[from], samples[to]};
}

std::vector<Patch> patchesByShape(const WallEvidence& evidence, Generator scale, int threads) {
    const WallSamples& wall = evidence.samples;
    const auto shapes = shapesOf(evidence, scale);
    const ShapeLimits limits = limitsOf(scale);
    auto patches =
        patchesOf(wall,
                  componentsWhere(wall,
                                  [&](std::uint32_t v) {
                                      return shapes[v].k2 >= float(limits.growCurvature) &&
                                             !evidence.unseen[v];
                                  }),
                  threads, [&](const std::vector<std::uint32_t>& component) {
                      return mayBePatch(wall, shapes, limits, component);
                  });
    for (Patch& patch : patches)
        patch.by = scale;
    return patches;
}

std::vector<std::vector<Patch>> otherLevels(const WallEvidence& evidence,
                                            std::span<const Patch* const> patches, int threads) {
    const WallSamples& wall = evidence.samples;
    std::vector<std::vector<Patch>> made(patches.size());
    struct Scratch {
        explicit Scratch(const WallSamples& wall)
            : holes(wall), taken(wall.mesh.vertices.size()), inPatch(wall.mesh.vertices.size()) {}
        HoleFiller holes;
        SampleNumbers taken, inPatch;
    };
    parallelForEach(
        patches.size(), threads, [&] { return Scratch(wall); },
        [&](std::size_t n, Scratch& scratch) {
            auto& [holes, taken, inPatch] = scratch;
            const Patch& patch = *patches[n];
            const auto shapes = shapesOf(evidence, patch.by);
            const ShapeLimits limits = limitsOf(patch.by);
            const auto reaches = [&](std::uint32_t v, double curvature) {
                return shapes[v].k2 >= float(curvature) && !evidence.unseen[v];
            };
            const auto keep = [&](std::vector<std::uint32_t> samples) {
                if (!mayBePatch(wall, shapes, limits, samples)) return;
                holes.fill(samples);
                std::sort(samples.begin(), samples.end());
                made[n].push_back({std::move(samples), patch.by});
            };
            taken.clear();
            for (const std::uint32_t v : patch.samples)
                taken.add(v);
            double area = areaOf(wall, patch.samples);
            keep(connected(wall, patch.samples, taken, [&](std::uint32_t v) {
                if (area > limits.mostMm2 || !reaches(v, limits.wideCurvature)) return false;
                area += wall.areaMm2[v];
                return true;
            }));
            inPatch.clear(), taken.clear();
            for (const std::uint32_t v : patch.samples)
                inPatch.add(v);
            for (const std::uint32_t v : patch.samples) {
                if (taken.has(v) || !reaches(v, limits.narrowCurvature)) continue;
                taken.add(v);
                keep(connected(wall, {v}, taken, [&](std::uint32_t w) {
                    return inPatch.has(w) && reaches(w, limits.narrowCurvature);
                }));
            }
        });
    return made;
}

std::vector<Patch> patchesByTexture(const WallEvidence& evidence,
                                    std::span<const float> textureDistance, int threads) {
    constexpr double leastMm = 5.0;
    const WallSamples& wall = evidence.samples;
    return patchesOf(wall,
                     componentsWhere(wall,
                                     [&](std::uint32_t v) {
                                         return textureDistance[v] < 1.0f && !evidence.unseen[v];
                                     }),
                     threads, [&](const std::vector<std::uint32_t>& component) {
                         return boxMm(wall, component) >= leastMm &&
                                areaOf(wall, component) <= ShapeLimits().mostMm2 &&
                                diameterOf(wall, component).mm >= leastMm;
                     });
}

}  // namespace haustra::cad
