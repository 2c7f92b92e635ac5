#include "cli/flat_image_export.h"

#include "cli/arguments.h"
#include "cli/caption.h"
#include "cli/case_scans.h"
#include "cli/interruption.h"
#include "cli/number_range.h"
#include "cli/progress_bar.h"
#include "cli/provenance.h"
#include "cli/wall_paint.h"
#include "core/strip_layout.h"
#include "gpu/context.h"
#include "render/strip_picture.h"
#include "store/products.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {

namespace fs = std::filesystem;

namespace product = store::product;

void addFlatImageOptions(CLI::App& command, FlatImageOptions& options) {
    options.transferFunction = render::opticsPresets().front();
    const auto group = command.add_option_group(
        product::flatImage, std::string("Of ") + product::flatImage + " alone:");
    group->add_option("--width", options.width, "Pixels of the colon's circumference")
        ->type_name("W")
        ->check(CLI::Range(1, render::maxPixelsPerUnit))
        ->capture_default_str();
    group
        ->add_option("--seam-margin", options.seamMargin,
                     "How much of the circumference is repeated beyond the seam on either side")
        ->type_name("M")
        ->check(numberRange(0.0, 0.5))
        ->capture_default_str();
    group->add_option("--transfer-function", options.transferFunction, "Colours")
        ->check(CLI::IsMember(render::opticsPresets()))
        ->capture_default_str();
    group->add_flag("--caption", options.caption,
                    "Draw the strip's ends and a scale of millimetres along the centerline, and "
                    "around findings rings with their numbers");
    auto* findings = group->add_flag(
        "--findings", options.findings,
        "Colour the case's findings green, and violet what scored lower and is asked "
        "for (--least-probability)");
    group
        ->add_option("--least-probability", options.leastProbability,
                     "And the candidates below the operating point that are so probable to be a "
                     "polyp")
        ->type_name("P")
        ->check(numberRange(0.0, 1.0))
        ->needs(findings);
    addThreadsOption(*group, options.threads);
}

namespace {

/// The most --width with which a strip `height` circumferences long, its margins with it, is a
/// picture that `file` holds.
double widestStrip(const fs::path& file, double height, double seamMargin) {
    const double side = pictures::mostSide(file);
    const double across = (side - 1.0) / (1.0 + 2.0 * seamMargin),  // either margin is rounded
        along = std::min(double(render::maxStripRows), side) / height;
    return std::floor(std::min({double(render::maxPixelsPerUnit), across, along}));
}

}  // namespace

Result<void> exportFlatImage(const store::Case& source, const fs::path& file,
                             const FlatImageOptions& options) {
    auto map = TRY(source.readFlatMap());
    const double height = map.height;
    auto function = TRY(render::opticsPreset(options.transferFunction));
    render::StripPicture picture{options.width, options.seamMargin, std::move(function), {}};
    const double widest = widestStrip(file, height, options.seamMargin);
    if (options.width > widest) {
        return fail(ErrorKind::badInput,
                    fmt::format("a strip {:.4g} circumferences long fits a {} picture up to "
                                "--width {:.0f}",
                                height, file.extension().string(), widest),
                    file.string());
    }
    const auto size = TRY(render::stripPictureSize(picture, height));

    const auto scans = TRY(readCaseScans(source, false));
    pictures::Provenance provenance = ownProvenance();
    provenance.facts = {{"case", source.name()}, {"view", product::flatImage}};
    addProduct(provenance, source,
               scans.cleansed.voxels().empty() ? product::ct : product::cleansed);
    addProduct(provenance, source, product::flatMap);
    if (options.findings) addProduct(provenance, source, product::findings);
    provenance.facts.insert(provenance.facts.end(),
                            {{"pixels_per_circumference", std::to_string(options.width)},
                             {"seam_margin", fmt::format("{}", options.seamMargin)},
                             {"raycaster", toString(render::RendererOptions{}.raycaster)},
                             {"transfer_function", options.transferFunction}});
    auto prepared = TRY(render::prepareCase(scans.ct, scans.cleansed, options.threads));
    prepared.flatMap = std::make_shared<const FlatMap>(std::move(map));
    PaintedFindings painted;
    if (options.findings)
        painted = TRY(paintFindings(source, prepared.flatMap, options.leastProbability));
    else
        painted.paint = TRY(paintBridges(source, prepared.flatMap, nullptr));
    picture.paint = painted.paint;
    pictures::Marks marks;
    if (options.caption) {
        const FlatWindow whole{{0.5, 0.5 * size.y / options.width}, double(options.width)};
        std::vector<NumberedPlace> places;
        for (const PaintedFindings::Place& finding : painted.places)
            for (const double turn : {-1.0, 0.0, 1.0})  // beyond the seam in its margins, too
                places.push_back({finding.number,
                                  whole.pixelFromFlat(finding.flat + glm::dvec2(turn, 0.0), size),
                                  finding.color});
        marks = TRY(stripCaption(*prepared.flatMap, size, places));
    }
    auto context = TRY(gpu::Context::create());
    auto renderer = TRY(
        render::CaseRenderer::upload(*context, std::move(prepared), {.threads = options.threads}));

    const Interruption interruption;  // outlives the picture, which then takes back what it wrote
    const auto output = TRY(pictures::createPicture(file, size.x, size.y, provenance));
    ProgressBar bar;
    int rows = 0;
    return render::drawStrip(*renderer, picture, height,
                             [&](const Image& band) -> Result<void> {
                                 rows += band.height;
                                 bar.show("flat image", double(rows) / size.y);
                                 if (interruption.came())
                                     return fail(ErrorKind::io, "interrupted", file.string());
                                 if (!options.caption) return output->append(band);
                                 Image marked = band;
                                 TRY(pictures::draw(marks, marked, rows - band.height));
                                 return output->append(marked);
                             })
        .and_then([&] { return output->finish(); });
}

}  // namespace haustra::cli
