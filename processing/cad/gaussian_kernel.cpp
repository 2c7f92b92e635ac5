#include "cad/gaussian_kernel.h"

#include <cmath>

namespace haustra::cad {

std::vector<float> gaussianKernel(double sigmaVoxels) {
    const int reach = int(std::ceil(kernelDeviations * sigmaVoxels));
    std::vector<float> kernel;
    double sum = 0.0;
    for (int n = -reach; n <= reach; ++n)
        sum += kernel.emplace_back(
            float(sigmaVoxels > 0.0 ? std::exp(-0.5 * n * n / (sigmaVoxels * sigmaVoxels)) : 1.0));
    for (float& weight : kernel)
        weight = float(weight / sum);
    return kernel;
}

}  // namespace haustra::cad
