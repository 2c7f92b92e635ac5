#include "cad/annular_wall.h"

#include "cad/lesion.h"
#include "core/parallel.h"
#include "core/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <span>

namespace haustra::cad {
namespace {

constexpr double thickMm = 6.0, sectionMm = 4.0, analCanalMm = 40.0;
constexpr std::size_t leastSections = 3, firstSection = std::size_t(analCanalMm / sectionMm);
constexpr std::size_t sectors = 12, leastJudged = 6;
constexpr double leastThickShare = 5.0 / 6.0;
// One ray in so many: 0.7 mm² of wall each.
constexpr std::size_t stride = 8, leastRays = 3;
constexpr double unbounded = std::numeric_limits<double>::infinity();

// Where each of the samples is along the colon and around it, by the map's triangles, which are
// smaller than what is asked for here.
class SectionsOfWall {
public:
    SectionsOfWall(const PreparedColon& colon, const WallSamples& samples)
        : samples_(samples), ofTriangle_(colon.surface.triangles.size()) {
        const FlatMap& map = colon.flat;
        for (std::size_t t = 0; t < map.surface.triangles.size(); ++t) {
            const glm::ivec3 corners = map.surface.triangles[t];
            Place place;
            for (int c = 0; c < 3; ++c) {
                const auto v = std::size_t(corners[c]);
                place.arcMm += map.cameras[std::size_t(map.camera[v])].arcMm / 3.0;
                place.turn += map.flat[v].x / 3.0;
            }
            place.turn -= std::floor(place.turn);
            ofTriangle_[std::size_t(map.sourceTriangle[t])] = place;
            sections_ = std::max(sections_, sectionAt(place.arcMm) + 1);
        }
    }

    std::size_t sections() const { return sections_; }
    std::size_t section(std::uint32_t sample) const { return sectionAt(of(sample).arcMm); }
    std::size_t sector(std::uint32_t sample) const {
        return std::min(std::size_t(of(sample).turn * double(sectors)), sectors - 1);
    }

private:
    struct Place {
        double arcMm = 0.0, turn = 0.0;
    };
    static std::size_t sectionAt(double arcMm) {
        return std::size_t(std::max(0.0, arcMm) / sectionMm);
    }
    const Place& of(std::uint32_t sample) const {
        const std::uint32_t triangle = samples_.triangles[samples_.beginTriangles[sample]];
        return ofTriangle_[std::size_t(samples_.sourceTriangle[triangle])];
    }

