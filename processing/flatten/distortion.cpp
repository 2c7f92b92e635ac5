#include "flatten/distortion.h"

#include "flatten/triangle_stretch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace haustra::flatten {
namespace {

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    Spread spread;
    for (const double value : values)
        spread.mean += value;
    spread.mean /= double(values.size());
    std::sort(values.begin(), values.end());
    const auto quantile = [&](double share) {
        return values[std::size_t(share * double(values.size() - 1))];
    };
    spread.p95 = quantile(0.95);
    spread.p999 = quantile(0.999);
    spread.max = values.back();
    return spread;
}

double angleBetween(const glm::dvec3& p, const glm::dvec3& q) {
    return std::atan2(glm::length(glm::cross(p, q)), glm::dot(p, q));
}

double angleBetween(const glm::dvec2& p, const glm::dvec2& q) {
    return std::atan2(std::abs(p.x * q.y - p.y * q.x), glm::dot(p, q));
}

struct WeightedLog {
    double value, weight;
};

/// The value below which `share` of the weight lies; `sorted` by value.
double quantile(const std::vector<WeightedLog>& sorted, double total, double share) {
    double below = 0.0;
    for (const WeightedLog& entry : sorted) {
        below += entry.weight;
        if (below >= share * total) return entry.value;
    }
    return sorted.empty() ? 0.0 : sorted.back().value;
}

void measureAreas(std::vector<WeightedLog> logs, Distortion& found) {
    double total = 0.0, mean = 0.0, square = 0.0;
    for (const WeightedLog& entry : logs) {
        total += entry.weight;
        mean += entry.weight * entry.value;
    }
    if (!(total > 0.0)) return;
    mean /= total;
    for (const WeightedLog& entry : logs)
        square += entry.weight * (entry.value - mean) * (entry.value - mean);
    found.logAreaDeviation = std::sqrt(square / total);
    std::sort(logs.begin(), logs.end(), [](const WeightedLog& a, const WeightedLog& b) {
        return std::pair(a.value, a.weight) < std::pair(b.value, b.weight);
    });
    found.areaRange = std::exp(quantile(logs, total, 0.999) - quantile(logs, total, 0.001));
}

/// Vertices on an edge of one triangle: around the others the edges' directions cancel out.
std::vector<char> rimVertices(const TriMesh& mesh) {
    // Σ of (target − origin) over the half-edges across a vertex's corners is 0 in a closed fan.
    std::vector<long long> balance(mesh.vertices.size(), 0);
    for (const glm::ivec3& t : mesh.triangles) {
        for (int c = 0; c < 3; ++c)
            balance[std::size_t(t[c])] += t[(c + 2) % 3] - t[(c + 1) % 3];
    }
    std::vector<char> rim(balance.size());
    for (std::size_t v = 0; v < rim.size(); ++v)
        rim[v] = balance[v] != 0;
    return rim;
}

}  // namespace

Distortion measureDistortion(const TriMesh& mesh,
                             const std::function<glm::dvec2(std::size_t, int)>& cornerAt) {
    constexpr double degrees = 180.0 / std::numbers::pi;
    Distortion found;
    std::vector<double> errors, dilatations;
    std::vector<WeightedLog> logs;
    std::vector<double> angleSum(mesh.vertices.size(), 0.0);
    errors.reserve(mesh.triangles.size() * 3);
    dilatations.reserve(mesh.triangles.size());
    logs.reserve(mesh.triangles.size());
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        glm::dvec3 at[3];
        glm::dvec2 flat[3];
        for (int c = 0; c < 3; ++c) {
            at[c] = mesh.vertices[std::size_t(mesh.triangles[t][c])];
            flat[c] = cornerAt(t, c);
        }
        const glm::dvec3 a = at[1] - at[0], b = at[2] - at[0];
        const glm::dvec2 p = flat[1] - flat[0], q = flat[2] - flat[0];
        const double area = glm::length(glm::cross(a, b)), flatArea = p.x * q.y - p.y * q.x;
        if (!(flatArea > 0.0)) ++found.flips;
        double angles[3];
        for (int c = 0; c < 3; ++c) {
            angles[c] = angleBetween(at[(c + 1) % 3] - at[c], at[(c + 2) % 3] - at[c]);
            angleSum[std::size_t(mesh.triangles[t][c])] += angles[c];
        }
        if (!(area > 0.0)) continue;
        for (int c = 0; c < 3; ++c) {
            const double angle =
                angleBetween(flat[(c + 1) % 3] - flat[c], flat[(c + 2) % 3] - flat[c]);
            errors.push_back(degrees * std::abs(angle - angles[c]));
        }
        if (const double stretch = dilatation(a, b, p, q); std::isfinite(stretch))
            dilatations.push_back(stretch);
        if (flatArea > 0.0) logs.push_back({std::log(flatArea / area), area});
    }
    const std::vector<char> rim = rimVertices(mesh);
    for (std::size_t v = 0; v < rim.size(); ++v) {
        if (!rim[v] && angleSum[v] > 0.0)
            found.angleFloorDegrees += degrees * std::abs(2.0 * std::numbers::pi - angleSum[v]);
    }
    if (!mesh.triangles.empty()) found.angleFloorDegrees /= 3.0 * double(mesh.triangles.size());
    found.angleErrorDegrees = spreadOf(std::move(errors));
    found.dilatation = spreadOf(std::move(dilatations));
    measureAreas(std::move(logs), found);
    return found;
}

}  // namespace haustra::flatten
