// Owners of linked programs: compute, and raster.
#pragma once

#include "core/result.h"
#include "gpu/buffer.h"
#include "gpu/raster_target.h"
#include "gpu/texture.h"

#include <initializer_list>
#include <string_view>

#include <glm/glm.hpp>

namespace haustra::gpu {

/// Belongs to the thread of the context in which it was made, which must be current when it dies.
/// Move-only.
class ComputeProgram {
public:
    /// Compiles the pieces in order as one shader, after "#version 450 core". Fails with the
    /// compiler's log, whose line numbers count from each piece's beginning; `what` names the
    /// program there.
    static Result<ComputeProgram> create(const char* what,
                                         std::initializer_list<std::string_view> pieces);
    ~ComputeProgram();
    ComputeProgram(ComputeProgram&& other) noexcept;
    ComputeProgram& operator=(ComputeProgram&& other) noexcept;

    /// Runs groups that cover `threads`, then makes their image writes visible to later reads of
    /// any kind.
    void dispatch(glm::ivec2 threads) const;
    /// Runs at least `groups` groups, in rows of at most groupsInRow; the rest of the last row runs
    /// too, and has nothing to do.
    void dispatchGroups(int groups) const;
    static constexpr int groupsInRow = 32768;

private:
    ComputeProgram() = default;
    unsigned id_ = 0;
    glm::ivec2 groupSize_{1};
};

/// Draws triangles. A vertex is known by its index alone: the vertex shader
/// reads what it needs from storage blocks at gl_VertexID. Belongs to the thread of the context in
/// which it was made, which must be current when it dies. Move-only.
class RasterProgram {
public:
    /// Compiles and links the two shaders, each from its pieces, as ComputeProgram does.
    static Result<RasterProgram> create(const char* what,
                                        std::initializer_list<std::string_view> vertexPieces,
                                        std::initializer_list<std::string_view> fragmentPieces);
    ~RasterProgram();
    RasterProgram(RasterProgram&& other) noexcept;
    RasterProgram& operator=(RasterProgram&& other) noexcept;

    /// Fills `target`, a 2-D texture of format rg32i, with `background`, then draws the triangles
    /// [first, first + count) of `indices` (three 32-bit indices each) `copies` times, without
    /// depth and whichever way they wind; later ones cover earlier ones. What it draws is visible
    /// to later reads. gl_PrimitiveID counts from `first`.
    ///
    /// gl_Position is 0 at the corner of the target's first pixel, and grows by 1 in reachPixels,
    /// whatever the target's size: places in whole parts of a pixel stay exact on their way to the
    /// raster, and triangles that leave the target are not clipped before they are far from it.
    static constexpr int reachPixels = 4096;
    void draw(const Texture& target, glm::ivec2 background, const StorageBuffer& indices, int first,
              int count, int copies) const;

    /// Draws the triangles [first, first + count) of `indices` into `target` as it is, whichever
    /// way they wind; of those that cover a pixel the nearest stays, and what stood there before
    /// counts as one of them. What it draws is visible to later reads. gl_PrimitiveID counts from
    /// `first`.
    void drawNearest(const RasterTarget& target, const StorageBuffer& indices, int first,
                     int count) const;
    /// Runs the fragment shader for every pixel of `target` that each of the triangles covers,
    /// whatever stands before it, and leaves the target as it is: for shaders that count.
    void drawAll(const RasterTarget& target, const StorageBuffer& indices, int first,
                 int count) const;

private:
    RasterProgram() = default;
    void drawInto(const RasterTarget& target, const StorageBuffer& indices, int first,
                  int count) const;
    unsigned program_ = 0, vertexArray_ = 0, framebuffer_ = 0;
};

}  // namespace haustra::gpu
