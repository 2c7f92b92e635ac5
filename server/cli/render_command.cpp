// haustra render: one picture of a case, as the server draws it.
#include "cli/arguments.h"
#include "cli/case_scans.h"
#include "cli/commands.h"
#include "cli/text_files.h"
#include "core/centerline.h"
#include "core/flat_lookup.h"
#include "core/wall_camera.h"
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
    std::string preset = render::opticsPresets().front();
    std::optional<double> arcMm;
    std::vector<glm::dvec3> positionMm;
    std::optional<glm::dvec2> flat;
    double pixelsPerCircumference = FlatWindow{}.pixelsPerUnit;
    double fovDegrees = render::Camera{}.fovDegrees, zoom = 1.0;
    glm::ivec2 size{512, 512};
    render::WindowLevel window;
    int threads = 0;
};

Result<render::CameraView> endoscopicView(const Arguments& arguments,
                                          const CenterlineCamera& from) {
    auto preset = render::opticsPreset(arguments.preset);
    if (!preset) return tl::make_unexpected(preset.error());
    render::CameraView view;
    view.camera = {from.positionMm, from.forward, from.up, arguments.fovDegrees};
    view.optics = std::move(*preset);
    return view;
}

bool isFlattened(const Arguments& arguments) {
    return arguments.view == "flattened" || arguments.view == "flattened-zoom";
}
bool isSlice(const Arguments& arguments) {
    return arguments.view != "endoscopic" && !isFlattened(arguments);
}

Result<CaseScans> readScans(const Arguments& arguments, const store::Case& source) {
    const bool cleansedIsAsked = arguments.compare || arguments.product == "cleansed";
    if (cleansedIsAsked || (!isSlice(arguments) && arguments.product.empty()))
        return readCaseScans(source, cleansedIsAsked);
    auto ct = source.readVolume<std::int16_t>("ct");
    if (!ct) return tl::make_unexpected(ct.error());
    return CaseScans{std::move(*ct), {}};
}

/// The place of the wall that is given, or the nearest to the point that is.
Result<WallPlace> wallPlace(const Arguments& arguments, const Centerline& centerline,
                            const FlatLookup& lookup) {
    if (arguments.flat) {
        if (const auto place = lookup.at(*arguments.flat)) return *place;
        return fail(
            ErrorKind::badInput,
            fmt::format("the strip runs from 0 to {:.3f} circumferences", lookup.map().height),
            fmt::format("--flat {},{}", arguments.flat->x, arguments.flat->y));
    }
    return lookup.nearest(arguments.positionMm.empty()
                              ? poseAtArc(centerline, *arguments.arcMm).point.positionMm
                              : arguments.positionMm.front());
}

/// On the centerline, or turned from it to a place of the wall or a point near one.
Result<CenterlineCamera> camera(const Arguments& arguments, const Centerline& centerline,
                                const std::shared_ptr<const FlatMap>& map) {
    if (arguments.arcMm) {
        return cameraAtArc(centerline, rotationMinimizingUps(centerline, flightPreferredUp),
                           *arguments.arcMm,
                           arguments.direction == "antegrade" ? FlightDirection::antegrade
                                                              : FlightDirection::retrograde);
    }
    return wallPlace(arguments, centerline, FlatLookup(map)).map([&](const WallPlace& place) {
        return cameraTowards(*map, place,
                             arguments.flat ? place.positionMm : arguments.positionMm.front());
    });
}

