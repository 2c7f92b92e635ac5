#include "topology/lumen.h"

#include "topology/air_fluid.h"
#include "topology/colon_selection.h"
#include "topology/filled_sections.h"
#include "topology/pools.h"
#include "topology/run_components.h"
#include "topology/tagged_stool.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace haustra::topology {
namespace {

constexpr double smallestPieceMl = 1.0;

tl::unexpected<Error> nothing(std::string message) {
    return fail(ErrorKind::noResult, std::move(message), "lumen");
}

std::string text(const char* format, double a, double b = 0.0) {
    char line[200];
    std::snprintf(line, sizeof line, format, a, b);
    return line;
}

// Median HU of large components, in bins of 8 HU; small ones are mostly partial volume and keep −∞.
std::vector<double> medianHu(const Volume<std::int16_t>& hu, const RunComponents& air,
                             std::uint64_t atLeast) {
    constexpr int bins = 256, binHu = 8, lowest = -1536;
    const auto& components = air.components();
    std::vector<int> slot(components.size(), -1);
    int slots = 0;
    for (std::size_t c = 0; c < components.size(); ++c) {
        if (components[c].voxels >= atLeast) slot[c] = slots++;
    }
    std::vector<std::uint64_t> histogram(std::size_t(slots) * bins, 0);
    for (int k = 0; k < hu.grid().size.z; ++k) {
        for (int j = 0; j < hu.grid().size.y; ++j) {
            for (const Run& run : air.row(j, k)) {
                if (slot[run.component] < 0) continue;
                std::uint64_t* h = &histogram[std::size_t(slot[run.component]) * bins];
                const std::int16_t* row = &hu.voxels()[hu.grid().index(0, j, k)];
                for (int i = run.begin; i < run.end; ++i)
                    ++h[std::clamp((row[i] - lowest) / binHu, 0, bins - 1)];
            }
        }
    }
    std::vector<double> median(components.size(), -std::numeric_limits<double>::infinity());
    for (std::size_t c = 0; c < components.size(); ++c) {
        if (slot[c] < 0) continue;
        std::uint64_t below = 0;
        int bin = 0;
        while (bin < bins &&
               2 * (below += histogram[std::size_t(slot[c]) * bins + bin]) < components[c].voxels)
            ++bin;
        median[c] = lowest + (bin + 0.5) * binHu;
    }
    return median;
}

// Air inside the body that is gas: not the room, not the lungs, not what runs through every slice.
std::vector<char> bowelAirOf(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                             const RunComponents& air) {
    constexpr double lungMl = 12.0, lungAboveAirHu = 60.0;
    const glm::ivec3 size = hu.grid().size;
    const double voxelMl = hu.grid().voxelVolumeMm3() / 1000.0;
    const std::vector<double> median = medianHu(hu, air, std::uint64_t(lungMl / voxelMl));
    std::vector<char> bowel(air.components().size(), 1);
    for (std::size_t c = 0; c < bowel.size(); ++c) {
        const RunComponent& component = air.components()[c];
        const bool side = component.touches(0, false, size) || component.touches(0, true, size) ||
                          component.touches(1, false, size) || component.touches(1, true, size);
        const bool throughout =
            size.z > 1 && component.touches(2, false, size) && component.touches(2, true, size);
        const bool lung = median[c] > tissue.meanHu[int(Tissue::air)] + lungAboveAirHu;
        if (side || throughout || lung) bowel[c] = 0;
    }
    return bowel;
}

// The grid axis and sign along which a patient direction points most.
GravityAxis axisOf(const Grid& grid, glm::dvec3 gravity) {
    GravityAxis down;
    double best = -1.0;
    for (int axis = 0; axis < 2; ++axis) {
        const double along =
            glm::dot(glm::normalize(glm::dvec3(grid.patientFromVoxel[axis])), gravity);
        if (std::abs(along) > best) best = std::abs(along), down = {axis, along < 0.0 ? -1 : 1};
    }
    return down;
}

struct Gravity {
    glm::dvec3 direction{0.0};
    GravityAxis down;
    std::vector<Level> levels;
};

// The patient position says which way is down; the levels must agree, and overrule it where they
// clearly do not.
Gravity findGravity(const CtScan& scan, const TissueModel& tissue, const RunComponents& air,
                    const std::vector<char>& bowelAir, int threads,
                    std::vector<std::string>& notes) {
    constexpr double clearMm2 = 400.0, clearRatio = 3.0;
    const glm::dvec3 told = gravityDirection(scan.position);
    const bool known = glm::length(told) > 0.0;
    std::vector<glm::dvec3> directions;
    if (known)
        directions = {told, -told};
    else
        directions = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {-1, 0, 0}};
    std::vector<Gravity> tried;
    std::size_t best = 0;
    for (const glm::dvec3& direction : directions) {
        const GravityAxis down = axisOf(scan.hu.grid(), direction);
        tried.push_back(
            {direction, down, findLevels(scan.hu, tissue, air, bowelAir, down, threads)});
        if (totalAreaMm2(tried.back().levels) > totalAreaMm2(tried[best].levels))
            best = tried.size() - 1;
    }
    const double bestArea = totalAreaMm2(tried[best].levels);
    if (known && best != 0) {
        const double toldArea = totalAreaMm2(tried[0].levels);
        if (bestArea > clearMm2 && bestArea > clearRatio * toldArea) {
            notes.push_back(std::string("the air-fluid levels show that the patient did not lie ") +
                            toString(scan.position) +
                            ", as the series says, but turned over; the levels are believed");
        } else {
            best = 0;
        }
    }
    if (!known && bestArea > 0.0) {
        notes.push_back(
            text("patient position unknown; gravity taken from the air-fluid levels (%.0f, %.0f in "
                 "x, y)",
                 tried[best].direction.x, tried[best].direction.y));
    }
    return std::move(tried[best]);
}

