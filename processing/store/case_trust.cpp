#include "store/case_trust.h"

namespace haustra::store {

Result<ColonTrust> readTrust(const Case& source) {
    const auto quality = source.readText("quality");
    if (!quality) return tl::make_unexpected(quality.error());
    auto trust = trustOfQuality(*quality);
    if (!trust || !source.find("centerline")) return trust;
    const auto pieces = piecesOfQuality(*quality);
    if (!pieces) return tl::make_unexpected(pieces.error());
    const auto path = source.readCenterline();
    if (!path) return tl::make_unexpected(path.error());
    const std::vector<std::string> missed = piecesPassedBy(*path, *pieces);
    trust->warnings.insert(trust->warnings.begin(), missed.begin(), missed.end());
    return trust;
}

}  // namespace haustra::store
