// haustra render: one picture of a case, as the server draws it.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/text_files.h"
#include "core/centerline.h"
#include "gpu/context.h"
#include "render/case_renderer.h"
#include "render/comparison.h"
#include "render/png_file.h"
#include "store/case_store.h"

#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

struct Arguments {
    fs::path store, out;
    std::string caseName, view = "endoscopic", direction = "antegrade";
    std::string product;  // empty: what the view shows by itself
    bool compare = false;
    std::string preset = render::transferFunctionPresets().front();
    std::optional<double> arcMm;
    std::vector<glm::dvec3> positionMm;
    double fovDegrees = render::Camera{}.fovDegrees, zoom = 1.0;
    glm::ivec2 size{512, 512};
    render::WindowLevel window;
    int threads = 0;
};

Result<render::EndoscopicView> endoscopicView(const Arguments& arguments,
                                              const Centerline& centerline) {
    auto preset = render::transferFunctionPreset(arguments.preset);
    if (!preset) return tl::make_unexpected(preset.error());
    const CenterlineCamera onPath = cameraAtArc(
        centerline, rotationMinimizingUps(centerline, flightPreferredUp), *arguments.arcMm,
        arguments.direction == "antegrade" ? FlightDirection::antegrade
                                           : FlightDirection::retrograde);
    render::EndoscopicView view;
    view.camera = {onPath.positionMm, onPath.forward, onPath.up, arguments.fovDegrees};
    view.transferFunction = std::move(*preset);
    return view;
}

struct Scans {
    Volume<std::int16_t> ct;
    Volume<std::int16_t> cleansed;  // empty where it is not drawn
};

Result<Scans> readScans(const Arguments& arguments, const store::Case& source) {
    auto ct = source.readVolume<std::int16_t>("ct");
    if (!ct) return tl::make_unexpected(ct.error());
    Scans scans{std::move(*ct), {}};
    const bool asked = arguments.compare || arguments.product == "cleansed";
    const bool wanted = asked || (arguments.view == "endoscopic" && arguments.product.empty());
    if (!wanted) return scans;
    if (!asked && !source.find("cleansed")) {
        fmt::print(stderr,
                   "haustra: note: case {} has no cleansed scan; the picture shows the scan as it "
                   "is, with its residue\n",
                   source.name());
        return scans;
    }
    auto cleansed = source.readVolume<std::int16_t>("cleansed");
    if (!cleansed) return tl::make_unexpected(cleansed.error());
    scans.cleansed = std::move(*cleansed);
    return scans;
}

/// Before, classification and after, each as a slice of its own would be.
Result<render::Image> compare(render::CaseRenderer& renderer,
                              const Volume<TissueFractions>& mixture, render::SliceView slice,
                              glm::ivec2 size) {
    auto before = renderer.render(slice, size.x, size.y);
    if (!before) return before;
    auto tissues = render::tissuePicture(mixture, slice, size.x, size.y);
    if (!tissues) return tissues;
    slice.scan = render::Scan::cleansed;
    auto after = renderer.render(slice, size.x, size.y);
    if (!after) return after;
    return render::sideBySide({std::move(*before), std::move(*tissues), std::move(*after)});
}

Result<render::Image> draw(const Arguments& arguments, const store::Case& source) {
    const auto plane = render::viewFromString(arguments.view);
    if (!plane) return tl::make_unexpected(plane.error());
    Centerline centerline;
    if (arguments.arcMm) {
        auto read = source.readCenterline();
        if (!read) return tl::make_unexpected(read.error());
        if (read->points.empty())
            return fail(ErrorKind::noResult, "the centerline is empty", source.name());
        centerline = std::move(*read);
        const double length = centerline.lengthMm();
        if (!(*arguments.arcMm >= 0.0 && *arguments.arcMm <= length)) {
            return fail(ErrorKind::badInput,
                        fmt::format("the centerline runs from 0 to {:.1f} mm", length),
                        fmt::format("--arc-mm {}", *arguments.arcMm));
        }
    }
    const auto scans = readScans(arguments, source);
    if (!scans) return tl::make_unexpected(scans.error());
    // Before the GPU has work: a case may have no mixture.
    Volume<TissueFractions> mixture;
    if (arguments.compare) {
        auto read = source.readVolume<TissueFractions>("mixture");
        if (!read) return tl::make_unexpected(read.error());
        mixture = std::move(*read);
    }
    auto context = gpu::Context::create();
    if (!context) return tl::make_unexpected(context.error());
    auto renderer =
        render::CaseRenderer::create(**context, scans->ct, scans->cleansed, arguments.threads);
    if (!renderer) return tl::make_unexpected(renderer.error());

    if (*plane == render::View::endoscopic) {
        const auto view = endoscopicView(arguments, centerline);
        if (!view) return tl::make_unexpected(view.error());
        return (*renderer)->render(*view, arguments.size.x, arguments.size.y);
    }
    render::SliceView slice{*plane, {}, arguments.zoom, arguments.window};
    slice.positionMm = arguments.positionMm.empty()
                           ? poseAtArc(centerline, *arguments.arcMm).point.positionMm
                           : arguments.positionMm.front();
    if (arguments.compare) return compare(**renderer, mixture, slice, arguments.size);
    if (arguments.product == "cleansed") slice.scan = render::Scan::cleansed;
    return (*renderer)->render(slice, arguments.size.x, arguments.size.y);
}

