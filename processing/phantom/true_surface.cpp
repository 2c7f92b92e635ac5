#include "phantom/true_surface.h"

#include "core/flood_fill.h"
#include "core/voxel_sweep.h"
#include "phantom/filled_colon.h"

#include <array>
#include <cmath>
#include <memory>

namespace haustra::phantom {
namespace {

constexpr double differenceMm = 0.01;  // of differences
constexpr double onSurfaceMm = 2e-4;   // of the field
constexpr double nearMm = 0.01;        // nearer than this is near enough
constexpr double cellMm = 2.0;
/// A collapsed stretch is left out with this much of the lumen's tapered ends.
constexpr double collapseMarginMm = 6.0;
constexpr double leastPieceMl = 1.0;

/// Where the field changes sign between a (negative) and b, to a micrometre.
glm::dvec3 bisect(const std::function<double(glm::dvec3)>& field, glm::dvec3 a, glm::dvec3 b) {
    for (int round = 0; round < 11; ++round) {
        const glm::dvec3 middle = 0.5 * (a + b);
        (field(middle) < 0.0 ? a : b) = middle;
    }
    return 0.5 * (a + b);
}

/// To the faces and corners of a cube.
const std::array<glm::dvec3, 14>& allAround() {
    static const std::array<glm::dvec3, 14> directions = [] {
        std::array<glm::dvec3, 14> all;
        for (int n = 0; n < 8; ++n)
            all[std::size_t(n)] =
                glm::normalize(glm::dvec3(n & 1 ? 1 : -1, n & 2 ? 1 : -1, n & 4 ? 1 : -1));
        for (int n = 0; n < 6; ++n)
            all[std::size_t(8 + n)][n / 2] = n % 2 ? 1.0 : -1.0;
        return all;
    }();
    return directions;
}

}  // namespace

TrueSurface::TrueSurface(Implicit implicit, const Volume<std::uint8_t>& inside, int threads)
    : implicit_(std::move(implicit)) {
    const Grid& grid = inside.grid();
    std::vector<std::vector<SurfaceSample>> bySlice(std::size_t(grid.size.z));
    forVoxels(grid, threads, [&](std::size_t n, glm::ivec3 v) {
        const bool here = inside[n];
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 beside = v;
            if (++beside[axis] >= grid.size[axis] || bool(inside.at(beside)) == here) continue;
            const glm::dvec3 a = grid.patientFromVoxelPoint(v),
                             b = grid.patientFromVoxelPoint(beside);
            bySlice[std::size_t(v.z)].push_back(here ? crossing(a, b, grid) : crossing(b, a, grid));
        }
    });
    std::vector<Box> boxes;
    for (const auto& slice : bySlice) {
        for (const SurfaceSample& sample : slice) {
            samples_.push_back(sample);
            boxes.push_back({sample.positionMm, sample.positionMm});
        }
    }
    near_ = CellGrid(boxes, cellMm);
}

/// Where the surface crosses the edge from `in` to `out`.
SurfaceSample TrueSurface::crossing(glm::dvec3 in, glm::dvec3 out, const Grid& grid) const {
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::dmat3 patientFromVoxel(grid.patientFromVoxel);
    // How many crossings of each axis's edges there are on a square millimetre square to it.
    const glm::dvec3 density = spacing / grid.voxelVolumeMm3();
    SurfaceSample sample;
    sample.positionMm = bisect(implicit_.field, in, out);
    const glm::dvec3 g = gradient(sample.positionMm, implicit_.field(sample.positionMm));
    if (const double steep = glm::length(g); steep > 1e-6) sample.outward = g / steep;
    double crossings = 0.0;
    for (int a = 0; a < 3; ++a) {
        crossings +=
            density[a] * std::abs(glm::dot(sample.outward, patientFromVoxel[a])) / spacing[a];
    }
    if (crossings > 0.0) sample.areaMm2 = 1.0 / crossings;
    return sample;
}

double TrueSurface::areaMm2() const {
    double area = 0.0;
    for (const SurfaceSample& sample : samples_)
        area += sample.areaMm2;
    return area;
}

