#include "pipeline/prepare.h"

#include "organs/organ_profile.h"
#include "pipeline/preparation.h"
#include "pipeline/stages.h"

#include <algorithm>
#include <new>
#include <system_error>

namespace haustra::pipeline {
namespace {

namespace product = store::product;

// Beyond these a surface is no surface of the organ, or simplification has nothing to take.
constexpr double leastSurfaceErrorMm = 0.001, greatestSurfaceErrorMm = 10.0;

Result<void> checkOptions(const PrepareOptions& options) {
    const auto& names = stageNames();
    if (!options.until.empty() &&
        std::find(names.begin(), names.end(), options.until) == names.end()) {
        return fail(ErrorKind::badInput, "there is no stage " + options.until);
    }
    if (options.series.empty() && options.lumenMask.empty()) {
        return fail(ErrorKind::badInput, "there is neither a series nor a mask to prepare");
    }
    if (options.series.empty() && options.until == "import") {
        return fail(ErrorKind::badInput, "a mask has no import: there is nothing to make");
    }
    if (!options.lumenMask.empty() && !(options.seedsMm.empty() && options.excludesMm.empty() &&
                                        options.cuts.empty() && options.joins.empty())) {
        return fail(ErrorKind::badInput,
                    "points to seed or to exclude are of no use where a mask is the lumen");
    }
    if (!(options.surfaceErrorMm >= leastSurfaceErrorMm &&
          options.surfaceErrorMm <= greatestSurfaceErrorMm)) {
        return fail(ErrorKind::badInput, "the surface's error must be 0.001 to 10 mm");
    }
    if (!(options.areaWeight >= 0.0 && options.areaWeight <= 1.0))
        return fail(ErrorKind::badInput, "the weight of areas must be between 0 and 1");
    for (const std::filesystem::path& source : {options.series, options.lumenMask}) {
        std::error_code ignored;
        if (!source.empty() && !std::filesystem::exists(source, ignored)) {
            return fail(ErrorKind::notFound, "there is no such file or folder", source.string());
        }
    }
    if (std::error_code ignored; std::filesystem::is_directory(options.lumenMask, ignored)) {
        return fail(ErrorKind::badInput, "this is a folder, not a mask's NIfTI file",
                    options.lumenMask.string());
    }
    return {};
}

Result<PrepareReport> runStages(Preparation& preparation) {
    const PrepareOptions& options = preparation.options();
    std::optional<ProductKey> ct;
    if (!options.series.empty()) {
        ct = TRY(importScan(preparation));
    } else {
        ct = preparation.keyOf(product::ct);
    }
    if (!preparation.wanted("segmentation")) return preparation.takeReport();
    const auto segmentation =
        TRY(options.lumenMask.empty() ? segmentScan(preparation, *ct) : takeMask(preparation, ct));

    WallSource wall{product::segmentation, segmentation, ct ? product::ct : "",
                    ct.value_or(ProductKey{})};
    if (ct && preparation.organ().cleanse) {
        if (!preparation.wanted("mixture")) return preparation.takeReport();
        std::optional<cleansing::TaggedLumen> tagged;
        const auto mixture = TRY(mixTissues(preparation, *ct, segmentation, tagged));
        if (!preparation.wanted("cleansing")) return preparation.takeReport();
        const auto cleansed =
            TRY(cleanseScan(preparation, *ct, segmentation, mixture, std::move(tagged)));
        wall = {product::cleansedLumen, cleansed, product::cleansed, cleansed};
    }
    if (!preparation.wanted("denoising")) return preparation.takeReport();
    const auto lumen = TRY(denoiseLumen(preparation, wall));
    if (!preparation.wanted("distance")) return preparation.takeReport();
    std::future<Result<WallSurface>> begun;
    if (preparation.wanted("surface")) begun = beginSurface(preparation, wall, lumen);
    const auto distance = TRY(measureDistance(preparation, lumen));
    if (!preparation.wanted("centerline")) return preparation.takeReport();
    const auto centerline = TRY(traceCenterline(preparation, lumen, distance));
    TRY(preparation.noteBridges());
    if (!preparation.wanted("surface")) return preparation.takeReport();
    const auto surface = TRY(makeSurface(preparation, wall, lumen, std::move(begun)));
    TRY(preparation.noteBridgedWall());
    if (!preparation.wanted("flattening")) return preparation.takeReport();
    if (!preparation.organ().flatten) {
        preparation.note("flattening: left out, as the organ's profile does not ask for it");
        return preparation.takeReport();
    }
    const auto flatMap = flattenSurface(preparation, surface, centerline);
    // A colon that cannot be flattened is searched for polyps all the same: from the map detection
    // has which way the strip runs, and where a place is along the colon.
    if (!flatMap && flatMap.error().kind != ErrorKind::noResult)
        return tl::make_unexpected(flatMap.error());
    if (preparation.wanted("cad")) {
        if (preparation.organ().detectPolyps && ct)
            TRY(detectPolyps(preparation, surface, centerline,
                             flatMap ? std::optional(*flatMap) : std::nullopt));
        else
            preparation.note(ct ? "cad: left out, as the organ's profile does not ask for it"
                                : "cad: left out, as there is no scan");
    }
    if (!flatMap) return tl::make_unexpected(flatMap.error());
    return preparation.takeReport();
}

// The study of the scans that a case has beside `scan`; empty where no UID tells it.
Result<std::string> studyOfOtherScans(const store::CaseStore& store, const std::string& caseName,
                                      const std::string& scan) {
    const auto names = TRY(store.cases());
    for (const std::string& name : names) {
        if (name == scan || (name != caseName && !name.starts_with(caseName + "."))) continue;
        const auto other = TRY(
            store.openCase(name).and_then([](const store::Case& opened) { return opened.scan(); }));
        if (other && !other->studyUid.empty()) return other->studyUid;
    }
    return std::string();
}

// A case that was refused before its first product leaves no folder behind.
void removeIfEmpty(const std::filesystem::path& folder) {
    std::error_code ignored;
    std::filesystem::directory_iterator at(folder, ignored), end;
    for (; !ignored && at != end; at.increment(ignored)) {
        if (at->path().filename() != ".lock") return;
    }
    if (ignored) return;
    std::filesystem::remove(folder / ".lock", ignored);
    std::filesystem::remove(folder, ignored);
}

}  // namespace

const std::vector<std::string>& stageNames() {
    static const std::vector<std::string> names = store::catalogue().stages();
    return names;
}

Result<PrepareReport> prepare(const store::CaseStore& store, const std::string& caseName,
                              const PrepareOptions& options) {
    TRY(checkOptions(options));
    TRY(checkCadModel(options));
    auto organ = TRY(organs::readProfile(options.organ));
    const std::string name = options.scan.empty() ? caseName : caseName + "." + options.scan;
    std::string study;
    if (!options.scan.empty()) study = TRY(studyOfOtherScans(store, caseName, name));
    auto target = TRY(store.createCase(name));
    const store::Case held = target;  // keeps the lock until the folder is tidied
    try {
        Preparation preparation(std::move(target), options, std::move(organ), std::move(study));
        auto report = runStages(preparation);
        if (!report) removeIfEmpty(held.folder());
        return report;
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::io, "there is not enough memory", "prepare");
    }
}

}  // namespace haustra::pipeline
