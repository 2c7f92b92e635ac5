// Plants polyps of tissue on the wall of a colon that was really scanned, and writes the scan with
// its truth, so that `haustra prepare` and `haustra cad evaluate --truth` can tell how many are
// found among a patient's own folds, stool and noise. The same seed plants the same polyps.
// `--help` tells the options.
#include "cleansing/pseudo_enhancement.h"
#include "core/centerline.h"
#include "core/crop.h"
#include "core/ct_scan.h"
#include "core/findings.h"
#include "core/flood_fill.h"
#include "core/parallel.h"
#include "dicom/write_series.h"
#include "phantom/growth_truth.h"
#include "phantom/implicit.h"
#include "phantom/random.h"
#include "phantom/scanner.h"
#include "pipeline/product_attributes.h"
#include "store/case_store.h"
#include "store/products.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace {

using namespace haustra;
namespace fs = std::filesystem;
using phantom::GrowthTruth, phantom::Random;

constexpr double twoPi = 6.283185307179586, fwhmPerSigma = 2.354820045;
// From other polyps, and from what was found before; masses, whose radius is more, by more.
constexpr double apartMm = 32.0, apartRadiusMm = 8.0;
constexpr double deepestMm = 1.0;             // that a polyp's tissue reaches into the wall
constexpr double scannerSigmaMm = 0.65;       // of the point spread
constexpr double textureHu = 12.0;            // standard deviation within a polyp
constexpr double grainMm = 1.1;               // of that and of added noise, full width
constexpr double lobe2 = 0.07, lobe3 = 0.05;  // how far an outline is from a circle, of its radius
// How many of a polyp are tried, and how many of these far from others, before another is drawn.
constexpr int placesPerPolyp = 1000, freePlacesPerPolyp = 40;

struct PlantOptions {
    std::string store, name;
    fs::path out;
    std::uint64_t seed = 1;
    int count = 20, masses = 0, rings = 0;
    std::vector<double> tissueHu = {20.0, 60.0};  ///< least, most
    double noiseSdHu = 0.0;
};

struct Patient {
    CtScan scan;
    std::string scanKey;
    Volume<std::uint8_t> segmentation, lumen;  ///< LumenLabel
    TriMesh surface;
    Centerline centerline;
    TissueModel tissue;
    std::vector<glm::dvec3> findingsMm;
};

Result<Patient> readPatient(const std::string& root, const std::string& name) {
    namespace product = store::product;
    const auto store = TRY(store::CaseStore::open(root, false));
    const auto source = TRY(store.openCase(name));
    for (const char* needed : {product::ct, product::segmentation, product::lumen, product::surface,
                               product::centerline})
        if (!source.find(needed))
            return fail(
                ErrorKind::notFound,
                fmt::format("case {} is not prepared to `surface`: it has no {}", name, needed),
                root);
    Patient patient;
    patient.scan.hu = TRY(source.readVolume<std::int16_t>(product::ct));
    const auto attributes = TRY(source.attributes(product::ct));
    if (const auto position = attributes.find("position"); position != attributes.end())
        patient.scan.position = patientPositionFromString(position->second);
    patient.scanKey = source.find(product::ct)->key.hex;
    patient.segmentation = TRY(source.readVolume<std::uint8_t>(product::segmentation));
    patient.lumen = TRY(source.readVolume<std::uint8_t>(product::lumen));
    patient.surface = TRY(source.readMesh(product::surface));
    patient.centerline = TRY(source.readCenterline(product::centerline));
    patient.tissue =
        TRY(source.attributes(product::segmentation).and_then(pipeline::tissueModelOf));
    if (!source.find(product::findings)) {
        fmt::print(stderr, "case {} has no findings: polyps may be planted on its own\n", name);
        return patient;
    }
    const auto text = TRY(source.readText(product::findings));
    for (const Finding& finding : TRY(findingsOfJson(text)).findings)
        patient.findingsMm.push_back(finding.positionMm);
    return patient;
}

enum class Kind { sessile, flat, pedunculated, mass, ring };
constexpr std::array<const char*, 5> kindNames = {"sessile", "flat", "pedunculated", "mass",
                                                  "annular"};

/// One of the domes that a mass is grown together from.
struct Dome {
    glm::dvec2 at{0.0};  ///< on the wall, from the mass' foot
    double radiusMm = 0.0, heightMm = 0.0;
};