glm::dvec3 TrueSurface::gradient(glm::dvec3 p, double atP) const {
    glm::dvec3 g;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 q = p;
        q[axis] += differenceMm;
        g[axis] = (implicit_.field(q) - atP) / differenceMm;
    }
    return g;
}

/// Slides over the surface from a point of it toward the foot of p, as far as the field is smooth.
glm::dvec3 TrueSurface::slide(glm::dvec3 p, glm::dvec3 start) const {
    glm::dvec3 foot = start;
    double best = glm::distance(p, foot);
    double reach = 1.0;  // mm, of one step
    for (int step = 0; step < 8 && best > 1e-3 && reach > 1e-3; ++step) {
        const glm::dvec3 g = gradient(foot, implicit_.field(foot));
        const double steep = glm::length(g);
        if (!(steep > 1e-3)) break;
        const glm::dvec3 outward = g / steep;
        glm::dvec3 along = (p - foot) - glm::dot(p - foot, outward) * outward;
        const double length = glm::length(along);
        // What is left to gain is length² / (2 best).
        if (length * length < 4e-3 * best) break;
        if (length > reach) along *= reach / length;
        glm::dvec3 q = foot + along;
        double f = implicit_.field(q);
        // Back to the surface along the gradient of the start, which is near enough for small
        // steps.
        for (int round = 0; round < 4 && std::abs(f) > onSurfaceMm; ++round) {
            const glm::dvec3 there = round == 0 ? g : gradient(q, f);
            const double square = glm::dot(there, there);
            if (!(square > 1e-6)) break;
            q -= there * (f / square);
            f = implicit_.field(q);
        }
        const double d = glm::distance(p, q);
        if (std::abs(f) <= onSurfaceMm && d < best) {
            best = d, foot = q;
        } else {
            reach = 0.4 * std::min(reach, length);
        }
    }
    return foot;
}

/// Looks from p in one direction for a place of the other side nearer than `foot`, and moves the
/// foot there.
bool TrueSurface::probe(glm::dvec3 p, bool inLumen, glm::dvec3 direction, glm::dvec3& foot) const {
    const double best = glm::distance(p, foot);
    const glm::dvec3 far = p + (0.99 * best - 1e-3) * direction;
    if ((implicit_.field(far) < 0.0) == inLumen) return false;
    foot = inLumen ? bisect(implicit_.field, p, far) : bisect(implicit_.field, far, p);
    return true;
}

CellGrid::Nearest TrueSurface::nearestSample(glm::dvec3 p) const {
    return near_.nearest(p, [&](std::uint32_t n) {
        const glm::dvec3 d = samples_[n].positionMm - p;
        return glm::dot(d, d);
    });
}

double TrueSurface::atMostMm(glm::dvec3 p) const {
    return std::sqrt(nearestSample(p).squaredMm2);
}

