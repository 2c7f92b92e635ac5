#include "phantom/scanner.h"

#include "core/parallel.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace haustra::phantom {
namespace {

constexpr double fwhmPerSigma = 2.354820045;

/// Half of a symmetric, normalised Gaussian kernel: centre first.
std::vector<float> gaussian(double sigmaVoxels) {
    if (sigmaVoxels < 0.15) return {1.0f};
    const int reach = std::max(1, int(std::ceil(2.6 * sigmaVoxels)));
    std::vector<double> w(reach + 1);
    double sum = 0.0;
    for (int n = 0; n <= reach; ++n) {
        w[n] = std::exp(-0.5 * n * n / (sigmaVoxels * sigmaVoxels));
        sum += n ? 2.0 * w[n] : w[n];
    }
    std::vector<float> kernel;
    for (double v : w)
        kernel.push_back(float(v / sum));
    return kernel;
}

/// Convolves `lines` neighbouring lines at once: element n of line m is data[n · stride + m].
void blurLines(float* data, int length, std::size_t stride, int lines,
               const std::vector<float>& kernel, std::vector<float>& copy) {
    copy.resize(std::size_t(length) * lines);
    for (int n = 0; n < length; ++n)
        std::copy_n(data + n * stride, lines, &copy[std::size_t(n) * lines]);
    for (int n = 0; n < length; ++n) {
        float* out = data + n * stride;
        const float* center = &copy[std::size_t(n) * lines];
        for (int m = 0; m < lines; ++m)
            out[m] = kernel[0] * center[m];
        for (int r = 1; r < int(kernel.size()); ++r) {
            const float* before = &copy[std::size_t(std::max(0, n - r)) * lines];
            const float* after = &copy[std::size_t(std::min(length - 1, n + r)) * lines];
            for (int m = 0; m < lines; ++m)
                out[m] += kernel[r] * (before[m] + after[m]);
        }
    }
}

void blurRow(float* row, int length, const std::vector<float>& kernel, std::vector<float>& padded) {
    const int reach = int(kernel.size()) - 1;
    padded.resize(std::size_t(length) + 2 * reach);
    std::fill_n(padded.begin(), reach, row[0]);
    std::copy_n(row, length, padded.begin() + reach);
    std::fill_n(padded.begin() + reach + length, reach, row[length - 1]);
    for (int i = 0; i < length; ++i)
        row[i] = kernel[0] * padded[std::size_t(i + reach)];
    for (int r = 1; r <= reach; ++r) {
        const float *a = &padded[std::size_t(reach - r)], *b = &padded[std::size_t(reach + r)];
        for (int i = 0; i < length; ++i)
            row[i] += kernel[r] * (a[i] + b[i]);
    }
}

void blurSlice(float* slice, glm::ivec2 size, const std::vector<float>& alongX,
               const std::vector<float>& alongY, std::vector<float>& scratch) {
    for (int j = 0; j < size.y; ++j)
        blurRow(slice + std::size_t(j) * size.x, size.x, alongX, scratch);
    blurLines(slice, size.y, std::size_t(size.x), size.x, alongY, scratch);
}

double sumOfSquares(const std::vector<float>& kernel) {
    double sum = double(kernel[0]) * kernel[0];
    for (std::size_t n = 1; n < kernel.size(); ++n)
        sum += 2.0 * double(kernel[n]) * kernel[n];
    return sum;
}

}  // namespace

void blur(Volume<float>& volume, glm::dvec3 fwhmMm, int threads) {
    const Grid grid = volume.grid();
    const glm::dvec3 sigma = fwhmMm / fwhmPerSigma / grid.spacingMm();
    const auto alongX = gaussian(sigma.x), alongY = gaussian(sigma.y), alongZ = gaussian(sigma.z);
    float* data = volume.writable().data();
    const std::size_t slice = std::size_t(grid.size.x) * grid.size.y;
    parallelFor(std::size_t(grid.size.z), 1, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> scratch;
        for (std::size_t k = begin; k < end; ++k) {
            blurSlice(data + k * slice, {grid.size.x, grid.size.y}, alongX, alongY, scratch);
        }
    });
    if (alongZ.size() == 1) return;
    parallelFor(std::size_t(grid.size.y), 4, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> scratch;
        for (std::size_t j = begin; j < end; ++j) {
            blurLines(data + j * grid.size.x, grid.size.z, slice, grid.size.x, alongZ, scratch);
        }
    });
}