bool poolHolds(const Pool& pool, std::size_t index) {
    return std::binary_search(pool.voxels.begin(), pool.voxels.end(), std::uint32_t(index));
}

// The air component or pool at a patient point, or within 3 mm of it.
Result<void> partAt(const CtScan& scan, const RunComponents& air, const std::vector<Pool>& pools,
                    glm::dvec3 pointMm, int& airPart, int& poolPart) {
    constexpr double reachMm = 3.0;
    const Grid& grid = scan.hu.grid();
    const glm::ivec3 centre(glm::round(grid.voxelFromPatientPoint(pointMm)));
    const glm::ivec3 reach(glm::ceil(reachMm / grid.spacingMm()));
    airPart = poolPart = -1;
    double nearest = std::numeric_limits<double>::max();
    for (int k = -reach.z; k <= reach.z; ++k) {
        for (int j = -reach.y; j <= reach.y; ++j) {
            for (int i = -reach.x; i <= reach.x; ++i) {
                const glm::ivec3 v = centre + glm::ivec3(i, j, k);
                if (!grid.contains(v)) continue;
                const double d = glm::distance(grid.patientFromVoxelPoint(glm::dvec3(v)), pointMm);
                if (d > reachMm || d >= nearest) continue;
                if (const int component = air.at(v); component >= 0) {
                    nearest = d, airPart = component, poolPart = -1;
                    continue;
                }
                for (std::size_t p = 0; p < pools.size(); ++p) {
                    if (poolHolds(pools[p], grid.index(v)))
                        nearest = d, airPart = -1, poolPart = int(p);
                }
            }
        }
    }
    if (airPart < 0 && poolPart < 0) {
        char where[100];
        std::snprintf(where, sizeof where, "%.1f,%.1f,%.1f", pointMm.x, pointMm.y, pointMm.z);
        return fail(ErrorKind::badInput,
                    "there is no air or tagged fluid within 3 mm of this point", where);
    }
    return {};
}

