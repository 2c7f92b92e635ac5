#include "pipeline/product_attributes.h"
#include "pipeline/read_inputs.h"
#include "pipeline/scan_identity.h"
#include "pipeline/source_key.h"
#include "pipeline/stages.h"

namespace haustra::pipeline {
namespace {

using store::Attributes;

// Raise it whenever the scan changes for the same files.
constexpr int importVersion = 1;

}  // namespace

Result<ProductKey> importScan(Preparation& preparation) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const auto source = TRY(sourceKey(options.series, options.threads));
    const ProductKey key = store::makeKey("import", importVersion, options.seriesUid, {source});
    TRY(identifyScan(options.series, options.seriesUid, source, options.threads)
            .and_then(
                [&](const store::ScanIdentity& scan) { return preparation.bind(scan, key); }));
    StageCase stage = preparation.open("import", key);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const auto input =
            TRY(readScan(options.series, options.seriesUid, options.threads, progress));
        Attributes attributes{{"position", toString(input.scan.position)},
                              {"images", std::to_string(input.images)}};
        setNotes(attributes, input.notes);
        return stage.publish(store::product::ct, input.scan.hu, attributes);
    });
}

}  // namespace haustra::pipeline
