#include "store/case_trust.h"

#include "core/scan_coarseness.h"
#include "store/notes.h"
#include "store/products.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::store {
namespace {

std::vector<std::string> warningsIn(const Attributes& attributes) {
    constexpr std::string_view mark = "warning: ";
    std::vector<std::string> warnings;
    for (const std::string& note : notesOf(attributes)) {
        if (note.starts_with(mark)) warnings.push_back(note.substr(mark.size()));
    }
    return warnings;
}

Result<std::vector<std::string>> scanWarnings(const Case& source) {
    if (!source.find(product::ct)) return std::vector<std::string>{};
    const Grid grid = TRY(source.readVolume<std::int16_t>(product::ct)).grid();
    std::vector<std::string> warnings;
    std::optional<SourceSeries> series;
    if (source.find(product::source)) {
        auto read = source.readText(product::source).and_then([](const std::string& text) {
            return sourceSeriesOfJson(text);
        });
        if (read)
            series = *std::move(read);
        else  // nobody is kept from the case by it
            warnings.push_back(
                "the record of the scan's series is damaged, so that nobody knows how "
                "thick its slices are");
    }
    if (auto coarse = coarsenessOf(grid, series ? &*series : nullptr))
        warnings.push_back(*std::move(coarse));
    return warnings;
}

}  // namespace

Result<ColonTrust> readTrust(const Case& source) {
    const auto quality = TRY(source.readText(product::quality));
    auto trust = trustOfQuality(quality);
    if (!trust) return trust;
    std::vector<std::string> first = TRY(scanWarnings(source));
    if (source.find(product::centerline)) {
        const auto pieces = TRY(piecesOfQuality(quality));
        const auto path = TRY(source.readCenterline());
        for (std::string& warning : piecesPassedBy(path, pieces))
            first.push_back(std::move(warning));
    }
    for (const std::string product : {product::cleansedLumen, product::flatMap}) {
        if (!source.find(product)) continue;
        for (std::string& warning : warningsIn(TRY(source.attributes(product))))
            first.push_back(std::move(warning));
    }
    trust->warnings.insert(trust->warnings.begin(), first.begin(), first.end());
    return trust;
}

}  // namespace haustra::store
