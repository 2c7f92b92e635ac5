#include "cad/forest.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <opencv2/ml.hpp>

namespace haustra::cad {

double Forest::at(std::span<const float> features) const {
    double sum = 0.0;
    for (const std::vector<TreeNode>& tree : trees) {
        const TreeNode* node = &tree.front();
        while (node->feature >= 0)
            node = &tree[std::size_t(features[std::size_t(node->feature)] <= node->threshold
                                         ? node->left
                                         : node->right)];
        sum += node->threshold;
    }
    return sum / double(trees.size());
}

Result<void> checkForest(const Forest& forest, int features) {
    const auto refuse = [](const char* what) { return fail(ErrorKind::badInput, what, "model"); };
    if (forest.trees.empty()) return refuse("there is no tree");
    for (const std::vector<TreeNode>& tree : forest.trees) {
        if (tree.empty()) return refuse("a tree has no root");
        for (std::size_t n = 0; n < tree.size(); ++n) {
            const TreeNode& node = tree[n];
            if (!std::isfinite(node.threshold)) return refuse("a tree's number is not finite");
            if (node.feature < 0) continue;
            if (node.feature >= features) return refuse("a tree asks for a feature there is not");
            for (const std::int32_t next : {node.left, node.right})
                if (next <= std::int32_t(n) || next >= std::int32_t(tree.size()))
                    return refuse("a tree's branch leads nowhere");
        }
    }
    return {};
}

Forest trainForest(std::span<const float> rows, std::span<const float> responses, int features,
                   int trees, int depth, int leastRows) {
    const int count = int(responses.size());
    const cv::Mat samples(count, features, CV_32F, const_cast<float*>(rows.data())),
        wanted(count, 1, CV_32F, const_cast<float*>(responses.data()));
    const auto forest = cv::ml::RTrees::create();
    forest->setMaxDepth(depth);
    forest->setMinSampleCount(leastRows);
    forest->setRegressionAccuracy(1e-4f);
    forest->setActiveVarCount(0);  // the root of their number
    forest->setTermCriteria({cv::TermCriteria::MAX_ITER, trees, 0.0});
    cv::theRNG().state = 20061123;
    forest->train(cv::ml::TrainData::create(samples, cv::ml::ROW_SAMPLE, wanted));

    // Its trees lie one after the other in lists of nodes and splits.
    const auto& nodes = forest->getNodes();
    const auto& splits = forest->getSplits();
    Forest result;
    for (const int root : forest->getRoots()) {
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
