// The stages of prepare, one file each. Each runs and returns the key of its products; `ct`,
// `segmentation` and so on are the keys of what it reads.
#pragma once

#include "cleansing/tagged_lumen.h"
#include "core/tri_mesh.h"
#include "pipeline/preparation.h"

#include <future>
#include <optional>
#include <set>
#include <string>

namespace haustra::pipeline {

using store::ProductKey;

Result<ProductKey> importScan(Preparation& preparation);

/// `segmentation` as the organ's profile finds it in the scan, and `quality`.
Result<ProductKey> segmentScan(Preparation& preparation, const ProductKey& ct);
/// The same from --lumen; without a scan the mask stands alone.
Result<ProductKey> takeMask(Preparation& preparation, const std::optional<ProductKey>& ct);

/// What it measures of the tagged lumen it leaves in `lumen`, so that cleansing need not measure it
/// again.
Result<ProductKey> mixTissues(Preparation& preparation, const ProductKey& ct,
                              const ProductKey& segmentation,
                              std::optional<cleansing::TaggedLumen>& lumen);
/// `cleansed-lumen` and `cleansed`.
Result<ProductKey> cleanseScan(Preparation& preparation, const ProductKey& ct,
                               const ProductKey& segmentation, const ProductKey& mixture,
                               std::optional<cleansing::TaggedLumen> lumen);

/// What `lumen` is made from, and its surface is contoured on.
struct WallSource {
    std::string labels;  ///< the product: cleansed-lumen or segmentation
    ProductKey labelsKey;
    std::string hu;  ///< the product: cleansed or ct; empty: there is no scan
    ProductKey huKey;
};

/// `lumen`: handles cut where the organ is a ball, else the labels as they are.
Result<ProductKey> denoiseLumen(Preparation& preparation, const WallSource& source);
Result<ProductKey> measureDistance(Preparation& preparation, const ProductKey& lumen);
/// `centerline` and `branches`.
Result<ProductKey> traceCenterline(Preparation& preparation, const ProductKey& lumen,
                                   const ProductKey& distance);

/// The wall's mesh, not published yet.
struct WallSurface {
    TriMesh mesh;
    store::Attributes attributes;
    std::set<std::string> read;  ///< the products that it was made from
    double seconds = 0.0;        ///< that it took to make
};
/// `surface`: the lumen contoured at the wall's HU and simplified within the error bound; `begun`,
/// where it is valid, is what beginSurface returned of the same.
Result<ProductKey> makeSurface(Preparation& preparation, const WallSource& source,
                               const ProductKey& lumen,
                               std::future<Result<WallSurface>> begun = {});
/// Makes the surface beside the stages before its own, which leave cores idle; it only reads the
/// case. Not valid where there is one thread, or the case holds the surface.
std::future<Result<WallSurface>> beginSurface(Preparation& preparation, const WallSource& source,
                                              const ProductKey& lumen);

/// `flatmap`: the surface's conformal map, cut open, each vertex with the place of the centerline
/// that it is seen from.
Result<ProductKey> flattenSurface(Preparation& preparation, const ProductKey& surface,
                                  const ProductKey& centerline);

/// Fails where the options name a model that detection cannot use, before the first stage has run.
Result<void> checkCadModel(const PrepareOptions& options);

/// `findings`: places of the wall that may be polyps. Without `flatMap`, for a colon that could not
/// be flattened; surface and centerline are then the last of the products that it reads.
Result<ProductKey> detectPolyps(Preparation& preparation, const ProductKey& surface,
                                const ProductKey& centerline,
                                const std::optional<ProductKey>& flatMap);

}  // namespace haustra::pipeline
