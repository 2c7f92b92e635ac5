// haustra calibrate: an endoscope's lens from pictures of a flat board.
#include "cli/arguments.h"
#include "cli/calibration_picture.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "cli/provenance.h"
#include "cli/text_files.h"
#include "core/durable_file.h"
#include "coverage/board.h"
#include "coverage/calibrate.h"
#include "coverage/lens_file.h"
#include "coverage/undistort.h"
#include "pictures/picture_file.h"

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
    std::vector<fs::path> images;
    std::optional<coverage::Board> board;
    std::string model = "kannala-brandt", lens, nominal = "equidistance", name = "endoscope";
    std::optional<double> fieldDegrees, focalMm, pixelsPerMm;
    std::vector<double> depthMm{3.0, 100.0};
    double spacingMm = 1.0, tipRadiusMm = 6.4;
    fs::path out, openCv, residuals, undistorted;
};

struct Picture {
    fs::path file;
    Image image;
};

Result<std::vector<Picture>> readPictures(const std::vector<fs::path>& files) {
    std::vector<Picture> pictures;
    for (const fs::path& file : files) {
        const auto read = TRY(pictures::readColorPicture(file, coverage::mostScopePixels));
        Image image = blankImage(read.size);
        for (std::size_t n = 0; n < read.pixels.size(); ++n)
            for (int c = 0; c < 3; ++c)
                image.rgb[3 * n + std::size_t(c)] = read.pixels[n][c];
        if (!pictures.empty() && (image.width != pictures.front().image.width ||
                                  image.height != pictures.front().image.height))
            return fail(ErrorKind::badInput,
                        fmt::format("the picture is of {}x{} pixels, and {} of {}x{}: one camera's "
                                    "pictures are of one size",
                                    image.width, image.height, files.front().string(),
                                    pictures.front().image.width, pictures.front().image.height),
                        file.string());
        pictures.push_back({file, std::move(image)});
    }
    return pictures;
}

void tellNumber(const char* name, double value, double error, bool held) {
    if (held)
        fmt::print("{:<6}{:14.7g}   held\n", name, value);
    else
        fmt::print("{:<6}{:14.7g} ± {:.2g}\n", name, value, error);
}

/// What does not reach the printed page is told as 0: what a model leaves out.
void tellLens(const coverage::FisheyeLens& lens, const coverage::Calibration* calibration) {
    const auto numbers = coverage::numbersOf(lens);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        const double error = calibration ? calibration->standardErrors[n] : 0.0;
        const bool held = calibration && calibration->held == n;
        const char* name = coverage::lensNumberNames()[n];
        if (calibration && (held || error > 0.0))
            tellNumber(name, numbers[n], error, held);
        else if (numbers[n] != 0.0)
            fmt::print("{:<6}{:14.7g}\n", name, numbers[n]);
    }
}

/// A name that marks can write.
std::string printable(const fs::path& file) {
    std::string name = file.filename().string();
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return name;
}

/// What was found in the pictures, and what of them has no board.
struct Boards {
    std::vector<std::size_t> pictures;  ///< one of each view
    std::vector<coverage::BoardView> views;
    std::vector<std::string> reasons;  ///< of each picture; empty where it has a board
};

Result<Boards> findBoards(const std::vector<Picture>& pictures, const coverage::Board& board) {
    Boards boards;
    boards.reasons.resize(pictures.size());
    ProgressBar bar;
    for (std::size_t n = 0; n < pictures.size(); ++n) {
        bar.show("boards", double(n) / double(pictures.size()));
        auto view = coverage::findBoard(pictures[n].image, board);
        if (view) {
            boards.pictures.push_back(n);
            boards.views.push_back(std::move(*view));
        } else if (view.error().kind == ErrorKind::noResult) {
            boards.reasons[n] = view.error().message;
        } else {
            return tl::make_unexpected(view.error());
        }
    }
    bar.show("boards", 1.0);
    return boards;
}

