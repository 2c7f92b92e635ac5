#include "render/classification.h"

#include "shaders/uniforms.h"

#include <algorithm>
#include <utility>

namespace haustra::render {

Result<Classification> Classification::create(const Optics& optics, double stepMm, bool leaping,
                                              const BlockRanges& ranges, int threads) {
    using gpu::Filter, gpu::Texture, gpu::TexelFormat;
    TransferTable table = makeTransferTable(optics.transferFunction, stepMm);
    Result<Texture> tableTexture =
        Texture::create(1, {TransferTable::entries, 1, 1}, TexelFormat::rgba32f, Filter::linear,
                        "transfer function");
    if (!tableTexture) return tl::make_unexpected(tableTexture.error());
    tableTexture->upload(table.rgba.data());
    Result<Texture> leapTexture =
        Texture::create(3, ranges.size, TexelFormat::r8ui, Filter::nearest, "leap map");
    if (!leapTexture) return tl::make_unexpected(leapTexture.error());
    const std::vector<std::uint8_t> distances =
        leaping ? leapDistances(ranges, table, threads)
                : std::vector<std::uint8_t>(ranges.lowHu.size(), 0);
    leapTexture->uploadSlices(0, ranges.size.z, distances.data());
    return Classification(optics, stepMm, leaping, std::move(table), std::move(*tableTexture),
                          std::move(*leapTexture));
}

Classification::Classification(Optics optics, double stepMm, bool leaping, TransferTable table,
                               gpu::Texture tableTexture, gpu::Texture leapTexture)
    : optics_(std::move(optics)),
      stepMm_(stepMm),
      leaping_(leaping),
      table_(std::move(table)),
      tableTexture_(std::move(tableTexture)),
      leapTexture_(std::move(leapTexture)) {}

bool Classification::isFor(const Optics& optics, double stepMm, bool leaping) const {
    return stepMm == stepMm_ && leaping == leaping_ && optics == optics_;
}

void Classification::bind() const {
    tableTexture_.bind(shaders::tableUnit);
    leapTexture_.bind(shaders::leapUnit);
}

}  // namespace haustra::render
