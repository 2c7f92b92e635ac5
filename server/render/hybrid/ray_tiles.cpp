#include "render/hybrid/ray_tiles.h"

#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::render {

namespace {

/// Rays of the CPU and the GPU differ by rounding: what matters lies this far inside, in samples.
constexpr double guard = 0.05;
/// No ray has more samples.
constexpr double mostSamples = 1e7;
/// How far a ray is followed to the first visible sample.
constexpr int mostSamplesToBoundary = 64;

/// Value at a place, as the GPU interpolates it.
double valueAt(const Volume<std::int16_t>& volume, glm::dvec3 voxel) {
    const glm::ivec3 size = volume.grid().size;
    const glm::dvec3 inside = glm::clamp(voxel, glm::dvec3(0.0), glm::dvec3(size - 1));
    const glm::ivec3 low = glm::min(glm::ivec3(inside), glm::max(size - 2, glm::ivec3(0)));
    const glm::ivec3 step = glm::min(low + 1, size - 1) - low;
    const glm::dvec3 share = inside - glm::dvec3(low);
    const std::size_t row = std::size_t(size.x), slice = row * std::size_t(size.y);
    const std::int16_t* at = &volume.voxels()[volume.grid().index(low)];
    const auto line = [&](std::size_t offset) {
        return glm::mix(double(at[offset]), double(at[offset + std::size_t(step.x)]), share.x);
    };
    const std::size_t y = row * std::size_t(step.y), z = slice * std::size_t(step.z);
    return glm::mix(glm::mix(line(0), line(y), share.y), glm::mix(line(z), line(y + z), share.y),
                    share.z);
}

}  // namespace

RayTiles::RayTiles(const CameraRays& rays, const RayMedium& medium, const Band& band,
                   const Backdrop* backdrop, double stepMm, const HybridControls& controls,
                   std::span<RaySpan> spans)
    : rays_(rays),
      medium_(medium),
      band_(band),
      backdrop_(backdrop),
      stepMm_(stepMm),
      controls_(controls),
      spans_(spans),
      tiles_((glm::ivec2(band.pictureSize.x, band.rows) + tileSide - 1) / tileSide),
      quadState_(std::size_t(tiles()) * quadsPerTile, QuadState::terminated),
      ended_(quadState_.size(), outside),
      slabsCast_(quadState_.size(), 0),
      live_(std::size_t(tiles()), 0),
      whole_(std::size_t(tiles()), 0) {}

double RayTiles::beamStart(glm::ivec2 corner) const {
    // Rays of other lenses do not begin at one point, or bend between a beam's corners.
    if (!rays_.perspective()) return 0.0;
    const glm::dvec2 low(corner + glm::ivec2(0, band_.firstRow));
    const VoxelRay axis = *rays_.through(low + 0.5 * beamSide);
    // How fast the corners' rays leave the axis; others stay within this but for their curvature.
    double spread = 0.0;
    for (int at = 0; at < 4; ++at) {
        const glm::dvec2 place = low + double(beamSide) * glm::dvec2(at & 1, at >> 1);
        const glm::dvec3 aside = glm::abs(rays_.through(place)->direction - axis.direction);
        spread = std::max(spread, std::max(aside.x, std::max(aside.y, aside.z)));
    }
    spread *= 1.05;
    const glm::dvec3 along = glm::abs(axis.direction);
    const double speed = std::max(along.x, std::max(along.y, along.z)) + spread;
    const ClassifiedOctree& octree = medium_.octree;
    const int leafSide = blockSide;
    const glm::dvec3 size(medium_.volume.grid().size);
    // Whether all nodes of a level within `reach` of a place are empty; there are none outside.
    const auto clear = [&](int level, glm::dvec3 place, double reach) {
        const double side = double(leafSide << level);
        const glm::ivec3 last = octree.nodes(level) - 1;
        if (glm::any(glm::lessThan(place + reach, glm::dvec3(-0.5))) ||
            glm::any(glm::greaterThan(place - reach, size - 0.5)))
            return true;
        const glm::ivec3 from = glm::clamp(glm::ivec3(glm::floor((place - reach) / side)),
                                           glm::ivec3(0), last),
                         to = glm::clamp(glm::ivec3(glm::floor((place + reach) / side)),
                                         glm::ivec3(0), last);
        return !anyInBox(
            from, to, [&](glm::ivec3 node) { return octree.at(level, node) != NodeClass::empty; });
    };
    double n = 0.0;
    int level = octree.levels() - 1;
    while (n < mostSamples) {
        const glm::dvec3 place = axis.at(n);
        const double width = n * spread + 0.1;
        const double room = 0.5 * (leafSide << level);
        // Wide beams among small nodes would have to look at many.
        if (width > 2.0 * room) return n;
        if (clear(level, place, width + room)) {
            n += room / speed;
            level = std::min(level + 1, octree.levels() - 1);
            // Beyond the volume there is nothing to come.
            const glm::dvec3 ahead = axis.direction;
            for (int side = 0; side < 3; ++side)
                if ((ahead[side] >= 0.0 && place[side] - width > size[side] + room) ||
                    (ahead[side] <= 0.0 && place[side] + width < -1.0 - room))
                    if (std::abs(ahead[side]) >= spread) return n;
        } else if (level-- == 0) {
            return n;
        }
    }
    return n;
}

