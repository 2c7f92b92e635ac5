#include "simplification/regions.h"

#include <algorithm>
#include <limits>
#include <utility>

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

bool holds(const Box& box, const glm::dvec3& p) {
    return glm::all(glm::lessThanEqual(box.low, p)) && glm::all(glm::lessThan(p, box.high));
}

/// The region's triangles, −1 for those that reach out of its box; the whole learns the numbers of
/// what is inside.
std::vector<int> innerSlots(Simplification& whole, const Region& region) {
    for (std::size_t i = 0; i < region.vertices.size(); ++i)
        whole.numberInRegion[region.vertices[i]] = int(i);
    std::vector<int> slots = region.triangles;
    for (std::size_t i = 0; i < slots.size(); ++i) {
        const int* v = &whole.mesh.vertex[3 * std::size_t(slots[i])];
        const auto in = [&](int k) { return holds(region.box, whole.mesh.position[v[k]]); };
        if (in(0) && in(1) && in(2)) {
            whole.slotInRegion[slots[i]] = int(i);
        } else {
            slots[i] = -1;
        }
    }
    return slots;
}

std::size_t numberIn(const std::vector<int>& ascending, int value) {
    return std::size_t(std::lower_bound(ascending.begin(), ascending.end(), value) -
                       ascending.begin());
}

}  // namespace

std::vector<Region> partition(const CornerMesh& mesh, std::size_t vertexLimit, double share) {
    return Tree(mesh, vertexLimit, share).takeRegions();
}

RegionPart::RegionPart(Simplification& whole, const Region& region)
    : region_(region),
      innerSlots_(innerSlots(whole, region)),
      samples(whole.bound, innerSlots_),
      version(region.vertices.size(), 0),
      disturbed(region.vertices.size(), 0),
      movable(region.vertices.size(), 1),
      changed(region.triangles.size(), 0) {
    const CornerMesh& from = whole.mesh;
    const std::size_t vertices = region.vertices.size(), triangles = region.triangles.size();
    std::vector<int> outside;
    for (std::size_t t = 0; t < triangles; ++t) {
        if (innerSlots_[t] >= 0) continue;
        for (int k = 0; k < 3; ++k) {
            const int v = from.vertex[3 * std::size_t(region.triangles[t]) + k];
            if (!holds(region.box, from.position[v])) outside.push_back(v);
        }
    }
    std::sort(outside.begin(), outside.end());
    outside.erase(std::unique(outside.begin(), outside.end()), outside.end());

    mesh.position.reserve(vertices + outside.size());
    for (const int v : region.vertices) {
        mesh.position.push_back(from.position[v]);
        mesh.valence.push_back(from.valence[v]);
        quadric.push_back(whole.quadric[v]);
        settled.push_back(whole.settled[v]);
    }
    for (const int v : outside)
        mesh.position.push_back(from.position[v]);
    mesh.cornerOf.assign(vertices, -1);
    mesh.vertex.resize(3 * triangles);
    mesh.opposite.assign(3 * triangles, -1);
    for (std::size_t t = 0; t < triangles; ++t) {
        for (int k = 0; k < 3; ++k) {
            const int corner = 3 * region.triangles[t] + k, v = from.vertex[corner];
            int& number = mesh.vertex[3 * t + k];
            if (innerSlots_[t] < 0 && !holds(region.box, from.position[v])) {
                number = int(vertices + numberIn(outside, v));
                continue;
            }
            number = whole.numberInRegion[v];
            if (innerSlots_[t] < 0) movable[number] = 0;
            if (from.cornerOf[v] == corner) mesh.cornerOf[number] = int(3 * t) + k;
        }
    }
    for (int corner = 0; corner < int(3 * triangles); ++corner) {
        if (!facesInside(corner)) continue;
        const int across = from.opposite[3 * region.triangles[corner / 3] + corner % 3];
        const int slot = across / 3;
        // It has an edge in the box, so that its third vertex tells whether it reaches out.
        const bool inner = holds(region.box, from.position[from.vertex[across]]);
        const int triangle =
            inner ? whole.slotInRegion[slot] : int(numberIn(region.triangles, slot));
        mesh.opposite[corner] = 3 * triangle + across % 3;
    }
}

bool RegionPart::facesInside(int corner) const {
    return mesh.vertex[CornerMesh::next(corner)] < insideCount() &&
           mesh.vertex[CornerMesh::previous(corner)] < insideCount();
}

void RegionPart::writeTo(Simplification& whole) const {
    CornerMesh& to = whole.mesh;
    const auto cornerThere = [&](int corner) {
        return corner < 0 ? -1 : 3 * region_.triangles[corner / 3] + corner % 3;
    };
    for (int v = 0; v < insideCount(); ++v) {
        const int there = region_.vertices[v];
        to.cornerOf[there] = cornerThere(mesh.cornerOf[v]);
        to.valence[there] = mesh.valence[v];
        whole.settled[there] = settled[v];
        if (!movable[v]) continue;  // other regions may look at its place
        to.position[there] = mesh.position[v];
        whole.quadric[there] = quadric[v];
    }
    for (int corner = 0; corner < int(mesh.vertex.size()); ++corner) {
        const int there = cornerThere(corner);
        if (innerSlots_[corner / 3] >= 0) {
            const int v = mesh.vertex[corner];
            to.vertex[there] = v < 0 ? -1 : region_.vertices[v];
            to.opposite[there] = cornerThere(mesh.opposite[corner]);
        } else if (facesInside(corner)) {
            to.opposite[there] = cornerThere(mesh.opposite[corner]);
        }
    }
    samples.writeTo(whole.bound, innerSlots_);
}

}  // namespace haustra::simplification
