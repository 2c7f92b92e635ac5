#include "cad/boosted_trees.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <opencv2/ml.hpp>

namespace haustra::cad {

namespace {

constexpr int deepest = 32;  // levels of branches of a tree from a file

// What of a tree's branch and below it counts.
double below(const std::vector<TreeNode>& tree, std::int32_t at, std::span<const float> features,
             std::span<const float> widths) {
    const TreeNode* node = &tree[std::size_t(at)];
    while (node->feature >= 0) {
        const auto feature = std::size_t(node->feature);
        const float above = features[feature] - node->threshold, half = 0.5f * widths[feature];
        if (above > -half && above < half) {
            const double right = 0.5 * (1.0 + double(above) / half);
            return (1.0 - right) * below(tree, node->left, features, widths) +
                   right * below(tree, node->right, features, widths);
        }
        node = &tree[std::size_t(above > 0.0f ? node->right : node->left)];
    }
    return node->threshold;
}

std::vector<float> deviations(std::span<const float> rows, std::size_t features) {
    std::vector<double> sum(features, 0.0), squares(features, 0.0);
    for (std::size_t n = 0; n < rows.size(); ++n)
        sum[n % features] += rows[n], squares[n % features] += double(rows[n]) * rows[n];
    const double count = double(rows.size() / features);
    std::vector<float> result;
    for (std::size_t f = 0; f < features; ++f) {
        const double mean = sum[f] / count;
        result.push_back(float(std::sqrt(std::max(0.0, squares[f] / count - mean * mean))));
    }
    return result;
}

}  // namespace

double BoostedTrees::at(std::span<const float> features) const {
    double sum = 0.0;
    for (const std::vector<TreeNode>& tree : trees)
        sum += below(tree, 0, features, widths);
    return sum;
}

Result<void> checkTrees(const BoostedTrees& boosted, int features) {
    const auto refuse = [](const char* what) { return fail(ErrorKind::badInput, what, "model"); };
    if (boosted.trees.empty()) return refuse("there is no tree");
    if (int(boosted.widths.size()) != features) return refuse("features have no widths");
    for (const float width : boosted.widths)
        if (!(width >= 0.0f && std::isfinite(width))) return refuse("a width is no length");
    for (const std::vector<TreeNode>& tree : boosted.trees) {
        if (tree.empty()) return refuse("a tree has no root");
        // So that a walk down both sides ends soon: each node but the root has one parent, and none
        // is deep.
        std::vector<int> depth(tree.size(), 0);
        for (std::size_t n = 0; n < tree.size(); ++n) {
            const TreeNode& node = tree[n];
            if (!std::isfinite(node.threshold)) return refuse("a tree's number is not finite");
            if (node.feature < 0) continue;
            if (node.feature >= features) return refuse("a tree asks for a feature there is not");
            for (const std::int32_t next : {node.left, node.right}) {
                if (next <= std::int32_t(n) || next >= std::int32_t(tree.size()))
                    return refuse("a tree's branch leads nowhere");
                if (std::exchange(depth[std::size_t(next)], depth[n] + 1) != 0)
                    return refuse("two branches of a tree lead to one node");
            }
            if (depth[n] == deepest) return refuse("a tree is too deep");
        }
    }
    return {};
}

BoostedTrees boostTrees(std::span<const float> rows, std::span<const float> responses, int features,
                        int trees) {
    constexpr int depth = 4, leastRows = 10;
    constexpr float widthInDeviations = 0.2f;
    const int count = int(responses.size());
    const cv::Mat samples(count, features, CV_32F, const_cast<float*>(rows.data()));
    cv::Mat classes(count, 1, CV_32S);
    for (int n = 0; n < count; ++n)
        classes.at<int>(n) = responses[std::size_t(n)] > 0.5f;
    const auto boost = cv::ml::Boost::create();
    boost->setBoostType(cv::ml::Boost::GENTLE);
    boost->setWeakCount(trees);
    boost->setWeightTrimRate(0.95);
    boost->setMaxDepth(depth);
    boost->setMinSampleCount(leastRows);
    boost->train(cv::ml::TrainData::create(samples, cv::ml::ROW_SAMPLE, classes));

    // Its trees lie one after the other in lists of nodes and splits.
    const auto& nodes = boost->getNodes();
    const auto& splits = boost->getSplits();
    BoostedTrees result;
    for (const float deviation : deviations(rows, std::size_t(features)))
        result.widths.push_back(widthInDeviations * deviation);
    for (const int root : boost->getRoots()) {
        std::vector<TreeNode> tree;
        const auto add = [&](const auto& self, int at) -> std::int32_t {
            const auto& node = nodes[std::size_t(at)];
            const auto number = std::int32_t(tree.size());
            tree.push_back({});
            if (node.split < 0) {
                tree.back().threshold = float(node.value);
                return number;
            }
            const auto& split = splits[std::size_t(node.split)];
            const std::int32_t left = self(self, split.inversed ? node.right : node.left),
                               right = self(self, split.inversed ? node.left : node.right);
            tree[std::size_t(number)] = {split.varIdx, split.c, left, right};
            return number;
        };
        add(add, root);
        result.trees.push_back(std::move(tree));
    }
    return result;
}

}  // namespace haustra::cad
