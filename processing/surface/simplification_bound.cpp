#include "surface/simplification_bound.h"

#include <algorithm>

namespace haustra::surface {
namespace {

/// Single precision resolves places 250 mm from the centre to 10⁻⁵ mm.
constexpr double roundingMm = 1e-4;

}  // namespace

NearTriangle::NearTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c)
    : corner{a, b, c}, edge{b - a, c - b, a - c} {
    const glm::vec3 upright = glm::cross(edge[0], edge[1]);
    const float length = glm::length(upright);
    normal = length > 0.0f ? upright / length : glm::vec3(0.0f);
    for (int k = 0; k < 3; ++k) {
        const float squared = glm::dot(edge[k], edge[k]);
        invertedEdgeSquared[k] = squared > 0.0f ? 1.0f / squared : 0.0f;
    }
}

bool NearTriangle::within(const glm::vec3& p, float squared) const {
    const glm::vec3 from[] = {p - corner[0], p - corner[1], p - corner[2]};
    const float height = glm::dot(normal, from[0]);
    if (height * height > squared) return false;
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        if (glm::dot(glm::cross(edge[k], from[k]), normal) >= 0.0f) continue;
        inside = false;
        const float along =
            std::clamp(glm::dot(from[k], edge[k]) * invertedEdgeSquared[k], 0.0f, 1.0f);
        const glm::vec3 away = from[k] - along * edge[k];
        if (glm::dot(away, away) <= squared) return true;
    }
    return inside;
}

ErrorBound::ErrorBound(const CornerMesh& input, double errorMm)
    : errorSquared_(float(std::max(0.0, errorMm - roundingMm) * (errorMm - roundingMm))),
      vertexCount_(int(input.position.size())),
      edgeCount_(int(input.vertex.size() / 2)),
      inputVertex_(input.vertex),
      inputOpposite_(input.opposite),
      first_(std::size_t(input.triangleCount()), -1) {
    const std::size_t count =
        input.position.size() + input.vertex.size() / 2 + input.vertex.size() / 3;
    place_.reserve(count);
    corner_.reserve(count);
    next_.assign(count, -1);
    const auto hang = [&](int corner) {
        const int sample = int(corner_.size());
        corner_.push_back(corner);
        if (corner < 0) return;  // a vertex that no triangle uses
        next_[sample] = first_[corner / 3];
        first_[corner / 3] = sample;
    };
    for (std::size_t v = 0; v < input.position.size(); ++v) {
        place_.push_back(glm::vec3(input.position[v]));
        hang(input.cornerOf[v]);
    }
    for (int c = 0; c < int(input.vertex.size()); ++c) {
        if (c > input.opposite[c]) continue;
        place_.push_back(glm::vec3(0.5 * (input.position[input.vertex[CornerMesh::next(c)]] +
                                          input.position[input.vertex[CornerMesh::previous(c)]])));
        hang(c);
    }
    for (int t = 0; t < input.triangleCount(); ++t) {
        const int* v = &input.vertex[3 * t];
        place_.push_back(
            glm::vec3((input.position[v[0]] + input.position[v[1]] + input.position[v[2]]) / 3.0));
        hang(3 * t);
    }
}

void ErrorBound::gather(std::span<const int> oldTriangles, Patch& patch) const {
    patch.samples.clear();
    patch.x.clear();
    patch.y.clear();
    patch.z.clear();
    for (const int triangle : oldTriangles) {
        for (int sample = first_[triangle]; sample >= 0; sample = next_[sample]) {
            const glm::vec3 p = place(sample);
            patch.samples.push_back(sample);
            patch.x.push_back(p.x);
            patch.y.push_back(p.y);
            patch.z.push_back(p.z);
        }
    }
}

bool ErrorBound::nearInputTriangle(int triangle, const glm::vec3& p) const {
    const int* v = &inputVertex_[3 * std::size_t(triangle)];
    return NearTriangle(place(v[0]), place(v[1]), place(v[2])).within(p, errorSquared_);
}

bool ErrorBound::nearTrianglesOf(int sample, const glm::vec3& p) const {
    const int first = corner_[sample];
    if (sample >= vertexCount_ + edgeCount_) return nearInputTriangle(first / 3, p);
    if (sample >= vertexCount_)
        return nearInputTriangle(first / 3, p) || nearInputTriangle(inputOpposite_[first] / 3, p);
    int corner = first;
    do {
        if (nearInputTriangle(corner / 3, p)) return true;
        corner = CornerMesh::next(inputOpposite_[CornerMesh::next(corner)]);
    } while (corner != first);
    return false;
}

bool ErrorBound::nearInput(const glm::vec3& p, Patch& patch) const {
    const std::size_t count = patch.samples.size();
    if (count == 0) return false;
    patch.squared.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float dx = patch.x[i] - p.x, dy = patch.y[i] - p.y, dz = patch.z[i] - p.z;
        patch.squared[i] = dx * dx + dy * dy + dz * dz;
    }
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < count; ++i) {
        if (patch.squared[i] < patch.squared[nearest]) nearest = i;
    }
    return patch.squared[nearest] <= errorSquared_ || nearTrianglesOf(patch.samples[nearest], p);
}

bool ErrorBound::findHomes(Patch& patch) const {
    const std::size_t triangles = patch.triangles.size();
    patch.home.resize(patch.samples.size());
    std::size_t last = 0;  // a sample's neighbour in the list is often its neighbour in space
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
        const glm::vec3 p(patch.x[i], patch.y[i], patch.z[i]);
        std::size_t tried = 0;
        while (tried < triangles && !patch.triangles[last].within(p, errorSquared_)) {
            ++tried;
            last = last + 1 == triangles ? 0 : last + 1;
        }
        if (tried == triangles) return false;
        patch.home[i] = int(last);
    }
    return true;
}

void ErrorBound::rehang(std::span<const int> oldTriangles, std::span<const int> slots,
                        const Patch& patch) {
    for (const int triangle : oldTriangles)
        first_[triangle] = -1;
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
        int& first = first_[slots[patch.home[i]]];
        next_[patch.samples[i]] = first;
        first = patch.samples[i];
    }
}

}  // namespace haustra::surface
