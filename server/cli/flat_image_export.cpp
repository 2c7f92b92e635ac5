#include "cli/flat_image_export.h"

#include "cli/arguments.h"
#include "cli/bridge_paint.h"
#include "cli/case_scans.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "gpu/context.h"
#include "render/png_file.h"
#include "render/strip_picture.h"

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
    auto map = TRY(source.readFlatMap());
    const double height = map.height;
    auto function = TRY(render::opticsPreset(options.transferFunction));
    render::StripPicture picture{options.width, options.seamMargin, std::move(function), {}};
    const double widest = std::min(double(render::maxPixelsPerUnit),
                                   std::floor(double(render::maxStripRows) / height));
    if (options.width > widest) {
        return fail(ErrorKind::badInput,
                    fmt::format("a strip {:.4g} circumferences long fits a picture up to --width "
                                "{:.0f}",
                                height, widest),
                    "flat image");
    }
    const auto size = TRY(render::stripPictureSize(picture, height));

    const auto scans = TRY(readCaseScans(source, false));
    auto prepared = TRY(render::prepareCase(scans.ct, scans.cleansed, options.threads));
    prepared.flatMap = std::make_shared<const FlatMap>(std::move(map));
    auto paint = TRY(paintBridges(source, prepared.flatMap, nullptr));
    picture.paint = std::move(paint);
    auto context = TRY(gpu::Context::create());
    auto renderer = TRY(
        render::CaseRenderer::upload(*context, std::move(prepared), {.threads = options.threads}));

    const Interruption interruption;  // outlives the picture, which then takes back what it wrote
    auto png = TRY(render::PngFile::create(file, size.x, size.y));
    ProgressBar bar;
    int rows = 0;
    return render::drawStrip(*renderer, picture, height,
                             [&](const render::Image& band) -> Result<void> {
                                 rows += band.height;
                                 bar.show("flat image", double(rows) / size.y);
                                 if (interruption.came())
                                     return fail(ErrorKind::io, "interrupted", file.string());
                                 return png.append(band);
                             })
        .and_then([&] { return png.finish(); });
}

}  // namespace haustra::cli
