// haustra render: one picture of a case, as the server draws it, or of a scan from a file.
#include "cli/arguments.h"
#include "cli/caption.h"
#include "cli/case_scans.h"
#include "cli/commands.h"
#include "cli/input_volume.h"
#include "cli/provenance.h"
#include "cli/render_arguments.h"
#include "cli/render_camera.h"
#include "cli/text_files.h"
#include "cli/wall_paint.h"
#include "core/centerline.h"
#include "core/flat_lookup.h"
#include "core/orbit.h"
#include "core/slice_placement.h"
#include "core/strip_layout.h"
#include "core/wall_camera.h"
#include "gpu/context.h"
#include "nifti/nifti_file.h"
#include "pictures/drawing.h"
#include "pictures/picture_file.h"
#include "render/case_renderer.h"
#include "render/comparison.h"
#include "render/object_order/labelled_raycaster.h"
#include "render/optics/optics_presets.h"
#include "render/wall/wall_paint.h"
#include "store/case_store.h"
#include "store/products.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

namespace product = store::product;

using pictures::Provenance;

/// What the file will say of the picture, and how the picture lies: its drawing adds to it.
struct Notes {
    Provenance provenance;
    std::optional<PictureFrame> frame;
    std::vector<NumberedPlace> findings = {};  ///< where a picture of the whole colon shows them
};

/// What the case has, as far as the picture needs it.
struct Products {
    Centerline centerline;
    std::shared_ptr<const FlatMap> flatMap;
    std::shared_ptr<const render::WallPaint> paint;  ///< --paint, with the bridges hatched
    std::vector<PaintedFindings::Place> findings;    ///< of --paint findings
    std::shared_ptr<const TriMesh> wall;
    CaseScans scans;
    Volume<TissueFractions> mixture;
};

/// --tf, a preset's name or file; `otherwise` names the view's own. Fails naming the file.
Result<Optics> opticsOf(const RenderArguments& arguments, const char* otherwise) {
    const std::string name = arguments.optics.empty() ? otherwise : arguments.optics;
    if (std::filesystem::path(name).extension() != ".json") return render::opticsPreset(name);
    auto preset = TRY(readPresetFile(name));
    return std::move(preset.optics);
}

/// --step, else as it is.
render::MarchOptions marchOf(const RenderArguments& arguments, render::MarchOptions march = {}) {
    march.stepVoxels = arguments.stepVoxels.value_or(march.stepVoxels);
    return march;
}

/// The nearest to the point of --position. Fails where that is so far that the point means none of
/// the wall.
Result<WallPlace> wallNear(glm::dvec3 pointMm, const FlatLookup& lookup) {
    constexpr double farthestMm = 100.0;
    const WallPlace place = lookup.nearest(pointMm);
    const double awayMm = glm::distance(place.positionMm, pointMm);
    if (awayMm <= farthestMm) return place;
    return fail(ErrorKind::badInput,
                fmt::format("the wall nearest to this place is {:.0f} mm away, which is more than "
                            "{:.0f} mm",
                            std::ceil(awayMm), farthestMm),
                "--position " + toText(pointMm));
}

/// The place of the wall that is given, or the nearest to the point that is.
Result<WallPlace> wallPlace(const RenderArguments& arguments, const Centerline& centerline,
                            const FlatLookup& lookup) {
    if (arguments.flat) {
        if (const auto place = lookup.at(*arguments.flat)) return *place;
        return fail(ErrorKind::badInput,
                    fmt::format("the strip runs from 0 to {:.3f} circumferences",
                                std::floor(1000.0 * lookup.map().height) / 1000.0),
                    fmt::format("--flat {},{}", arguments.flat->x, arguments.flat->y));
    }
    if (arguments.positionMm.empty())
        return lookup.nearest(poseAtArc(centerline, *arguments.arcMm).point.positionMm);
    return wallNear(arguments.positionMm.front(), lookup);
}

