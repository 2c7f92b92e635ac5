// A case's centerlines: from memory to product files and back.
#include "store/case_store.h"
#include "store/product_file.h"

#include <cstring>
#include <span>

namespace haustra::store {
namespace {

struct CenterlineSample {
    double x, y, z, arc, radius, gap;
};
static_assert(sizeof(CenterlineSample) == centerlineSampleBytes);

}  // namespace

Result<Centerline> Case::readCenterline(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::centerline, product));
    Centerline centerline;
    centerline.points.reserve(mapped.values.size() / sizeof(CenterlineSample));
    for (std::size_t at = 0; at < mapped.values.size(); at += sizeof(CenterlineSample)) {
        CenterlineSample s;
        std::memcpy(&s, mapped.values.data() + at, sizeof s);
        centerline.points.push_back({{s.x, s.y, s.z}, s.arc, s.radius, s.gap != 0.0});
    }
    TRY(checkWhole(mapped));
    return centerline;
}

Result<void> Case::publishCenterline(std::string_view product, const ProductKey& key,
                                     const Centerline& centerline, const Attributes& attributes,
                                     const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    std::vector<CenterlineSample> samples;
    samples.reserve(centerline.points.size());
    for (const CenterlinePoint& p : centerline.points) {
        samples.push_back({p.positionMm.x, p.positionMm.y, p.positionMm.z, p.arcMm, p.radiusMm,
                           p.gap ? 1.0 : 0.0});
    }
    ProductHeader header{Content::centerline, {}, digestFromHex(key.hex), {}, attributes};
    const ProductEntry entry{std::string(product), key,
                             productFileName(product, key.hex, Content::centerline)};
    header.grid.size =
        TRY(elementNumbers(Content::centerline, {samples.size(), 1, 1}, folder_ / entry.file));
    return writeProduct(folder_, entry.file, header, {std::as_bytes(std::span(samples))})
        .and_then([&] { return announce(entry, outdated); });
}

}  // namespace haustra::store