/// Lengths in mm, angles in radians. Places are in the frame of its foot: z into the lumen.
struct Polyp {
    Kind kind = Kind::sessile;
    double diameterMm = 0.0;  ///< largest; of a pedunculated one, of its head
    double heightMm = 0.0;    ///< above the wall, stalk included
    double edgeMm = 0.0;      ///< over which a flat one rises to its height
    std::array<double, 2> lobes{};
    glm::dvec3 stalk{0.0, 0.0, 1.0};  ///< direction of a pedunculated one's
    double stalkMm = 0.0;             ///< from the foot to the middle of the head
    double stalkRadiusMm = 0.0;
    double headShare = 1.0;   ///< the head's length along the stalk, of its diameter
    std::vector<Dome> domes;  ///< of a mass
    double channelMm = 0.0;   ///< radius of what a ring leaves open
    double tissueHu = 0.0;
    std::uint64_t textureSeed = 0;

    double radiusMm() const { return 0.5 * diameterMm; }
    glm::dvec3 center() const {
        return kind == Kind::pedunculated ? stalkMm * stalk : glm::dvec3(0, 0, 0.5 * heightMm);
    }
};

Polyp drawPolyp(Random& random, const std::vector<double>& tissueHu) {
    Polyp polyp;
    const double draw = random.uniform();
    polyp.kind = draw < 0.45 ? Kind::sessile : draw < 0.75 ? Kind::flat : Kind::pedunculated;
    if (polyp.kind == Kind::sessile) {
        polyp.diameterMm = random.uniform(5.0, 14.0);
        polyp.heightMm = polyp.diameterMm * random.uniform(0.5, 0.85);
    } else if (polyp.kind == Kind::flat) {
        polyp.diameterMm = random.uniform(6.0, 16.0);
        polyp.heightMm = random.uniform(1.3, 3.0);
        polyp.edgeMm = std::min(random.uniform(0.8, 3.5), polyp.radiusMm());
    } else {
        polyp.diameterMm = random.uniform(5.5, 12.0);
        polyp.stalkMm = random.uniform(4.0, 10.0);
        polyp.stalkRadiusMm = random.uniform(1.2, 2.0);
        polyp.headShare = random.uniform(0.8, 1.0);
        const double lean = random.uniform(0.0, 0.6), towards = random.uniform(0.0, twoPi);
        polyp.stalk = {std::sin(lean) * std::cos(towards), std::sin(lean) * std::sin(towards),
                       std::cos(lean)};
        polyp.heightMm =
            polyp.stalkMm * std::cos(lean) +
            polyp.radiusMm() * std::hypot(polyp.headShare * std::cos(lean), std::sin(lean));
    }
    for (double& lobe : polyp.lobes)
        lobe = random.uniform(0.0, twoPi);
    polyp.tissueHu = random.uniform(tissueHu[0], tissueHu[1]);
    polyp.textureSeed = random.bits();
    return polyp;
}

/// As carcinomas and large adenomas are: one dome, or lobed, domes around one in the middle.
Polyp drawMass(Random& random, const std::vector<double>& tissueHu) {
    Polyp mass;
    mass.kind = Kind::mass;
    mass.diameterMm = random.uniform(20.0, 40.0);
    mass.heightMm = random.uniform(6.0, 14.0);
    const bool lobed = random.uniform() < 0.7;
    mass.domes.push_back({glm::dvec2(0.0), (lobed ? 0.6 : 1.0) * mass.radiusMm(), mass.heightMm});
    const int around = lobed ? 4 + int(random.uniform(0.0, 3.0)) : 0;
    const double first = random.uniform(0.0, twoPi);
    for (int n = 0; n < around; ++n) {
        const double angle = first + twoPi * (n + random.uniform(-0.2, 0.2)) / around;
        Dome dome{{},
                  mass.radiusMm() * random.uniform(0.35, 0.5),
                  mass.heightMm * random.uniform(0.5, 0.9)};
        // The first reaches its widest, as far as the next to opposite does.
        const double outMm = mass.radiusMm() * (n == 0 ? 1.0 : random.uniform(0.85, 1.0));
        dome.at = (outMm - dome.radiusMm) * glm::dvec2(std::cos(angle), std::sin(angle));
        mass.domes.push_back(dome);
    }
    mass.tissueHu = random.uniform(tissueHu[0], tissueHu[1]);
    mass.textureSeed = random.bits();
    return mass;
}

