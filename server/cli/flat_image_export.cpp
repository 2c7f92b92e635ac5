#include "cli/flat_image_export.h"

#include "cli/arguments.h"
#include "cli/bridge_paint.h"
#include "cli/case_scans.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "gpu/context.h"
#include "render/flat/strip_picture.h"
#include "render/png_file.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {

void addFlatImageOptions(CLI::App& command, FlatImageOptions& options) {
    options.transferFunction = render::opticsPresets().front();
    const auto group = command.add_option_group("flat-image", "Of flat-image alone:");
    group->add_option("--width", options.width, "Pixels of the colon's circumference")
        ->type_name("W")
        ->check(CLI::Range(1, render::maxPixelsPerUnit))
        ->capture_default_str();
    group
        ->add_option("--seam-margin", options.seamMargin,
                     "How much of the circumference is repeated beyond the seam on either side")
        ->type_name("M")
        ->check(CLI::Range(0.0, 0.5))
        ->capture_default_str();
    group->add_option("--transfer-function", options.transferFunction, "Colours")
        ->check(CLI::IsMember(render::opticsPresets()))
        ->capture_default_str();
    addThreadsOption(*group, options.threads);
}

Result<void> exportFlatImage(const store::Case& source, const std::filesystem::path& file,
                             const FlatImageOptions& options) {
    auto map = source.readFlatMap();
    if (!map) return tl::make_unexpected(map.error());
    const double height = map->height;
    auto function = render::opticsPreset(options.transferFunction);
    if (!function) return tl::make_unexpected(function.error());
    render::StripPicture picture{options.width, options.seamMargin, std::move(*function), {}};
    const double widest = std::min(double(render::maxPixelsPerUnit),
                                   std::floor(double(render::maxStripRows) / height));
    if (options.width > widest) {
        return fail(ErrorKind::badInput,
                    fmt::format("a strip {:.4g} circumferences long fits a picture up to --width "
                                "{:.0f}",
                                height, widest),
                    "flat image");
    }
    const auto size = render::stripPictureSize(picture, height);
    if (!size) return tl::make_unexpected(size.error());

    const auto scans = readCaseScans(source, false);
    if (!scans) return tl::make_unexpected(scans.error());
    auto prepared = render::prepareCase(scans->ct, scans->cleansed, options.threads);
    if (!prepared) return tl::make_unexpected(prepared.error());
    prepared->flatMap = std::make_shared<const FlatMap>(std::move(*map));
    auto paint = paintBridges(source, prepared->flatMap, nullptr);
    if (!paint) return tl::make_unexpected(paint.error());
    picture.paint = std::move(*paint);
    auto context = gpu::Context::create();
    if (!context) return tl::make_unexpected(context.error());
    auto renderer =
        render::CaseRenderer::upload(**context, std::move(*prepared), {.threads = options.threads});
    if (!renderer) return tl::make_unexpected(renderer.error());

    const Interruption interruption;  // outlives the picture, which then takes back what it wrote
    auto png = render::PngFile::create(file, size->x, size->y);
    if (!png) return tl::make_unexpected(png.error());
    ProgressBar bar;
    int rows = 0;
    return render::drawStrip(**renderer, picture, height,
                             [&](const render::Image& band) -> Result<void> {
                                 rows += band.height;
                                 bar.show("flat image", double(rows) / size->y);
                                 if (interruption.came())
                                     return fail(ErrorKind::io, "interrupted", file.string());
                                 return png->append(band);
                             })
        .and_then([&] { return png->finish(); });
}

}  // namespace haustra::cli