Result<coverage::CalibrationOptions> optionsOf(const CalibrateArguments& arguments,
                                               const std::vector<Picture>& pictures) {
    coverage::CalibrationOptions options;
    options.model = coverage::findLensModel(arguments.model);
    options.pictureSize = {pictures.front().image.width, pictures.front().image.height};
    options.fieldDegrees = arguments.fieldDegrees;
    options.focalMm = arguments.focalMm;
    options.pixelsPerMm = arguments.pixelsPerMm;
    options.nominal = coverage::findLensModel(arguments.nominal)->projection;
    if (!arguments.lens.empty())
        options.start = TRY(coverage::readColonoscope(arguments.lens)).lens;
    std::vector<Image> images;
    for (const Picture& picture : pictures)
        images.push_back(picture.image);
    const auto field = coverage::findField(images);
    if (field) {
        options.field = *field;
        fmt::print("field: an ellipse about ({:.2f}, {:.2f}) of radii {:.2f} and {:.2f} pixels\n",
                   field->center.x, field->center.y, field->radii.x, field->radii.y);
    } else if (field.error().kind == ErrorKind::noResult) {
        fmt::print("field: {}; taken to reach the corners\n", field.error().message);
    } else {
        return tl::make_unexpected(field.error());
    }
    return options;
}

void tellPictures(const std::vector<Picture>& pictures, const Boards& boards,
                  const coverage::Calibration& calibration, int points) {
    std::vector<double> rms;
    for (const coverage::ViewFit& fit : calibration.views)
        rms.push_back(fit.rmsPixels);
    std::sort(rms.begin(), rms.end());
    const double middle = 0.5 * (rms[(rms.size() - 1) / 2] + rms[rms.size() / 2]);
    std::size_t view = 0;
    for (std::size_t n = 0; n < pictures.size(); ++n) {
        const std::string name = pictures[n].file.filename().string();
        if (!boards.reasons[n].empty()) {
            fmt::print("  {}: left out: {}\n", name, boards.reasons[n]);
            continue;
        }
        const coverage::ViewFit& fit = calibration.views[view++];
        fmt::print("  {}: {} of {} points, RMS {:.3f} px, largest {:.3f} px{}\n", name,
                   fit.residuals.size(), points, fit.rmsPixels, fit.largestPixels,
                   fit.rmsPixels > 2.0 * middle ? ": stands out; is its board flat?" : "");
    }
}

Result<coverage::Colonoscope> calibrateOn(const CalibrateArguments& arguments,
                                          const std::vector<Picture>& pictures,
                                          std::string& lensText, std::optional<Image>& residuals) {
    coverage::Board board = *arguments.board;
    board.spacingMm = arguments.spacingMm;
    const auto boards = TRY(findBoards(pictures, board));
    if (boards.views.empty()) {
        for (std::size_t n = 0; n < pictures.size(); ++n)
            fmt::print("  {}: {}\n", pictures[n].file.filename().string(), boards.reasons[n]);
        return fail(ErrorKind::noResult, "no picture shows a " + coverage::textOf(board));
    }
    const auto options = TRY(optionsOf(arguments, pictures));
    const auto calibration = TRY(coverage::calibrate(boards.views, options));

    fmt::print("model {}: r(t) = {}, t from the axis in radians\n", options.model->name,
               options.model->formula);
    tellLens(calibration.lens, &calibration);
    fmt::print(
        "pictures show only the products m·k: {} is held{}\n",
        coverage::lensNumberNames()[calibration.held],
        calibration.held == 0 && !options.focalMm && !options.start && !options.model->firstIsOne
            ? ", so that k are in focal lengths (--focal or --pixels-per-mm: in mm)"
            : "");
    fmt::print("focal length k1·m_u {:.3f} ± {:.3f} pixels; aspect m_v/m_u {:.5f}\n",
               calibration.focalPixels, calibration.focalError,
               calibration.lens.mv / calibration.lens.mu);
    // A hundredth of the focal length moves all angles by as much.
    constexpr double poorlyKnown = 0.03;
    if (calibration.focalError > poorlyKnown * calibration.focalPixels)
        fmt::print(
            "warning: these pictures fix the focal length to ±{:.0f} % only; more of them, "
            "nearer and more oblique, would tell it better\n",
            100.0 * calibration.focalError / calibration.focalPixels);
    std::size_t points = 0;
    for (const auto& fit : calibration.views)
        points += fit.residuals.size();
    fmt::print(
        "RMS {:.4f} px of {} points in {} of {} pictures (after the first three steps "
        "{:.3f} px), out to {:.1f}° from the axis\n",
        calibration.rmsPixels, points, boards.views.size(), pictures.size(),
        calibration.startRmsPixels, glm::degrees(calibration.largestAngle));
    if (calibration.dotRadiusMm > 0.0)
        fmt::print(
            "dots of {:.3f} mm radius; their pictures' centres were moved by {:.3f} px at "
            "most to be their centres' pictures\n",
            calibration.dotRadiusMm, calibration.largestBiasPixels);
    tellPictures(pictures, boards, calibration, coverage::pointCount(board));

    coverage::Colonoscope scope;
    scope.name = arguments.name;
    scope.lens = calibration.lens;
    scope.pictureSize = options.pictureSize;
    const auto open = options.field.value_or(coverage::wholePicture(options.pictureSize));
    scope.openCenter = open.center, scope.openRadii = open.radii;
    scope.fieldDegrees = arguments.fieldDegrees.value_or(
        coverage::fieldWithin(calibration.lens, open, options.pictureSize));
    scope.nearestMm = arguments.depthMm[0], scope.farthestMm = arguments.depthMm[1];
    scope.tipRadiusMm = arguments.tipRadiusMm;
    lensText = coverage::lensText(scope, options.model, &calibration);
    if (arguments.residuals.empty()) return scope;
    std::vector<CalibratedPicture> drawn;
    for (std::size_t v = 0; v < boards.views.size(); ++v) {
        const Picture& picture = pictures[boards.pictures[v]];
        drawn.push_back(
            {printable(picture.file), &picture.image, &boards.views[v], &calibration.views[v]});
    }
    residuals = TRY(residualPicture(drawn, calibration.rmsPixels));
    return scope;
}

