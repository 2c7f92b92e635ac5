#include "cleansing/point_spread.h"

#include "core/normal_distribution.h"
#include "core/voxel_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace haustra::cleansing {
namespace {

constexpr double leastAlong = 0.85;  // cosine between the axis and the face's normal
constexpr double plateauMm = 1.5;    // from the half height, where a step is over
constexpr double binMm = 0.01;
constexpr int bins = 250;
constexpr double fewestLines = 200.0;

/// What the lines along one axis add up to, in one slice.
struct Lines {
    double count = 0.0;
    glm::dvec3 squares{0.0};            // of the normals' parts along the axes
    std::array<double, bins> weight{};  // by the step's standard deviation

    void add(const Lines& other) {
        count += other.count, squares += other.squares;
        for (std::size_t b = 0; b < bins; ++b)
            weight[b] += other.weight[b];
    }

    double medianMm() const {
        double whole = 0.0, sum = 0.0;
        for (const double w : weight)
            whole += w;
        std::size_t b = 0;
        while (b + 1 < bins && sum + weight[b] < 0.5 * whole)
            sum += weight[b++];
        return (double(b) + (0.5 * whole - sum) / std::max(weight[b], 1e-12)) * binMm;
    }
};

class Faces {
public:
    Faces(const CtScan& scan, const Volume<std::uint8_t>& segmentation, const LocalMeans& means)
        : hu_(scan.hu),
          segmentation_(segmentation),
          means_(means),
          spacingMm_(scan.hu.grid().spacingMm()) {}

    /// The line through gas voxel `v` along `axis` to `side`, if a face lies just beyond it.
    void addLine(glm::ivec3 v, int axis, int side, Lines& lines) const {
        const Grid& grid = hu_.grid();
        glm::ivec3 step(0);
        step[axis] = side;
        const int plateau = int(std::ceil(plateauMm / spacingMm_[axis]));
        const int reach = plateau + 4;
        if (!grid.contains(v - reach) || !grid.contains(v + reach)) return;
        const glm::ivec3 next = v + step;
        const auto label = LumenLabel(segmentation_.at(next));
        if (label == LumenLabel::bridge) return;
        const bool fluid = label == LumenLabel::tagged;
        const double low = means_.airHu.at(v.x, v.y, v.z);
        const double high =
            fluid ? means_.taggedHu.at(next) : means_.softHu.at(next.x, next.y, next.z);
        if (high - low < 500.0) return;
        const auto heightAt = [&](int n) { return (hu_.at(v + n * step) - low) / (high - low); };
        // Gas and contents or wall, and nothing else: the half height lies once on the line.
        int before = 0;
        while (before < 2 && heightAt(before + 1) < 0.5)
            ++before;
        const double below = heightAt(before), above = heightAt(before + 1);
        if (below >= 0.5 || above < 0.5) return;
        const double noise =
            3.0 * std::max(means_.noise.gas, fluid ? means_.noise.tagged : means_.noise.soft) /
                (high - low) +
            0.03;
        for (int n = 0; n <= 1; ++n) {
            if (std::abs(heightAt(before - plateau - n)) > noise ||
                std::abs(heightAt(before + 1 + plateau + n) - 1.0) > noise)
                return;
        }
        const auto normal = normalBetween(v + before * step, v + (before + 1) * step);
        if (!normal || side * (*normal)[axis] < leastAlong) return;
        const double from = normalQuantile(below), to = normalQuantile(above);
        if (std::max(-from, to) > 2.3) return;
        const double sdMm = spacingMm_[axis] * std::abs((*normal)[axis]) / (to - from);
        const int bin = int(sdMm / binMm);
        if (bin >= bins) return;
        // Inverse variance of to − from, for equal noise of both heights: a quantile q's is in
        // proportion to exp(q²).
        lines.weight[std::size_t(bin)] += 1.0 / (std::exp(from * from) + std::exp(to * to));
        lines.count += 1.0, lines.squares += *normal * *normal;
    }

private:
    std::optional<glm::dvec3> normalBetween(glm::ivec3 a, glm::ivec3 b) const {
        glm::dvec3 g(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 u(0);
            u[axis] = 1;
            for (const glm::ivec3 at : {a, b})
                g[axis] += (hu_.at(at + u) - hu_.at(at - u)) / spacingMm_[axis];
        }
        const double length = glm::length(g);
        if (length < 1.0) return std::nullopt;
        return g / length;
    }

    const Volume<std::int16_t>& hu_;
    const Volume<std::uint8_t>& segmentation_;
    const LocalMeans& means_;
    glm::dvec3 spacingMm_;
};

}  // namespace

PointSpread measurePointSpread(const CtScan& scan, const Volume<std::uint8_t>& segmentation,
                               const LocalMeans& means, int threads) {
    const Grid& grid = scan.hu.grid();
    const Faces faces(scan, segmentation, means);
    const auto isGas = [&](std::size_t n) {
        return LumenLabel(segmentation[n]) == LumenLabel::air;
    };
    std::vector<std::array<Lines, 3>> slices(std::size_t(grid.size.z));
    forVoxels(grid, threads, [&](std::size_t n, glm::ivec3 v) {
        if (!isGas(n)) return;
        visitFaces(grid, n, v, [&](std::size_t m, int axis) {
            if (!isGas(m))
                faces.addLine(v, axis, m > n ? 1 : -1, slices[std::size_t(v.z)][std::size_t(axis)]);
        });
    });
    std::array<Lines, 3> all;
    for (const auto& slice : slices) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            all[axis].add(slice[axis]);
    }
    // Σ (n_a σ_a)² of each axis' lines is their variance; an axis without lines is as the others.
    glm::dmat3 equations(0.0);
    glm::dvec3 variance(0.0), known(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const Lines& lines = all[std::size_t(axis)];
        if (lines.count < fewestLines) continue;
        const double sdMm = lines.medianMm();
        known[axis] = 1.0, variance[axis] = std::clamp(sdMm * sdMm, 0.04, 4.0);
        for (int b = 0; b < 3; ++b)
            equations[b][axis] = lines.squares[b] / lines.count;
    }
    const double others = known == glm::dvec3(0.0)
                              ? 0.25
                              : glm::dot(known, variance) / glm::dot(known, glm::dvec3(1.0));
    for (int axis = 0; axis < 3; ++axis) {
        if (known[axis] == 0.0) equations[axis][axis] = 1.0, variance[axis] = others;
    }
    const glm::dvec3 squares = glm::inverse(equations) * variance;
    return {glm::sqrt(glm::clamp(squares, 0.04, 4.0)), grid.spacingMm()};
}

}  // namespace haustra::cleansing