/// A slice at a place beside the scan would be black.
Result<void> checkSlicePlace(const RenderArguments& arguments, const Grid& grid) {
    if (!arguments.isSlice() || arguments.positionMm.empty()) return {};
    // A tenth of a millimetre that is told, rounded inwards, is in the scan, whatever its last bit.
    constexpr double rounding = 1e-6;
    ScanBounds scan = boundsMm(grid);
    scan.low -= rounding, scan.high += rounding;
    const glm::dvec3 point = arguments.positionMm.front();
    if (scan.contains(point)) return {};
    const glm::dvec3 low = glm::ceil(10.0 * scan.low) / 10.0 + 0.0,
                     high = glm::floor(10.0 * scan.high) / 10.0;
    return fail(ErrorKind::badInput,
                fmt::format("this place is outside the scan, which runs from "
                            "{:.1f},{:.1f},{:.1f} to {:.1f},{:.1f},{:.1f}",
                            low.x, low.y, low.z, high.x, high.y, high.z),
                "--position " + toText(point));
}

/// On the centerline, or turned from it to a place of the wall or a point near one.
Result<CenterlineCamera> cameraOnPath(const RenderArguments& arguments,
                                      const Centerline& centerline,
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

void addCamera(Notes& notes, const Camera& camera, int pictureHeight) {
    cli::addCamera(notes.provenance, camera);
    notes.frame = frameOf(camera, pictureHeight);
}

Result<Image> drawCamera(const RenderArguments& arguments, const Camera& camera,
                         std::shared_ptr<const render::WallPaint> paint,
                         render::CaseRenderer& renderer, Notes& notes) {
    addCamera(notes, camera, arguments.size.y);
    auto optics = TRY(opticsOf(arguments, "mucosa"));
    render::CameraView view{camera, std::move(optics), marchOf(arguments)};
    view.paint = std::move(paint);
    return renderer.render(view, arguments.size.x, arguments.size.y);
}

Result<Image> drawEndoscopic(const RenderArguments& arguments, const Products& products,
                             render::CaseRenderer& renderer, Notes& notes) {
    const auto from = TRY(cameraOnPath(arguments, products.centerline, products.flatMap));
    Camera camera{from.positionMm, from.forward, from.up, fovOf(arguments, Camera{}.fovDegrees),
                  arguments.lens};
    if (arguments.heightMm) camera.heightMm = *arguments.heightMm;
    return drawCamera(arguments, camera, products.paint, renderer, notes);
}

Result<Image> drawFlattened(const RenderArguments& arguments, const Products& products,
                            render::CaseRenderer& renderer, Notes& notes) {
    auto optics = TRY(opticsOf(arguments, "mucosa"));
    const auto [width, height] = std::pair(arguments.size.x, arguments.size.y);
    if (arguments.shown() == View::flattened) {
        const StripLayout layout = layOutStrip(products.flatMap->height, arguments.size);
        for (const PaintedFindings::Place& finding : products.findings)
            notes.findings.push_back(
                {finding.number, layout.pixelFromFlat(finding.flat), finding.color});
        return renderer.render(
            render::FlatOverview{std::move(optics), marchOf(arguments), products.paint}, width,
            height);
    }
    const auto center =
        TRY(wallPlace(arguments, products.centerline, FlatLookup(products.flatMap)));
    const FlatWindow window{center.flat, arguments.pixelsPerCircumference};
    notes.provenance.facts.emplace_back("flat.center", toText(center.flat));
    notes.provenance.facts.emplace_back("flat.pixels_per_circumference",
                                        fmt::format("{}", window.pixelsPerUnit));
    return renderer.render(
        render::FlatView{window, std::move(optics), marchOf(arguments), products.paint}, width,
        height);
}

Result<Image> drawOverview(const RenderArguments& arguments, const Products& products,
                           render::CaseRenderer& renderer, Notes& notes) {
    auto optics = TRY(opticsOf(arguments, "body"));
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::dvec3 vertex : products.wall->vertices) {
        low = glm::min(low, vertex);
        high = glm::max(high, vertex);
    }
    Orbit orbit = orbitAround(low, high, aspectOf(arguments));
    orbit.azimuthDegrees = arguments.azimuthDegrees;
    orbit.elevationDegrees = arguments.elevationDegrees;
    if (arguments.heightMm) orbit.heightMm = *arguments.heightMm;
    render::OverviewView view;
    view.camera = cameraOf(orbit);
    addCamera(notes, view.camera, arguments.size.y);
    for (const PaintedFindings::Place& finding : products.findings)
        notes.findings.push_back({finding.number,
                                  projected(view.camera, finding.wallMm, arguments.size),
                                  finding.color});
    view.bookmarksMm = arguments.marksMm;
    view.paint = products.paint;
    view.body = arguments.body;
    view.optics = std::move(optics);
    view.march = marchOf(arguments, view.march);
    if (arguments.arcMm) {
        const auto reader = TRY(cameraOnPath(arguments, products.centerline, {}));
        view.reader = Camera{reader.positionMm, reader.forward, reader.up};
    }
    return renderer.render(view, arguments.size.x, arguments.size.y);
}

