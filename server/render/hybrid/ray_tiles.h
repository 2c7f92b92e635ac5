// The CPU's half of the hybrid raycaster: where rays begin, and when they have ended
// (dissertation §5.3.1, §5.3.2.3).
#pragma once

#include "core/volume.h"
#include "render/hybrid/balance.h"
#include "render/hybrid/camera_rays.h"
#include "render/optics/transfer_table.h"
#include "render/scene/min_max_octree.h"
#include "render/scene/raycaster.h"

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::render {

/// Samples first … last of a pixel's ray; none where last < first. As the shader reads it.
struct RaySpan {
    float first = 1.0f, last = 0.0f;
};

/// Two by two pixels, whose rays begin and end a slab together.
enum class QuadState : std::uint8_t {
    live,        ///< all its rays go on
    hole,        ///< some have ended: the rest is left to the filling of holes
    terminated,  ///< all have ended
};

/// What rays are found in.
struct RayMedium {
    const Volume<std::int16_t>& volume;
    const ClassifiedOctree& octree;
    const TransferTable& table;
    bool endsInOpaque = true;  ///< some leaves are opaque, and rays end there
    int samplesToEnd = 1;      ///< in an opaque leaf: 2 where segments count, not samples
};

/// The rays of one band, in tiles. Tiles are independent of each other: any number of threads, one
/// to a tile. It refers to all that it is made of.
class RayTiles {
public:
    static constexpr int tileSide = 32, quadsPerSide = tileSide / 2;
    static constexpr int quadsPerTile = quadsPerSide * quadsPerSide;
    /// Samples of a slab: as many of each ray are cast in a pass.
    static constexpr int slabSamples = 32;

    /// `spans` has one entry for each pixel of the band, row by row: the GPU's.
    RayTiles(const CameraRays& rays, const RayMedium& medium, const Band& band,
             const Backdrop* backdrop, double stepMm, const HybridControls& controls,
             std::span<RaySpan> spans);

    int tiles() const { return tiles_.x * tiles_.y; }
    int quads() const { return int(quadState_.size()); }
    /// Quads of a tile that go on.
    int liveQuads(int tile) const { return live_[std::size_t(tile)]; }
    /// Whether no quad of the tile has ended or is a hole.
    bool full(int tile) const { return live_[std::size_t(tile)] == whole_[std::size_t(tile)]; }

    /// Finds where the tile's rays begin (controls 1 and 2) and end (control 3).
    void determine(int tile);
    /// Finds which of its rays end in this slab, counted from each ray's beginning: which go
    /// beyond their last sample, or through a leaf that is opaque all through. Never says so of one
    /// that goes on. Then leaves the tile to filling where too few go on (control 4).
    void follow(int tile, int slab);

    /// Calls visit(quad's place in quads, slabs that have been cast) for the tile's quads in this
    /// state.
    template <class Visit>
    void forEach(int tile, QuadState state, Visit&& visit) const {
        for (int quad = 0; quad < quadsPerTile; ++quad) {
            const std::size_t at = std::size_t(tile) * quadsPerTile + std::size_t(quad);
            if (quadState_[at] == state && ended_[at] != outside)
                visit(place(tile, quad), int(slabsCast_[at]));
        }
    }

private:
    static constexpr std::uint8_t allEnded = 15, outside = 255;
    static constexpr int beamSide = 8;
    glm::ivec2 place(int tile, int quad) const {
        const glm::ivec2 corner(tile % tiles_.x, tile / tiles_.x);
        return corner * quadsPerSide + glm::ivec2(quad % quadsPerSide, quad / quadsPerSide);
    }
    /// Up to which sample none of a beam's rays can meet anything: those through a square of
    /// pixels, beamSide along its side.
    double beamStart(glm::ivec2 corner) const;
    RaySpan span(glm::ivec2 pixel, double from) const;
    float firstVisible(const VoxelRay& ray, double from, double to) const;
    bool endsWithin(const VoxelRay& ray, double from, double to) const;
    void leaveToFilling(int tile);

    const CameraRays& rays_;
    const RayMedium& medium_;
    Band band_;
    const Backdrop* backdrop_;
    double stepMm_;
    HybridControls controls_;
    std::span<RaySpan> spans_;
    glm::ivec2 tiles_;
    std::vector<QuadState> quadState_;  // tile by tile
    std::vector<std::uint8_t> ended_;   // a bit for each ray of a quad
    std::vector<std::uint16_t> slabsCast_;
    std::vector<int> live_, whole_;  // quads of each tile: going on; in the picture
};

}  // namespace haustra::render