    const WallSamples& samples_;
    std::vector<Place> ofTriangle_;
    std::size_t sections_ = 0;
};

using Rays = std::array<std::vector<double>, sectors>;  // their thicknesses, of one section

// Median of the sectors, where the wall is thick all around in a section, from firstSection on, and
// in those before and after it.
std::optional<double> thicknessAllAround(std::span<const Rays> sections, std::size_t section) {
    std::vector<double> judged;
    for (std::size_t sector = 0; sector < sectors; ++sector) {
        std::vector<double> rays;
        for (std::size_t n = std::max(section - 1, firstSection);
             n < std::min(section + 2, sections.size()); ++n)
            rays.insert(rays.end(), sections[n][sector].begin(), sections[n][sector].end());
        if (rays.size() < leastRays) continue;
        if (const double mm = medianOf(rays); mm != unbounded) judged.push_back(mm);
    }
    const auto thick = std::ranges::count_if(judged, [](double mm) { return mm >= thickMm; });
    if (judged.size() < leastJudged || double(thick) < leastThickShare * double(judged.size()))
        return std::nullopt;
    return medianOf(judged);
}

// Of the smoothed scan, so deep behind a sample.
double huBehind(const WallEvidence& evidence, std::uint32_t sample, double mm) {
    const glm::dvec3 at =
        evidence.samples.mesh.vertices[sample] + mm * glm::dvec3(evidence.shapes[sample].intoWall);
    return evidence.smooth->linear(
        glm::vec3(evidence.smooth->voxelFromPatient() * glm::dvec4(at, 1.0)));
}

double leastTissueHu(const WallEvidence& evidence) {
    return 0.5 * (evidence.statistics.wallHu + evidence.statistics.fatHu);
}

// What lies behind the samples, down to a depth.
std::vector<VoxelRun> tissueOf(const AnnularWall& wall, const PreparedColon& colon,
                               const WallEvidence& evidence, double deepestMm) {
    constexpr double stepMm = 0.5;
    // Rays part as they go outwards: where the outside is thrice as wide, to 1.5 mm. So each takes
    // places beside it along.
    constexpr double besideMm = 0.5;
    const Grid& grid = colon.cleansed.grid();
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    std::set<std::size_t> voxels = voxelsBehind(evidence, wall.samples, grid);
    for (const std::uint32_t sample : wall.samples) {
        const double mm = std::min(deepestMm, wallThicknessMm(evidence, sample).value_or(0.0));
        const glm::dvec3 from = evidence.samples.mesh.vertices[sample],
                         into(evidence.shapes[sample].intoWall);
        const glm::dvec3 across = glm::normalize(
            glm::cross(into, std::abs(into.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
        const glm::dvec3 other = glm::cross(into, across);
        for (double depth = stepMm; depth < mm; depth += stepMm)
            for (const glm::dvec3& beside : {across, -across, other, -other}) {
                const glm::dvec3 at = from + depth * into + besideMm * beside;
                const glm::ivec3 voxel(
                    glm::floor(glm::dvec3(voxelFromPatient * glm::dvec4(at, 1.0)) + 0.5));
                if (grid.contains(voxel) && colon.cleansed.at(voxel) >= colon.tissue.airBelowHu)
                    voxels.insert(grid.index(voxel));
            }
    }
    return runsOf(voxels, grid);
}

// How deep tissue reaches behind a sample, mm, and whether another loop's gas ends it.
struct TissueBehind {
    double mm = unbounded;  // where nothing ends it
    bool isEndedByGas = false;
};

TissueBehind tissueBehind(const WallEvidence& evidence, std::uint32_t sample) {
    constexpr double stepMm = 0.5, edgeMm = 3.0;  // by then an edge's blur has passed
    const SmoothScan& scan = *evidence.smooth;
    const glm::dmat4& voxelFromPatient = scan.voxelFromPatient();
    const glm::vec3 start(voxelFromPatient *
                          glm::dvec4(evidence.samples.mesh.vertices[sample], 1.0));
    const glm::vec3 perMm(glm::dmat3(voxelFromPatient) *
                          glm::dvec3(evidence.shapes[sample].intoWall));
    const auto huAt = [&](double mm) { return double(scan.linear(start + float(mm) * perMm)); };
    const double tissueHu = leastTissueHu(evidence),
                 gasHu = 0.5 * (evidence.statistics.fatHu + emptyHu);
    bool inTissue = false;
    double before = 0.0;
    for (double mm = stepMm; mm <= deepestWallMm; mm += stepMm) {
        const double hu = huAt(mm);
        if (inTissue && hu < tissueHu) {
            TissueBehind behind{mm - stepMm * (tissueHu - hu) / std::max(before - hu, 1e-6)};
            // Down to gas without fat between, which would end the wall.
            double last = hu;
            for (double beyond = mm; beyond <= mm + edgeMm && huAt(beyond) <= last;
                 beyond += stepMm) {
                last = huAt(beyond);
                behind.isEndedByGas |= last < gasHu;
            }
            return behind;
        }
        inTissue |= hu >= tissueHu;
        if (!inTissue && mm >= edgeMm) return {0.0};
        before = hu;
    }
    return {};
}

// Stretches whose wall is thick all around by the thickness of one sample in `stride`.
std::vector<AnnularWall> stretchesOf(const PreparedColon& colon, const WallEvidence& evidence,
                                     const SectionsOfWall& places,
                                     std::span<const double> thickness) {
    const std::size_t count = evidence.samples.mesh.vertices.size();
    std::vector<Rays> sections(places.sections());
    for (std::size_t n = 0; n * stride < count; ++n) {
        const auto sample = std::uint32_t(n * stride);
        if (evidence.unseen[sample] || evidence.untagged[sample]) continue;
        sections[places.section(sample)][places.sector(sample)].push_back(thickness[n]);
    }
    std::vector<AnnularWall> walls;
    std::vector<std::vector<double>> thicknesses;
    for (std::size_t n = firstSection; n < sections.size(); ++n) {
        const auto mm = thicknessAllAround(sections, n);
        if (!mm) continue;
        const double fromMm = double(n) * sectionMm;
        // One section between may be spoilt by a pool or a leak.
        if (walls.empty() || fromMm > walls.back().toMm + sectionMm) {
            walls.push_back({.fromMm = fromMm, .toMm = fromMm});
            thicknesses.emplace_back();
        }
        walls.back().toMm = fromMm + sectionMm;
        thicknesses.back().push_back(*mm);
    }
    std::size_t kept = 0;
    for (std::size_t wall = 0; wall < walls.size(); ++wall) {
        if (thicknesses[wall].size() < leastSections) continue;
        walls[kept] = walls[wall];
        walls[kept++].thicknessMm = medianOf(thicknesses[wall]);
    }
    walls.resize(kept);
    std::vector<std::size_t> wallOf(sections.size(), walls.size());  // or none
    for (std::size_t wall = 0; wall < walls.size(); ++wall)
        std::fill(wallOf.begin() + std::ptrdiff_t(walls[wall].fromMm / sectionMm),
                  wallOf.begin() + std::ptrdiff_t(walls[wall].toMm / sectionMm), wall);
    for (std::uint32_t sample = 0; sample < count; ++sample)
        if (const std::size_t wall = wallOf[places.section(sample)]; wall < walls.size())
            walls[wall].samples.push_back(sample);
    for (AnnularWall& wall : walls) {
        std::vector<double> hus;
        for (const std::uint32_t sample : wall.samples)
            if (const double mm = thickness[sample / stride];
                sample % stride == 0 && mm >= thickMm && mm != unbounded &&
                !evidence.unseen[sample] && !evidence.untagged[sample])
                hus.push_back(huBehind(evidence, sample, 0.5 * mm));
        wall.middleHu = hus.empty() ? evidence.statistics.wallHu : medianOf(hus);
        wall.channelMm = unbounded;
        for (double arcMm = wall.fromMm; arcMm <= wall.toMm; arcMm += 1.0)
            wall.channelMm =
                std::min(wall.channelMm, 2.0 * poseAtArc(colon.centerline, arcMm).point.radiusMm);
    }
    return walls;
}

}  // namespace

std::optional<double> wallThicknessMm(const WallEvidence& evidence, std::uint32_t sample) {
    const TissueBehind behind = tissueBehind(evidence, sample);
    if (behind.isEndedByGas || behind.mm == unbounded) return std::nullopt;
    return behind.mm;
}

std::vector<AnnularWall> annularWalls(const PreparedColon& colon, const WallEvidence& evidence,
                                      int threads) {
    const std::size_t count = evidence.samples.mesh.vertices.size();
    if (colon.flat.surface.triangles.empty() || count == 0) return {};
    std::vector<double> toFat(count / stride + 1, unbounded), toFatOrGas = toFat;
    parallelFor(toFat.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end && n * stride < count; ++n) {
            const TissueBehind behind = tissueBehind(evidence, std::uint32_t(n * stride));
            toFatOrGas[n] = behind.mm;
            if (!behind.isEndedByGas) toFat[n] = behind.mm;
        }
    });
    const SectionsOfWall places(colon, evidence.samples);
    std::vector<AnnularWall> walls = stretchesOf(colon, evidence, places, toFat);
    const std::size_t sure = walls.size();
    for (AnnularWall& wall : stretchesOf(colon, evidence, places, toFatOrGas)) {
        const auto overlaps = [&](const AnnularWall& other) {
            return wall.fromMm <= other.toMm && other.fromMm <= wall.toMm;
        };
        if (std::any_of(walls.begin(), walls.begin() + std::ptrdiff_t(sure), overlaps)) continue;
        wall.isBesideLoops = true;
        walls.push_back(std::move(wall));
    }
    std::ranges::sort(walls, {}, &AnnularWall::fromMm);
    return walls;
}

bool isFluid(const AnnularWall& wall, const WallStatistics& statistics) {
    constexpr double waterHu = 0.0;
    return wall.middleHu < 0.5 * (waterHu + statistics.wallHu);
}

Finding findingOf(const AnnularWall& wall, const PreparedColon& colon, const WallEvidence& evidence,
                  const std::vector<SegmentStart>& segments) {
    const auto& places = evidence.samples.mesh.vertices;
    const auto nearestTo = [&](glm::dvec3 point) {
        return places[*std::ranges::min_element(
            wall.samples, {}, [&](std::uint32_t v) { return glm::distance(places[v], point); })];
    };
    const auto axisAt = [&](double arcMm) {
        return poseAtArc(colon.centerline, arcMm).point.positionMm;
    };
    Finding finding;
    finding.kind = annularKind;
    finding.arcMm = 0.5 * (wall.fromMm + wall.toMm);
    finding.segment = segmentAt(segments, finding.arcMm);
    finding.positionMm = axisAt(finding.arcMm);
    finding.wallMm = nearestTo(finding.positionMm);
    // On the side of that place.
    const glm::dvec3 aside = finding.wallMm - finding.positionMm;
    finding.diameterEndsMm = {nearestTo(axisAt(wall.fromMm) + aside),
                              nearestTo(axisAt(wall.toMm) + aside)};
    finding.diameterMm = glm::distance(finding.diameterEndsMm.first, finding.diameterEndsMm.second);
    finding.heightMm = wall.thicknessMm;
    finding.score = annularScore;
    // Others of a list have room besides, on their way to a reader.
    constexpr std::size_t mostRuns = maxFindingRuns / 2;
    for (double deepestMm = deepestWallMm; deepestMm > 0.5; deepestMm *= 0.5) {
        finding.voxels = tissueOf(wall, colon, evidence, deepestMm);
        if (finding.voxels.size() <= mostRuns) return finding;
    }
    finding.voxels.clear();
    return finding;
}

}  // namespace haustra::cad