RaySpan RayTiles::span(glm::ivec2 pixel, double from) const {
    const glm::ivec2 inPicture = pixel + glm::ivec2(0, band_.firstRow);
    const auto ray = rays_.through(inPicture);
    if (!ray) return {};
    double to = mostSamples;
    if (backdrop_) {
        const std::size_t at =
            std::size_t(inPicture.y) * std::size_t(band_.pictureSize.x) + std::size_t(inPicture.x);
        to = std::min(to, double(backdrop_->pixels[at].w) / stepMm_ + 1.0);
    }
    const ClassifiedOctree& octree = medium_.octree;
    const int levels = octree.levels();
    const auto entry =
        octree.firstNonEmpty(*ray, from, to, std::min(controls_.entryLevel, levels - 1));
    if (!entry) return {};
    RaySpan span;
    span.first = controls_.toBoundary
                     ? firstVisible(*ray, entry->enter, to)
                     : float(std::max(std::floor(entry->enter - guard) - 1.0, 0.0));
    // Where it leaves the volume.
    const glm::dvec3 size(medium_.volume.grid().size);
    for (int axis = 0; axis < 3; ++axis) {
        const double along = ray->direction[axis];
        if (along == 0.0) continue;
        const double face = along > 0.0 ? size[axis] - 0.5 : -0.5;
        to = std::min(to, (face - ray->origin[axis]) / along);
    }
    if (controls_.exitLevel >= 0) {
        const VoxelRay back{ray->at(to), -ray->direction};
        const auto exit = octree.firstNonEmpty(back, 0.0, to - span.first,
                                               std::min(controls_.exitLevel, levels - 1));
        if (exit) to -= exit->enter;
    }
    span.last = float(std::ceil(to + guard) + 1.0);
    return span;
}

float RayTiles::firstVisible(const VoxelRay& ray, double from, double to) const {
    double n = std::max(std::floor(from - guard), 0.0);
    for (int samples = 0; samples < mostSamplesToBoundary && n <= to;) {
        const auto entry = medium_.octree.firstNonEmpty(ray, n, to);
        if (!entry) break;
        n = std::max(n, std::floor(entry->enter - guard));
        for (; n <= entry->leave + guard && samples < mostSamplesToBoundary; n += 1.0, ++samples) {
            // The GPU interpolates with 8 bits between voxels, and rounds.
            const double value = valueAt(medium_.volume, ray.at(n));
            const double beyond = valueAt(medium_.volume, ray.at(n + 1.0));
            const double blur = 2.0 + std::abs(beyond - value);
            if (medium_.table.anyVisible(value - blur, value + blur))
                return float(std::max(n - 1.0, 0.0));
        }
        if (samples < mostSamplesToBoundary) n = std::max(n, std::ceil(entry->leave));
    }
    return float(std::max(n - 1.0, 0.0));
}

