#include "cli/biopsy_export.h"

#include "cad/biopsy_image.h"
#include "cad/biopsy_transfer.h"
#include "cad/wall_evidence.h"
#include "cli/provenance.h"
#include "pictures/picture_file.h"
#include "pipeline/colon_inputs.h"
#include "store/products.h"

#include <chrono>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {

namespace product = store::product;

void addBiopsyImageOptions(CLI::App& command, BiopsyImageOptions& options) {
    const auto group =
        command.add_option_group(product::biopsy, std::string("Of ") + product::biopsy + " alone:");
    group->add_option("--length", options.length, "Pixels from the rectum to the cecum")
        ->type_name("N")
        ->check(CLI::Range(1, 32000))
        ->capture_default_str();
    group->add_option("--around", options.around, "Pixels once around the colon")
        ->type_name("N")
        ->check(CLI::Range(1, 8000))
        ->capture_default_str();
    group->add_option("--finer", options.finer, "Rays a pixel along either side")
        ->type_name("N")
        ->check(CLI::Range(1, 8))
        ->capture_default_str();
    group->add_flag("--fixed-transfer", options.fixedTransfer,
                    "The transfer function of the preset biopsy, not one derived from the scan");
}

Result<void> exportBiopsyImage(const store::Case& source, const std::filesystem::path& file,
                               const BiopsyImageOptions& options) {
    // Each keeps its place of the wall, twelve bytes.
    constexpr double mostRays = 300e6;
    const double rays = double(options.length) * options.around * options.finer * options.finer;
    if (rays > mostRays)
        throw CLI::ValidationError(
            "--length", fmt::format("{:.0f} million rays are more than {:.0f} million; ask for "
                                    "fewer pixels or less of --finer",
                                    rays / 1e6, mostRays / 1e6));
    const auto inputs =
        TRY(pipeline::readColon(source, {source.find(product::quality).has_value(),
                                         source.find(product::cleansed).has_value()}));
    const cad::PreparedColon colon = inputs.colon();
    const cad::SmoothScan smooth = cad::smoothedAround(colon, cad::shapeSigmaMm, options.threads);
    const cad::WallStatistics statistics = cad::wallStatistics(colon, smooth);
    const cad::BiopsyTable table(options.fixedTransfer ? cad::fixedBiopsyTransfer()
                                                       : cad::automaticBiopsyTransfer(statistics));
    const auto begun = std::chrono::steady_clock::now();
    const Image image =
        cad::biopsyImage({smooth, colon.lumen, colon.tissue.airBelowHu}, colon.flat, table,
                         {options.length, options.around}, options.finer, options.threads);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
    pictures::Provenance provenance = ownProvenance();
    provenance.facts = {{"case", source.name()}, {"view", product::biopsy}};
    addProduct(provenance, source,
               source.find(product::cleansed) ? product::cleansed : product::ct);
    addProduct(provenance, source, product::flatMap);
    provenance.facts.insert(provenance.facts.end(),
                            {{"transfer_function", options.fixedTransfer ? "biopsy" : "automatic"},
                             {"wall_hu", fmt::format("{:.1f}", statistics.wallHu)},
                             {"fat_hu", fmt::format("{:.1f}", statistics.fatHu)},
                             {"noise_hu", fmt::format("{:.1f}", statistics.noiseHu)}});
    TRY(pictures::writePicture(file, image, provenance));
    fmt::print(
        "{} x {} pixels, {} ray(s) each, in {:.2f} s; wall {:.0f} HU, fat {:.0f} HU, noise "
        "{:.0f} HU\n",
        options.length, options.around, options.finer * options.finer, took.count(),
        statistics.wallHu, statistics.fatHu, statistics.noiseHu);
    return {};
}

}  // namespace haustra::cli