/// A cancer that goes all around; its diameter is its length along the colon. Its height is found
/// where it is planted.
Polyp drawRing(Random& random, const std::vector<double>& tissueHu) {
    Polyp ring = drawPolyp(random, tissueHu);
    ring.kind = Kind::ring;
    ring.diameterMm = random.uniform(20.0, 50.0);
    ring.channelMm = random.uniform(5.0, 10.0);
    ring.edgeMm = random.uniform(2.0, 6.0);
    return ring;
}

double smoothMin(double a, double b, double k) {
    return -phantom::smoothMax(-a, -b, k);
}

/// How far its outline on the wall is from its foot, in the direction of p.
double outlineMm(const Polyp& polyp, glm::dvec3 p) {
    const double angle = std::atan2(p.y, p.x);
    const double lobes = lobe2 * std::cos(2.0 * angle + polyp.lobes[0]) +
                         lobe3 * std::cos(3.0 * angle + polyp.lobes[1]);
    return polyp.radiusMm() * (1.0 + lobes) / (1.0 + lobe2);  // so wide at most as it says
}

bool flatHolds(const Polyp& polyp, glm::dvec3 p, double lumenMm) {
    if (glm::length(p) > polyp.radiusMm() + polyp.heightMm + 3.0) return false;
    const double rise =
        polyp.heightMm *
        phantom::smoothstep(0.0, polyp.edgeMm, outlineMm(polyp, p) - std::hypot(p.x, p.y));
    return rise > 0.0 && lumenMm < rise;
}

/// About the distance to a dome on the wall, negative inside; `out`: from its foot, where its
/// outline is `outlineMm` off, of `radiusMm` at most.
double domeMm(double out, double outlineMm, double radiusMm, double heightMm, double lumenMm) {
    const double half = std::min(radiusMm, 0.75 * heightMm);
    return half * (std::hypot(out / outlineMm, (lumenMm - (heightMm - half)) / half) - 1.0);
}

bool sessileHolds(const Polyp& polyp, glm::dvec3 p, double lumenMm) {
    const double out = std::hypot(p.x, p.y);
    if (out > polyp.radiusMm() + 2.5 || std::abs(p.z) > polyp.heightMm + 3.0) return false;
    const double dome = domeMm(out, outlineMm(polyp, p), polyp.radiusMm(), polyp.heightMm, lumenMm);
    return smoothMin(dome, lumenMm, 0.8) < 0.0;
}

bool massHolds(const Polyp& mass, glm::dvec3 p, double lumenMm) {
    if (std::hypot(p.x, p.y) > mass.radiusMm() + 2.5 || std::abs(p.z) > mass.heightMm + 4.0)
        return false;
    double grown = lumenMm;
    for (const Dome& dome : mass.domes) {
        const double out = glm::distance(glm::dvec2(p), dome.at);
        if (out < dome.radiusMm + 2.5)
            grown = smoothMin(
                grown, domeMm(out, dome.radiusMm, dome.radiusMm, dome.heightMm, lumenMm), 1.5);
    }
    return grown < 0.0;
}

bool pedunculatedHolds(const Polyp& polyp, glm::dvec3 p, double lumenMm) {
    constexpr double filletMm = 0.6, reachMm = 2.0;
    const glm::dvec3 fromHead = p - polyp.center();
    const double stalk = phantom::capsule(p, glm::dvec3(0.0), polyp.center(), polyp.stalkRadiusMm);
    const double along = glm::dot(fromHead, polyp.stalk),
                 across = glm::length(fromHead - along * polyp.stalk),
                 half = polyp.headShare * polyp.radiusMm();
    const double head = half * (std::hypot(along / half, across / polyp.radiusMm()) - 1.0);
    if (stalk > reachMm && head > reachMm) return false;
    return smoothMin(smoothMin(stalk, head, filletMm), lumenMm, filletMm) < 0.0;
}

/// Whether a place is the polyp's or the wall's under it. `lumenMm`: how far in the lumen the place
/// was before; negative in the wall.
bool holds(const Polyp& polyp, glm::dvec3 p, double lumenMm) {
    if (lumenMm <= -deepestMm) return false;
    if (polyp.kind == Kind::flat) return flatHolds(polyp, p, lumenMm);
    if (polyp.kind == Kind::mass) return massHolds(polyp, p, lumenMm);
    if (polyp.kind == Kind::sessile) return sessileHolds(polyp, p, lumenMm);
    return pedunculatedHolds(polyp, p, lumenMm);
}

void smooth(Volume<float>& volume, double sigmaVoxels) {
    phantom::blur(volume, fwhmPerSigma * sigmaVoxels * volume.grid().spacingMm(), 0);
}