void addWindow(Notes& notes, const WindowLevel& window) {
    notes.provenance.facts.emplace_back("window_hu",
                                        toText(glm::dvec2(window.centerHu, window.widthHu)));
}

Result<Image> drawOblique(const RenderArguments& arguments, const Centerline& centerline,
                          const WindowLevel& window, Scan scan, render::CaseRenderer& renderer,
                          Notes& notes) {
    ObliqueView view;
    view.window = window;
    view.scan = scan;
    view.heightMm = arguments.heightMm.value_or(view.heightMm);
    if (arguments.arcMm) {
        const auto from = TRY(cameraOnPath(arguments, centerline, {}));
        view.positionMm = from.positionMm;
        view.forward = from.forward;
        view.up = from.up;
    } else {
        view.positionMm = arguments.positionMm.front();
        view.forward = arguments.lookMm.front() - view.positionMm;
        view.up = uprightFor(view.forward);
    }
    if (!arguments.up.empty()) view.up = arguments.up.front();
    addCamera(notes,
              {.positionMm = view.positionMm,
               .forward = view.forward,
               .up = view.up,
               .lens = Lens::orthographic,
               .heightMm = view.heightMm},
              arguments.size.y);
    addWindow(notes, window);
    return renderer.render(view, arguments.size.x, arguments.size.y);
}

/// Before, classification and after, each as a slice of its own would be.
Result<Image> compare(render::CaseRenderer& renderer, const Volume<TissueFractions>& mixture,
                      SliceView slice, glm::ivec2 size) {
    auto before = TRY(renderer.render(slice, size.x, size.y));
    auto tissues = TRY(render::tissuePicture(mixture, slice, size.x, size.y));
    slice.scan = Scan::cleansed;
    auto after = TRY(renderer.render(slice, size.x, size.y));
    return pictures::sideBySide({std::move(before), std::move(tissues), std::move(after)});
}

Result<Image> drawSlice(const RenderArguments& arguments, const Products& products,
                        const Grid& grid, const WindowLevel& window, render::CaseRenderer& renderer,
                        Notes& notes) {
    SliceView slice{arguments.shown(), {}, arguments.zoom, window};
    slice.positionMm = arguments.positionMm.empty()
                           ? poseAtArc(products.centerline, *arguments.arcMm).point.positionMm
                           : arguments.positionMm.front();
    notes.provenance.facts.emplace_back("slice.position_mm", toText(slice.positionMm));
    notes.provenance.facts.emplace_back("slice.zoom", fmt::format("{}", slice.zoom));
    addWindow(notes, window);
    notes.frame = frameOf(TRY(placeSlice(slice, grid, arguments.size.x, arguments.size.y)));
    if (arguments.compare) return compare(renderer, products.mixture, slice, arguments.size);
    if (arguments.product == product::cleansed) slice.scan = Scan::cleansed;
    return renderer.render(slice, arguments.size.x, arguments.size.y);
}

