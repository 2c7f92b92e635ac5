// Mixture and cleansing: they start from the same, and what the one measures the other needs.
#include "cleansing/digital_cleansing.h"
#include "cleansing/mixture.h"
#include "cleansing/untagged_fluid.h"
#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"
#include "segmentation/told_places.h"

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using store::Attributes;

// Raise them whenever the products change for the same input.
constexpr int mixtureVersion = 16, cleansingVersion = 15;

// What both start from, mapped.
struct SegmentedScan {
    CtScan scan;
    Volume<std::uint8_t> labels;
    TissueModel tissue;
    glm::dvec3 gravity{0.0};
};

Result<SegmentedScan> readSegmentedScan(StageCase& stage) {
    auto scan = TRY(stage.readScan());
    auto labels = TRY(stage.readVolume<std::uint8_t>(product::segmentation));
    const auto attributes = TRY(stage.attributes(product::segmentation));
    const auto tissue = TRY(tissueModelOf(attributes));
    return SegmentedScan{std::move(scan), std::move(labels), tissue, gravityOf(attributes)};
}

std::vector<std::string> notesOn(const std::vector<cleansing::LostLumen>& lost) {
    if (lost.empty()) return {};
    double ml = 0.0;
    segmentation::ToldPlaces places;
    for (const cleansing::LostLumen& body : lost)
        ml += body.ml, places.add(body.placeMm);
    return {printed("warning: %.0f ml of what was taken for tagged residue look like tissue once "
                    "cleansed, and are no part of the lumen, at ",
                    ml) +
            places.text()};
}

}  // namespace

Result<ProductKey> mixTissues(Preparation& preparation, const ProductKey& ct,
                              const ProductKey& segmentation,
                              std::optional<cleansing::TaggedLumen>& lumen) {
    const StageMeter meter;
    const ProductKey key = store::makeKey("mixture", mixtureVersion, "", {ct, segmentation});
    StageCase stage = preparation.open("mixture", key);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const int threads = preparation.options().threads;
        cleansing::PartialVolumeModel model;
        std::optional<cleansing::LumenPart> part;
        {
            const auto input = TRY(readSegmentedScan(stage));
            model = cleansing::fitPartialVolume(input.scan, input.tissue, threads);
            auto cropped = TRY(cleansing::cropToLumen(input.scan, input.labels, threads));
            part = std::move(cropped);
        }
        progress(0.1);
        // Mapped anew: until the mixture is written none of the whole scan is in memory.
        const auto input = TRY(readSegmentedScan(stage));
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
        return stage.publish(product::mixture, mixture, {}, threads);
    });
}

Result<ProductKey> cleanseScan(Preparation& preparation, const ProductKey& ct,
                               const ProductKey& segmentation, const ProductKey& mixture,
                               std::optional<cleansing::TaggedLumen> lumen) {
    const StageMeter meter;
    const ProductKey key =
        store::makeKey("cleansing", cleansingVersion, "", {ct, segmentation, mixture});
    StageCase stage = preparation.open("cleansing", key);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const int threads = preparation.options().threads;
        if (!lumen) {
            const auto input = TRY(readSegmentedScan(stage));
            auto part = TRY(cleansing::cropToLumen(input.scan, input.labels, threads));
            if (part)
                lumen = cleansing::measureTaggedLumen(std::move(*part), input.tissue, threads);
        }
        progress(0.3);
        const auto input = TRY(readSegmentedScan(stage));
        const Attributes wall{{"air-below-hu", exactText(input.tissue.airBelowHu)}};
        const auto publish = [&](const auto& labels, const auto& hu,
                                 const std::vector<cleansing::LostLumen>& lost) {
            Attributes ofLumen = wall;
            setNotes(ofLumen, notesOn(lost));
            return stage.publish(product::cleansedLumen, labels, ofLumen).and_then([&] {
                return stage.publish(product::cleansed, hu, wall);
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
            return publish(input.labels, hu, {});
        }
        const auto cleansed =
            TRY(stage.readVolume<TissueFractions>(product::mixture)
                    .map([&](const Volume<TissueFractions>& fractions) {
                        return cleansing::cleanse(input.scan, input.tissue, fractions,
                                                  std::move(*lumen), threads);
                    }));
        progress(0.8);
        return publish(cleansed.lumen, cleansed.hu, cleansed.lost);
    });
}

}  // namespace haustra::pipeline