/// Eight voxels in the place of each.
Grid twiceAsFine(const Grid& grid) {
    Grid fine = grid;
    fine.size *= 2;
    fine.patientFromVoxel =
        glm::scale(glm::translate(grid.patientFromVoxel, glm::dvec3(-0.25)), glm::dvec3(0.5));
    return fine;
}

/// The mean of the eight voxels that lie in each of `grid`.
Volume<float> twiceAsCoarse(const Volume<float>& fine, const Grid& grid) {
    Volume<float> coarse(grid, 0.0f);
    const auto out = coarse.writable();
    for (std::size_t n = 0; n < fine.grid().voxelCount(); ++n)
        out[grid.index(fine.grid().voxelAt(n) / 2)] += 0.125f * fine[n];
    return coarse;
}

/// The wall around a place.
struct Surroundings {
    VoxelBox box;           ///< of the scan
    Volume<float> lumenMm;  ///< to the wall, positive in the open lumen; on a grid twice as fine

    double at(glm::dvec3 patientMm) const {
        return trilinear(lumenMm, lumenMm.grid().voxelFromPatientPoint(patientMm));
    }
};

/// Whether a place is a ring's: `alongMm` from its middle along the colon, `outMm` off the axis.
/// Its channel is uneven, and opens over its edges.
bool ringHolds(const Polyp& ring, double alongMm, double outMm, glm::dvec3 around) {
    const double edge = std::abs(alongMm) - (ring.radiusMm() - ring.edgeMm);
    if (edge > ring.edgeMm) return false;
    const double angle = std::atan2(around.y, around.x);
    const double uneven = 1.0 + lobe2 * std::cos(3.0 * angle + ring.lobes[0]) +
                          lobe3 * std::sin(alongMm / 3.0 + ring.lobes[1]);
    constexpr double openMm = 40.0;
    return outMm >
           ring.channelMm * uneven +
               openMm * (1.0 - std::sqrt(1.0 - std::pow(std::max(0.0, edge) / ring.edgeMm, 2.0)));
}

/// None near the scan's end, or where the lumen is not open.
std::optional<Surroundings> surroundingsOf(const Volume<std::uint8_t>& lumen, glm::dvec3 atMm,
                                           double reachMm) {
    const Grid& grid = lumen.grid();
    const glm::ivec3 voxel(glm::round(grid.voxelFromPatientPoint(atMm))),
        reach(glm::ceil(reachMm / grid.spacingMm()));
    const VoxelBox box{voxel - reach, 2 * reach + 1};
    if (!grid.contains(voxel - reach) || !grid.contains(voxel + reach)) return {};
    const auto labels = croppedCopy(lumen, box, 0);
    Volume<float> share(labels.grid());
    std::transform(labels.voxels().begin(), labels.voxels().end(), share.writable().begin(),
                   [](std::uint8_t label) {
                       return label && LumenLabel(label) != LumenLabel::bridge ? 1.0f : 0.0f;
                   });
    smooth(share, 0.5);
    const Grid fine = twiceAsFine(labels.grid());
    Volume<std::uint8_t> open(fine), closed(fine);
    std::size_t openVoxels = 0;
    for (std::size_t n = 0; n < fine.voxelCount(); ++n) {
        const glm::dvec3 v = 0.5 * glm::dvec3(fine.voxelAt(n)) - 0.25;
        open.writable()[n] = trilinear(share, v) > 0.5;
        closed.writable()[n] = !open[n];
        openVoxels += open[n];
    }
    if (openVoxels == 0 || openVoxels == fine.voxelCount()) return {};
    auto toWall = topology::distanceToBoundaryMm(open);
    const auto toLumen = topology::distanceToBoundaryMm(closed);
    for (std::size_t n = 0; n < fine.voxelCount(); ++n)
        toWall.writable()[n] -= toLumen[n];
    smooth(toWall, 1.0);
    return Surroundings{box, std::move(toWall)};
}

