#include "store/case_trust.h"

#include "store/notes.h"
#include "store/products.h"

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

}  // namespace

Result<ColonTrust> readTrust(const Case& source) {
    const auto quality = TRY(source.readText(product::quality));
    auto trust = trustOfQuality(quality);
    if (!trust) return trust;
    std::vector<std::string> first;
    if (source.find(product::centerline)) {
        const auto pieces = TRY(piecesOfQuality(quality));
        const auto path = TRY(source.readCenterline());
        first = piecesPassedBy(path, pieces);
    }
    if (source.find(product::flatMap)) {
        for (std::string& warning : warningsIn(TRY(source.attributes(product::flatMap))))
            first.push_back(std::move(warning));
    }
    trust->warnings.insert(trust->warnings.begin(), first.begin(), first.end());
    return trust;
}

}  // namespace haustra::store
