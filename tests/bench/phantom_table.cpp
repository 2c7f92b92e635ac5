// How well the lumen and its centerline are found on phantoms of every preset in both positions,
// against the truth, as a Markdown table.
//
//   phantom_table [--small] [--seed N] [--seeds COUNT]

#include "cleansing/tissue_mixture.h"
#include "phantom/phantom.h"
#include "phantom/score.h"
#include "topology/centerline_path.h"
#include "topology/distance_field.h"
#include "topology/lumen.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace haustra;

namespace {

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

struct Outcome {
    phantom::LumenScore score;
    double phantomSeconds = 0, lumenSeconds = 0, centerlineSeconds = 0;
    double lengthMm = 0, lumenMl = 0;
};

Result<Outcome> examine(const phantom::PhantomOptions& options) {
    Outcome outcome;
    double start = now();
    const auto lap = [&] {
        const double then = start;
        start = now();
        return start - then;
    };
    const auto truth = phantom::makePhantom(options);
    if (!truth) return tl::make_unexpected(truth.error());
    outcome.phantomSeconds = lap();
    outcome.lengthMm = truth->centerline.lengthMm();
    for (std::uint8_t label : truth->lumen.voxels())
        outcome.lumenMl += label != 0;
    outcome.lumenMl *= truth->lumen.grid().voxelVolumeMm3() * 1e-3;

    start = now();
    const auto tissue = cleansing::fitTissueModel(truth->scan);
    if (!tissue) return tl::make_unexpected(tissue.error());
    const auto lumen = topology::findLumen(truth->scan, *tissue);
    if (!lumen) return tl::make_unexpected(lumen.error());
    outcome.lumenSeconds = lap();
    const auto distance = topology::distanceToBoundaryMm(lumen->labels);
    const auto traced = topology::traceCenterline(lumen->labels, distance);
    outcome.centerlineSeconds = lap();

    // A lumen without a centerline still has a score of its own.
    const auto score = phantom::scoreLumen(truth->lumen, truth->centerline, lumen->labels,
                                           traced ? traced->centerline : Centerline{});
    if (!score) return tl::make_unexpected(score.error());
    outcome.score = *score;
    return outcome;
}

}  // namespace

int main(int count, char** arguments) {
    phantom::PhantomOptions options;
    int seeds = 1;
    for (int n = 1; n < count; ++n) {
        const bool more = n + 1 < count;
        if (!std::strcmp(arguments[n], "--small")) {
            options.size = phantom::Size::small;
        } else if (!std::strcmp(arguments[n], "--seed") && more) {
            options.seed = std::strtoull(arguments[++n], nullptr, 10);
        } else if (!std::strcmp(arguments[n], "--seeds") && more) {
            seeds = std::atoi(arguments[++n]);
        } else {
            std::fprintf(stderr, "usage: phantom_table [--small] [--seed N] [--seeds COUNT]\n");
            return 2;
        }
    }
    std::printf(
        "| preset | position | seed | length mm | lumen ml | Dice | air | tagged | missed line mm "
        "(%%) | missed ml | "
        "false ml | over ml | centerline error mm, mean / max | seconds: phantom, lumen, "
        "centerline |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    bool failed = false;
    const std::uint64_t first = options.seed;
    for (int s = 0; s < seeds; ++s) {
        options.seed = first + std::uint64_t(s);
        for (const auto preset :
             {phantom::Preset::easy, phantom::Preset::standard, phantom::Preset::hard}) {
            for (const auto position : {PatientPosition::supine, PatientPosition::prone}) {
                options.preset = preset, options.position = position;
                const char* name = preset == phantom::Preset::easy       ? "easy"
                                   : preset == phantom::Preset::standard ? "standard"
                                                                         : "hard";
                const auto outcome = examine(options);
                std::printf("| %s | %s | %llu | ", name, toString(position),
                            (unsigned long long)options.seed);
                if (outcome) {
                    const phantom::LumenScore& score = outcome->score;
                    std::printf(
                        "%.0f | %.0f | %.4f | %.4f | %.4f | %.0f (%.2f) | %.1f | %.1f | %.1f | "
                        "%.2f / %.1f | "
                        "%.1f, %.1f, %.1f |\n",
                        outcome->lengthMm, outcome->lumenMl, score.dice, score.diceAir,
                        score.diceTagged, score.missedCenterlineMm,
                        100.0 * score.missedCenterlineShare, score.missedMl, score.falseMl,
                        score.overMl, score.centerlineMeanErrorMm, score.centerlineMaxErrorMm,
                        outcome->phantomSeconds, outcome->lumenSeconds, outcome->centerlineSeconds);
                } else {
                    std::printf("%s |\n", describe(outcome.error()).c_str());
                    failed = true;
                }
                std::fflush(stdout);
            }
        }
    }
    return failed ? 1 : 0;
}
