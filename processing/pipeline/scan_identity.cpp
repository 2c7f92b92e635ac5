#include "pipeline/scan_identity.h"

#include "dicom/import_series.h"
#include "pipeline/read_inputs.h"

namespace haustra::pipeline {
namespace {

constexpr int identityVersion = 1;  // another one parts all scans from their bookmarks
constexpr std::size_t studyDigits = 12, seriesDigits = 8, contentDigits = 20;

}  // namespace

Result<store::ScanIdentity> identifyScan(const std::filesystem::path& series,
                                         const std::string& seriesUid,
                                         const store::ProductKey& content, int threads) {
    if (isNiftiFile(series)) return store::ScanIdentity{content, {}, {}};
    return dicom::findSeries(series, {seriesUid, threads, {}})
        .map([](const dicom::SeriesSummary& found) {
            return store::ScanIdentity{
                store::makeKey("scan", identityVersion, found.studyUid + " " + found.seriesUid, {}),
                found.studyUid, found.seriesUid};
        });
}

bool sameScan(const store::ScanIdentity& a, const store::ScanIdentity& b) {
    return a.key == b.key ||
           (!a.seriesUid.empty() && a.seriesUid == b.seriesUid && a.studyUid == b.studyUid);
}

std::string studyCode(const std::string& studyUid) {
    if (studyUid.empty()) return {};
    return store::makeKey("study", identityVersion, studyUid, {}).hex.substr(0, studyDigits);
}

std::string defaultCaseName(const store::ScanIdentity& scan) {
    if (scan.studyUid.empty()) return "scan-" + scan.key.hex.substr(0, contentDigits);
    return studyCode(scan.studyUid) + "." + scan.key.hex.substr(0, seriesDigits);
}

}  // namespace haustra::pipeline