Result<CaseScans> readScans(const RenderArguments& arguments, const store::Case& source) {
    const bool cleansedIsAsked = arguments.compare || arguments.product == product::cleansed;
    if (cleansedIsAsked || (arguments.castsRays() && arguments.product.empty()))
        return readCaseScans(source, cleansedIsAsked);
    auto ct = TRY(source.readVolume<std::int16_t>(product::ct));
    return CaseScans{std::move(ct), {}};
}

template <class T>
Result<void> keep(Result<T> read, T& in) {
    in = TRY(std::move(read));
    return {};
}
template <class T>
Result<void> keep(Result<T> read, std::shared_ptr<const T>& in) {
    in = std::make_shared<const T>(TRY(std::move(read)));
    return {};
}

/// Before the GPU has work: a case may lack what the picture needs.
Result<Products> readProducts(const RenderArguments& arguments, const store::Case& source) {
    const View view = arguments.shown();
    const bool isFree = arguments.view == "camera";
    Products products;
    if (arguments.arcMm || view == View::overview) {
        TRY(keep(source.readCenterline(), products.centerline));
        if (products.centerline.points.empty())
            return fail(ErrorKind::noResult, "the centerline is empty", source.name());
    }
    if (arguments.arcMm) {
        const double length = products.centerline.lengthMm();
        if (!(*arguments.arcMm >= 0.0 && *arguments.arcMm <= length)) {
            // Rounded down: what is told is on the centerline.
            return fail(ErrorKind::badInput,
                        fmt::format("the centerline runs from 0 to {:.1f} mm",
                                    std::floor(10.0 * length) / 10.0),
                        fmt::format("--arc-mm {}", *arguments.arcMm));
        }
    }
    TRY(keep(readScans(arguments, source), products.scans));
    if (arguments.compare)
        TRY(keep(source.readVolume<TissueFractions>(product::mixture), products.mixture));
    const bool onWall = view == View::endoscopic && !isFree && !arguments.arcMm;
    const bool showsWall = arguments.castsRays() || arguments.isFlattened();
    const auto bridged =
        TRY(showsWall && source.find(product::flatMap) ? hasBridges(source) : false);
    if (arguments.isFlattened() || onWall || !arguments.paint.empty() || bridged) {
        TRY(keep(source.readFlatMap(), products.flatMap));
    }
    if (arguments.paintsFindings()) {
        auto painted = TRY(paintFindings(source, products.flatMap, arguments.leastProbability));
        products.paint = std::move(painted.paint);
        products.findings = std::move(painted.places);
    } else if (!arguments.paint.empty()) {
        TRY(keep(readWallPaint(arguments.paint, products.flatMap->height), products.paint));
    }
    if (bridged && !arguments.paintsFindings())
        TRY(keep(paintBridges(source, products.flatMap, products.paint), products.paint));
    if (view == View::overview ||
        (arguments.castsRays() && raycasterEntry(arguments.raycaster).needsWallMesh))
        TRY(keep(source.readMesh(), products.wall));
    return products;
}

/// Makes a renderer for `prepared` and has `draw` use it.
Result<Image> drawWith(const RenderArguments& arguments, render::PreparedCase prepared,
                       const std::function<Result<Image>(render::CaseRenderer&)>& draw) {
    auto context = TRY(gpu::Context::create());
    render::RendererOptions options;
    if (arguments.castsRays()) options.raycaster = arguments.raycaster;
    options.gpuBudgetBytes = std::size_t(std::ceil(arguments.gpuBudgetMiB * 1048576.0));
    options.threads = arguments.threads;
    auto renderer = TRY(render::CaseRenderer::upload(*context, std::move(prepared), options));
    return draw(*renderer);
}