bool RayTiles::endsWithin(const VoxelRay& ray, double from, double to) const {
    bool ends = false;
    medium_.octree.pierce(ray, from, to, [&](const NodeCrossing& leaf, NodeClass kind) {
        if (kind != NodeClass::opaque) return true;
        const double first = std::ceil(std::max(leaf.enter, from) + guard);
        ends = first + medium_.samplesToEnd - 1 <= std::min(leaf.leave - guard, to);
        return !ends;
    });
    return ends;
}

void RayTiles::determine(int tile) {
    const glm::ivec2 size(band_.pictureSize.x, band_.rows);
    int live = 0, whole = 0;
    constexpr int beams = tileSide / beamSide;
    std::array<double, beams * beams> from{};
    for (int beam = 0; beam < beams * beams; ++beam) {
        const glm::ivec2 corner =
            2 * place(tile, 0) + beamSide * glm::ivec2(beam % beams, beam / beams);
        if (corner.x < size.x && corner.y < size.y) from[std::size_t(beam)] = beamStart(corner);
    }
    for (int quad = 0; quad < quadsPerTile; ++quad) {
        const std::size_t at = std::size_t(tile) * quadsPerTile + std::size_t(quad);
        const glm::ivec2 corner = 2 * place(tile, quad);
        const glm::ivec2 inTile = (corner - 2 * place(tile, 0)) / beamSide;
        const double start = from[std::size_t(inTile.x + beams * inTile.y)];
        if (corner.x >= size.x || corner.y >= size.y) continue;
        std::uint8_t ended = 0;
        for (int ray = 0; ray < 4; ++ray) {
            const glm::ivec2 pixel = corner + glm::ivec2(ray & 1, ray >> 1);
            if (pixel.x >= size.x || pixel.y >= size.y) {
                ended = std::uint8_t(ended | 1 << ray);
                continue;
            }
            const RaySpan found = span(pixel, start);
            spans_[std::size_t(pixel.y) * std::size_t(size.x) + std::size_t(pixel.x)] = found;
            if (found.last < found.first) ended = std::uint8_t(ended | 1 << ray);
        }
        ended_[at] = ended;
        quadState_[at] = ended == 0          ? QuadState::live
                         : ended == allEnded ? QuadState::terminated
                                             : QuadState::hole;
        live += quadState_[at] == QuadState::live;
        ++whole;
    }
    live_[std::size_t(tile)] = live;
    whole_[std::size_t(tile)] = whole;
    if (controls_.leftToFilling > 1.0) leaveToFilling(tile);
}

void RayTiles::follow(int tile, int slab) {
    const glm::ivec2 size(band_.pictureSize.x, band_.rows);
    int& live = live_[std::size_t(tile)];
    for (int quad = 0; quad < quadsPerTile; ++quad) {
        const std::size_t at = std::size_t(tile) * quadsPerTile + std::size_t(quad);
        if (quadState_[at] != QuadState::live) continue;
        slabsCast_[at] = std::uint16_t(slab + 1);
        const glm::ivec2 corner = 2 * place(tile, quad);
        std::uint8_t ended = 0;
        for (int ray = 0; ray < 4; ++ray) {
            const glm::ivec2 pixel = corner + glm::ivec2(ray & 1, ray >> 1);
            const RaySpan found =
                spans_[std::size_t(pixel.y) * std::size_t(size.x) + std::size_t(pixel.x)];
            const double begin = found.first + double(slab) * slabSamples,
                         end = begin + slabSamples - 1;
            bool ends = end >= found.last;
            if (!ends && medium_.endsInOpaque)
                ends =
                    endsWithin(*rays_.through(pixel + glm::ivec2(0, band_.firstRow)), begin, end);
            if (ends) ended = std::uint8_t(ended | 1 << ray);
        }
        ended_[at] = ended;
        if (ended == 0) continue;
        quadState_[at] = ended == allEnded ? QuadState::terminated : QuadState::hole;
        --live;
    }
    if (live < controls_.leftToFilling * whole_[std::size_t(tile)]) leaveToFilling(tile);
}

void RayTiles::leaveToFilling(int tile) {
    for (int quad = 0; quad < quadsPerTile; ++quad) {
        QuadState& state = quadState_[std::size_t(tile) * quadsPerTile + std::size_t(quad)];
        if (state == QuadState::live) state = QuadState::hole;
    }
    live_[std::size_t(tile)] = 0;
}

}  // namespace haustra::render
