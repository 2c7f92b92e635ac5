// What cutting handles does to masks: one line of a table for each NIfTI mask given.
// Arguments: [--threads N] [--write FOLDER] mask…
#include "centerline/path.h"
#include "nifti/nifti_file.h"
#include "stopwatch.h"
#include "topology/distance_field.h"
#include "topology/handle_cutting.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace haustra {
namespace {

using bench::cpuMilliseconds, bench::milliseconds;

void printHeader() {
    std::printf("%-24s %10s %6s %9s %8s | %6s %6s %8s %8s %6s %6s | %10s %6s %6s\n", "mask",
                "voxels", "pieces", "cavities", "handles", "ball", "filled", "removed", "added",
                "s", "cpu s", "line mm", "s", "cpu s");
}

bool printLine(const std::filesystem::path& file, int threads, const std::string& folder) {
    const auto mask = nifti::readNifti<std::uint8_t>(file);
    if (!mask) {
        std::fprintf(stderr, "%s\n", describe(mask.error()).c_str());
        return false;
    }
    const topology::DigitalTopology before = topology::digitalTopology(*mask, threads);
    const std::size_t voxels = topology::maskOf(*mask, threads).count();
    double wall = milliseconds(), cpu = cpuMilliseconds();
    topology::HandleCuttingOptions options;
    options.threads = threads;
    const auto cut = topology::cutHandles(*mask, options);
    if (!cut) {
        std::fprintf(stderr, "%s: %s\n", file.c_str(), describe(cut.error()).c_str());
        return false;
    }
    std::printf("%-24s %10zu %6ld %9ld %8ld | %6s %6ld %8zu %8zu %6.2f %6.2f | ",
                file.filename().c_str(), voxels, before.components, before.cavities,
                before.handles(), topology::isBallEitherWay(cut->labels, threads) ? "yes" : "NO",
                cut->cavitiesFilled, cut->voxelsRemoved, cut->voxelsAdded,
                1e-3 * (milliseconds() - wall), 1e-3 * (cpuMilliseconds() - cpu));
    wall = milliseconds(), cpu = cpuMilliseconds();
    centerline::CenterlineOptions tracing;
    tracing.threads = threads;
    const auto traced = centerline::traceCenterline(
        cut->labels, topology::distanceToBoundaryMm(cut->labels, threads), tracing);
    std::printf("%10.0f %6.2f %6.2f\n", traced ? traced->centerline.lengthMm() : 0.0,
                1e-3 * (milliseconds() - wall), 1e-3 * (cpuMilliseconds() - cpu));
    for (const std::string& note : cut->notes)
        std::printf("    %s\n", note.c_str());
    if (folder.empty()) return true;
    const auto written = nifti::writeNifti<std::uint8_t>(
        std::filesystem::path(folder) / file.filename(), cut->labels);
    if (!written) std::fprintf(stderr, "%s\n", describe(written.error()).c_str());
    return written.has_value();
}

}  // namespace
}  // namespace haustra

int main(int count, char** arguments) {
    std::vector<std::filesystem::path> masks;
    std::string folder;
    int threads = 0;
    for (int n = 1; n < count; ++n) {
        const std::string argument = arguments[n];
        if (argument == "--threads" && n + 1 < count)
            threads = std::atoi(arguments[++n]);
        else if (argument == "--write" && n + 1 < count)
            folder = arguments[++n];
        else
            masks.emplace_back(argument);
    }
    if (masks.empty()) {
        std::fprintf(stderr,
                     "usage: handle_cutting_bench [--threads N] [--write FOLDER] mask...\n");
        return 2;
    }
    haustra::printHeader();
    bool all = true;
    for (const auto& mask : masks)
        all = haustra::printLine(mask, threads, folder) && all;
    return all ? 0 : 1;
}
