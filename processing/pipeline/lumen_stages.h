// The stages that shape the lumen: denoising, distance, centerline, surface, flattening.
#pragma once

#include "core/tri_mesh.h"
#include "pipeline/preparation.h"

#include <future>

namespace haustra::pipeline {

using store::ProductKey;

/// What `lumen` is made from, and its surface is contoured on.
struct WallSource {
    std::string labels;  ///< the product: cleansed-lumen or segmentation
    ProductKey labelsKey;
    std::string hu;  ///< the product: cleansed or ct; empty: there is no scan
    ProductKey huKey;
};

/// Each runs its stage and returns its product's key.
/// `lumen`: handles cut where the organ is a ball, else the labels as they are.
Result<ProductKey> denoiseLumen(Preparation& preparation, const WallSource& source);
Result<ProductKey> measureDistance(Preparation& preparation, const ProductKey& lumen);
Result<ProductKey> traceCenterline(Preparation& preparation, const ProductKey& lumen,
                                   const ProductKey& distance);
/// The wall's mesh, not published yet.
struct WallSurface {
    TriMesh mesh;
    store::Attributes attributes;
    double seconds = 0.0;  ///< that it took to make
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

}  // namespace haustra::pipeline