void reconstruct(Volume<float>& volume, glm::dvec3 fwhmMm, double overshoot, int threads) {
    if (overshoot <= 0.0) return blur(volume, fwhmMm, threads);
    Volume<float> wide = volume.clone();
    blur(volume, fwhmMm, threads);
    blur(wide, fwhmMm * glm::dvec3(2.2, 2.2, 1.0), threads);
    const auto sharp = volume.writable();
    for (std::size_t n = 0; n < sharp.size(); ++n)
        sharp[n] += float(overshoot) * (sharp[n] - wide[n]);
}

void enhanceBesideTagging(Volume<float>& tagged, const Volume<float>& untagged, double edgeHu,
                          int threads) {
    constexpr double spreadMm = 16.0, stepHu = 1500.0;
    Volume<float> excess(tagged.grid());
    const auto added = excess.writable(), out = tagged.writable();
    for (std::size_t n = 0; n < added.size(); ++n)
        added[n] = std::max(0.0f, out[n] - untagged[n]);
    blur(excess, {spreadMm, spreadMm, 0.0}, threads);
    const float gain = float(edgeHu / (0.5 * stepHu));
    for (std::size_t n = 0; n < added.size(); ++n)
        out[n] += gain * added[n];
}

int blurReachSlices(const Grid& grid, glm::dvec3 fwhmMm) {
    return int(gaussian(fwhmMm.z / fwhmPerSigma / grid.spacingMm().z).size()) - 1;
}

Volume<std::int16_t> addNoise(const Volume<float>& clean, const Noise& noise, int threads) {
    Volume<std::int16_t> hu(clean.grid());
    addNoise(clean, 0, clean.grid().size.z, 0, noise, threads, hu.writable());
    return hu;
}

void addNoise(const Volume<float>& slab, int first, int count, int firstOfAll, const Noise& noise,
              int threads, std::span<std::int16_t> out) {
    const Grid& grid = slab.grid();
    const std::size_t slice = std::size_t(grid.size.x) * grid.size.y;
    const glm::dvec3 sigma = glm::dvec3(noise.correlationMm) / fwhmPerSigma / grid.spacingMm();
    const auto alongX = gaussian(sigma.x), alongY = gaussian(sigma.y);
    // Neighbouring slices of a helical scan share some of their noise.
    constexpr float beside = 0.25f;
    const double gain = noise.sdHu / std::sqrt(sumOfSquares(alongX) * sumOfSquares(alongY) *
                                               (1.0 + 2.0 * beside * beside));
    const std::uint64_t key = mixBits(noise.seed ^ 0x6E6F697365ull);
    parallelFor(std::size_t(count), 4, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<float> grain(slice), scratch;
        for (std::size_t k = begin; k < end; ++k) {
            for (std::size_t n = 0; n < slice; ++n) {
                // Slices are numbered from 1 so that the one below the first has a number too.
                const std::size_t v = (k + std::size_t(firstOfAll) + 1) * slice + n;
                grain[n] = whiteNoise(key, v) +
                           beside * (whiteNoise(key, v - slice) + whiteNoise(key, v + slice));
            }
            blurSlice(grain.data(), {grid.size.x, grid.size.y}, alongX, alongY, scratch);
            const float* in = slab.voxels().data() + (k + std::size_t(first)) * slice;
            for (std::size_t n = 0; n < slice; ++n) {
                const float v = std::clamp(in[n] + float(gain) * grain[n], -1024.0f, 3071.0f);
                out[k * slice + n] = std::int16_t(std::lrintf(v));
            }
        }
    });
}

}  // namespace haustra::phantom
