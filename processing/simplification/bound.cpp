#include "simplification/bound.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace haustra::simplification {
namespace {

/// Single precision resolves places 250 mm from the centre to 10⁻⁵ mm.
constexpr double roundingMm = 1e-4;

}  // namespace

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
    return isNear(p, inputPlace_[v[0]], inputPlace_[v[1]], inputPlace_[v[2]], errorSquared_);
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

AttachedSamples::AttachedSamples(const ErrorBound& bound, std::span<const int> slots)
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

void AttachedSamples::gather(std::span<const int> oldTriangles, Patch& patch) const {
    patch.samples.clear();
    patch.points.clear();
    // The triangles' lists side by side: the processor waits for several links at once.
    patch.ends.clear();
    for (const int triangle : oldTriangles) {
        if (first_[triangle] >= 0) patch.ends.push_back(first_[triangle]);
    }
    // By pointers: checked indices would make it take 45 % longer.
    const Sample* const samples = sample_.data();
    int* const ends = patch.ends.data();
    for (std::size_t lists = patch.ends.size(); lists > 0;) {
        for (std::size_t i = 0; i < lists;) {
            const int number = ends[i];
            const Sample& sample = samples[number];
            patch.samples.push_back(number);
            patch.points.add(sample.place);
            if (sample.next >= 0) {
                ends[i++] = sample.next;
            } else {
                ends[i] = ends[--lists];
            }
        }
    }
    patch.points.fill();
}

bool AttachedSamples::nearInput(const glm::vec3& p, const Patch& patch) const {
    if (patch.samples.empty()) return false;
    const std::size_t nearest = nearestPoint(patch.points, p);
    const glm::vec3 away = patch.points.at(nearest) - p;
    return glm::dot(away, away) <= bound_.errorSquared_ ||
           bound_.nearTrianglesOf(number_[patch.samples[nearest]], p);
}

bool AttachedSamples::findTriangles(Patch& patch) const {
    return findNear(patch.points, patch.triangles, bound_.errorSquared_, patch.triangleOf,
                    patch.heightSquared);
}

void AttachedSamples::reattach(std::span<const int> oldTriangles, std::span<const int> newTriangles,
                               const Patch& patch) {
    for (const int triangle : oldTriangles)
        first_[triangle] = -1;
    for (std::size_t i = 0; i < patch.samples.size(); ++i) {
        int& first = first_[newTriangles[patch.triangleOf[i]]];
        sample_[patch.samples[i]].next = first;
        first = patch.samples[i];
    }
}

void AttachedSamples::writeTo(ErrorBound& bound, std::span<const int> slots) const {
    const auto numberOf = [&](int sample) { return sample < 0 ? -1 : number_[sample]; };
    for (std::size_t t = 0; t < slots.size(); ++t) {
        if (slots[t] >= 0) bound.first_[slots[t]] = numberOf(first_[t]);
    }
    for (std::size_t n = 0; n < sample_.size(); ++n)
        bound.next_[number_[n]] = numberOf(sample_[n].next);
}

}  // namespace haustra::simplification