/// What is known before anything is drawn. Of a scan from a file its name is not told.
Provenance provenanceOf(const RenderArguments& arguments) {
    Provenance provenance = ownProvenance();
    const auto add = [&](const char* name, std::string value) {
        provenance.facts.emplace_back(name, std::move(value));
    };
    add(arguments.isScan() ? "scan" : "case", arguments.isScan() ? "a file" : arguments.input);
    if (arguments.view.empty())
        add("view", arguments.isScan() ? "camera" : toString(arguments.shown()));
    else
        add("view", arguments.view);
    if (!arguments.castsRays()) return provenance;
    add("raycaster", arguments.labels.empty() ? toString(arguments.raycaster) : "labelled");
    if (fs::path(arguments.optics).extension() == ".json")
        add("transfer_function", "a file");
    else if (arguments.labels.empty())
        add("transfer_function", !arguments.optics.empty()             ? arguments.optics
                                 : arguments.shown() == View::overview ? "body"
                                                                       : "mucosa");
    return provenance;
}

void addProducts(Provenance& provenance, const RenderArguments& arguments, const Products& products,
                 const store::Case& source) {
    const bool showsCleansed = arguments.compare || arguments.product == product::cleansed ||
                               (arguments.castsRays() && !products.scans.cleansed.empty());
    if (arguments.compare || !showsCleansed) addProduct(provenance, source, product::ct);
    if (arguments.compare) addProduct(provenance, source, product::mixture);
    if (showsCleansed) addProduct(provenance, source, product::cleansed);
    if (!products.centerline.points.empty()) addProduct(provenance, source, product::centerline);
    if (products.flatMap) addProduct(provenance, source, product::flatMap);
    if (products.wall) addProduct(provenance, source, product::surface);
    if (arguments.paintsFindings()) addProduct(provenance, source, product::findings);
}

Result<Image> drawCase(const RenderArguments& arguments, Notes& notes) {
    const auto source =
        TRY(store::CaseStore::open(arguments.store, false).and_then([&](const auto& s) {
            return s.openCase(arguments.input);
        }));
    const auto products = TRY(readProducts(arguments, source));
    addProducts(notes.provenance, arguments, products, source);
    const CaseScans& scans = products.scans;
    const Grid grid = scans.ct.grid();
    TRY(checkSlicePlace(arguments, grid));
    auto prepared = TRY(render::prepareCase(scans.ct, scans.cleansed, arguments.threads));
    prepared.flatMap = products.flatMap;
    prepared.wall = products.wall;
    if (!products.centerline.points.empty())
        prepared.path = std::make_shared<const Centerline>(products.centerline);
    return drawWith(arguments, std::move(prepared), [&](render::CaseRenderer& renderer) {
        const auto window = arguments.window.value_or(WindowLevel{});
        const auto scan = arguments.product == product::cleansed ? Scan::cleansed : Scan::original;
        if (arguments.isFlattened()) return drawFlattened(arguments, products, renderer, notes);
        if (arguments.shown() == View::overview)
            return drawOverview(arguments, products, renderer, notes);
        if (arguments.shown() == View::oblique)
            return drawOblique(arguments, products.centerline, window, scan, renderer, notes);
        if (arguments.isSlice())
            return drawSlice(arguments, products, grid, window, renderer, notes);
        if (arguments.view == "camera")
            return drawCamera(arguments, freeCamera(arguments, grid), products.paint, renderer,
                              notes);
        return drawEndoscopic(arguments, products, renderer, notes);
    });
}

Result<Image> drawScan(const RenderArguments& arguments, Notes& notes) {
    auto volume = TRY(readInputVolume(arguments.input, arguments.spacingMm, arguments.threads));
    const Grid grid = volume.grid();
    TRY(checkSlicePlace(arguments, grid));
    WindowLevel window;
    if (arguments.window) {
        window = *arguments.window;
    } else {
        const auto [low, high] = std::ranges::minmax(volume.voxels());
        window = {0.5 * (low + high), std::max(1.0, double(high) - low)};
    }
    auto prepared = TRY(render::prepareCase(volume, {}, arguments.threads));
    return drawWith(arguments, std::move(prepared), [&](render::CaseRenderer& renderer) {
        if (arguments.isSlice()) return drawSlice(arguments, {}, grid, window, renderer, notes);
        if (arguments.shown() == View::oblique)
            return drawOblique(arguments, {}, window, Scan::original, renderer, notes);
        return drawCamera(arguments, freeCamera(arguments, grid), nullptr, renderer, notes);
    });
}

