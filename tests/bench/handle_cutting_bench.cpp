// What cutting handles does to masks: one line of a table for each NIfTI mask given.
// Arguments: [--threads N] [--write FOLDER] mask…
#include "nifti/nifti_file.h"
#include "topology/centerline_path.h"
#include "topology/distance_field.h"
#include "topology/handle_cutting.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/resource.h>

namespace haustra::topology {
namespace {

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}
double cpuSeconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    return double(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * double(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

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
    const DigitalTopology before = digitalTopology(*mask, threads);
    const std::size_t voxels = maskOf(*mask, threads).count();
    double wall = seconds(), cpu = cpuSeconds();
    HandleCuttingOptions options;
    options.threads = threads;
    const auto cut = cutHandles(*mask, options);
    if (!cut) {
        std::fprintf(stderr, "%s: %s\n", file.c_str(), describe(cut.error()).c_str());
        return false;
    }
    std::printf("%-24s %10zu %6ld %9ld %8ld | %6s %6ld %8zu %8zu %6.2f %6.2f | ",
                file.filename().c_str(), voxels, before.components, before.cavities,
                before.handles(), digitalTopology(cut->labels, threads).isBall() ? "yes" : "NO",
                cut->cavitiesFilled, cut->voxelsRemoved, cut->voxelsAdded, seconds() - wall,
                cpuSeconds() - cpu);
    wall = seconds(), cpu = cpuSeconds();
    CenterlineOptions centerline;
    centerline.threads = threads;
    const auto traced =
        traceCenterline(cut->labels, distanceToBoundaryMm(cut->labels, threads), centerline);
    std::printf("%10.0f %6.2f %6.2f\n", traced ? traced->centerline.lengthMm() : 0.0,
                seconds() - wall, cpuSeconds() - cpu);
    for (const std::string& note : cut->notes)
        std::printf("    %s\n", note.c_str());
    if (folder.empty()) return true;
    const auto written = nifti::writeNifti<std::uint8_t>(
        std::filesystem::path(folder) / file.filename(), cut->labels);
    if (!written) std::fprintf(stderr, "%s\n", describe(written.error()).c_str());
    return written.has_value();
}

}  // namespace
}  // namespace haustra::topology

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
    haustra::topology::printHeader();
    bool all = true;
    for (const auto& mask : masks)
        all = haustra::topology::printLine(mask, threads, folder) && all;
    return all ? 0 : 1;
}
