#include "pipeline/scan_stages.h"

#include "cleansing/digital_cleansing.h"
#include "cleansing/mixture.h"
#include "cleansing/tissue_mixture.h"
#include "cleansing/untagged_fluid.h"
#include "contouring/wall_field.h"
#include "pipeline/product_attributes.h"
#include "pipeline/read_inputs.h"
#include "pipeline/scan_identity.h"
#include "pipeline/source_key.h"
#include "segmentation/find_colon.h"
#include "segmentation/hu_range_lumen.h"

namespace haustra::pipeline {
namespace {

using organs::LumenFinder;
using store::Attributes;

// Raise a stage's version whenever its products change for the same input and options.
constexpr int importVersion = 1;
constexpr int segmentationVersion = 12;
constexpr int maskVersion = 8;
constexpr int mixtureVersion = 13;
constexpr int cleansingVersion = 12;

// How a mask without a scan is drawn.
const TissueModel drawnTissue{
    {-1000.0, -100.0, 40.0, 600.0}, {20.0, 20.0, 20.0, 100.0}, {0.1, 0.2, 0.6, 0.1}, -480.0, 320.0};

Result<void> publishSegmentation(Preparation& preparation, const ProductKey& key,
                                 const Volume<std::uint8_t>& labels, const Attributes& attributes) {
    return preparation.target().publishVolume(product::segmentation, key, labels, attributes,
                                              madeFrom(product::segmentation));
}

// What this call says of the colon, which the case keeps; or what an earlier one said.
Result<ColonEdits> takeEdits(Preparation& preparation) {
    const PrepareOptions& options = preparation.options();
    store::Case& target = preparation.target();
    ColonEdits edits{options.seedsMm, options.excludesMm, options.cuts, options.joins};
    if (edits.empty() && !options.forgetEdits) {
        if (!target.find(product::edits)) return edits;
        const auto text = TRY(target.readText(product::edits));
        auto kept = editsFromJson(text);
        if (kept && !kept->empty())
            preparation.note("segmentation: what an earlier call said of the colon stands (edits)");
        return kept;
    }
    if (edits.empty() && !target.find(product::edits)) return edits;
    const std::string text = editsJson(edits);
    const ProductKey key = store::makeKey("edits", 1, text, {});
    return target.publishText(product::edits, key, text).map([&] { return edits; });
}

Result<void> findGasAndTagged(Preparation& preparation, const CtScan& scan, const ProductKey& key,
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
    return publishSegmentation(preparation, key, colon.labels, attributes).and_then([&] {
        return preparation.target().publishText(product::quality, key, qualityJson(colon.record),
                                                {}, madeFrom(product::quality));
    });
}

Result<void> findHuRange(Preparation& preparation, const CtScan& scan, const ProductKey& key,
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
    return publishSegmentation(preparation, key, lumen.labels, attributes);
}

// What mixture and cleansing start from, mapped.
struct SegmentedScan {
    CtScan scan;
    Volume<std::uint8_t> labels;
    TissueModel tissue;
    glm::dvec3 gravity{0.0};
};

Result<SegmentedScan> readSegmentedScan(Preparation& preparation) {
    auto scan = TRY(preparation.readScan());
    auto labels = TRY(preparation.target().readVolume<std::uint8_t>(product::segmentation));
    const auto attributes = TRY(preparation.target().attributes(product::segmentation));
    const auto tissue = TRY(tissueModelOf(attributes));
    return SegmentedScan{std::move(scan), std::move(labels), tissue, gravityOf(attributes)};
}

}  // namespace

Result<ProductKey> importScan(Preparation& preparation) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const auto source = TRY(sourceKey(options.series, options.threads));
    const ProductKey key = store::makeKey("import", importVersion, options.seriesUid, {source});
    TRY(identifyScan(options.series, options.seriesUid, source, options.threads)
            .and_then(
                [&](const store::ScanIdentity& scan) { return preparation.bind(scan, key); }));
    const auto make = [&](const Progress& progress) -> Result<void> {
        const auto input =
            TRY(readScan(options.series, options.seriesUid, options.threads, progress));
        Attributes attributes{{"position", toString(input.scan.position)},
                              {"images", std::to_string(input.images)}};
        setNotes(attributes, input.notes);
        return preparation.target().publishVolume(product::ct, key, input.scan.hu, attributes,
                                                  madeFrom(product::ct));
    };
    return preparation.run({"import", key, {product::ct}}, meter, make).map([&] { return key; });
}

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
        auto taken = TRY(takeEdits(preparation));
        edits = std::move(taken);
    }
    const ProductKey key =
        store::makeKey("segmentation", segmentationVersion,
                       organs::segmentationOptions(preparation.organ()) + editsJson(edits), {ct});
    const auto make = [&](const Progress& progress) -> Result<void> {
        const auto scan = TRY(preparation.readScan());
        return colon ? findGasAndTagged(preparation, scan, key, edits, progress)
                     : findHuRange(preparation, scan, key, progress);
    };
    std::vector<std::string> products{product::segmentation};
    if (colon) products.push_back(product::quality);
    return preparation.run({"segmentation", key, products}, meter, make).map([&] { return key; });
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
    const auto make = [&](const Progress& progress) -> Result<void> {
        CtScan scan;
        if (ct) {
            auto read = TRY(preparation.readScan());
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
            return publishSegmentation(preparation, key, input.labels, attributes);
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
        return publishSegmentation(preparation, key, found ? found->labels : input.labels,
                                   attributes)
            .and_then([&] {
                return preparation.target().publishText(product::quality, key, qualityJson(record),
                                                        {}, madeFrom(product::quality));
            });
    };
    std::vector<std::string> products{product::segmentation};
    if (colon) products.push_back(product::quality);
    return preparation.run({"segmentation", key, products}, meter, make).map([&] { return key; });
}

