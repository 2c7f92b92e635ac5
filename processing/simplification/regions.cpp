#include "simplification/regions.h"

#include <algorithm>
#include <limits>

namespace haustra::simplification {
namespace {

struct Node {
    Box box;
    int axis = -1;  // −1 for a leaf
    double cut = 0.0;
    int below = -1, above = -1;  // nodes
    int region = -1;             // of a leaf
};

class Tree {
public:
    Tree(const CornerMesh& mesh, std::size_t vertexLimit, double share)
        : mesh_(mesh), vertexLimit_(vertexLimit), share_(share) {
        std::vector<int> vertices;
        Box bounds{glm::dvec3(std::numeric_limits<double>::max()),
                   glm::dvec3(std::numeric_limits<double>::lowest())};
        for (std::size_t v = 0; v < mesh.position.size(); ++v) {
            if (mesh.cornerOf[v] < 0) continue;
            vertices.push_back(int(v));
            bounds.low = glm::min(bounds.low, mesh.position[v]);
            bounds.high = glm::max(bounds.high, mesh.position[v]);
        }
        if (vertices.empty()) return;
        // Half open above, so the highest vertices need room.
        build({bounds.low - 1.0, bounds.high + 1.0}, std::move(vertices));
    }

    std::vector<Region> takeRegions() {
        for (int t = 0; t < mesh_.triangleCount(); ++t) {
            if (!mesh_.alive(t)) continue;
            const glm::dvec3 &a = mesh_.position[mesh_.vertex[3 * t]],
                             &b = mesh_.position[mesh_.vertex[3 * t + 1]],
                             &c = mesh_.position[mesh_.vertex[3 * t + 2]];
            addTriangle(0, t, {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c))});
        }
        return std::move(regions_);
    }

private:
    int build(const Box& box, std::vector<int> vertices) {
        const int index = int(nodes_.size());
        nodes_.push_back({box});
        const glm::dvec3 extent = box.high - box.low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                         : extent.y >= extent.z                       ? 1
                                                                      : 2;
        const auto along = [&](int v) { return mesh_.position[v][axis]; };
        double cut = 0.0;
        bool cuts = vertices.size() > vertexLimit_;
        if (cuts) {
            const auto middle = vertices.begin() + std::ptrdiff_t(share_ * double(vertices.size()));
            std::nth_element(vertices.begin(), middle, vertices.end(),
                             [&](int v, int w) { return along(v) < along(w); });
            cut = along(*middle);
            cuts = cut > box.low[axis];
        }
        std::vector<int> below, above;
        if (cuts) {
            for (const int v : vertices)
                (along(v) < cut ? below : above).push_back(v);
        }
        if (below.empty() || above.empty()) {
            std::sort(vertices.begin(), vertices.end());
            nodes_[index].region = int(regions_.size());
            regions_.push_back({box, std::move(vertices), {}});
            return index;
        }
        vertices = {};
        Box lower = box, upper = box;
        lower.high[axis] = upper.low[axis] = cut;
        nodes_[index].axis = axis;
        nodes_[index].cut = cut;
        const int lowerNode = build(lower, std::move(below));
        const int upperNode = build(upper, std::move(above));
        nodes_[index].below = lowerNode;
        nodes_[index].above = upperNode;
        return index;
    }

    void addTriangle(int index, int triangle, const Box& box) {
        const Node& node = nodes_[index];
        if (node.axis < 0) {
            regions_[node.region].triangles.push_back(triangle);
            return;
        }
        if (box.low[node.axis] < node.cut) addTriangle(node.below, triangle, box);
        if (box.high[node.axis] >= node.cut) addTriangle(node.above, triangle, box);
    }

    const CornerMesh& mesh_;
    std::size_t vertexLimit_;
    double share_;
    std::vector<Node> nodes_;
    std::vector<Region> regions_;
};

}  // namespace

std::vector<Region> partition(const CornerMesh& mesh, std::size_t vertexLimit, double share) {
    return Tree(mesh, vertexLimit, share).takeRegions();
}

}  // namespace haustra::simplification
