#include "pipeline/lumen_stages.h"

#include "centerline/path.h"
#include "core/colon_record.h"
#include "pipeline/product_attributes.h"
#include "topology/digital_topology.h"
#include "topology/distance_field.h"
#include "topology/handle_cutting.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace haustra::pipeline {
namespace {

using organs::ExpectedTopology;
using store::Attributes;

// Raise a stage's version whenever its product changes for the same input and options.
constexpr int denoisingVersion = 2;
constexpr int distanceVersion = 1;
constexpr int centerlineVersion = 5;

// The distance transform goes axis by axis, which needs axes at right angles.
Result<void> checkOrthogonal(const Grid& grid) {
    const glm::dmat3 axes(grid.patientFromVoxel);
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        const double cosine =
            glm::dot(axes[a], axes[b]) / (glm::length(axes[a]) * glm::length(axes[b]));
        if (!(std::abs(cosine) <= 1e-3)) {
            return fail(ErrorKind::unsupported, "the lumen's voxel axes are not at right angles");
        }
    }
    return {};
}

// The `branches` product: one after the other, each from an arc of 0 on.
Centerline joined(const std::vector<Centerline>& branches) {
    Centerline all;
    for (const Centerline& branch : branches)
        all.points.insert(all.points.end(), branch.points.begin(), branch.points.end());
    return all;
}

}  // namespace

Result<ProductKey> denoiseLumen(Preparation& preparation, const WallSource& source) {
    const StageMeter meter;
    const ExpectedTopology topology = preparation.organ().topology;
    const ProductKey key =
        store::makeKey("denoising", denoisingVersion,
                       std::string("topology=") + organs::toString(topology), {source.labelsKey});
    // What an earlier call cleansed is no part of a case that is not cleansed now.
    std::vector<std::string> outdated = madeFrom(product::lumen);
    if (source.labels == product::segmentation) {
        outdated.insert(outdated.end(),
                        {product::mixture, product::cleansedLumen, product::cleansed});
    }
    const auto make = [&](const Progress& progress) -> Result<void> {
        store::Case& target = preparation.target();
        const int threads = preparation.options().threads;
        const auto labels = TRY(target.readVolume<std::uint8_t>(source.labels));
        Attributes attributes;
        if (const auto from = target.attributes(source.labels)) {
            if (const auto iso = from->find("air-below-hu");
                iso != from->end() && !source.hu.empty()) {
                attributes["iso-hu"] = iso->second;
            }
        }
        if (topology == ExpectedTopology::any) {
            const auto kept = topology::digitalTopology(labels, threads);
            attributes["handles-kept"] = std::to_string(kept.handles());
            setNotes(attributes, {attributes["handles-kept"] + " handles kept"});
            return target.publishVolume(product::lumen, key, labels, attributes, outdated);
        }
        topology::HandleCuttingOptions cutting;
        cutting.threads = threads;
        cutting.progress = progress;
        const auto cut = TRY(topology::cutHandles(labels, cutting));
        attributes["handles-cut"] = std::to_string(cut.handlesCut);
        attributes["cavities-filled"] = std::to_string(cut.cavitiesFilled);
        attributes["voxels-removed"] = std::to_string(cut.voxelsRemoved);
        attributes["voxels-added"] = std::to_string(cut.voxelsAdded);
        std::vector<std::string> notes{attributes["handles-cut"] + " handles cut, " +
                                       attributes["cavities-filled"] + " cavities filled, " +
                                       attributes["voxels-removed"] + " voxels removed, " +
                                       attributes["voxels-added"] + " added"};
        notes.insert(notes.end(), cut.notes.begin(), cut.notes.end());
        setNotes(attributes, notes);
        return target.publishVolume(product::lumen, key, cut.labels, attributes, outdated);
    };
    return preparation.run({"denoising", key, {product::lumen}}, meter, make).map([&] {
        return key;
    });
}

Result<ProductKey> measureDistance(Preparation& preparation, const ProductKey& lumen) {
    const StageMeter meter;
    const ProductKey key = store::makeKey("distance", distanceVersion, "", {lumen});
    const auto make = [&](const Progress&) -> Result<void> {
        store::Case& target = preparation.target();
        const auto labels = TRY(target.readVolume<std::uint8_t>(product::lumen));
        TRY(checkOrthogonal(labels.grid()));
        const auto distanceMm =
            topology::distanceToBoundaryMm(labels, preparation.options().threads);
        return target.publishVolume(product::distance, key, distanceMm, {},
                                    madeFrom(product::distance));
    };
    return preparation.run({"distance", key, {product::distance}}, meter, make).map([&] {
        return key;
    });
}

Result<ProductKey> traceCenterline(Preparation& preparation, const ProductKey& lumen,
                                   const ProductKey& distance) {
    const StageMeter meter;
    const organs::OrganProfile& organ = preparation.organ();
    const ProductKey key =
        store::makeKey("centerline", centerlineVersion,
                       std::string("end-points=") + organs::toString(organ.endPoints) +
                           (organ.branches ? ";branches" : ""),
                       {lumen, distance});
    Stage stage{"centerline", key, {product::centerline}};
    if (organ.branches) stage.products.push_back(product::branches);
    const auto make = [&](const Progress& progress) -> Result<void> {
        store::Case& target = preparation.target();
        const auto labels = TRY(target.readVolume<std::uint8_t>(product::lumen));
        const auto distanceMm = TRY(target.readVolume<float>(product::distance));
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
        if (target.find(product::quality)) {
            const auto pieces = TRY(target.readText(product::quality).and_then(piecesOfQuality));
            const auto missed = piecesPassedBy(traced.centerline, pieces);
            notes.insert(notes.end(), missed.begin(), missed.end());
        }
        setNotes(attributes, notes);
        auto published = target.publishCenterline(product::centerline, key, traced.centerline,
                                                  attributes, madeFrom(product::centerline));
        if (!published || !organ.branches) return published;
        return target.publishCenterline(product::branches, key, joined(traced.branches),
                                        {{"branches", std::to_string(traced.branches.size())}},
                                        madeFrom(product::branches));
    };
    return preparation.run(stage, meter, make).map([&] { return key; });
}

}  // namespace haustra::pipeline
