// A volume as one transfer function shows it, on the GPU.
#pragma once

#include "gpu/texture.h"
#include "render/optics/leap_map.h"
#include "render/optics/transfer_table.h"

#include <optional>

namespace haustra::render {

/// The transfer function's table for one step length, and the leap map that follows from it.
/// Belongs to the thread of the context.
class Classification {
public:
    /// Where `leaping` is false the map lets no ray leap. Cost: leapDistances and an upload.
    static Result<Classification> create(const Optics& optics, double stepMm, bool leaping,
                                         const BlockRanges& ranges, int threads);

    bool isFor(const Optics& optics, double stepMm, bool leaping) const;
    void bind() const;  ///< to the units of shaders/uniforms.h

    const TransferTable& table() const { return table_; }
    std::size_t gpuBytes() const;

private:
    Classification(Optics optics, double stepMm, bool leaping, TransferTable table,
                   gpu::Texture tableTexture, std::optional<gpu::Texture> integralTexture,
                   gpu::Texture leapTexture);
    Optics optics_;
    double stepMm_;
    bool leaping_;
    TransferTable table_;
    gpu::Texture tableTexture_;
    std::optional<gpu::Texture> integralTexture_;  // of pre-integrated optics
    gpu::Texture leapTexture_;
};

}  // namespace haustra::render