/// Its picture size and the picture's are one: places in it are told in pixels.
Result<void> checkFits(const coverage::Colonoscope& scope, const Picture& picture) {
    const glm::ivec2 size(picture.image.width, picture.image.height);
    if (size == scope.pictureSize) return {};
    return fail(ErrorKind::badInput,
                fmt::format("the picture is of {}x{} pixels, and the lens {} is of pictures of "
                            "{}x{}",
                            size.x, size.y, scope.name, scope.pictureSize.x, scope.pictureSize.y),
                picture.file.string());
}

Result<void> runCalibrate(const CalibrateArguments& arguments) {
    for (const fs::path& file :
         {arguments.out, arguments.openCv, arguments.residuals, arguments.undistorted})
        if (!file.empty()) TRY(checkOutputFile(file));
    const auto pictures = TRY(readPictures(arguments.images));
    coverage::Colonoscope scope;
    std::string lensText;
    std::optional<Image> residuals;
    if (arguments.board) {
        scope = TRY(calibrateOn(arguments, pictures, lensText, residuals));
    } else {
        scope = TRY(coverage::readColonoscope(arguments.lens));
        if (!pictures.empty()) TRY(checkFits(scope, pictures.front()));
        fmt::print("{}\n", scope.name);
        tellLens(scope.lens, nullptr);
        lensText = coverage::lensText(scope);
    }
    fmt::print("field {:.1f}°, depth {:g} to {:g} mm, tip radius {:g} mm\n", scope.fieldDegrees,
               scope.nearestMm, scope.farthestMm, scope.tipRadiusMm);

    // All that can fail first, so that files are there together.
    std::string openCv;
    if (!arguments.openCv.empty())
        openCv = TRY(coverage::openCvText(scope, arguments.openCv.extension().string()));
    if (!arguments.out.empty()) TRY(writeDurably(arguments.out, lensText));
    if (!arguments.openCv.empty()) TRY(writeDurably(arguments.openCv, openCv));
    if (residuals) TRY(pictures::writePicture(arguments.residuals, *residuals, ownProvenance()));
    if (!arguments.undistorted.empty())
        TRY(pictures::writePicture(arguments.undistorted,
                                   coverage::undistorted(pictures.front().image, scope.lens),
                                   ownProvenance()));
    return {};
}

