#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"
#include "topology/digital_topology.h"
#include "topology/handle_cutting.h"

#include <algorithm>

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using organs::ExpectedTopology;
using store::Attributes;

// Raise it whenever the lumen changes for the same input and options.
constexpr int denoisingVersion = 2;

// Products that a lumen could come by but this one, which is made from `labels`, does not, with all
// that is made from them: what an earlier call cleansed is no part of a case that is not cleansed
// now.
std::vector<std::string> unusedSources(const std::string& labels) {
    const store::Catalogue& catalogue = store::catalogue();
    std::vector<std::string> used = catalogue.sources(labels), unused;
    used.push_back(labels);
    for (const std::string& source : catalogue.sources(product::lumen)) {
        if (std::ranges::find(used, source) != used.end()) continue;
        const auto dependents = catalogue.madeFrom(source);
        unused.push_back(source);
        unused.insert(unused.end(), dependents.begin(), dependents.end());
    }
    return unused;
}

}  // namespace

Result<ProductKey> denoiseLumen(Preparation& preparation, const WallSource& source) {
    const StageMeter meter;
    const ExpectedTopology topology = preparation.organ().topology;
    const ProductKey key =
        store::makeKey("denoising", denoisingVersion,
                       std::string("topology=") + organs::toString(topology), {source.labelsKey});
    StageCase stage = preparation.open("denoising", key);
    const std::vector<std::string> unused = unusedSources(source.labels);
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
        return stage.publish(product::lumen, cut.labels, attributes, unused);
    });
}

}  // namespace haustra::pipeline
