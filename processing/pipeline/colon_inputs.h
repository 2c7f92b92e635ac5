// A prepared colon as detection reads it from a case.
#pragma once

#include "cad/smooth_scan.h"
#include "cad/wall_evidence.h"
#include "core/colon_record.h"
#include "core/printed_text.h"
#include "pipeline/product_attributes.h"
#include "store/products.h"

#include <algorithm>

namespace haustra::pipeline {

/// What detection reads, kept while it works. Volumes are mapped.
struct ColonInputs {
    Volume<std::int16_t> ct, cleansed;
    Volume<std::uint8_t> lumen;
    TriMesh surface;
    FlatMap flat;
    Centerline centerline;
    TissueModel tissue;
    std::vector<ColonPiece> pieces;
    std::vector<RebuiltWallRecord> rebuilt;

    cad::PreparedColon colon() const {
        return {ct, cleansed, lumen, surface, flat, centerline, tissue, pieces, rebuilt};
    }
};

/// Which of a case's products there are.
struct ColonProducts {
    bool quality = false;   ///< of a colon that was found; else of a mask
    bool cleansed = false;  ///< else the scan as it came stands for it
    bool flatMap = true;    ///< else it is empty
};

/// From a StageCase or a store::Case. Fails where a product is missing or damaged, or the scan has
/// fewer voxels along an axis than derivatives ask for.
template <class Source>
Result<ColonInputs> readColon(Source& source, const ColonProducts& products) {
    namespace product = store::product;
    ColonInputs inputs;
    inputs.ct = TRY(source.template readVolume<std::int16_t>(product::ct));
    const glm::ivec3 size = inputs.ct.grid().size;
    if (std::min({size.x, size.y, size.z}) < cad::SmoothScan::leastVoxels)
        return fail(ErrorKind::unsupported,
                    printed("has %dx%dx%d voxels: what lies beneath the wall can be told from %d "
                            "along each axis on",
                            size.x, size.y, size.z, cad::SmoothScan::leastVoxels),
                    product::ct);
    inputs.cleansed = TRY(source.template readVolume<std::int16_t>(
        products.cleansed ? product::cleansed : product::ct));
    inputs.lumen = TRY(source.template readVolume<std::uint8_t>(product::lumen));
    inputs.surface = TRY(source.readMesh(product::surface));
    if (products.flatMap) inputs.flat = TRY(source.readFlatMap(product::flatMap));
    inputs.centerline = TRY(source.readCenterline(product::centerline));
    inputs.tissue = TRY(source.attributes(product::segmentation).and_then(tissueModelOf));
    if (products.quality) {
        const auto text = TRY(source.readText(product::quality));
        inputs.pieces = TRY(piecesOfQuality(text));
        inputs.rebuilt = TRY(rebuiltWallsOfQuality(text));
    }
    return inputs;
}

}  // namespace haustra::pipeline