/// Options that say nothing with the others are wrong usage.
void checkUse(const CLI::App& command, const CalibrateArguments& arguments) {
    const auto wrong = [](const char* option, const std::string& what) {
        throw CLI::ValidationError(option, what);
    };
    const auto given = [&](const char* option) { return command.count(option) > 0; };
    if (!arguments.board) {
        if (arguments.lens.empty())
            wrong("--board", "is needed, or --lens with a lens that is known");
        for (const char* option :
             {"--spacing", "--model", "--field", "--focal", "--pixels-per-mm", "--nominal",
              "--residuals", "--name", "--depth-mm", "--tip-radius-mm"})
            if (given(option)) wrong(option, "is for calibrating, with --board");
        if (arguments.images.empty() && given("--undistorted"))
            wrong("--undistorted", "needs a picture");
        if (!arguments.images.empty() && !given("--undistorted"))
            wrong("IMAGES", "are of no use without --board or --undistorted");
    } else {
        if (arguments.images.empty()) wrong("IMAGES", "are needed: pictures of the board");
        if (!given("--spacing")) wrong("--spacing", "is needed: mm between the board's points");
        const coverage::LensModel& model = *coverage::findLensModel(arguments.model);
        if (arguments.fieldDegrees && !(*arguments.fieldDegrees >= model.leastFieldDegrees &&
                                        *arguments.fieldDegrees <= model.mostFieldDegrees()))
            wrong("--field", fmt::format("of {} is {:g} to {:g} degrees, not {:g}", arguments.model,
                                         model.leastFieldDegrees, model.mostFieldDegrees(),
                                         *arguments.fieldDegrees));
        for (const char* option : {"--focal", "--pixels-per-mm"})
            if (model.firstIsOne && given(option))
                wrong(option, "is of no use to " + arguments.model + ", whose k1 is 1");
        if (given("--focal") && given("--pixels-per-mm"))
            wrong("--focal", "and --pixels-per-mm would each fix the scale");
        const bool polynomial =
            model.coefficients > 1 && model.projection == coverage::Projection::equidistance;
        if (given("--nominal") && (!polynomial || given("--lens")))
            wrong("--nominal", "is of no use to " +
                                   (polynomial ? std::string("--lens") : arguments.model) +
                                   ", which has a beginning of its own");
    }
    for (const auto& [option, file] : {std::pair("--residuals", arguments.residuals),
                                       std::pair("--undistorted", arguments.undistorted)})
        if (!file.empty() && !pictures::isPictureFile(file))
            wrong(option, "a picture is written as .png, .tif, .exr or .jpg, not as \"" +
                              file.filename().string() + "\"");
    const std::string ending = arguments.openCv.extension().string();
    if (!arguments.openCv.empty() && ending != ".xml" && ending != ".yml" && ending != ".yaml" &&
        ending != ".json")
        wrong("--opencv", "OpenCV's files end in .xml, .yml, .yaml or .json");
    std::error_code ignored;
    std::vector<fs::path> written;
    for (const fs::path& file :
         {arguments.out, arguments.openCv, arguments.residuals, arguments.undistorted}) {
        if (file.empty()) continue;
        const fs::path resolved = fs::weakly_canonical(file, ignored);
        for (const fs::path& other : written)
            if (other == resolved) wrong("FILE", "two results would go into " + file.string());
        for (const fs::path& image : arguments.images)
            if (fs::weakly_canonical(image, ignored) == resolved)
                wrong("FILE", "a result would replace the picture " + file.string());
        written.push_back(resolved);
    }
}

std::string positive(const std::string& text) {
    const auto number = parseNumbers(text, ',', 1);
    return number && (*number)[0] > 0.0 ? std::string() : "\"" + text + "\" is not over 0";
}

}  // namespace

