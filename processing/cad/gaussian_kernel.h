// Weighted sums along lines of a volume.
#pragma once

#include <vector>

namespace haustra::cad {

/// How far to either side weights reach, in standard deviations.
inline constexpr double kernelDeviations = 3.0;

/// A Gaussian's weights at whole numbers, kernelDeviations to either side and up to the next whole
/// number, of sum 1; of a deviation of 0 the one weight 1.
std::vector<float> gaussianKernel(double sigmaVoxels);

/// out = Σ kernel[reach + n] · line(n), of lines of `count` numbers, for a symmetric kernel of an
/// odd length; line(n) and line(−n) are added first, as they have one weight.
template <class Line>
void weightedSum(const std::vector<float>& kernel, const Line& line, int count, float* out) {
    const int reach = int(kernel.size()) / 2;
    const float* middle = line(0);
    for (int i = 0; i < count; ++i)
        out[i] = kernel[std::size_t(reach)] * middle[i];
    for (int n = 1; n <= reach; ++n) {
        const float *before = line(-n), *after = line(n);
        const float weight = kernel[std::size_t(reach + n)];
        for (int i = 0; i < count; ++i)
            out[i] += weight * (before[i] + after[i]);
    }
}

}  // namespace haustra::cad