// Partial volume between colon air and the colon fluid straight beneath belongs to the tagged
// lumen, at the height of a level and the menisci at its rim: elsewhere a thin wall looks the same.
void fillInterfaces(Volume<std::uint8_t>& labels, const std::vector<Level>& levels,
                    const std::vector<int>& colonLevels, GravityAxis down) {
    constexpr int rimVoxels = 2, nearVoxels = 4;
    const Grid& grid = labels.grid();
    const auto out = labels.writable();
    const int across = 1 - down.axis;
    for (int l : colonLevels) {
        for (const LevelColumn& column : levels[l].columns) {
            for (int dz = -rimVoxels; dz <= rimVoxels; ++dz) {
                for (int dn = -rimVoxels; dn <= rimVoxels; ++dn) {
                    // From air above the level to fluid below it, nothing else between.
                    glm::ivec3 v = column.below;
                    v[across] += dn, v.z += dz, v[down.axis] -= nearVoxels * down.sign;
                    std::vector<std::size_t> between;
                    bool underAir = false;
                    for (int step = 0; step < 2 * nearVoxels; ++step, v[down.axis] += down.sign) {
                        if (!grid.contains(v)) break;
                        const std::size_t index = grid.index(v);
                        if (LumenLabel(out[index]) == LumenLabel::air) {
                            underAir = true, between.clear();
                        } else if (LumenLabel(out[index]) == LumenLabel::tagged) {
                            if (underAir && between.size() < nearVoxels) {
                                for (std::size_t gap : between)
                                    out[gap] = std::uint8_t(LumenLabel::tagged);
                            }
                            break;
                        } else if (underAir) {
                            between.push_back(index);
                        }
                    }
                }
            }
        }
    }
}

// Fluid whose air is not the colon's, or that a level's columns missed: what no labelled air
// touches is left out.
void dropStrandedFluid(Volume<std::uint8_t>& labels) {
    const Grid& grid = labels.grid();
    const auto out = labels.writable();
    std::vector<bool> seen(grid.voxelCount(), false);
    std::vector<std::uint32_t> body;
    for (std::size_t n = 0; n < out.size(); ++n) {
        if (seen[n] || LumenLabel(out[n]) != LumenLabel::tagged) continue;
        body.assign(1, std::uint32_t(n));
        seen[n] = true;
        bool besideAir = false;
        for (std::size_t head = 0; head < body.size(); ++head) {
            const glm::ivec3 v = grid.voxelAt(body[head]);
            for (int step = 0; step < 27; ++step) {
                const glm::ivec3 w = v + glm::ivec3(step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1);
                if (!grid.contains(w)) continue;
                const std::size_t next = grid.index(w);
                besideAir = besideAir || LumenLabel(out[next]) == LumenLabel::air;
                if (seen[next] || LumenLabel(out[next]) != LumenLabel::tagged) continue;
                seen[next] = true;
                body.push_back(std::uint32_t(next));
            }
        }
        if (besideAir) continue;
        for (std::uint32_t index : body)
            out[index] = std::uint8_t(LumenLabel::outside);
    }
}

}  // namespace

