// haustra coverage: how much of a colon's wall a simulated colonoscopy shows (dissertation
// §2.3–2.5).
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interruption.h"
#include "cli/progress_bar.h"
#include "cli/provenance.h"
#include "cli/text_files.h"
#include "core/bridges.h"
#include "core/durable_file.h"
#include "coverage/corner_path.h"
#include "coverage/coverage_pictures.h"
#include "coverage/coverage_report.h"
#include "coverage/fine_wall.h"
#include "coverage/lens_file.h"
#include "coverage/path_planning.h"
#include "gpu/context.h"
#include "pictures/picture_file.h"
#include "render/wall/item_buffer.h"
#include "store/case_store.h"
#include "store/products.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;
namespace product = store::product;

using namespace haustra::coverage;

// Raise it whenever the product changes for the same input and options.
constexpr int coverageVersion = 2;

struct CoverageArguments {
    fs::path store, report, pictures;
    std::string caseName, mode, direction, visibility = "rays", lens = "olympus-cf-q160l";
    int cameras = 1000, side = PinholePicture{}.side, threads = 0;

    bool isOptical() const { return mode == "oc"; }
};

/// The case, as far as coverage needs it, and what it was read under.
struct Inputs {
    CoverageWall wall;
    Volume<float> distance;
    std::vector<ColonPiece> pieces;            ///< empty: not known
    std::vector<std::int32_t> sourceTriangle;  ///< of each fine one
    std::optional<FlatMap> flattened;
    std::vector<store::ProductKey> keys;
};

Result<Inputs> readInputs(const store::Case& source, bool optical) {
    Inputs inputs;
    const auto note = [&](const char* name) -> Result<void> {
        const auto entry = source.find(name);
        if (!entry)
            return fail(ErrorKind::noResult,
                        std::string("the case has no ") + name + ": prepare it first",
                        "case " + source.name());
        inputs.keys.push_back(entry->key);
        return source.verify(name);
    };
    TRY(note(product::surface));
    TRY(note(product::centerline));
    TRY(note(product::lumen));
    auto fine = fineWall(TRY(source.readMesh()));
    inputs.sourceTriangle = std::move(fine.sourceTriangle);
    inputs.wall.mesh = std::move(fine.mesh);
    inputs.wall.neighbours = neighboursOf(inputs.wall.mesh);
    inputs.wall.centerline = TRY(source.readCenterline());
    if (inputs.wall.centerline.points.empty())
        return fail(ErrorKind::noResult, "the centerline is empty", "case " + source.name());
    const auto lumen = TRY(source.readVolume<std::uint8_t>(product::lumen));
    inputs.wall.bridged = bridgedTriangles(inputs.wall.mesh, lumen);
    if (optical) {
        TRY(note(product::distance));
        inputs.distance = TRY(source.readVolume<float>(product::distance));
    }
    if (source.find(product::quality)) {
        TRY(note(product::quality));
        inputs.pieces = TRY(source.readText(product::quality).and_then(piecesOfQuality));
    }
    if (source.find(product::flatMap)) {
        TRY(note(product::flatMap));
        inputs.flattened = TRY(source.readFlatMap());
    }
    return inputs;
}