Result<render::Image> drawFlattened(const Arguments& arguments, const Centerline& centerline,
                                    const std::shared_ptr<const FlatMap>& map,
                                    render::CaseRenderer& renderer) {
    auto function = render::opticsPreset(arguments.preset);
    if (!function) return tl::make_unexpected(function.error());
    if (arguments.view == "flattened")
        return renderer.render(render::FlatOverview{std::move(*function), {}}, arguments.size.x,
                               arguments.size.y);
    const auto center = wallPlace(arguments, centerline, FlatLookup(map));
    if (!center) return tl::make_unexpected(center.error());
    const FlatWindow window{center->flat, arguments.pixelsPerCircumference};
    return renderer.render(render::FlatView{window, std::move(*function), {}}, arguments.size.x,
                           arguments.size.y);
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
    std::shared_ptr<const FlatMap> flatMap;
    if (isFlattened(arguments) || (!isSlice(arguments) && !arguments.arcMm)) {
        auto read = source.readFlatMap();
        if (!read) return tl::make_unexpected(read.error());
        flatMap = std::make_shared<const FlatMap>(std::move(*read));
    }
    auto prepared = render::prepareCase(scans->ct, scans->cleansed, arguments.threads);
    if (!prepared) return tl::make_unexpected(prepared.error());
    prepared->flatMap = flatMap;
    auto context = gpu::Context::create();
    if (!context) return tl::make_unexpected(context.error());
    auto renderer = render::CaseRenderer::upload(**context, std::move(*prepared),
                                                 {.threads = arguments.threads});
    if (!renderer) return tl::make_unexpected(renderer.error());
    if (isFlattened(arguments)) return drawFlattened(arguments, centerline, flatMap, **renderer);

    if (*plane == render::View::endoscopic) {
        const auto from = camera(arguments, centerline, flatMap);
        if (!from) return tl::make_unexpected(from.error());
        const auto view = endoscopicView(arguments, *from);
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

void addFlatOptions(CLI::App& command, const std::shared_ptr<Arguments>& arguments) {
    command
        .add_option_function<std::string>(
            "--flat",
            [arguments](const std::string& text) {
                const auto numbers = parseNumbers(text, ',', 2);
                if (!numbers) throw CLI::ValidationError("--flat", "\"" + text + "\" is not X,Y");
                arguments->flat = glm::dvec2((*numbers)[0], (*numbers)[1]);
            },
            "The middle of flattened-zoom on the strip, in circumferences: X around the colon, Y "
            "from the rectum; in place of --arc-mm. Or the place of the wall that the endoscopic "
            "view looks at, as with --position")
        ->type_name("X,Y");
    command
        .add_option("--pixels-per-circumference", arguments->pixelsPerCircumference,
                    "Enlargement of flattened-zoom")
        ->type_name("P")
        ->check(CLI::Range(1.0, double(render::maxPixelsPerUnit)))
        ->capture_default_str();
}

void addViewOptions(CLI::App& command, const std::shared_ptr<Arguments>& arguments) {
    command.add_option("--view", arguments->view, "What to draw")
        ->check(CLI::IsMember(
            {"endoscopic", "axial", "coronal", "sagittal", "flattened", "flattened-zoom"}))
        ->capture_default_str();
    auto* product =
        command
            .add_option("--product", arguments->product,
                        "Which scan to draw; else a slice shows ct, the other views cleansed where "
                        "the case has it")
            ->check(CLI::IsMember({"ct", "cleansed"}));
    command
        .add_flag("--compare", arguments->compare,
                  "A slice three times, side by side: ct, the mixture by colours (air red, soft "
                  "tissue green, bone and tagged material blue, air meeting tagged material pink), "
                  "cleansed")
        ->excludes(product);
    command
        .add_option("--arc-mm", arguments->arcMm,
                    "Where on the centerline, from the rectum: the camera, the point that a slice "
                    "shows, or "
                    "the one whose nearest place on the wall is in the middle of flattened-zoom")
        ->type_name("A");
    addPointsOption(
        command, "--position", arguments->positionMm,
        "The point (LPS, mm) of a slice or of flattened-zoom, in place of --arc-mm. The endoscopic "
        "view looks at it from where the flat map registers the place of the wall nearest to it "
        "with the centerline, turned as flattened-zoom is: the cecum up");
    addFlatOptions(command, arguments);
    command
        .add_option("--direction", arguments->direction, "Which way the camera on --arc-mm looks")
        ->check(CLI::IsMember({"antegrade", "retrograde"}))
        ->capture_default_str();
    command.add_option("--fov", arguments->fovDegrees, "Vertical field of view of the camera")
        ->type_name("DEGREES")
        ->check(CLI::Range(1.0, 170.0))
        ->capture_default_str();
    command
        .add_option("--transfer-function", arguments->preset,
                    "Colours of the endoscopic and flattened views")
        ->check(CLI::IsMember(render::opticsPresets()))
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
        "render",
        "Draw one picture of a case: a camera in the colon, a slice of the scan, or the flattened "
        "wall.");
    command->add_option("CASE", arguments->caseName, "The case's name")->required();
    addStoreOption(*command, arguments->store);
    addViewOptions(*command, arguments);
    addPictureOptions(*command, arguments);
    addThreadsOption(*command, arguments->threads);
    command->callback([arguments] {
        const std::string& view = arguments->view;
        if (!isSlice(*arguments) && arguments->compare)
            throw CLI::ValidationError("--compare", "compares slices; give --view");
        if (arguments->flat && isSlice(*arguments))
            throw CLI::ValidationError("--flat", "places flattened-zoom and endoscopic");
        if (arguments->positionMm.size() > 1)
            throw CLI::ValidationError("--position", "given more than once");
        const int places = (arguments->arcMm ? 1 : 0) + int(arguments->positionMm.size()) +
                           (arguments->flat ? 1 : 0);
        if (view == "flattened" && places > 0)
            throw CLI::ValidationError("--view",
                                       "flattened shows the whole strip and takes no place");
        if (!isSlice(*arguments) && places > 1)
            throw CLI::ValidationError("--view", "the place is given in two ways");
        if (view != "flattened" && places == 0) {
            throw CLI::RequiredError(isSlice(*arguments) ? "--arc-mm or --position"
                                                         : "--flat, --arc-mm or --position");
        }
    });
    return {command, [arguments] { return runRender(*arguments); }};
}

}  // namespace haustra::cli