/// Unit, into the lumen: the mean over the wall that lies around the place. None on a crest, where
/// the wall turns.
std::optional<glm::dvec3> inwardAt(const Surroundings& around, glm::dvec3 atMm, double diameterMm) {
    const double nearMm = std::max(3.0, 0.35 * diameterMm);
    const Grid& fine = around.lumenMm.grid();
    const glm::ivec3 voxel(glm::round(fine.voxelFromPatientPoint(atMm)));
    auto part = croppedCopy(around.lumenMm,
                            boxWithin(fine, voxel, voxel, nearMm + 6.0 * fine.spacingMm()), 0);
    const auto sharp = part.clone();
    smooth(part, 2.0);
    const Grid& grid = part.grid();
    glm::dvec3 sum(0.0);
    int count = 0;
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        if (std::abs(sharp[n]) > 1.5f ||
            glm::distance(grid.patientFromVoxelPoint(v), atMm) > nearMm)
            continue;
        const auto slope = [&](glm::ivec3 step) { return part.at(v + step) - part.at(v - step); };
        sum += 0.5 * glm::dvec3(slope({1, 0, 0}), slope({0, 1, 0}), slope({0, 0, 1}));
        ++count;
    }
    if (count == 0) return {};
    const glm::dvec3 mean =
        glm::transpose(glm::dmat3(grid.voxelFromPatient())) * (sum / double(count));
    if (glm::length(mean) < 0.5) return {};
    return glm::normalize(mean);
}

struct Foot {
    glm::dvec3 atMm{0.0}, inward{0.0}, across{0.0}, along{0.0};  ///< a place; unit vectors

    glm::dvec3 patientOf(glm::dvec3 p) const {
        return atMm + p.x * across + p.y * along + p.z * inward;
    }
    glm::dvec3 ofPatient(glm::dvec3 patientMm) const {
        const glm::dvec3 p = patientMm - atMm;
        return {glm::dot(p, across), glm::dot(p, along), glm::dot(p, inward)};
    }
};

Foot footAt(glm::dvec3 atMm, glm::dvec3 inward) {
    const glm::dvec3 other = std::abs(inward.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 across = glm::normalize(glm::cross(inward, other));
    return {atMm, inward, across, glm::cross(inward, across)};
}

/// Whether the lumen is open from the foot to past the polyp's top, and its foot's wall is the one
/// that is nearest there: else what is measured from the wall would reach across the lumen.
bool hasRoom(const Polyp& polyp, const Foot& foot, const Surroundings& around) {
    // A mass is wide enough to have the wall across from it within its outline.
    const double openMm = (polyp.kind == Kind::mass ? 2.0 : 1.0) * polyp.heightMm + 4.0;
    for (double mm = 1.5; mm < openMm; mm += 0.5)
        if (around.at(foot.patientOf({0, 0, mm})) < 0.4) return false;
    if (polyp.kind == Kind::pedunculated)
        return around.at(foot.patientOf(polyp.center())) > polyp.radiusMm() + 1.0;
    return around.at(foot.patientOf({0, 0, polyp.heightMm})) > 0.9 * polyp.heightMm;
}

/// 1 in the polyp, on the fine grid: what is connected to its foot; empty where nothing is.
Volume<float> bodyOf(const Polyp& polyp, const Foot& foot, const Surroundings& around) {
    const Grid& grid = around.lumenMm.grid();
    Volume<std::uint8_t> inside(grid);
    const auto isIn = inside.writable();
    const std::size_t slice = grid.index(0, 0, 1);
    parallelFor(std::size_t(grid.size.z), 4, 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin * slice; n < end * slice; ++n) {
            const glm::dvec3 p = foot.ofPatient(grid.patientFromVoxelPoint(grid.voxelAt(n)));
            isIn[n] = holds(polyp, p, around.lumenMm[n]);
        }
    });
    double least = 1e30;
    std::vector<std::size_t> body(1);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const double mm = glm::distance(grid.patientFromVoxelPoint(grid.voxelAt(n)), foot.atMm);
        if (isIn[n] && mm < least) least = mm, body[0] = n;
    }
    if (least > 2.0) return {};
    isIn[body[0]] = 0;
    floodFill(body, faceNeighbours(grid), [&](std::size_t n) {
        const bool taken = isIn[n];
        isIn[n] = 0;
        return taken;
    });
    Volume<float> share(grid, 0.0f);
    for (const std::size_t n : body)
        share.writable()[n] = 1.0f;
    return share;
}

class Planter {
public:
    explicit Planter(const Patient& patient)
        : patient_(patient),
          hu_(patient.scan.hu.clone()),
          enhancement_(cleansing::measurePseudoEnhancement(patient.scan, patient.tissue,
                                                           patient.segmentation, 0)) {
        for (const glm::dvec3 at : patient.findingsMm)
            taken_.push_back({at, 0.0});
        double sum = 0.0;
        for (const glm::ivec3& t : patient.surface.triangles) {
            const auto& v = patient.surface.vertices;
            sum += 0.5 * glm::length(glm::cross(v[t.y] - v[t.x], v[t.z] - v[t.x]));
            areaUpTo_.push_back(sum);
        }
    }