Command addCalibrate(CLI::App& program) {
    auto arguments = std::make_shared<CalibrateArguments>();
    CLI::App* command = program.add_subcommand(
        "calibrate",
        "Find an endoscope's lens from pictures of a flat board, each from another side: where it "
        "shows a ray that makes the angle t with its axis. Prints the lens with standard errors "
        "and how far it is off in each picture. A picture in which the board is not found is "
        "named, with the reason, and left out. With --lens and no --board: shows, converts or "
        "applies a lens that is known.");
    command->add_option("IMAGES", arguments->images,
                        "Pictures of the board by one camera: PNG, TIFF or JPEG");
    command
        ->add_option_function<std::string>(
            "--board",
            [arguments](const std::string& text) {
                arguments->board = coverage::boardOfText(text);
                if (!arguments->board)
                    throw CLI::ValidationError(
                        "--board", "\"" + text +
                                       "\" is none of checkerboard:8x7, dots:7x5, "
                                       "asymmetric-dots:3x11, with 4 (dots: 3) to 200 a side");
            },
            "What the board shows: checkerboard:8x7, counted in squares; dots:7x5; "
            "asymmetric-dots:3x11, 3 in each of 11 rows, every second moved by half a step. At "
            "least half of it must be in the picture")
        ->type_name("KIND:CxR");
    command
        ->add_option("--spacing", arguments->spacingMm,
                     "A square's side, or the distance of neighbouring dots, mm; of asymmetric "
                     "dots the distance of rows, half of that of neighbours in a row")
        ->type_name("MM")
        ->check(positive, "FLOAT > 0");
    std::vector<std::string> models, projections;
    for (const coverage::LensModel& model : coverage::lensModels()) {
        models.emplace_back(model.name);
        if (model.coefficients == 1) projections.emplace_back(model.name);
    }
    command
        ->add_option("--model", arguments->model,
                     "r(t): kannala-brandt is the source's k1 t + k2 t^3; brown is a pinhole with "
                     "Brown's distortion, brown-radial without its decentring")
        ->check(CLI::IsMember(models))
        ->capture_default_str();
    command
        ->add_option("--field", arguments->fieldDegrees,
                     "Nominal whole field of view, degrees, which the picture's open ellipse is "
                     "taken to show at first (default: several are tried)")
        ->type_name("DEG")
        ->check(positive, "FLOAT > 0");
    command
        ->add_option("--focal", arguments->focalMm,
                     "Nominal focal length, mm: k1 is held there (default: 1, so that k are in "
                     "focal lengths)")
        ->type_name("MM")
        ->check(positive, "FLOAT > 0");
    command
        ->add_option("--pixels-per-mm", arguments->pixelsPerMm,
                     "Pixels per mm of the sensor from left to right, where they are known: m_u "
                     "is held there, and k are in mm")
        ->type_name("N")
        ->check(positive, "FLOAT > 0");
    command
        ->add_option("--nominal", arguments->nominal,
                     "What the lens is nominally built to: where a polynomial's search begins")
        ->check(CLI::IsMember(projections))
        ->capture_default_str();
    command
        ->add_option("--lens", arguments->lens,
                     "A lens to begin with: olympus-cf-q160l, a file of --out, or one of OpenCV's")
        ->type_name("NAME|FILE");
    command->add_option("--name", arguments->name, "What the endoscope is called in --out")
        ->type_name("TEXT")
        ->capture_default_str();
    command
        ->add_option("--depth-mm", arguments->depthMm,
                     "Depth of field from the lens, for --out: two lengths, mm")
        ->type_name("FROM TO")
        ->expected(2)
        ->capture_default_str();
    command
        ->add_option("--tip-radius-mm", arguments->tipRadiusMm,
                     "How near the lens comes to a wall, for --out, mm")
        ->type_name("MM")
        ->check(positive, "FLOAT > 0")
        ->capture_default_str();
    command->add_option("--out", arguments->out, "Write the lens as JSON, for `--lens` and others")
        ->type_name("FILE.json");
    command
        ->add_option("--opencv", arguments->openCv,
                     "Write the lens as OpenCV does: .xml, .yml, .yaml or .json; its files have no "
                     "field, so that of a lens read from one all of the picture is open")
        ->type_name("FILE");
    command
        ->add_option("--residuals", arguments->residuals,
                     "Write a picture of what is left between the points and the lens")
        ->type_name("FILE.png");
    command
        ->add_option("--undistorted", arguments->undistorted,
                     "Write the first picture as a pinhole camera would have taken it; of a --lens "
                     "that is known, it is of that lens's size")
        ->type_name("FILE.png");
    command->callback([arguments, command] {
        checkUse(*command, *arguments);
        if (!(arguments->depthMm[0] >= 0.0 && arguments->depthMm[1] > arguments->depthMm[0]))
            throw CLI::ValidationError("--depth-mm", "is two lengths, the nearer first");
    });
    return {command, [arguments] { return runCalibrate(*arguments); }};
}

}  // namespace haustra::cli