Result<void> runRender(const Arguments& arguments) {
    if (auto fit = checkOutputFile(arguments.out); !fit) return fit;
    const auto source = store::CaseStore::open(arguments.store, false).and_then([&](const auto& s) {
        return s.openCase(arguments.caseName);
    });
    if (!source) return tl::make_unexpected(source.error());
    const auto image = draw(arguments, *source);
    if (!image) return tl::make_unexpected(image.error());
    return render::writePng(arguments.out, *image);
}

void addPictureOptions(CLI::App& command, const std::shared_ptr<Arguments>& arguments) {
    command
        .add_option_function<std::string>(
            "--size",
            [arguments](const std::string& text) {
                const auto sides = parseNumbers(text, 'x', 2);
                for (int axis = 0; axis < 2; ++axis) {
                    const double side = sides ? (*sides)[axis] : 0.0;
                    if (!(side >= 1.0 && side <= render::maxPictureSide) || side != int(side)) {
                        throw CLI::ValidationError(
                            "--size", "\"" + text + "\" is not WxH with sides of 1 to " +
                                          std::to_string(render::maxPictureSide));
                    }
                    arguments->size[axis] = int(side);
                }
            },
            "Pixels; with --compare, of each of the three")
        ->type_name("WxH")
        ->default_str("512x512");
    command.add_option("--out", arguments->out, "The picture; replaced in one step")
        ->type_name("FILE.png")
        ->check([](const std::string& name) {
            return fs::path(name).extension() == ".png" ? std::string()
                                                        : "\"" + name + "\" does not end in .png";
        })
        ->required();
}

void addViewOptions(CLI::App& command, const std::shared_ptr<Arguments>& arguments) {
    command.add_option("--view", arguments->view, "What to draw")
        ->check(CLI::IsMember({"endoscopic", "axial", "coronal", "sagittal"}))
        ->capture_default_str();
    auto* product =
        command
            .add_option("--product", arguments->product,
                        "Which scan to draw; else a slice shows ct, the endoscopic view cleansed "
                        "where the case has it")
            ->check(CLI::IsMember({"ct", "cleansed"}));
    command
        .add_flag("--compare", arguments->compare,
                  "A slice three times, side by side: ct, the mixture by colours (air red, soft "
                  "tissue green, bone and tagged material blue, air meeting tagged material pink), "
                  "cleansed")
        ->excludes(product);
    command
        .add_option(
            "--arc-mm", arguments->arcMm,
            "Where on the centerline, from the rectum: the camera, or the point that a slice shows")
        ->type_name("A");
    addPointsOption(command, "--position", arguments->positionMm,
                    "The point (LPS, mm) that a slice shows, in place of --arc-mm");
    command.add_option("--direction", arguments->direction, "Which way the camera looks")
        ->check(CLI::IsMember({"antegrade", "retrograde"}))
        ->capture_default_str();
    command.add_option("--fov", arguments->fovDegrees, "Vertical field of view of the camera")
        ->type_name("DEGREES")
        ->check(CLI::Range(1.0, 170.0))
        ->capture_default_str();
    command.add_option("--transfer-function", arguments->preset, "Colours of the endoscopic view")
        ->check(CLI::IsMember(render::transferFunctionPresets()))
        ->capture_default_str();
    command
        .add_option_function<std::string>(
            "--window",
            [arguments](const std::string& text) {
                const auto numbers = parseNumbers(text, ',', 2);
                if (!numbers || !((*numbers)[1] > 0.0)) {
                    throw CLI::ValidationError("--window", "\"" + text + "\" is not CENTER,WIDTH");
                }
                arguments->window = {(*numbers)[0], (*numbers)[1]};
            },
            "Grey values of a slice, HU")
        ->type_name("C,W")
        ->default_str("0,2000");
    command.add_option("--zoom", arguments->zoom, "Enlargement of a slice")
        ->type_name("Z")
        ->check(CLI::Range(1.0, 64.0))
        ->capture_default_str();
}

}  // namespace

Command addRender(CLI::App& program) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = program.add_subcommand(
        "render", "Draw one picture of a case: a camera in the colon, or a slice of the scan.");
    command->add_option("CASE", arguments->caseName, "The case's name")->required();
    addStoreOption(*command, arguments->store);
    addViewOptions(*command, arguments);
    addPictureOptions(*command, arguments);
    addThreadsOption(*command, arguments->threads);
    command->callback([arguments] {
        const bool slice = arguments->view != "endoscopic";
        if (!slice && !arguments->positionMm.empty()) {
            throw CLI::ValidationError("--position", "the endoscopic view is placed by --arc-mm");
        }
        if (!slice && arguments->compare)
            throw CLI::ValidationError("--compare", "compares slices; give --view");
        if (arguments->positionMm.size() > 1)
            throw CLI::ValidationError("--position", "given more than once");
        if (!arguments->arcMm && arguments->positionMm.empty()) {
            throw CLI::RequiredError(slice ? "--arc-mm or --position" : "--arc-mm");
        }
    });
    return {command, [arguments] { return runRender(*arguments); }};
}

}  // namespace haustra::cli
