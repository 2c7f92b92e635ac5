#include "cli/case_scans.h"

#include "store/products.h"

#include <fmt/format.h>

namespace haustra::cli {

Result<CaseScans> readCaseScans(const store::Case& source, bool cleansedIsAsked) {
    auto ct = TRY(source.readVolume<std::int16_t>(store::product::ct));
    CaseScans scans{std::move(ct), {}};
    if (!cleansedIsAsked && !source.find(store::product::cleansed)) {
        fmt::print(stderr,
                   "haustra: note: case {} has no cleansed scan; the picture shows the scan as it "
                   "is, with its residue\n",
                   source.name());
        return scans;
    }
    auto cleansed = TRY(source.readVolume<std::int16_t>(store::product::cleansed));
    scans.cleansed = std::move(cleansed);
    return scans;
}

}  // namespace haustra::cli