/// Colours from a NIfTI of RGB24 or RGBA32, labels from a NIfTI of whole numbers on the same grid.
/// RGB24 has no opacity: it follows from how fast the colour changes (withColorOpacity), and what
/// has a label is a little opaque throughout.
Result<std::shared_ptr<const render::LabelledColorVolume>> readLabelledColor(
    const std::filesystem::path& color, const std::filesystem::path& labels, int threads) {
    auto image = TRY(nifti::readColorNifti(color));
    auto organs = TRY(nifti::readNifti<std::int16_t>(labels));
    auto volume = TRY(render::makeLabelledColor(std::move(image.voxels), std::move(organs)));
    if (!image.hasOpacity)
        volume.color =
            render::withColorOpacity(volume.color, volume.labels, {.least = 0.1}, threads);
    return std::make_shared<const render::LabelledColorVolume>(std::move(volume));
}

Result<Image> drawLabelled(const RenderArguments& arguments, Notes& notes) {
    auto volume = TRY(readLabelledColor(arguments.input, arguments.labels, arguments.threads));
    auto context = TRY(gpu::Context::create());
    auto raycaster = TRY(render::LabelledRaycaster::create(
        *context, volume,
        {.budgetBytes = std::size_t(std::ceil(arguments.gpuBudgetMiB * 1048576.0)),
         .threads = arguments.threads}));
    TRY(raycaster->choose({arguments.shownLabels.begin(), arguments.shownLabels.end()}));
    render::CameraView view{freeCamera(arguments, volume->grid()), {}, marchOf(arguments)};
    addCamera(notes, view.camera, arguments.size.y);
    view.optics.light.halfDepthMm = 1e6;  // the camera's distance darkens nothing
    const glm::ivec2 size = arguments.size;
    Image image = blankImage(size);
    TRY(raycaster->render(view, render::Band::whole(size.x, size.y), image));
    return image;
}

/// What it is of, which view, and where, in a line.
Result<pictures::Marks> captionOf(const RenderArguments& arguments, const Notes& notes) {
    const auto fact = [&](const char* name) -> std::string {
        for (const auto& [known, value] : notes.provenance.facts)
            if (known == name) return value;
        return {};
    };
    std::string line = fact("case");
    for (const std::string& word :
         {fact("view"), arguments.arcMm ? fmt::format("{:g} mm", *arguments.arcMm) : std::string()})
        if (!word.empty()) line += (line.empty() ? "" : "  ") + word;
    return arguments.compare ? comparisonCaption(line, *notes.frame, arguments.size)
                             : caption(line, notes.frame, arguments.size, notes.findings);
}

Result<void> runRender(const RenderArguments& arguments) {
    TRY(checkOutputFile(arguments.out));
    Notes notes{provenanceOf(arguments), {}};
    auto image = TRY(!arguments.labels.empty() ? drawLabelled(arguments, notes)
                     : arguments.isScan()      ? drawScan(arguments, notes)
                                               : drawCase(arguments, notes));
    if (arguments.caption) TRY(pictures::draw(TRY(captionOf(arguments, notes)), image));
    return pictures::writePicture(arguments.out, image, notes.provenance);
}

}  // namespace

Command addRender(CLI::App& program) {
    auto arguments = std::make_shared<RenderArguments>();
    CLI::App* command = program.add_subcommand(
        "render",
        "Draw one picture. Of a case: a camera in the colon or anywhere, the colon from outside, a "
        "slice of the scan in any direction, or the flattened wall. Of a scan from a file: from "
        "outside or anywhere, or a slice.");
    addRenderOptions(*command, *arguments);
    command->callback([arguments, command] { checkUsage(*command, *arguments); });
    return {command, [arguments] { return runRender(*arguments); }};
}

}  // namespace haustra::cli
