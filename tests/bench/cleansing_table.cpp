// What cleansing makes of phantoms as one scanner or another sees them, as a Markdown table.
// `--help` tells the options.
#include "cleansing/digital_cleansing.h"
#include "cleansing/mixture.h"
#include "cleansing/tissue_mixture.h"
#include "phantom/cleansing_score.h"
#include "segmentation/find_colon.h"

#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace haustra;

namespace {

const std::map<std::string, phantom::Preset> presets{{"easy", phantom::Preset::easy},
                                                     {"standard", phantom::Preset::standard},
                                                     {"hard", phantom::Preset::hard}};

Result<std::string> rowOf(const phantom::PhantomOptions& options) {
    const auto truth = TRY(phantom::makePhantom(options));
    const auto tissue = TRY(cleansing::fitTissueModel(truth.scan));
    const auto colon = TRY(segmentation::findColon(truth.scan, tissue));
    const auto mixture =
        TRY(cleansing::estimateMixture(truth.scan, tissue, colon.labels, colon.gravity));
    const auto cleansed = TRY(cleansing::cleanse(truth.scan, tissue, mixture, colon.labels));
    const auto score = TRY(phantom::scoreCleansing(truth, cleansed.hu));
    double voxels = 0.0, kept = 0.0;
    for (const phantom::SubmergedPolyp& polyp : score.polyps)
        voxels += double(polyp.voxels), kept += polyp.volumeShare * double(polyp.voxels);
    const auto region = [](const phantom::RegionError& error) {
        return fmt::format("{:.1f}, {:+.1f}", error.rmseHu, error.biasHu);
    };
    return fmt::format("{:.2f} | {:.1f} | {} | {} | {} | {} | {}, {:.1f}",
                       truth.scan.hu.grid().spacingMm().x, truth.noiseSdHu, region(score.fluid),
                       region(score.interface), region(score.wall), region(score.rim),
                       score.polyps.size(), voxels > 0.0 ? 100.0 * kept / voxels : 0.0);
}

}  // namespace

int main(int count, char** arguments) {
    CLI::App program("Scores the cleansing of phantoms by field of view and kernel.");
    phantom::PhantomOptions options;
    std::string preset = "standard", position = "supine";
    std::vector<double> fieldsMm = {0.0}, blurMm = {0.0, 0.0, 0.0};
    program.add_option("--preset", preset)->check(CLI::IsMember(presets))->capture_default_str();
    program.add_option("--position", position)->capture_default_str();
    program.add_option("--seed", options.seed)->capture_default_str();
    program.add_option("--field", fieldsMm, "Fields of view, mm; a pixel is a 512th");
    program.add_option("--blur", blurMm, "Point spread along x, y, z, full width, mm")->expected(3);
    program.add_option("--overshoot", options.scan.overshoot, "Of a sharp kernel, 0 to 0.6");
    program.add_option("--noise", options.scan.noiseSdHu, "HU");
    program.add_option("--pseudo", options.scan.pseudoEnhancementHu, "At a pool's edge, HU");
    CLI11_PARSE(program, count, arguments);
    options.preset = presets.at(preset);
    options.position = patientPositionFromString(position);
    options.scan.blurMm = {blurMm[0], blurMm[1], blurMm[2]};
    fmt::print(
        "| phantom | pixel mm | noise sd | fluid RMSE, bias | interface | wall | rim | "
        "submerged polyps: n, kept % |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    bool failed = false;
    for (const double field : fieldsMm) {
        options.scan.fieldOfViewMm = field;
        const auto row = rowOf(options);
        failed = failed || !row;
        fmt::print("| {} {} {} | {} |\n", preset, position, options.seed,
                   row ? *row : describe(row.error()));
    }
    return failed ? 1 : 0;
}