Result<Lumen> findLumen(const CtScan& scan, const TissueModel& tissue,
                        const LumenOptions& options) {
    const Grid& grid = scan.hu.grid();
    auto progress = [&](double fraction) {
        if (options.progress) options.progress(fraction);
    };
    if (grid.voxelCount() > std::numeric_limits<std::uint32_t>::max()) {
        return fail(ErrorKind::unsupported, "the scan has more than 2^32 voxels", "lumen");
    }
    Lumen lumen;
    progress(0.0);
    const RunComponents air(scan.hu, tissue.airBelowHu, options.threads);
    progress(0.3);
    std::vector<char> bowelAir = bowelAirOf(scan.hu, tissue, air);
    progress(0.4);
    Gravity gravity = findGravity(scan, tissue, air, bowelAir, options.threads, lumen.notes);
    lumen.gravity = gravity.direction;
    progress(0.55);
    std::vector<Pool> pools = floodPools(scan.hu, tissue, gravity.levels, gravity.down);
    progress(0.7);

    // All points are looked up before anything is taken away: two may lie in one pool.
    std::vector<int> seedAir, seedPools, excludedAir, excludedPools;
    auto lookUp = [&](const std::vector<glm::dvec3>& points, std::vector<int>& airParts,
                      std::vector<int>& poolParts) -> Result<void> {
        for (const glm::dvec3& point : points) {
            int airPart, poolPart;
            if (auto found = partAt(scan, air, pools, point, airPart, poolPart); !found)
                return found;
            if (airPart >= 0) airParts.push_back(airPart);
            if (poolPart >= 0) poolParts.push_back(poolPart);
        }
        return {};
    };
    if (auto found = lookUp(options.excludesMm, excludedAir, excludedPools); !found)
        return tl::make_unexpected(found.error());
    if (auto found = lookUp(options.seedsMm, seedAir, seedPools); !found)
        return tl::make_unexpected(found.error());
    for (int component : excludedAir)
        bowelAir[component] = 0;
    for (int component : seedAir)
        bowelAir[component] = 1;
    std::vector<std::uint32_t> excludedVoxels;
    for (int excluded : excludedPools) {
        excludedVoxels.insert(excludedVoxels.end(), pools[excluded].voxels.begin(),
                              pools[excluded].voxels.end());
        pools[excluded].voxels.clear(), pools[excluded].levels.clear(),
            pools[excluded].touches.clear();
        for (Pool& pool : pools)
            pool.touches.erase(std::remove(pool.touches.begin(), pool.touches.end(), excluded),
                               pool.touches.end());
    }

    const std::vector<BowelPiece> pieces =
        bowelPieces(scan.hu, air, bowelAir, gravity.levels, pools,
                    options.seedsMm.empty() ? smallestPieceMl : 0.02);
    std::vector<int> chosen;
    for (std::size_t n = 0; n < pieces.size(); ++n) {
        const auto holds = [](const std::vector<int>& all, int one) {
            return std::find(all.begin(), all.end(), one) != all.end();
        };
        const bool named = std::any_of(seedAir.begin(), seedAir.end(),
                                       [&](int c) { return holds(pieces[n].air, c); }) ||
                           std::any_of(seedPools.begin(), seedPools.end(),
                                       [&](int p) { return holds(pieces[n].pools, p); });
        if (named) chosen.push_back(int(n));
    }
    const std::vector<int> selected = selectColon(pieces, chosen);
    if (selected.empty()) return nothing("no gas-filled bowel was found in the scan");
    progress(0.8);

    lumen.labels = Volume<std::uint8_t>(grid, std::uint8_t(LumenLabel::outside));
    const auto labels = lumen.labels.writable();
    std::vector<int> colonLevels;
    std::vector<char> colonAir(air.components().size(), 0);
    for (int n : selected) {
        for (int component : pieces[n].air)
            colonAir[component] = 1;
        for (int pool : pieces[n].pools) {
            colonLevels.insert(colonLevels.end(), pools[pool].levels.begin(),
                               pools[pool].levels.end());
            for (std::uint32_t index : pools[pool].voxels)
                labels[index] = std::uint8_t(LumenLabel::tagged);
        }
        lumen.segments.push_back({pieces[n].airMl, pieces[n].taggedMl, pieces[n].centroidMm});
    }
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            for (const Run& run : air.row(j, k)) {
                if (!colonAir[run.component]) continue;
                std::fill(&labels[grid.index(run.begin, j, k)],
                          &labels[grid.index(run.begin, j, k)] + (run.end - run.begin),
                          std::uint8_t(LumenLabel::air));
            }
        }
    }
    fillInterfaces(lumen.labels, gravity.levels, colonLevels, gravity.down);
    progress(0.85);
    if (const double ml = addFilledSections(lumen.labels, scan.hu, tissue, excludedVoxels);
        ml > 0.0)
        lumen.notes.push_back(text("%.0f ml of tagged fluid without air above were taken in", ml));
    addTaggedStool(lumen.labels, scan.hu, tissue, excludedVoxels);
    dropStrandedFluid(lumen.labels);
    progress(1.0);
    return lumen;
}

}  // namespace haustra::topology