double millisecondsNow() {
    return std::chrono::duration<double, std::milli>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

/// One way to see: rays, or a GPU's item buffer.
class Looker {
public:
    Looker(const CoverageArguments& arguments, const SightTree& tree, const CoverageWall& wall,
           const Eyepiece& eyepiece, const PinholePicture& picture, SightOptions options)
        : arguments_(arguments),
          tree_(tree),
          wall_(wall),
          eyepiece_(eyepiece),
          picture_(picture),
          options_(std::move(options)) {}

    /// --visibility; auto takes what would be done first with all pictures on this machine, told
    /// from some of them.
    Result<void> choose(const std::vector<CenterlineCamera>& cameras, ProgressBar& bar) {
        if (arguments_.isOptical() || arguments_.visibility == "rays") return {};
        auto made = makeItems();
        if (!made) {
            if (arguments_.visibility == "gpu") return made;
            bar.say("visibility: rays, as there is no GPU to use: " + describe(made.error()));
            return {};
        }
        useGpu_ = true;
        if (arguments_.visibility == "gpu") return {};
        const auto trial = [&](std::size_t count) {
            std::vector<CenterlineCamera> some;
            for (std::size_t n = 0; n < count; ++n)
                some.push_back(cameras[n * cameras.size() / count]);
            return some;
        };
        bar.show("visibility", 0.0);
        const auto timed = [&](std::size_t count, const auto& look) -> Result<double> {
            const auto some = trial(count);
            const double start = millisecondsNow();
            TRY(look(some));
            return millisecondsNow() - start;
        };
        const std::size_t all = cameras.size(), few = std::min<std::size_t>(2, all),
                          some = std::min<std::size_t>(24, all),
                          more = std::min<std::size_t>(96, all);
        SightOptions quiet = options_;
        quiet.progress = {};
        begun_.assign(wall_.mesh.triangles.size(), Visibility::unseen);
        const auto byRays = [&](const std::vector<CenterlineCamera>& chosen) {
            return coverage::look(tree_, eyepiece_, chosen, begun_, quiet);
        };
        const auto byGpu = [&](const std::vector<CenterlineCamera>& chosen) -> Result<void> {
            TRY(byItems(chosen, {}));
            return {};
        };
        // The GPU's pictures cost the same each. Those of rays cost little once what can be seen
        // has been seen by the first, so that all the rest cost no more each than the second lot.
        const auto fewMs = timed(few, byGpu);
        if (!fewMs && interrupted()) return tl::make_unexpected(fewMs.error());
        if (!fewMs) {
            useGpu_ = false;
            bar.say("visibility: rays, as the GPU fails: " + describe(fewMs.error()));
            return {};
        }
        const double gpuMs = *fewMs * double(all) / double(few);
        const double someMs = TRY(timed(some, byRays)), moreMs = TRY(timed(more, byRays));
        const double raysMs = someMs + moreMs * double(all) / double(more);
        useGpu_ = gpuMs < raysMs;
        bar.say(fmt::format("visibility: {}; about {:.1f} s by rays, {:.1f} s by {}", name(),
                            raysMs / 1e3, gpuMs / 1e3, context_->renderer()));
        return {};
    }

    const char* name() const { return useGpu_ ? "gpu" : "rays"; }

    Result<void> look(const std::vector<CenterlineCamera>& cameras, std::vector<Visibility>& seen,
                      const Progress& progress) {
        if (useGpu_) {
            addSeen(seen, TRY(byItems(cameras, progress)));
            return {};
        }
        // What the trial has seen is seen: its pictures are among these.
        if (!begun_.empty()) addSeen(seen, begun_);
        SightOptions options = options_;
        options.progress = progress;
        return coverage::look(tree_, eyepiece_, cameras, seen, options);
    }

private:
    bool interrupted() const { return options_.cancelled && options_.cancelled(); }
    Result<void> makeItems() {
        context_ = TRY(gpu::Context::create());
        items_ = TRY(render::ItemBuffer::create(*context_, wall_.mesh, wall_.bridged, picture_,
                                                options_.tellFully));
        return {};
    }
    Result<std::vector<Visibility>> byItems(const std::vector<CenterlineCamera>& cameras,
                                            const Progress& progress) {
        for (std::size_t n = 0; n < cameras.size(); ++n) {
            if (interrupted()) return fail(ErrorKind::wrongState, "interrupted");
            TRY(items_->look(cameras[n]));
            if (progress) progress(double(n + 1) / double(cameras.size()));
        }
        return items_->seen();
    }

    const CoverageArguments& arguments_;
    const SightTree& tree_;
    const CoverageWall& wall_;
    const Eyepiece& eyepiece_;
    PinholePicture picture_;
    SightOptions options_;
    bool useGpu_ = false;
    std::vector<Visibility> begun_;  ///< by the trial's rays
    std::unique_ptr<gpu::Context> context_;
    std::unique_ptr<render::ItemBuffer> items_;  // before the context
};

/// `count` on the centerline, half of them looking each way.
std::vector<CenterlineCamera> bothWays(const Centerline& line, int there, int back) {
    auto cameras = flightCameras(line, there, FlightDirection::antegrade);
    const auto others = flightCameras(line, back, FlightDirection::retrograde);
    cameras.insert(cameras.end(), others.begin(), others.end());
    return cameras;
}

std::vector<CenterlineCamera> camerasAlong(const CoverageArguments& arguments,
                                           const Centerline& path) {
    const auto along = arguments.isOptical() ? scopeCameras : flightCameras;
    std::vector<CenterlineCamera> cameras;
    for (const auto& [name, direction] : {std::pair("antegrade", FlightDirection::antegrade),
                                          std::pair("retrograde", FlightDirection::retrograde)}) {
        if (arguments.direction != name && arguments.direction != "both") continue;
        const auto more = along(path, arguments.cameras, direction);
        cameras.insert(cameras.end(), more.begin(), more.end());
    }
    return cameras;
}

/// Of the wall's area, what the flat map has: it leaves out a hole at either end.
double flattenedPercent(const Inputs& inputs) {
    std::vector<std::uint8_t> has;
    for (const std::int32_t triangle : inputs.flattened->sourceTriangle) {
        if (std::size_t(triangle) >= has.size()) has.resize(std::size_t(triangle) + 1, 0);
        has[std::size_t(triangle)] = 1;
    }
    double all = 0.0, flat = 0.0;
    for (std::size_t n = 0; n < inputs.sourceTriangle.size(); ++n) {
        if (inputs.wall.bridged[n]) continue;
        const auto source = std::size_t(inputs.sourceTriangle[n]);
        const double areaMm2 = inputs.wall.areaMm2(n);
        all += areaMm2;
        if (source < has.size() && has[source]) flat += areaMm2;
    }
    return all > 0.0 ? 100.0 * flat / all : 0.0;
}

struct Drawn {
    std::string name;
    Image image;
    pictures::Provenance provenance;
};

/// Figure 2.6: the colon from the front and from behind, and four views from within: of the largest
/// missed patches, where there are so many, else from among the cameras.
Result<std::vector<Drawn>> drawPictures(const CoverageArguments& arguments, const Inputs& inputs,
                                        const SightTree& tree, const Eyepiece& eyepiece,
                                        const Centerline& path,
                                        const std::vector<CenterlineCamera>& cameras,
                                        const std::vector<MissedPatch>& missed,
                                        const std::vector<Visibility>& seen, ProgressBar& bar,
                                        const Interruption& interruption) {
    constexpr glm::ivec2 outsideSize(768, 768);
    constexpr int views = 4;
    pictures::Provenance provenance = ownProvenance();
    provenance.facts = {{"case", arguments.caseName},
                        {"view", "coverage"},
                        {"mode", arguments.mode},
                        {"cameras", std::to_string(arguments.cameras)}};
    if (!arguments.direction.empty())
        provenance.facts.emplace_back("direction", arguments.direction);
    const WallRays& rays = tree.rays();
    std::vector<Drawn> drawn;
    const auto tell = [&] { bar.show("pictures", double(drawn.size()) / (views + 2)); };
    tell();
    for (const auto& [name, azimuth] : {std::pair("front.png", 0.0), {"back.png", 180.0}}) {
        drawn.push_back(
            {name,
             paintedOutside(rays, inputs.wall, seen, path, outsideSize, azimuth, arguments.threads),
             provenance});
        if (interruption.came()) return fail(ErrorKind::wrongState, "interrupted");
        tell();
    }
    for (int n = 0; n < views; ++n) {
        CenterlineCamera camera = cameras[cameras.size() * std::size_t(2 * n + 1) / (2 * views)];
        if (std::size_t(n) < missed.size())
            camera = cameraForPatch(tree, inputs.wall, missed[std::size_t(n)]).value_or(camera);
        drawn.push_back({fmt::format("view-{}.png", n + 1),
                         paintedView(rays, inputs.wall, seen, eyepiece, camera, arguments.threads),
                         provenance});
        auto& facts = drawn.back().provenance.facts;
        facts.emplace_back("camera.position_mm", toText(camera.positionMm));
        facts.emplace_back("camera.forward", toText(camera.forward));
        if (interruption.came()) return fail(ErrorKind::wrongState, "interrupted");
        tell();
    }
    return drawn;
}

Result<void> writePictures(const fs::path& folder, const std::vector<Drawn>& drawn) {
    if (drawn.empty()) return {};
    std::error_code error;
    fs::create_directory(folder, error);
    if (error)
        return fail(ErrorKind::io, "cannot make the folder: " + error.message(), folder.string());
    for (const Drawn& picture : drawn)
        TRY(pictures::writePicture(folder / picture.name, picture.image, picture.provenance));
    return {};
}

void print(const CoverageReport& report, double seconds, double lookSeconds) {
    fmt::print(
        "{}{}{} {} cameras, {} pictures by {}: {:.2f} % of the wall's area, {:.2f} % of its "
        "triangles, in {:.1f} s ({:.1f} s of it to see)\n",
        report.mode, report.direction.empty() ? "" : " ", report.direction, report.cameras,
        report.pictures, report.visibility, report.share.areaPercent(),
        report.share.trianglePercent(), seconds, lookSeconds);
    if (report.clearanceMm > 0.0)
        fmt::print("path: {:.0f} mm, {:.0f} mm of it nearer to the wall than {:.1f} mm\n",
                   report.pathMm, report.narrowMm, report.clearanceMm);
    if (report.segments) {
        for (int n = 0; n < colonSegments; ++n) {
            const Share& share = (*report.segments)[std::size_t(n)];
            if (share.triangles > 0)
                fmt::print("  {:<12} {:8.0f} mm2  {:6.2f} %\n", toString(ColonSegment(n)),
                           share.areaMm2, share.areaPercent());
        }
    }
    const auto large = std::ranges::count_if(
        report.missed, [](const MissedPatch& patch) { return patch.areaMm2 >= leastReviewedMm2; });
    fmt::print("missed: {} patches, {} of {:.0f} mm2 and more\n", report.missed.size(), large,
               leastReviewedMm2);
    if (report.review)
        fmt::print("after review of those: {:.2f} % of the area ({} pictures in {} rounds)\n",
                   report.reviewed.areaPercent(), report.review->patches, report.review->rounds);
    if (report.flattenedPercent)
        fmt::print("the flattened strip has {:.2f} % of the area\n", *report.flattenedPercent);
    if (report.centerlineShare)
        fmt::print("as many pictures on the centerline, both ways: {:.2f} % of the area\n",
                   report.centerlineShare->areaPercent());
}

Result<void> runCoverage(const CoverageArguments& arguments) {
    TRY(checkOutputFile(arguments.report));
    std::error_code error;
    if (fs::exists(arguments.pictures, error) && !fs::is_directory(arguments.pictures, error))
        return fail(ErrorKind::io, "pictures go into a folder, and this is none",
                    arguments.pictures.string());
    if (!arguments.pictures.empty() &&
        !fs::is_directory(fs::absolute(arguments.pictures / "").parent_path().parent_path(), error))
        return fail(ErrorKind::notFound, "there is no folder to make this one in",
                    arguments.pictures.string());
    const Colonoscope scope = TRY(readColonoscope(arguments.lens));
    const auto store = TRY(store::CaseStore::open(arguments.store, false));
    const auto source = TRY(store.openCase(arguments.caseName));

    const Interruption interruption;
    ProgressBar bar;
    const auto began = millisecondsNow();
    const auto stage = [&](const char* name) {
        bar.show(name, 0.0);
        return [&bar, name](double fraction) { bar.show(name, fraction); };
    };
    SightOptions options;
    options.tellFully = !arguments.isOptical();
    options.threads = arguments.threads;
    options.cancelled = [&] { return interruption.came(); };

    bar.show("surface", 0.0);
    const Inputs inputs = TRY(readInputs(source, arguments.isOptical()));
    bar.show("surface", 0.5);
    const CoverageWall& wall = inputs.wall;
    const auto rays = TRY(WallRays::of(wall.mesh, wall.bridged));
    const SightTree tree(rays);

    CoverageReport report;
    report.mode = arguments.mode;
    report.direction = arguments.direction;
    report.cameras = arguments.cameras;
    report.tellsFully = options.tellFully;
    PinholePicture picture;
    picture.side = arguments.side;
    const Eyepiece eyepiece = arguments.isOptical() ? Eyepiece::of(scope) : Eyepiece::of(picture);
    report.lens = arguments.isOptical()
                      ? scope.name
                      : fmt::format("pinhole {:.0f} degrees, {} x {}", picture.fovDegrees,
                                    picture.side, picture.side);
    report.nearestMm = arguments.isOptical() ? scope.nearestMm : picture.nearestMm;
    report.farthestMm = arguments.isOptical() ? scope.farthestMm : picture.farthestMm;

    Centerline path = wall.centerline;
    std::vector<CenterlineCamera> cameras;
    if (arguments.isOptical()) {
        bar.show("path", 0.0);
        auto corner = TRY(cornerPath(inputs.distance, wall.centerline, scope.tipRadiusMm));
        path = std::move(corner.path);
        report.narrowMm = corner.narrowMm;
        report.clearanceMm = scope.tipRadiusMm;
    }
    report.pathMm = path.lengthMm();
    if (arguments.mode == "planned") {
        PlanOptions plan;
        plan.threads = arguments.threads;
        plan.cancelled = options.cancelled;
        plan.progress = stage("planning");
        cameras = TRY(plannedCameras(tree, wall, picture, arguments.cameras, plan));
    } else {
        cameras = camerasAlong(arguments, path);
    }
    report.pictures = int(cameras.size());

    std::vector<Visibility> seen(wall.mesh.triangles.size(), Visibility::unseen);
    double lookSeconds = 0.0;
    {
        Looker looker(arguments, tree, wall, eyepiece, picture, options);
        TRY(looker.choose(cameras, bar));
        report.visibility = looker.name();
        const double start = millisecondsNow();
        TRY(looker.look(cameras, seen, stage("visibility")));
        lookSeconds = (millisecondsNow() - start) / 1e3;
    }
    report.share = shareOf(wall, seen);
    report.missed = wall.missed(seen);
    for (std::size_t n = 0; n < seen.size(); ++n)
        if (wall.bridged[n]) report.bridgedMm2 += wall.areaMm2(n);
    report.segmentOfTriangle =
        segmentsOf(arcsOf(wall, inputs.sourceTriangle,
                          inputs.flattened ? &*inputs.flattened : nullptr, arguments.threads),
                   segmentsAlong(wall.centerline, inputs.pieces));
    if (!report.segmentOfTriangle.empty())
        report.segments = sharesBySegment(wall, seen, report.segmentOfTriangle);
    if (inputs.flattened) report.flattenedPercent = flattenedPercent(inputs);
    if (arguments.mode == "planned") {
        std::vector<Visibility> onLine(seen.size(), Visibility::unseen);
        SightOptions plain = options;
        plain.tellFully = false;
        plain.progress = stage("centerline");
        const int count = int(cameras.size());
        TRY(look(tree, eyepiece, bothWays(wall.centerline, (count + 1) / 2, count / 2), onLine,
                 plain));
        report.centerlineShare = shareOf(wall, onLine);
    }
    {
        std::vector<Visibility> reviewed = seen;
        SightOptions review = options;
        review.tellFully = false;
        review.progress = stage("review");
        report.review = TRY(
            reviewMissed(tree, wall, Eyepiece::of(picture), leastReviewedMm2, reviewed, review));
        report.reviewed = shareOf(wall, reviewed);
    }
    std::vector<Drawn> drawn;
    if (!arguments.pictures.empty())
        drawn = TRY(drawPictures(arguments, inputs, tree, eyepiece, path, cameras, report.missed,
                                 seen, bar, interruption));
    if (interruption.came()) return fail(ErrorKind::wrongState, "interrupted");

    const std::string said =
        fmt::format("mode={} direction={} cameras={} side={} visibility={} lens={}", arguments.mode,
                    arguments.direction, arguments.cameras, arguments.side, report.visibility,
                    arguments.isOptical() ? lensText(scope) : "pinhole");
    auto target = TRY(store.createCase(arguments.caseName));
    for (const char* name : {product::surface, product::centerline, product::lumen}) {
        const auto entry = target.find(name);
        if (!entry || std::ranges::find(inputs.keys, entry->key) == inputs.keys.end())
            return fail(ErrorKind::wrongState,
                        "the case has been prepared anew meanwhile: run this again",
                        "case " + arguments.caseName);
    }
    TRY(target.publishText(product::coverage,
                           store::makeKey("coverage", coverageVersion, said, inputs.keys),
                           coverageJson(report, wall, seen)));
    if (!arguments.report.empty()) TRY(writeDurably(arguments.report, coverageJson(report)));
    TRY(writePictures(arguments.pictures, drawn));
    bar.show("done", 1.0);
    print(report, (millisecondsNow() - began) / 1e3, lookSeconds);
    return {};
}

}  // namespace

