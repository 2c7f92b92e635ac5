// A random forest of regression trees: the mean of what its trees say.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::cad {

struct TreeNode {
    std::int32_t feature = -1;         ///< −1: a leaf
    float threshold = 0.0f;            ///< not above: the left branch; of a leaf, its value
    std::int32_t left = 0, right = 0;  ///< nodes of the same tree, after this one
};

/// Immutable once it is made; any number of threads.
struct Forest {
    std::vector<std::vector<TreeNode>> trees;
    /// Mean of the leaves that the features lead to. The forest must have passed checkForest.
    double at(std::span<const float> features) const;
};

/// Fails (badInput) where there is no tree, a branch leads back or nowhere, or a feature does not
/// exist.
Result<void> checkForest(const Forest& forest, int features);

/// `rows`: `features` numbers each, as many rows as responses (0…1). Breiman's random forest
/// (cv::ml::RTrees) in which each tree sees a bootstrap sample of the rows and each split a few of
/// the features. The same for equal input.
Forest trainForest(std::span<const float> rows, std::span<const float> responses, int features,
                   int trees = 200, int depth = 10, int leastRows = 6);

}  // namespace haustra::cad