double TrueSurface::distanceMm(glm::dvec3 p) const {
    const auto nearest = nearestSample(p);
    if (nearest.item == CellGrid::none) return std::numeric_limits<double>::infinity();
    glm::dvec3 foot = slide(p, samples_[nearest.item].positionMm);
    // Creases and thin folds hide nearer places from a slide: any place of p's other side nearer
    // than the foot betrays one.
    const bool inLumen = implicit_.field(p) < 0.0;
    bool found = false;
    for (const glm::dvec3& direction : allAround())
        found |= glm::distance(p, foot) > nearMm && probe(p, inLumen, direction, foot);
    if (found) foot = slide(p, foot);
    for (const double angle : {0.7, 0.3, 0.12}) {
        for (int turn = 0; turn < 6 && glm::distance(p, foot) > nearMm; ++turn) {
            const glm::dvec3 axis = glm::normalize(foot - p);
            const glm::dvec3 u = glm::normalize(glm::cross(
                axis, std::abs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
            const glm::dvec3 v = glm::cross(axis, u);
            const double around = turn * 1.0471975512;
            probe(p, inLumen,
                  std::cos(angle) * axis +
                      std::sin(angle) * (std::cos(around) * u + std::sin(around) * v),
                  foot);
        }
    }
    return glm::distance(p, foot);
}

double TrueSurface::signedDistanceMm(glm::dvec3 p) const {
    const double d = distanceMm(p);
    return implicit_.field(p) < 0.0 ? -d : d;
}

namespace {

/// The shape's geometry at any point, with what lies near each block of space found beforehand.
class ColonEverywhere {
public:
    ColonEverywhere(ColonShape shape, const Grid& grid, int threads) : shape_(std::move(shape)) {
        const glm::dvec3 a = grid.patientFromVoxelPoint(glm::dvec3(0.0)),
                         b = grid.patientFromVoxelPoint(glm::dvec3(grid.size - 1));
        lowMm_ = glm::min(a, b) - blockMm;
        blocks_ = glm::ivec3(glm::ceil((glm::max(a, b) + blockMm - lowMm_) / blockMm));
        nearby_.resize(std::size_t(blocks_.x) * blocks_.y * blocks_.z);
        parallelFor(nearby_.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n) {
                const glm::ivec3 block(int(n % blocks_.x), int(n / blocks_.x % blocks_.y),
                                       int(n / (std::size_t(blocks_.x) * blocks_.y)));
                shape_.findNearby(lowMm_ + blockMm * (glm::dvec3(block) + 0.5), blockMm * 0.867,
                                  nearby_[n]);
            }
        });
    }

    ColonPoint operator()(glm::dvec3 p) const {
        const glm::ivec3 block(glm::floor((p - lowMm_) / blockMm));
        if (glm::any(glm::lessThan(block, glm::ivec3(0))) ||
            glm::any(glm::greaterThanEqual(block, blocks_))) {
            return {};
        }
        return shape_.evaluate(
            p, nearby_[std::size_t(block.x) +
                       std::size_t(blocks_.x) *
                           (std::size_t(block.y) + std::size_t(blocks_.y) * block.z)]);
    }

    bool collapsedAt(glm::dvec3 p) const {
        return shape_.path().collapsedWithin((*this)(p).arcMm, collapseMarginMm);
    }

private:
    static constexpr double blockMm = 8.0;
    ColonShape shape_;
    glm::dvec3 lowMm_{0.0};
    glm::ivec3 blocks_{0};
    std::vector<ColonShape::Nearby> nearby_;
};

/// The lumen without its 6-connected pieces below leastPieceMl.
Volume<std::uint8_t> largePieces(const Volume<std::uint8_t>& labels) {
    const Grid& grid = labels.grid();
    Volume<std::uint8_t> large(grid, 0);
    const auto out = large.writable();
    const double least = leastPieceMl * 1e3 / grid.voxelVolumeMm3();
    std::vector<std::uint32_t> piece;
    constexpr std::uint8_t dropped = 2;
    for (std::size_t start = 0; start < grid.voxelCount(); ++start) {
        if (!labels[start] || out[start]) continue;
        piece.assign(1, std::uint32_t(start)), out[start] = 1;
        floodFill(piece, faceNeighbours(grid), [&](std::size_t n) {
            if (!labels[n] || out[n]) return false;
            out[n] = 1;
            return true;
        });
        if (double(piece.size()) >= least) continue;
        for (const std::uint32_t n : piece)
            out[n] = dropped;
    }
    for (std::uint8_t& voxel : out)
        voxel = voxel == 1;
    return large;
}

}  // namespace

TrueSurface trueLumenSurface(const PhantomOptions& options,
                             const Volume<std::uint8_t>& truthLabels) {
    FilledColon colon = makeFilledColon(options);
    const auto everywhere = std::make_shared<const ColonEverywhere>(
        std::move(colon.shape), truthLabels.grid(), options.threads);
    return TrueSurface({[everywhere](glm::dvec3 p) { return (*everywhere)(p).lumenMm; },
                        [everywhere](glm::dvec3 p) { return everywhere->collapsedAt(p); }},
                       largePieces(truthLabels), options.threads);
}

}  // namespace haustra::phantom