Command addCoverage(CLI::App& program) {
    auto arguments = std::make_shared<CoverageArguments>();
    CLI::App* command = program.add_subcommand(
        "coverage",
        "How much of a colon's wall a simulated colonoscopy shows, and what it misses. It is kept "
        "as "
        "the case's product coverage. A prepared mask will do (prepare --lumen).");
    command->add_option("CASE", arguments->caseName, "The case's name")->required();
    addStoreOption(*command, arguments->store);
    command
        ->add_option("--mode", arguments->mode,
                     "oc: an optical colonoscope, whose lens keeps its distance from the wall and "
                     "hugs the corners; vc: a virtual flight along the centerline, 90 degrees; "
                     "planned: cameras beside the centerline, placed so that they miss little, and "
                     "as many on the centerline for comparison")
        ->required()
        ->check(CLI::IsMember({"oc", "vc", "planned"}));
    command
        ->add_option("--cameras", arguments->cameras,
                     "Places on the path, a picture at each for each direction; planned: pictures")
        ->type_name("N")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str();
    command
        ->add_option(
            "--direction", arguments->direction,
            "Where the cameras look: antegrade, towards the cecum, as a colonoscope does on "
            "its way in and out (default of oc); retrograde, towards the rectum; both "
            "(default of vc)")
        ->check(CLI::IsMember({"antegrade", "retrograde", "both"}));
    command
        ->add_option("--lens", arguments->lens,
                     "Of oc: olympus-cf-q160l, or a file that calibrate writes")
        ->type_name("NAME|FILE")
        ->capture_default_str();
    command->add_option("--side", arguments->side, "Of vc and planned: pixels of a picture's side")
        ->type_name("PIXELS")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    command
        ->add_option(
            "--visibility", arguments->visibility,
            "Of vc and planned: by rays on the CPU, by an item buffer on the GPU, or (auto) by "
            "whichever would be done first, told from some pictures: the two differ on a "
            "triangle in some ten thousand; of oc by rays")
        ->check(CLI::IsMember({"auto", "rays", "gpu"}))
        ->capture_default_str();
    command
        ->add_option(
            "--report", arguments->report,
            "Write shares by area and by triangle, of each segment, and the missed patches "
            "with area, centre (LPS, mm) and arc")
        ->type_name("FILE.json");
    command
        ->add_option(
            "--pictures", arguments->pictures,
            "Write pictures into this folder (made if it is not there), the wall green where it "
            "was seen: front.png and back.png from outside, view-1.png to view-4.png through the "
            "lens before the largest patches that were missed")
        ->type_name("FOLDER");
    addThreadsOption(*command, arguments->threads);
    command->callback([arguments, command] {
        if (arguments->mode != "oc" && command->count("--lens") > 0)
            throw CLI::ValidationError("--lens", "is an option of oc");
        if (arguments->mode == "oc" && command->count("--side") > 0)
            throw CLI::ValidationError("--side", "is an option of vc and planned");
        if (arguments->mode == "oc" && arguments->visibility == "gpu")
            throw CLI::ValidationError("--visibility gpu",
                                       "a raster draws straight edges, which oc's lens bends");
        if (arguments->mode == "planned" && command->count("--direction") > 0)
            throw CLI::ValidationError("--direction", "is an option of oc and vc");
        if (arguments->direction.empty() && arguments->mode != "planned")
            arguments->direction = arguments->mode == "oc" ? "antegrade" : "both";
    });
    return {command, [arguments] { return runCoverage(*arguments); }};
}

}  // namespace haustra::cli
