#include "centerline/path.h"
#include "core/colon_record.h"
#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using store::Attributes;

// Raise it whenever the paths change for the same input and options.
constexpr int centerlineVersion = 6;

// The `branches` product: one after the other, each from an arc of 0 on.
Centerline joined(const std::vector<Centerline>& branches) {
    Centerline all;
    for (const Centerline& branch : branches)
        all.points.insert(all.points.end(), branch.points.begin(), branch.points.end());
    return all;
}

}  // namespace

Result<ProductKey> traceCenterline(Preparation& preparation, const ProductKey& lumen,
                                   const ProductKey& distance) {
    const StageMeter meter;
    const organs::OrganProfile& organ = preparation.organ();
    const ProductKey key =
        store::makeKey("centerline", centerlineVersion,
                       std::string("end-points=") + organs::toString(organ.endPoints) +
                           (organ.branches ? ";branches" : ""),
                       {lumen, distance});
    StageCase stage = preparation.open(
        "centerline", key,
        organ.branches ? store::Catalogue::Names{} : store::Catalogue::Names{product::branches});
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const auto labels = TRY(stage.readVolume<std::uint8_t>(product::lumen));
        const auto distanceMm = TRY(stage.readVolume<float>(product::distance));
        centerline::CenterlineOptions tracing;
        tracing.threads = preparation.options().threads;
        tracing.progress = progress;
        tracing.ends = organ.endPoints == organs::EndPoints::farthest
                           ? centerline::EndRule::farthest
                           : centerline::EndRule::rectumToCecum;
        tracing.branches = organ.branches;
        const auto traced = TRY(centerline::traceCenterline(labels, distanceMm, tracing));
        Attributes attributes{{"length-mm", exactText(traced.centerline.lengthMm())}};
        std::vector<std::string> notes = traced.notes;
        if (TRY(stage.holds(product::quality))) {
            const auto pieces = TRY(stage.readText(product::quality).and_then(piecesOfQuality));
            const auto missed = piecesPassedBy(traced.centerline, pieces);
            notes.insert(notes.end(), missed.begin(), missed.end());
        }
        setNotes(attributes, notes);
        TRY(stage.publish(product::centerline, traced.centerline, attributes));
        if (!organ.branches) return {};
        return stage.publish(product::branches, joined(traced.branches),
                             {{"branches", std::to_string(traced.branches.size())}});
    });
}

}  // namespace haustra::pipeline
