#include "phantom/tube.h"

#include "core/voxel_sweep.h"

#include <algorithm>

namespace haustra::phantom {

Tube::Tube(std::vector<Node> nodes, double reachMm) : nodes_(std::move(nodes)) {
    if (nodes_.size() < 2) {
        nodes_.clear();
        return;
    }
    glm::dvec3 high = nodes_[0].position;
    lowMm_ = high;
    double widest = 0.0;
    for (const Node& node : nodes_) {
        lowMm_ = glm::min(lowMm_, node.position), high = glm::max(high, node.position);
        widest = std::max(widest, node.radiusMm);
    }
    const double margin = widest + reachMm;
    lowMm_ -= margin;
    cells_ = glm::ivec3(glm::floor((high + margin - lowMm_) / cellMm)) + 1;
    segments_.resize(std::size_t(cells_.x) * cells_.y * cells_.z);
    arcs_.push_back(0.0);
    for (std::size_t n = 0; n + 1 < nodes_.size(); ++n) {
        const glm::dvec3 a = nodes_[n].position, b = nodes_[n + 1].position;
        arcs_.push_back(arcs_.back() + glm::distance(a, b));
        const glm::ivec3 lo = glm::max(
            glm::ivec3(glm::floor((glm::min(a, b) - margin - lowMm_) / cellMm)), glm::ivec3(0));
        const glm::ivec3 hi = glm::min(
            glm::ivec3(glm::floor((glm::max(a, b) + margin - lowMm_) / cellMm)), cells_ - 1);
        visitBox(lo, hi,
                 [&](glm::ivec3 cell) { segments_[indexOf(cell)].push_back(std::uint32_t(n)); });
    }
}

Tube::Place Tube::at(glm::dvec3 p) const {
    Place best;
    const glm::ivec3 cell(glm::floor((p - lowMm_) / cellMm));
    if (glm::any(glm::lessThan(cell, glm::ivec3(0))) ||
        glm::any(glm::greaterThanEqual(cell, cells_)))
        return best;
    for (const std::uint32_t n : segments_[indexOf(cell)]) {
        const Node &a = nodes_[n], &b = nodes_[n + 1];
        const glm::dvec3 ab = b.position - a.position, ap = p - a.position;
        const double t = std::clamp(glm::dot(ap, ab) / std::max(1e-12, glm::dot(ab, ab)), 0.0, 1.0);
        const double d = glm::length(ap - t * ab) - glm::mix(a.radiusMm, b.radiusMm, t);
        if (d < best.distanceMm) best = {d, glm::mix(arcs_[n], arcs_[n + 1], t)};
    }
    return best;
}

}  // namespace haustra::phantom
