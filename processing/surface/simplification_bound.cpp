#include "surface/simplification_bound.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

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
        inward[k] = glm::cross(normal, edge[k]) * std::sqrt(invertedEdgeSquared[k]);
    }
}

bool NearTriangle::within(const glm::vec3& p, float squared) const {
    const glm::vec3 from[] = {p - corner[0], p - corner[1], p - corner[2]};
    const float height = glm::dot(normal, from[0]);
    if (height * height > squared) return false;
    float depth[3];
    for (int k = 0; k < 3; ++k) {
        depth[k] = glm::dot(inward[k], from[k]);
        if (depth[k] < 0.0f && depth[k] * depth[k] > squared) return false;
    }
    const bool flat = normal == glm::vec3(0.0f);
    bool inside = !flat;
    for (int k = 0; k < 3; ++k) {
        if (depth[k] >= 0.0f && !flat) continue;
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
      inputVertex_(input.vertex),
      inputOpposite_(input.opposite),
      first_(std::size_t(input.triangleCount()), -1) {
    inputPlace_.reserve(input.position.size());
    for (const glm::dvec3& p : input.position)
        inputPlace_.push_back(glm::vec3(p));
    const std::size_t count =
        input.position.size() + input.vertex.size() / 2 + input.vertex.size() / 3;
    place_.reserve(count);
    next_.reserve(count);
    on_.reserve(count);
    corner_.reserve(count);
    const auto add = [&](On on, int corner, const glm::dvec3& place) {
        int& first = first_[corner / 3];
        next_.push_back(first);
        first = int(place_.size());
        place_.push_back(glm::vec3(place));
        on_.push_back(on);
        corner_.push_back(corner);
    };
    const auto at = [&](int corner) { return input.position[input.vertex[corner]]; };
    for (int t = 0; t < input.triangleCount(); ++t) {
        for (int c = 3 * t; c < 3 * t + 3; ++c) {
            if (input.cornerOf[input.vertex[c]] == c) add(On::vertex, c, at(c));
            if (c < input.opposite[c])
                add(On::edge, c, 0.5 * (at(CornerMesh::next(c)) + at(CornerMesh::previous(c))));
        }
        add(On::triangle, 3 * t, (at(3 * t) + at(3 * t + 1) + at(3 * t + 2)) / 3.0);
    }
}

bool ErrorBound::nearInputTriangle(int triangle, const glm::vec3& p) const {
    const int* v = &inputVertex_[3 * std::size_t(triangle)];
    return NearTriangle(inputPlace_[v[0]], inputPlace_[v[1]], inputPlace_[v[2]])
        .within(p, errorSquared_);
}

bool ErrorBound::nearTrianglesOf(int sample, const glm::vec3& p) const {
    const int first = corner_[sample];
    if (on_[sample] == On::triangle) return nearInputTriangle(first / 3, p);
    if (on_[sample] == On::edge)
        return nearInputTriangle(first / 3, p) || nearInputTriangle(inputOpposite_[first] / 3, p);
    int corner = first;
    do {
        if (nearInputTriangle(corner / 3, p)) return true;
        corner = CornerMesh::next(inputOpposite_[CornerMesh::next(corner)]);
    } while (corner != first);
    return false;
}

HungSamples::HungSamples(const ErrorBound& bound, std::span<const int> slots)
    : bound_(bound), first_(slots.size(), -1) {
    for (std::size_t t = 0; t < slots.size(); ++t) {
        if (slots[t] < 0) continue;
        const int begin = int(sample_.size());
        for (int n = bound.first_[slots[t]]; n >= 0; n = bound.next_[n]) {
            number_.push_back(n);
            sample_.push_back({bound.place_[n], int(number_.size())});
        }
        if (begin == int(sample_.size())) continue;
        first_[t] = begin;
        sample_.back().next = -1;
    }
}

void HungSamples::gather(std::span<const int> oldTriangles, Patch& patch) const {
    patch.samples.clear();
    patch.x.clear();
    patch.y.clear();
    patch.z.clear();
    for (const int triangle : oldTriangles) {
        for (int sample = first_[triangle]; sample >= 0; sample = sample_[sample].next) {
            const glm::vec3 p = sample_[sample].place;
            patch.samples.push_back(sample);
            patch.x.push_back(p.x);
            patch.y.push_back(p.y);
            patch.z.push_back(p.z);
        }
    }
}

bool HungSamples::nearInput(const glm::vec3& p, const Patch& patch) const {
    const std::size_t count = patch.samples.size();
    if (count == 0) return false;
    // Floats that are not negative order as their bits do; with a sample's number in the lowest
    // bits, the least key tells the nearest sample (or one as near within rounding) in a loop
    // without branches.
    const auto numbers = int(std::bit_ceil(count) - 1);
    const float *x = patch.x.data(), *y = patch.y.data(), *z = patch.z.data();
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < count; ++i) {
        const float dx = x[i] - p.x, dy = y[i] - p.y, dz = z[i] - p.z;
        const int bits = std::bit_cast<int>(dx * dx + dy * dy + dz * dz);
        least = std::min(least, (bits & ~numbers) | int(i));
    }
    const std::size_t nearest = std::size_t(least & numbers);
    const glm::vec3 away = glm::vec3(x[nearest], y[nearest], z[nearest]) - p;
    return glm::dot(away, away) <= bound_.errorSquared_ ||
           bound_.nearTrianglesOf(number_[patch.samples[nearest]], p);
}

bool HungSamples::findHomes(Patch& patch) const {
    const std::size_t triangles = patch.triangles.size();
    patch.home.resize(patch.samples.size());
    std::size_t last = 0;  // a sample's neighbour in the list is often its neighbour in space
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
        const glm::vec3 p(patch.x[i], patch.y[i], patch.z[i]);
        std::size_t tried = 0;
        while (tried < triangles && !patch.triangles[last].within(p, bound_.errorSquared_)) {
            ++tried;
            last = last + 1 == triangles ? 0 : last + 1;
        }
        if (tried == triangles) return false;
        patch.home[i] = int(last);
    }
    return true;
}

void HungSamples::rehang(std::span<const int> oldTriangles, std::span<const int> newTriangles,
                         const Patch& patch) {
    for (const int triangle : oldTriangles)
        first_[triangle] = -1;
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
        int& first = first_[newTriangles[patch.home[i]]];
        sample_[patch.samples[i]].next = first;
        first = patch.samples[i];
    }
}

void HungSamples::writeTo(ErrorBound& bound, std::span<const int> slots) const {
    const auto numberOf = [&](int sample) { return sample < 0 ? -1 : number_[sample]; };
    for (std::size_t t = 0; t < slots.size(); ++t) {
        if (slots[t] >= 0) bound.first_[slots[t]] = numberOf(first_[t]);
    }
    for (std::size_t n = 0; n < sample_.size(); ++n)
        bound.next_[number_[n]] = numberOf(sample_[n].next);
}

}  // namespace haustra::surface