    const cleansing::PseudoEnhancement& enhancement() const { return enhancement_; }
    const Volume<std::int16_t>& hu() const { return hu_; }

    /// At one of the places that it draws; none where no polyp of this shape has room.
    std::optional<GrowthTruth> plant(const Polyp& polyp, Random& random) {
        for (int n = 0, free = 0; n < placesPerPolyp && free < freePlacesPerPolyp; ++n) {
            const glm::dvec3 atMm = placeOnWall(random);
            if (isTaken(atMm, polyp.radiusMm())) continue;
            if (const auto truth = plantAt(polyp, atMm)) return truth;
            ++free;
        }
        return {};
    }

    /// A ring where the lumen is wide all along it.
    std::optional<GrowthTruth> plantRing(Polyp ring, Random& random) {
        const auto& axis = patient_.centerline.points;
        constexpr double leastThickMm = 4.0, fromEndsMm = 60.0;
        for (int n = 0; n < placesPerPolyp; ++n) {
            const double arcMm = random.uniform(
                fromEndsMm, std::max(fromEndsMm, patient_.centerline.lengthMm() - fromEndsMm));
            const glm::dvec3 atMm = poseAtArc(patient_.centerline, arcMm).point.positionMm;
            const bool wide = std::ranges::all_of(axis, [&](const CenterlinePoint& point) {
                return std::abs(point.arcMm - arcMm) > ring.radiusMm() ||
                       (!point.gap && point.radiusMm > ring.channelMm + leastThickMm);
            });
            if (!wide || isTaken(atMm, ring.radiusMm())) continue;
            if (const auto truth = plantRingAt(ring, arcMm)) return truth;
        }
        return {};
    }

private:
    struct Taken {
        glm::dvec3 atMm;
        double radiusMm;
    };

    /// By area.
    glm::dvec3 placeOnWall(Random& random) const {
        const auto& mesh = patient_.surface;
        const auto at = std::upper_bound(areaUpTo_.begin(), areaUpTo_.end() - 1,
                                         random.uniform() * areaUpTo_.back());
        const glm::ivec3 t = mesh.triangles[std::size_t(at - areaUpTo_.begin())];
        return (mesh.vertices[t.x] + mesh.vertices[t.y] + mesh.vertices[t.z]) / 3.0;
    }
    bool isTaken(glm::dvec3 atMm, double radiusMm) const {
        const auto more = [](double mm) { return std::max(0.0, mm - apartRadiusMm); };
        return std::ranges::any_of(taken_, [&](const Taken& other) {
            return glm::distance(atMm, other.atMm) <
                   apartMm + more(radiusMm) + more(other.radiusMm);
        });
    }

    std::optional<GrowthTruth> plantAt(const Polyp& polyp, glm::dvec3 atMm) {
        const double acrossMm = polyp.kind == Kind::mass ? polyp.radiusMm() : polyp.diameterMm;
        const auto around = surroundingsOf(patient_.lumen, atMm, polyp.heightMm + acrossMm + 8.0);
        if (!around) return {};
        const auto inward = inwardAt(*around, atMm, polyp.diameterMm);
        if (!inward) return {};
        const Foot foot = footAt(atMm, *inward);
        if (!hasRoom(polyp, foot, *around)) return {};
        Volume<float> body = bodyOf(polyp, foot, *around);
        if (body.empty()) return {};
        GrowthTruth truth = truthOf(polyp, foot, *around, body);
        phantom::blur(body, glm::dvec3(fwhmPerSigma * scannerSigmaMm), 0);
        fill(polyp, around->box, body);
        taken_.push_back({atMm, polyp.radiusMm()});
        return truth;
    }

