#include "render/optics/classification.h"

#include "shaders/uniforms.h"

#include <algorithm>
#include <utility>

namespace haustra::render {

Result<Classification> Classification::create(const Optics& optics, double stepMm, bool leaping,
                                              const BlockRanges& ranges, int threads) {
    using gpu::Filter, gpu::Texture, gpu::TexelFormat;
    TransferTable table = makeTransferTable(optics, stepMm);
    const auto tableOf = [](const std::vector<glm::vec4>& texels, int rows) {
        Result<Texture> made =
            Texture::create(rows > 1 ? 2 : 1, {TransferTable::entries, rows, 1},
                            TexelFormat::rgba32f, Filter::linear, "transfer function");
        if (made) made->upload(texels.data());
        return made;
    };
    auto tableTexture = TRY(tableOf(table.rgba, table.rows));
    std::optional<Texture> integralTexture;
    if (!table.integrals.empty()) {
        auto made = TRY(tableOf(table.integrals, 1));
        integralTexture = std::move(made);
    }
    auto leapTexture =
        TRY(Texture::create(3, ranges.size, TexelFormat::r8ui, Filter::nearest, "leap map"));
    const std::vector<std::uint8_t> distances =
        leaping ? leapDistances(ranges, table, threads)
                : std::vector<std::uint8_t>(ranges.lowHu.size(), 0);
    leapTexture.uploadSlices(0, ranges.size.z, distances.data());
    return Classification(optics, stepMm, leaping, std::move(table), std::move(tableTexture),
                          std::move(integralTexture), std::move(leapTexture));
}

Classification::Classification(Optics optics, double stepMm, bool leaping, TransferTable table,
                               gpu::Texture tableTexture,
                               std::optional<gpu::Texture> integralTexture,
                               gpu::Texture leapTexture)
    : optics_(std::move(optics)),
      stepMm_(stepMm),
      leaping_(leaping),
      table_(std::move(table)),
      tableTexture_(std::move(tableTexture)),
      integralTexture_(std::move(integralTexture)),
      leapTexture_(std::move(leapTexture)) {}

bool Classification::isFor(const Optics& optics, double stepMm, bool leaping) const {
    return stepMm == stepMm_ && leaping == leaping_ && optics == optics_;
}

void Classification::bind() const {
    tableTexture_.bind(shaders::tableUnit);
    leapTexture_.bind(shaders::leapUnit);
    if (integralTexture_) integralTexture_->bind(shaders::integralUnit);
}

std::size_t Classification::gpuBytes() const {
    return tableTexture_.bytes() + leapTexture_.bytes() +
           (integralTexture_ ? integralTexture_->bytes() : 0);
}

}  // namespace haustra::render
