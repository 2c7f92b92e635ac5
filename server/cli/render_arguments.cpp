#include "cli/render_arguments.h"

#include "cli/arguments.h"
#include "cli/number_range.h"
#include "pictures/picture_file.h"
#include "render/optics/optics_presets.h"
#include "store/products.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <CLI/CLI.hpp>

namespace haustra::cli {

namespace {

namespace fs = std::filesystem;

const std::string camera = "camera";  // of View::endoscopic, placed by --eye

/// An option whose text `read` turns into a value. Its answer is empty, or says what the text is
/// that it should not be.
CLI::Option* addText(CLI::App& command, const std::string& name, const std::string& form,
                     const std::string& description,
                     std::function<std::string(const std::string&)> read) {
    return command
        .add_option_function<std::string>(
            name,
            [=](const std::string& text) {
                const std::string wrong = read(text);
                if (!wrong.empty()) throw CLI::ValidationError(name, "\"" + text + "\" " + wrong);
            },
            description)
        ->type_name(form);
}

CLI::Option* addPoint(CLI::App& command, const std::string& name, std::vector<glm::dvec3>& point,
                      const std::string& description) {
    return addPointsOption(command, name, point, description);
}

void addPlaceOptions(CLI::App& command, RenderArguments& my) {
    command
        .add_option("--arc-mm", my.arcMm,
                    "Where on the centerline, from the rectum: the endoscopic camera, the point "
                    "that a slice shows, the lumen's cross-section of oblique, the reader in the "
                    "overview, or the point whose nearest place on the wall is in the middle of "
                    "flattened-zoom")
        ->type_name("A");
    addPoint(
        command, "--position", my.positionMm,
        "The point (LPS, mm) of a slice, in the scan, of oblique, or of flattened-zoom, 100 mm "
        "from the wall at most, in place of --arc-mm. The endoscopic view looks at it from where "
        "the flat map registers the place of the wall nearest to it with the centerline, turned as "
        "flattened-zoom is: the cecum up");
    addText(command, "--flat", "X,Y",
            "The middle of flattened-zoom on the strip, in circumferences: X around the colon, Y "
            "from the rectum; in place of --arc-mm. Or the place of the wall that the endoscopic "
            "view looks at, as with --position",
            [&my](const std::string& text) {
                const auto numbers = parseNumbers(text, ',', 2);
                if (!numbers) return "is not X,Y";
                my.flat = glm::dvec2((*numbers)[0], (*numbers)[1]);
                return "";
            });
    command
        .add_option("--pixels-per-circumference", my.pixelsPerCircumference,
                    "Enlargement of flattened-zoom")
        ->type_name("P")
        ->check(numberRange(1.0, double(render::maxPixelsPerUnit)))
        ->capture_default_str();
    command.add_option("--direction", my.direction, "Which way the camera on --arc-mm looks")
        ->check(CLI::IsMember({"antegrade", "retrograde"}))
        ->capture_default_str();
}

void addCameraOptions(CLI::App& command, RenderArguments& my) {
    addPoint(command, "--eye", my.eyeMm,
             "Where the camera of --view camera is (LPS, mm); without it, outside, with all of "
             "the scan in the picture");
    addPoint(command, "--look", my.lookMm,
             "The point it looks at; the scan's middle. Of oblique with --position: a point "
             "straight before the slice");
    addPoint(command, "--up", my.up,
             "Of camera and oblique, the direction that is up in the picture; the patient's head, "
             "or the front where it looks along the patient");
    command
        .add_option("--azimuth", my.azimuthDegrees,
                    "Of a camera outside, and of the overview: from the patient's front (0), left "
                    "(90) or back (180)")
        ->type_name("DEGREES")
        ->check(numberRange(-360.0, 360.0))
        ->capture_default_str();
    command
        .add_option("--elevation", my.elevationDegrees,
                    "Likewise, how far from above; negative from the feet")
        ->type_name("DEGREES")
        ->check(numberRange(-90.0, 90.0))
        ->capture_default_str();
    command
        .add_option_function<std::string>(
            "--lens",
            [&my](const std::string& name) {
                my.lens = name == "fisheye"        ? Lens::fisheye
                          : name == "orthographic" ? Lens::orthographic
                                                   : Lens::perspective;
            },
            "How the camera's rays spread: a fisheye shows equal angles as equal lengths")
        ->check(CLI::IsMember({"perspective", "fisheye", "orthographic"}))
        ->default_str("perspective");
    command
        .add_option("--fov", my.fovDegrees,
                    "Vertical field of view: perspective 1 to 170 (90; 30 of a camera outside), "
                    "fisheye 1 to 360 (180)")
        ->type_name("DEGREES")
        ->check(numberRange(1.0, 360.0));
    command
        .add_option("--height-mm", my.heightMm,
                    "How much an orthographic camera (all of the scan), oblique (60) or the "
                    "overview (all of the colon) shows from top to bottom")
        ->type_name("H")
        ->check(numberRange(minObliqueMm, maxObliqueMm));
}

std::string presetNames() {
    std::string names;
    for (const std::string& name : render::opticsPresets())
        names += (names.empty() ? "" : ", ") + name;
    return names;
}

void addDrawingOptions(CLI::App& command, RenderArguments& my) {
    command
        .add_option("--tf,--transfer-function", my.optics,
                    "Colours, opacities and light of what rays meet: a preset (" + presetNames() +
                        ") or a preset's file. Of a case mucosa, or body around the overview's "
                        "colon, unless given; a scan from a file needs one")
        ->type_name("NAME|FILE.json")
        ->check([](const std::string& text) {
            const auto& presets = render::opticsPresets();
            if (fs::path(text).extension() == ".json" ||
                std::find(presets.begin(), presets.end(), text) != presets.end())
                return std::string();
            return "\"" + text + "\" is neither the name of a .json file nor a preset (" +
                   presetNames() + ")";
        });
    addText(command, "--raycaster", "KIND", "What casts the rays: " + raycasterNames(),
            [&my](const std::string& text) {
                const auto kind = raycasterFromString(text);
                if (!kind) return "is none of " + raycasterNames();
                my.raycaster = *kind;
                return std::string();
            })
        ->default_str(toString(my.raycaster));
    command
        .add_option(
            "--gpu-budget", my.gpuBudgetMiB,
            "GPU memory for the scan, MiB; 0: what there is. Of --raycaster object-order and of "
            "--labels: the others keep the whole scan there, or, native, nothing")
        ->type_name("MIB")
        ->check(numberRange(0.0, 1e7))
        ->capture_default_str();
    auto* labels = command
                       .add_option("--labels", my.labels,
                                   "The input is a colour volume (NIfTI, RGB24 or RGBA32), and "
                                   "this its voxels' labels on the same grid; drawn in object "
                                   "order by its own colours")
                       ->type_name("FILE.nii.gz");
    command
        .add_option("--label", my.shownLabels,
                    "Show what has this label alone; may be given again and again")
        ->type_name("N")
        ->needs(labels)
        ->check(CLI::Range(-32768, 32767));
    command
        .add_option("--step", my.stepVoxels,
                    "Distance of samples on a ray, in voxels (0.5; 1 in the overview)")
        ->type_name("V")
        ->check(numberRange(0.05, 4.0));
    command
        .add_option(
            "--paint", my.paint,
            "A picture of the whole strip, of its shape, as flat-image is without a seam "
            "margin, that colours the endoscopic view's wall; or findings: the case's own, "
            "in all views of the wall: green, and violet what scored lower and is asked for "
            "(--least-probability)")
        ->type_name("FILE.png|.tif|findings")
        ->check([](const std::string& text) {
            std::error_code ignored;
            return text == "findings" || fs::is_regular_file(text, ignored)
                       ? std::string()
                       : "\"" + text + "\" is neither a file nor the word findings";
        });
    command
        .add_option("--least-probability", my.leastProbability,
                    "Of --paint findings: the candidates below the operating point, too, that are "
                    "so probable to be a polyp")
        ->type_name("P")
        ->check(numberRange(0.0, 1.0));
    addPointsOption(command, "--mark", my.marksMm,
                    "A ball in the overview (LPS, mm); may be given again and again");
    command.add_flag_callback(
        "--no-body", [&my] { my.body = false; }, "Leave out the body around the overview's colon");
    addText(command, "--window", "C,W",
            "Grey values of a slice, HU (0,2000; of a scan from a file, all of its values)",
            [&my](const std::string& text) {
                const auto numbers = parseNumbers(text, ',', 2);
                if (!numbers) return "is not C,W";
                if (!((*numbers)[1] > 0.0)) return "has a width, W, that is not over 0";
                my.window = {(*numbers)[0], (*numbers)[1]};
                return "";
            });
    command
        .add_option(
            "--zoom", my.zoom,
            "Enlargement of a slice around its point, which stays where it is in the picture")
        ->type_name("Z")
        ->check(numberRange(1.0, 64.0))
        ->capture_default_str();
}

/// Empty, or what is wrong with it.
std::string readSize(const std::string& text, glm::ivec2& size) {
    const auto sides = parseNumbers(text, 'x', 2);
    if (!sides) return "is not WxH";
    for (int axis = 0; axis < 2; ++axis) {
        const double side = (*sides)[std::size_t(axis)];
        if (!(side >= 1.0 && side <= render::maxPictureSide) || side != std::floor(side))
            return "is not of whole pixels, 1 to " + std::to_string(render::maxPictureSide) +
                   " a side";
        size[axis] = int(side);
    }
    return {};
}

void addPictureOptions(CLI::App& command, RenderArguments& my) {
    addText(command, "--size", "WxH",
            "Pixels, at most " + std::to_string(render::maxPictureSide) +
                " a side; with --compare, of each of the three",
            [&my](const std::string& text) { return readSize(text, my.size); })
        ->default_str("512x512");
    command.add_flag("--caption", my.caption,
                     "Write into the picture what it shows and where; onto parallel views, the "
                     "patient's directions at the edges and a bar of millimetres; onto a "
                     "comparison, titles and the tissues' colours; with --paint findings, onto the "
                     "overview, where the colon hides them, too, and the whole strip, rings and "
                     "the findings' numbers. What has no room is cut short or left out, but for "
                     "the directions");
    command
        .add_option(
            "--out", my.out,
            "The picture, with a note of what it shows and how in its metadata; replaced in one "
            "step. JPEG loses some of the pixels; EXR holds linear light")
        ->type_name("FILE.png|.tif|.exr|.jpg")
        ->check([](const std::string& name) {
            return pictures::isPictureFile(name)
                       ? std::string()
                       : "\"" + name + "\" does not end in " +
                             CLI::detail::join(pictures::fileEndings(), ", ");
        })
        ->required();
}

[[noreturn]] void wrong(const std::string& option, const std::string& what) {
    throw CLI::ValidationError(option, what);
}

/// As --view calls it.
std::string nameOf(const RenderArguments& my) {
    return !my.view.empty() ? my.view : my.isScan() ? camera : toString(my.shown());
}

using Views = std::vector<std::string>;

/// Of options that would say nothing of other views, those of which they do.
const std::vector<std::pair<const char*, Views>>& viewsOfOptions() {
    static const Views slices{"axial", "coronal", "sagittal"},
        planes{"axial", "coronal", "sagittal", "oblique"}, cameras{"endoscopic", camera},
        outside{camera, "overview"}, free{camera, "oblique"}, overview{"overview"};
    static const std::vector<std::pair<const char*, Views>> table{
        {"--pixels-per-circumference", {"flattened-zoom"}},
        {"--direction", {"endoscopic", "oblique", "overview"}},
        {"--eye", {camera}},
        {"--look", free},
        {"--up", free},
        {"--azimuth", outside},
        {"--elevation", outside},
        {"--lens", cameras},
        {"--fov", cameras},
        {"--height-mm", {"endoscopic", camera, "oblique", "overview"}},
        {"--mark", overview},
        {"--no-body", overview},
        {"--window", planes},
        {"--zoom", slices}};
    return table;
}

/// An option that is given says something of the view that is drawn.
void checkViews(const CLI::App& command, const RenderArguments& my) {
    const std::string shown = nameOf(my);
    for (const auto& [option, views] : viewsOfOptions()) {
        if (command.count(option) == 0 ||
            std::find(views.begin(), views.end(), shown) != views.end())
            continue;
        std::string names = views.front();
        for (std::size_t n = 1; n < views.size(); ++n)
            names += (n + 1 < views.size() ? ", " : " or ") + views[n];
        wrong(option, "is for --view " + names + ", not " + shown);
    }
    if (my.castsRays()) return;
    for (const char* option : {"--raycaster", "--step", "--gpu-budget"})
        if (command.count(option) > 0) wrong(option, "a slice casts no rays");
}

/// Of a folder, what is in it tells when it is read.
void checkSpacing(const CLI::App& command, const RenderArguments& my) {
    std::error_code ignored;
    if (command.count("--spacing") > 0 && (!my.isScan() || fs::is_regular_file(my.input, ignored)))
        wrong("--spacing", "is for a folder of PNG or TIFF slices");
}

/// Options that the camera's lens or its place leaves nothing to say.
void checkCamera(const CLI::App& command, const RenderArguments& my) {
    if (my.lens == Lens::orthographic && my.fovDegrees)
        wrong("--fov", "an orthographic lens has none; give --height-mm");
    if (my.lens != Lens::orthographic && my.heightMm && my.shown() == View::endoscopic)
        wrong("--height-mm", "of a camera needs --lens orthographic");
    if (my.fovDegrees && my.lens == Lens::perspective && *my.fovDegrees > 170.0)
        wrong("--fov", "a perspective sees 170 degrees at most");
    for (const char* option : {"--azimuth", "--elevation"})
        if (command.count(option) > 0 && !my.eyeMm.empty())
            wrong(option, "turns a camera outside, and --eye places another");
    if (command.count("--direction") > 0 && !my.arcMm) wrong("--direction", "needs --arc-mm");
}

void checkPlace(const RenderArguments& my) {
    const bool outside = my.view == camera || (my.view.empty() && my.isScan());
    const View view = my.shown();
    const int places = (my.arcMm ? 1 : 0) + int(my.positionMm.size()) + (my.flat ? 1 : 0);
    if (my.positionMm.size() > 1) wrong("--position", "given more than once");
    for (const auto& [name, points] :
         {std::pair("--eye", &my.eyeMm), {"--look", &my.lookMm}, {"--up", &my.up}})
        if (points->size() > 1) wrong(name, "given more than once");
    if (!my.lookMm.empty() && (outside ? my.eyeMm : my.positionMm).empty())
        wrong("--look", outside ? "needs --eye" : "needs --position");
    if (my.flat && (my.isSlice() || view == View::oblique || view == View::overview))
        wrong("--flat", "places flattened-zoom and endoscopic");
    if (view == View::flattened && places > 0)
        wrong("--view", "flattened shows the whole strip and takes no place");
    if (outside && places > 0) wrong("--view", "camera is placed by --eye and --look");
    if (view == View::overview && (!my.positionMm.empty() || my.flat))
        wrong("--view", "overview takes no place but the reader's, --arc-mm");
    if (view == View::oblique && !my.positionMm.empty() && my.lookMm.empty())
        throw CLI::RequiredError("--look");
    if (places > 1) wrong("--view", "the place is given in two ways");
    if (places == 0 && !outside && view != View::flattened && view != View::overview)
        throw CLI::RequiredError(my.isSlice() || view == View::oblique
                                     ? "--arc-mm or --position"
                                     : "--flat, --arc-mm or --position");
}

}  // namespace

bool RenderArguments::isScan() const {
    const std::string& name = input;
    return name.find('/') != std::string::npos || name.ends_with(".nii") ||
           name.ends_with(".nii.gz");
}

View RenderArguments::shown() const {
    if (view.empty() || view == camera) return View::endoscopic;
    return *viewFromString(view);
}

bool RenderArguments::isSlice() const {
    const View kind = shown();
    return kind == View::axial || kind == View::coronal || kind == View::sagittal;
}

bool RenderArguments::isFlattened() const {
    return shown() == View::flattened || shown() == View::flattenedZoom;
}

bool RenderArguments::paintsFindings() const {
    return paint == store::product::findings;
}

bool RenderArguments::castsRays() const {
    return !isSlice() && shown() != View::oblique;
}

void addRenderOptions(CLI::App& command, RenderArguments& my) {
    command
        .add_option("INPUT", my.input,
                    "A case's name; or a scan: FILE.nii, FILE.nii.gz, or a FOLDER/ of DICOM files "
                    "or of PNG or TIFF slices (its name with a slash)")
        ->required();
    addStoreOption(command, my.store)->required(false);
    command
        .add_option("--view", my.view,
                    "What to draw; without it endoscopic, and camera of a scan, which has no other "
                    "than slices and oblique")
        ->check(CLI::IsMember({"endoscopic", "camera", "overview", "oblique", "axial", "coronal",
                               "sagittal", "flattened", "flattened-zoom"}));
    auto* product =
        command
            .add_option("--product", my.product,
                        "Which scan to draw; else a slice shows ct, the other views cleansed where "
                        "the case has it")
            ->check(CLI::IsMember({store::product::ct, store::product::cleansed}));
    command
        .add_flag("--compare", my.compare,
                  "A slice three times, side by side: ct, the mixture by colours (air red, soft "
                  "tissue green, bone and tagged material blue, air meeting tagged material pink), "
                  "cleansed")
        ->excludes(product);
    addPlaceOptions(command, my);
    addCameraOptions(command, my);
    addDrawingOptions(command, my);
    addText(command, "--spacing", "X,Y,Z",
            "Millimetres between pixels and between slices of a folder of PNG or TIFF slices. The "
            "first "
            "slice, by the numbers in the names, is the lowest; with a negative Z, the highest",
            [&my](const std::string& text) {
                const auto numbers = parseNumbers(text, ',', 3);
                if (!numbers) return "is not X,Y,Z";
                const glm::dvec3 mm((*numbers)[0], (*numbers)[1], (*numbers)[2]);
                if (!(mm.x > 0.0 && mm.y > 0.0)) return "has an X or Y that is not over 0";
                if (mm.z == 0.0) return "has a Z of 0";
                my.spacingMm = mm;
                return "";
            })
        ->default_str("1,1,1");
    addPictureOptions(command, my);
    addThreadsOption(command, my.threads);
}

void checkUsage(const CLI::App& command, const RenderArguments& my) {
    const View view = my.shown();
    if (my.isScan()) {
        if (my.view == "endoscopic" || my.isFlattened() || view == View::overview)
            wrong("--view", my.view + " shows a case, not a scan");
        if (my.compare || !my.product.empty()) wrong("--product", "a scan has no products");
        if (my.arcMm || my.flat) wrong("--arc-mm", "a scan has no centerline");
        if (view == View::endoscopic && my.optics.empty() && my.labels.empty())
            wrong("--tf", "a scan from a file needs a preset (" + presetNames() +
                              ") or a preset's file FILE.json");
        if (view != View::endoscopic && !my.labels.empty())
            wrong("--labels", "is for a camera's view");
    } else if (!my.labels.empty()) {
        wrong("--labels", "is for a colour volume from a file");
    } else if (my.store.empty()) {
        throw CLI::RequiredError("--store");
    }
    checkSpacing(command, my);
    checkViews(command, my);
    checkCamera(command, my);
    if (!my.optics.empty() && !my.castsRays())
        wrong("--tf", "a slice shows grey values; give --window");
    if (!my.optics.empty() && !my.labels.empty())
        wrong("--tf", "a colour volume has colours of its own");
    if (command.count("--raycaster") > 0 && !my.labels.empty())
        wrong("--raycaster", "a colour volume is drawn in object order");
    if (my.gpuBudgetMiB > 0.0 && my.labels.empty() &&
        raycasterEntry(my.raycaster).volume != VolumeOnGpu::cells)
        wrong("--gpu-budget",
              "only the object-order raycaster has one; give --raycaster "
              "object-order");
    if (!my.isSlice() && my.compare) wrong("--compare", "compares slices; give --view");
    if (my.leastProbability && !my.paintsFindings())
        wrong("--least-probability", "needs --paint findings");
    if (my.paintsFindings() && (my.isScan() || !showsWall(view)))
        wrong("--paint", "findings colours a case's views of the wall");
    if (!my.paint.empty() && !my.paintsFindings() && nameOf(my) != "endoscopic")
        wrong("--paint", "of a file is for --view endoscopic, not " + nameOf(my));
    checkPlace(my);
}

}  // namespace haustra::cli