    std::optional<GrowthTruth> plantRingAt(const Polyp& ring, double arcMm) {
        const CenterlinePose pose = poseAtArc(patient_.centerline, arcMm);
        const double reachMm = ring.radiusMm() + 30.0;
        const auto around = surroundingsOf(patient_.lumen, pose.point.positionMm, reachMm);
        if (!around) return {};
        auto axis = patient_.centerline.points;  // that may be nearest to a place in there
        std::erase_if(axis, [&](const CenterlinePoint& point) {
            return glm::distance(point.positionMm, pose.point.positionMm) > 2.0 * reachMm;
        });
        const Foot foot = footAt(pose.point.positionMm, pose.tangent);
        const Grid& grid = around->lumenMm.grid();
        Volume<float> body(grid, 0.0f);
        const auto share = body.writable();
        parallelFor(grid.voxelCount(), 1 << 16, 0, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                if (around->lumenMm[n] <= -deepestMm) continue;
                const glm::dvec3 p = grid.patientFromVoxelPoint(grid.voxelAt(n));
                // Another loop's lumen is nearest to another part of the axis.
                const auto nearest = std::ranges::min_element(axis, {}, [&](const auto& point) {
                    return glm::distance(point.positionMm, p);
                });
                share[n] = ringHolds(ring, nearest->arcMm - arcMm,
                                     glm::distance(nearest->positionMm, p), foot.ofPatient(p));
            }
        });
        GrowthTruth truth = truthOf(ring, foot, *around, body);
        truth.positionMm = pose.point.positionMm;
        truth.wallMm = foot.patientOf({ring.channelMm, 0, 0});
        truth.heightMm = pose.point.radiusMm - ring.channelMm;
        phantom::blur(body, glm::dvec3(fwhmPerSigma * scannerSigmaMm), 0);
        fill(ring, around->box, body);
        taken_.push_back({pose.point.positionMm, ring.radiusMm()});
        return truth;
    }

    GrowthTruth truthOf(const Polyp& polyp, const Foot& foot, const Surroundings& around,
                        const Volume<float>& body) const {
        const Grid& fine = body.grid();
        double added = 0.0, tagged = 0.0, untagged = 0.0;
        for (std::size_t n = 0; n < fine.voxelCount(); ++n) {
            if (body[n] == 0.0f || around.lumenMm[n] <= 0.0f) continue;
            const auto label =
                LumenLabel(patient_.segmentation.at(around.box.lo + fine.voxelAt(n) / 2));
            added += 1.0;
            tagged += label == LumenLabel::tagged, untagged += label == LumenLabel::untagged;
        }
        GrowthTruth truth;
        truth.kind = kindNames[std::size_t(polyp.kind)];
        truth.neoplastic = true;
        truth.positionMm = foot.patientOf(polyp.center());
        truth.wallMm = foot.atMm;
        truth.diameterMm = polyp.diameterMm, truth.heightMm = polyp.heightMm;
        truth.densityHu = polyp.tissueHu - patient_.tissue.meanHu[int(Tissue::soft)];
        truth.submergedShare = tagged / std::max(1.0, added);
        truth.untaggedShare = untagged / std::max(1.0, added);
        return truth;
    }

    /// Gives the polyp's share of each voxel its tissue's HU.
    void fill(const Polyp& polyp, const VoxelBox& box, const Volume<float>& fineShare) {
        const Grid part = cropped(hu_.grid(), box);
        const auto share = twiceAsCoarse(fineShare, part);
        Volume<float> clean(part);
        for (std::size_t n = 0; n < part.voxelCount(); ++n) {
            const glm::ivec3 v = box.lo + part.voxelAt(n);
            clean.writable()[n] =
                float(polyp.tissueHu + (enhancement_ ? enhancement_.at(v.x, v.y, v.z) : 0.0));
        }
        const auto tissue = phantom::addNoise(clean, {polyp.textureSeed, textureHu, grainMm}, 0);
        for (std::size_t n = 0; n < part.voxelCount(); ++n) {
            std::int16_t& hu = hu_.writable()[hu_.grid().index(box.lo + part.voxelAt(n))];
            if (share[n] > 0.0f)
                hu =
                    std::int16_t(std::lround((1.0 - share[n]) * hu + double(share[n]) * tissue[n]));
        }
    }

    const Patient& patient_;
    Volume<std::int16_t> hu_;
    std::vector<Taken> taken_;
    cleansing::PseudoEnhancement enhancement_;
    std::vector<double> areaUpTo_;  // of the surface's triangles, mm²
};

/// But where there is no scan: padding stays as it is.
Volume<std::int16_t> withNoise(const Volume<std::int16_t>& hu, const phantom::Noise& noise) {
    if (noise.sdHu <= 0.0) return hu.share();
    Volume<float> clean(hu.grid());
    std::copy(hu.voxels().begin(), hu.voxels().end(), clean.writable().begin());
    auto noisy = phantom::addNoise(clean, noise, 0);
    for (std::size_t n = 0; n < hu.grid().voxelCount(); ++n)
        if (hu[n] < -1024) noisy.writable()[n] = hu[n];
    return noisy;
}

