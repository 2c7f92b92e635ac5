// The distance field's time, beside ITK's Maurer filter on the same 512³ masks where ITK is found.
// Arguments: mask (0: a colon-like coil, 1: half the volume), threads.
#include "topology/distance_field.h"
#include "tube_phantom.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <benchmark/benchmark.h>

#ifdef HAUSTRA_BENCH_ITK
#include <itkImage.h>
#include <itkMultiThreaderBase.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>
#endif

namespace haustra::topology {
namespace {

Volume<std::uint8_t> coil(const Grid& grid) {
    Volume<std::uint8_t> mask(grid, std::uint8_t(0));
    const glm::dvec3 middle = 0.5 * grid.spacingMm() * glm::dvec3(grid.size);
    tests::fillTube(mask,
                    tests::sampleCurve(
                        [&](double t) {
                            const double a = 12.0 * t;
                            return middle + glm::dvec3(110.0 * std::cos(a), 90.0 * std::sin(a),
                                                       360.0 * (t - 0.5));
                        },
                        800),
                    22.0);
    return mask;
}

/// Rounded cells, inside and outside alike.
Volume<std::uint8_t> cells(const Grid& grid) {
    Volume<std::uint8_t> mask(grid);
    auto voxels = mask.writable();
    for (int k = 0; k < grid.size.z; ++k) {
        for (int j = 0; j < grid.size.y; ++j) {
            for (int i = 0; i < grid.size.x; ++i) {
                voxels[grid.index(i, j, k)] =
                    std::sin(0.05 * i) + std::sin(0.06 * j) + std::sin(0.045 * k) > 0.0;
            }
        }
    }
    return mask;
}

const Volume<std::uint8_t>& maskNumber(std::int64_t number) {
    static const Grid grid = axisAlignedGrid({512, 512, 512}, {0.8, 0.8, 1.0});
    static const Volume<std::uint8_t> masks[] = {coil(grid), cells(grid)};
    return masks[number];
}

void haustraDistance(benchmark::State& state) {
    const Volume<std::uint8_t>& mask = maskNumber(state.range(0));
    for (auto _ : state) {
        benchmark::DoNotOptimize(distanceToBoundaryMm(mask, int(state.range(1))).voxels().data());
    }
}

#ifdef HAUSTRA_BENCH_ITK
void itkMaurerDistance(benchmark::State& state) {
    using Mask = itk::Image<std::uint8_t, 3>;
    using Distance = itk::Image<float, 3>;
    const Volume<std::uint8_t>& mask = maskNumber(state.range(0));
    const Volume<float> ours = distanceToBoundaryMm(mask);
    const glm::ivec3 size = mask.grid().size;
    const glm::dvec3 spacing = mask.grid().spacingMm();
    auto image = Mask::New();
    image->SetRegions(
        Mask::SizeType{{std::size_t(size.x), std::size_t(size.y), std::size_t(size.z)}});
    image->SetSpacing(&spacing.x);
    image->Allocate();
    // ITK measures to the nearest object voxel: make the outside the object.
    for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n)
        image->GetBufferPointer()[n] = mask[n] == 0;
    itk::MultiThreaderBase::SetGlobalMaximumNumberOfThreads(unsigned(state.range(1)));
    double worstMm = 0.0;
    for (auto _ : state) {
        auto filter = itk::SignedMaurerDistanceMapImageFilter<Mask, Distance>::New();
        filter->SetInput(image);
        filter->UseImageSpacingOn();
        filter->SquaredDistanceOff();
        filter->SetNumberOfWorkUnits(unsigned(state.range(1)));
        filter->Update();
        state.PauseTiming();
        const float* theirs = filter->GetOutput()->GetBufferPointer();
        worstMm = 0.0;
        for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
            if (mask[n]) worstMm = std::max(worstMm, std::abs(double(theirs[n]) - double(ours[n])));
        }
        state.ResumeTiming();
    }
    state.counters["largest_difference_mm"] = worstMm;
}
BENCHMARK(itkMaurerDistance)
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
#endif

BENCHMARK(haustraDistance)
    ->ArgsProduct({{0, 1}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace haustra::topology

BENCHMARK_MAIN();
