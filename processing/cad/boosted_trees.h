// Boosted regression trees: the sum of what small trees say, each of which mends those before it.
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
struct BoostedTrees {
    std::vector<std::vector<TreeNode>> trees;
    /// Of each feature, 0 and more: a feature is known no better than within ± half of this.
    std::vector<float> widths;
    /// Sum of the leaves that the features lead to: above 0 where a polyp is more likely. Of a
    /// feature within half its width of a branch's threshold both sides count, each by its share of
    /// what the feature may truly be: the expected sum where each branch sees an error of its own,
    /// uniform over the width. They must have passed checkTrees.
    double at(std::span<const float> features) const;
};

/// Fails (badInput) where there is no tree, a width for each feature is missing or below 0, a
/// branch leads back or nowhere, two lead to one node, a tree has more than 32 levels of branches,
/// or a feature does not exist.
Result<void> checkTrees(const BoostedTrees& boosted, int features);

/// `rows`: `features` numbers each, as many rows as responses (0 or 1, both kinds). Gentle AdaBoost
/// (Friedman, Hastie and Tibshirani, Annals of Statistics 2000; 28: 337; cv::ml::Boost): `trees`
/// with four levels of branches at most; what holds fewer than ten rows is not split further, but a
/// split may leave fewer on one side. Rows that together have less than a twentieth of the weight
/// sit a round out. Widths are a fifth of the rows' standard deviation. The same for equal input.
BoostedTrees boostTrees(std::span<const float> rows, std::span<const float> responses, int features,
                        int trees = 200);

}  // namespace haustra::cad
