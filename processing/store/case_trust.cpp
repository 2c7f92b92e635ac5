#include "store/case_trust.h"

#include "store/products.h"

namespace haustra::store {

Result<ColonTrust> readTrust(const Case& source) {
    const auto quality = TRY(source.readText(product::quality));
    auto trust = trustOfQuality(quality);
    if (!trust || !source.find(product::centerline)) return trust;
    const auto pieces = TRY(piecesOfQuality(quality));
    const auto path = TRY(source.readCenterline());
    const std::vector<std::string> missed = piecesPassedBy(path, pieces);
    trust->warnings.insert(trust->warnings.begin(), missed.begin(), missed.end());
    return trust;
}

}  // namespace haustra::store
