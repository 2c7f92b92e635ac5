#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"
#include "topology/digital_topology.h"
#include "topology/handle_cutting.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using organs::ExpectedTopology;
using store::Attributes;

// Raise it whenever the lumen changes for the same input and options.
constexpr int denoisingVersion = 6;

// Products that a lumen could come by but this one, which is made from `source`, does not, with all
// that is made from them: what an earlier call cleansed is no part of a case that is not cleansed
// now.
std::vector<std::string> unusedSources(const WallSource& source) {
    const store::Catalogue& catalogue = store::catalogue();
    std::vector<std::string> used = catalogue.sources(source.labels), unused;
    used.insert(used.end(), {source.labels, source.hu});
    for (const std::string& other : catalogue.sources(product::lumen)) {
        if (std::ranges::find(used, other) != used.end()) continue;
        const auto dependents = catalogue.madeFrom(other);
        unused.push_back(other);
        unused.insert(unused.end(), dependents.begin(), dependents.end());
    }
    return unused;
}

}  // namespace

Result<ProductKey> denoiseLumen(Preparation& preparation, const WallSource& source) {
    const StageMeter meter;
    const ExpectedTopology topology = preparation.organ().topology;
    std::vector<ProductKey> inputs{source.labelsKey};
    const bool cleansed = source.hu == product::cleansed;
    if (cleansed) inputs.push_back(source.huKey);
    const ProductKey key =
        store::makeKey("denoising", denoisingVersion,
                       std::string("topology=") + organs::toString(topology), inputs);
    StageCase stage = preparation.open("denoising", key);
    const std::vector<std::string> unused = unusedSources(source);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const int threads = preparation.options().threads;
        const auto labels = TRY(stage.readVolume<std::uint8_t>(source.labels));
        Attributes attributes;
        if (const auto from = stage.attributes(source.labels)) {
            if (const auto iso = from->find("air-below-hu");
                iso != from->end() && !source.hu.empty()) {
                attributes["iso-hu"] = iso->second;
            }
        }
        if (topology == ExpectedTopology::any) {
            const auto kept = topology::digitalTopology(labels, threads);
            attributes["handles-kept"] = std::to_string(kept.handles());
            setNotes(attributes, {attributes["handles-kept"] + " handles kept"});
            return stage.publish(product::lumen, labels, attributes, unused);
        }
        topology::HandleCuttingOptions cutting;
        cutting.threads = threads;
        cutting.progress = progress;
        std::optional<Volume<std::int16_t>> hu;
        if (cleansed) {
            auto scan = TRY(stage.readVolume<std::int16_t>(source.hu));
            hu = std::move(scan);
            cutting.hu = &*hu;
            const auto tissue =
                TRY(stage.attributes(product::segmentation).and_then(tissueModelOf));
            cutting.wallHu = tissue.airBelowHu;
        }
        const auto cut = TRY(topology::cutHandles(labels, cutting));
        attributes["handles-cut"] = std::to_string(cut.handlesCut);
        attributes["cavities-filled"] = std::to_string(cut.cavitiesFilled);
        attributes["islands-tied"] = std::to_string(cut.islandsTied);
        attributes["voxels-removed"] = std::to_string(cut.voxelsRemoved);
        attributes["voxels-added"] = std::to_string(cut.voxelsAdded);
        std::vector<std::string> notes{attributes["handles-cut"] + " handles cut, " +
                                       attributes["cavities-filled"] + " cavities filled, " +
                                       attributes["islands-tied"] + " islands tied, " +
                                       attributes["voxels-removed"] + " voxels removed, " +
                                       attributes["voxels-added"] + " added"};
        notes.insert(notes.end(), cut.notes.begin(), cut.notes.end());
        setNotes(attributes, notes);
        return stage.publish(product::lumen, cut.labels, attributes, unused);
    });
}

}  // namespace haustra::pipeline
