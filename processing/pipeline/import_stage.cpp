#include "core/scan_coarseness.h"
#include "pipeline/product_attributes.h"
#include "pipeline/read_inputs.h"
#include "pipeline/scan_identity.h"
#include "pipeline/source_key.h"
#include "pipeline/stages.h"

namespace haustra::pipeline {
namespace {

using store::Attributes;

// Raise one whenever the scan changes for the same files. A case that lacks a product which the
// import has come to make gets it as the series is read again, and keeps all else that it has.
constexpr int dicomVersion = 3, niftiVersion = 3;

}  // namespace

Result<ProductKey> importScan(Preparation& preparation) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const auto source = TRY(sourceKey(options.series, options.threads));
    const bool isNifti = isNiftiFile(options.series);
    const ProductKey key = store::makeKey("import", isNifti ? niftiVersion : dicomVersion,
                                          options.seriesUid, {source});
    TRY(identifyScan(options.series, options.seriesUid, source, options.threads)
            .and_then(
                [&](const store::ScanIdentity& scan) { return preparation.bind(scan, key); }));
    std::vector<std::string> without;
    if (isNifti) without = {store::product::source};
    StageCase stage = preparation.open("import", key, without);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const auto input =
            TRY(readScan(options.series, options.seriesUid, options.threads, progress));
        Attributes attributes{{"position", toString(input.scan.position)},
                              {"images", std::to_string(input.images)}};
        auto notes = input.notes;
        if (preparation.organ().detectPolyps) {
            if (const auto coarse =
                    coarsenessOf(input.scan.hu.grid(), input.source ? &*input.source : nullptr))
                notes.push_back("warning: " + *coarse);
        }
        setNotes(attributes, notes);
        TRY(stage.publish(store::product::ct, input.scan.hu, attributes));
        if (!input.source) return {};
        return stage.publish(store::product::source, sourceSeriesJson(*input.source));
    });
}

}  // namespace haustra::pipeline