std::vector<GrowthTruth> plantAll(Planter& planter, const PlantOptions& options) {
    Random random(options.seed, 80);
    std::vector<GrowthTruth> truths;
    for (int drawn = 0; drawn < 2 * options.count && int(truths.size()) < options.count; ++drawn) {
        const int wide = options.masses + options.rings;
        const Polyp polyp = int(truths.size()) < options.masses ? drawMass(random, options.tissueHu)
                            : int(truths.size()) < wide         ? drawRing(random, options.tissueHu)
                                                        : drawPolyp(random, options.tissueHu);
        const auto truth = polyp.kind == Kind::ring ? planter.plantRing(polyp, random)
                                                    : planter.plant(polyp, random);
        if (!truth) continue;
        fmt::print("{:<12} {:4.1f} mm wide, {:4.1f} mm high, {:3.0f} HU, {:3.0f} % submerged\n",
                   truth->kind, truth->diameterMm, truth->heightMm, polyp.tissueHu,
                   100.0 * truth->submergedShare);
        std::fflush(stdout);
        truths.push_back(*truth);
    }
    return truths;
}

Result<void> writeTruth(const fs::path& folder, const std::vector<GrowthTruth>& truths) {
    std::error_code error;
    fs::create_directories(folder, error);
    std::ofstream file(folder / "growths.json");
    file << phantom::growthsJson(truths);
    file.close();
    if (!file) return fail(ErrorKind::io, "the truth cannot be written", folder.string());
    return {};
}

Result<void> run(const PlantOptions& options) {
    if (options.tissueHu[0] > options.tissueHu[1])
        return fail(ErrorKind::badInput, "the least HU are more than the most", "--hu");
    std::error_code error;
    const fs::path series = options.out / "series";
    if (fs::exists(series, error) && !fs::is_empty(series, error))
        return fail(ErrorKind::badInput, "the folder is not empty", series.string());
    const Patient patient = TRY(readPatient(options.store, options.name));
    Planter planter(patient);
    fmt::print("pseudo-enhancement: {:.0f} HU at a pool's edge\n", planter.enhancement().edgeHu());
    const auto truths = plantAll(planter, options);
    if (truths.empty())
        return fail(ErrorKind::badInput,
                    "no place was found on the wall of case " + options.name + " for any polyp",
                    options.store);
    if (int(truths.size()) < options.count)
        fmt::print(stderr, "only {} of {} polyps have a place\n", truths.size(), options.count);
    dicom::WriteOptions writing;
    writing.patientName = "HAUSTRA^PLANTED", writing.patientId = "PLANTED";
    writing.seriesDescription = fmt::format("Planted polyps {}", options.seed);
    writing.uidSeed = fmt::format("planted {} {} {} {} {} {} {} {}", patient.scanKey, options.seed,
                                  options.count, options.masses, options.rings, options.tissueHu[0],
                                  options.tissueHu[1], options.noiseSdHu);
    const CtScan scan{withNoise(planter.hu(), {options.seed, options.noiseSdHu, grainMm}),
                      patient.scan.position};
    return dicom::writeSeries(series, scan, writing).and_then([&] {
        return writeTruth(options.out / "truth", truths);
    });
}

}  // namespace

int main(int count, char** arguments) {
    CLI::App program(
        "Plants polyps on the wall of a prepared real scan: OUT/series, and OUT/truth/growths.json "
        "as `haustra phantom` writes it.");
    PlantOptions options;
    program.add_option("STORE", options.store, "The case store")->required();
    program.add_option("CASE", options.name, "A case that is prepared to `surface`")->required();
    program.add_option("OUT", options.out, "The folder to make")->required();
    program.add_option("--seed", options.seed)->capture_default_str();
    program.add_option("--count", options.count, "How many")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    program
        .add_option("--masses", options.masses,
                    "How many of these are masses of 20 to 40 mm; they come first")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    program
        .add_option("--rings", options.rings,
                    "How many are cancers that go all around and leave a channel, 20 to 50 mm "
                    "long; they come after the masses")
        ->check(CLI::Range(0, 1000))
        ->capture_default_str();
    program.add_option("--hu", options.tissueHu, "Least and most of a polyp's tissue: LO,HI")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(-1024.0, 3071.0))
        ->capture_default_str();
    program.add_option("--noise", options.noiseSdHu, "Added to all of the scan, HU")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    CLI11_PARSE(program, count, arguments);
    const auto done = run(options);
    if (!done) fmt::print(stderr, "{}\n", describe(done.error()));
    return done ? 0 : 1;
}