Result<ProductKey> mixTissues(Preparation& preparation, const ProductKey& ct,
                              const ProductKey& segmentation,
                              std::optional<cleansing::TaggedLumen>& lumen) {
    const StageMeter meter;
    const ProductKey key = store::makeKey("mixture", mixtureVersion, "", {ct, segmentation});
    const auto make = [&](const Progress& progress) -> Result<void> {
        const int threads = preparation.options().threads;
        cleansing::PartialVolumeModel model;
        std::optional<cleansing::LumenPart> part;
        {
            const auto input = TRY(readSegmentedScan(preparation));
            model = cleansing::fitPartialVolume(input.scan, input.tissue, threads);
            auto cropped = TRY(cleansing::cropToLumen(input.scan, input.labels, threads));
            part = std::move(cropped);
        }
        progress(0.1);
        // Mapped anew: until the mixture is written none of the whole scan is in memory.
        const auto input = TRY(readSegmentedScan(preparation));
        Volume<TissueFractions> byHu;
        if (part) {
            byHu = cleansing::fractionsByHu(part->scan.hu, model, threads);
            lumen = cleansing::measureTaggedLumen(std::move(*part), input.tissue, threads);
        }
        progress(0.4);
        const auto rest = [&](double fraction) { progress(0.4 + 0.5 * fraction); };
        const auto mixture =
            cleansing::estimateMixture(input.scan, model, std::move(byHu),
                                       lumen ? &*lumen : nullptr, input.gravity, {threads, rest});
        return preparation.target().publishVolume(product::mixture, key, mixture, {},
                                                  madeFrom(product::mixture), threads);
    };
    return preparation.run({"mixture", key, {product::mixture}}, meter, make).map([&] {
        return key;
    });
}

Result<ProductKey> cleanseScan(Preparation& preparation, const ProductKey& ct,
                               const ProductKey& segmentation, const ProductKey& mixture,
                               std::optional<cleansing::TaggedLumen> lumen) {
    const StageMeter meter;
    const ProductKey key =
        store::makeKey("cleansing", cleansingVersion, "", {ct, segmentation, mixture});
    const auto make = [&](const Progress& progress) -> Result<void> {
        store::Case& target = preparation.target();
        const int threads = preparation.options().threads;
        if (!lumen) {
            const auto input = TRY(readSegmentedScan(preparation));
            auto part = TRY(cleansing::cropToLumen(input.scan, input.labels, threads));
            if (part)
                lumen = cleansing::measureTaggedLumen(std::move(*part), input.tissue, threads);
        }
        progress(0.3);
        const auto input = TRY(readSegmentedScan(preparation));
        const Attributes wall{{"air-below-hu", exactText(input.tissue.airBelowHu)}};
        const auto publish = [&](const auto& labels, const auto& hu) {
            return target
                .publishVolume(product::cleansedLumen, key, labels, wall,
                               madeFrom(product::cleansedLumen))
                .and_then([&] {
                    return target.publishVolume(product::cleansed, key, hu, wall,
                                                madeFrom(product::cleansed));
                });
        };
        if (!lumen) {
            Volume<std::int16_t> hu = input.scan.hu.share();
            if (cleansing::hasUntagged(input.labels)) {
                hu = input.scan.hu.clone();
                Volume<std::uint8_t> labels = input.labels.clone();
                cleansing::takeOutUntagged(hu, labels, input.labels,
                                           input.tissue.meanHu[int(Tissue::air)], threads);
            }
            return publish(input.labels, hu);
        }
        const auto cleansed =
            TRY(target.readVolume<TissueFractions>(product::mixture)
                    .map([&](const Volume<TissueFractions>& fractions) {
                        return cleansing::cleanse(input.scan, input.tissue, fractions,
                                                  std::move(*lumen), threads);
                    }));
        progress(0.8);
        return publish(cleansed.lumen, cleansed.hu);
    };
    return preparation
        .run({"cleansing", key, {product::cleansedLumen, product::cleansed}}, meter, make)
        .map([&] { return key; });
}

}  // namespace haustra::pipeline
