#include "cleansing/tissue_mixture.h"
#include "contouring/wall_field.h"
#include "pipeline/product_attributes.h"
#include "pipeline/read_inputs.h"
#include "pipeline/source_key.h"
#include "pipeline/stages.h"
#include "segmentation/find_colon.h"
#include "segmentation/hu_range_lumen.h"

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using organs::LumenFinder;
using store::Attributes;

// Raise them whenever the products change for the same input and options.
constexpr int segmentationVersion = 27, maskVersion = 19;

// How a mask without a scan is drawn.
const TissueModel drawnTissue{
    {-1000.0, -100.0, 40.0, 600.0}, {20.0, 20.0, 20.0, 100.0}, {0.1, 0.2, 0.6, 0.1}, -480.0, 320.0};

// Only of a colon it is known how sure it is.
std::vector<std::string> withoutOf(const Preparation& preparation) {
    if (preparation.organ().finder == LumenFinder::gasAndTagged) return {};
    return {product::quality};
}

Result<void> findGasAndTagged(Preparation& preparation, StageCase& stage, const CtScan& scan,
                              const ColonEdits& edits, const Progress& progress) {
    const PrepareOptions& options = preparation.options();
    const auto tissue =
        TRY(cleansing::fitTissueModel(scan, options.threads, preparation.organ().tissues));
    segmentation::ColonOptions finding;
    finding.edits = edits, finding.threads = options.threads, finding.progress = progress;
    const auto colon = TRY(segmentation::findColon(scan, tissue, finding));
    Attributes attributes{{"source", "scan"}, {"gravity", exactText(colon.gravity)}};
    setTissueModel(attributes, tissue);
    std::vector<std::string> notes = colon.notes;
    notes.insert(notes.end(), colon.record.warnings.begin(), colon.record.warnings.end());
    setNotes(attributes, notes);
    TRY(stage.publish(product::segmentation, colon.labels, attributes));
    return stage.publish(product::quality, qualityJson(colon.record));
}

Result<void> findHuRange(Preparation& preparation, StageCase& stage, const CtScan& scan,
                         const Progress& progress) {
    const PrepareOptions& options = preparation.options();
    const organs::OrganProfile& organ = preparation.organ();
    const Volume<std::int16_t> hu =
        organ.smoothingMm > 0.0
            ? segmentation::smoothHu(scan.hu, organ.smoothingMm, options.threads)
            : scan.hu.share();
    auto lumen =
        TRY(segmentation::findHuRangeLumen(hu, {organ.contentHu, organ.openingMm, options.seedsMm,
                                                options.excludesMm, options.threads, progress}));
    // Where the wall is sharp, the HU on its two sides are themselves close to it.
    const auto wall = TRY(contouring::contentField(scan.hu, lumen.labels, options.threads));
    segmentation::growToWall(lumen.labels, hu, wall.negated ? -wall.isoHu : wall.isoHu,
                             wall.negated, options.threads);
    Attributes attributes{{"source", "scan"}, {"segments", std::to_string(lumen.bodies)}};
    setNotes(attributes, lumen.notes);
    return stage.publish(product::segmentation, lumen.labels, attributes);
}

}  // namespace

Result<ProductKey> segmentScan(Preparation& preparation, const ProductKey& ct) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const bool colon = preparation.organ().finder == LumenFinder::gasAndTagged;
    if (!colon && !(options.cuts.empty() && options.joins.empty())) {
        return fail(ErrorKind::badInput,
                    "only a colon can be cut or joined; this organ is not one");
    }
    ColonEdits edits{options.seedsMm, options.excludesMm, {}, {}};
    if (colon) {
        auto taken = TRY(preparation.takeEdits());
        edits = std::move(taken);
    }
    const ProductKey key =
        store::makeKey("segmentation", segmentationVersion,
                       organs::segmentationOptions(preparation.organ()) + editsJson(edits), {ct});
    StageCase stage = preparation.open("segmentation", key, withoutOf(preparation));
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const auto scan = TRY(stage.readScan());
        return colon ? findGasAndTagged(preparation, stage, scan, edits, progress)
                     : findHuRange(preparation, stage, scan, progress);
    });
}

Result<ProductKey> takeMask(Preparation& preparation, const std::optional<ProductKey>& ct) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const auto mask = TRY(sourceKey(options.lumenMask, options.threads));
    std::vector<ProductKey> inputs{mask};
    if (ct) {
        inputs.push_back(*ct);
    } else
        TRY(preparation.bind({mask, {}, {}}));
    // Of the organ, only how its tissues are told apart matters here.
    const bool colon = preparation.organ().finder == LumenFinder::gasAndTagged,
               fitted = ct && colon;
    const ProductKey key =
        store::makeKey("segmentation-mask", maskVersion,
                       fitted ? organs::segmentationOptions(preparation.organ()) : "", inputs);
    StageCase stage = preparation.open("segmentation", key, withoutOf(preparation));
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        CtScan scan;
        if (ct) {
            auto read = TRY(stage.readScan());
            scan = std::move(read);
        }
        const Grid grid = scan.hu.grid();
        const auto input =
            TRY(readLumenMask(options.lumenMask, ct ? &grid : nullptr, options.threads));
        Attributes attributes{{"source", "mask"}};
        TissueModel tissue = drawnTissue;
        if (fitted) {
            const auto fit =
                TRY(cleansing::fitTissueModel(scan, options.threads, preparation.organ().tissues));
            tissue = fit;
            attributes["gravity"] = exactText(gravityDirection(scan.position));
            setTissueModel(attributes, tissue);
        }
        std::vector<std::string> notes = input.notes;
        if (!colon) {
            setNotes(attributes, notes);
            return stage.publish(product::segmentation, input.labels, attributes);
        }
        segmentation::ColonOptions finding;
        finding.threads = options.threads, finding.progress = progress;
        const auto found =
            segmentation::findColonInMask(input.labels, ct ? &scan : nullptr, tissue, finding);
        ColonRecord record;
        if (found) {
            record = found->record;
            notes.insert(notes.end(), found->notes.begin(), found->notes.end());
            if (fitted) attributes["gravity"] = exactText(found->gravity);
        } else if (found.error().kind == ErrorKind::noResult) {
            record.confidence = 0.0;
            record.warnings.push_back(
                "no course of a colon was found in the mask; it is taken as it is");
        } else {
            return tl::make_unexpected(found.error());
        }
        notes.insert(notes.end(), record.warnings.begin(), record.warnings.end());
        setNotes(attributes, notes);
        TRY(stage.publish(product::segmentation, found ? found->labels : input.labels, attributes));
        return stage.publish(product::quality, qualityJson(record));
    });
}

}  // namespace haustra::pipeline
