// haustra phantom: a synthetic abdomen as a DICOM series, with its truth.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "cli/text_files.h"
#include "dicom/write_series.h"
#include "nifti/nifti_file.h"
#include "phantom/phantom.h"

#include <map>
#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

// The options as text: chosen on the command line, and written into phantom.json.
struct Arguments {
    fs::path out;
    std::uint64_t seed = 1;
    std::string preset = "standard", position = "supine", size = "full";
    bool force = false;
    int threads = 0;
};

const std::map<std::string, phantom::Preset> presets{{"easy", phantom::Preset::easy},
                                                     {"standard", phantom::Preset::standard},
                                                     {"hard", phantom::Preset::hard}};
const std::map<std::string, phantom::Size> sizes{{"small", phantom::Size::small},
                                                 {"full", phantom::Size::full}};

Result<void> writeAll(const fs::path& folder, const phantom::Phantom& made,
                      const Arguments& arguments) {
    std::error_code error;
    fs::create_directories(folder / "series", error);
    fs::create_directories(folder / "truth", error);
    if (error)
        return fail(ErrorKind::io, "cannot make the folder: " + error.message(), folder.string());

    dicom::WriteOptions writing;
    writing.seriesDescription = "Phantom " + arguments.preset + " " + arguments.position;
    writing.uidSeed = fmt::format("phantom {} {} {} {}", arguments.seed, arguments.preset,
                                  arguments.position, arguments.size);
    // One patient lying on the back and on the belly.
    writing.studySeed =
        fmt::format("phantom {} {} {}", arguments.seed, arguments.preset, arguments.size);
    const nlohmann::ordered_json facts{{"version", phantom::phantomVersion},
                                       {"seed", arguments.seed},
                                       {"preset", arguments.preset},
                                       {"position", arguments.position},
                                       {"size", arguments.size},
                                       {"centerline_mm", made.centerline.lengthMm()},
                                       {"polyps", made.polyps.findings.size()},
                                       {"noise_sd_hu", made.noiseSdHu},
                                       {"haustra", HAUSTRA_VERSION}};
    const fs::path truth = folder / "truth";
    return dicom::writeSeries(folder / "series", made.scan, writing)
        .and_then([&] { return nifti::writeNifti(truth / "lumen.nii.gz", made.lumen); })
        .and_then([&] { return nifti::writeNifti(truth / "untagged.nii.gz", made.untaggedHu); })
        .and_then(
            [&] { return writeTextFile(truth / "centerline.csv", centerlineCsv(made.centerline)); })
        .and_then([&] { return writeTextFile(truth / "polyps.json", findingsJson(made.polyps)); })
        .and_then([&] { return writeTextFile(truth / "phantom.json", facts.dump(2) + "\n"); });
}

// Puts the finished folder in its place. What else lies in `out` stays.
Result<void> moveInto(const fs::path& out, const fs::path& finished) {
    std::error_code error;
    if (!fs::exists(out, error) || fs::is_empty(out, error)) {
        fs::rename(finished, out, error);
    } else {
        for (const char* part : {"series", "truth"}) {
            if (!error) fs::remove_all(out / part, error);
            if (!error) fs::rename(finished / part, out / part, error);
        }
        std::error_code ignored;
        fs::remove_all(finished, ignored);
    }
    if (error)
        return fail(ErrorKind::io, "cannot put the phantom in its place: " + error.message(),
                    out.string());
    return {};
}

Result<void> runPhantom(const Arguments& arguments) {
    std::error_code error;
    fs::path out = fs::weakly_canonical(arguments.out, error);
    if (fs::exists(out, error) && !fs::is_directory(out, error)) {
        return fail(ErrorKind::badInput, "this is not a folder", out.string());
    }
    if (!arguments.force && fs::exists(out, error) && !fs::is_empty(out, error)) {
        return fail(ErrorKind::badInput,
                    "the folder is not empty (--force replaces series and truth)", out.string());
    }
    fs::create_directories(out.parent_path(), error);
    if (auto fit = checkOutputFile(out.parent_path() / (out.filename().string() + ".new")); !fit)
        return fail(ErrorKind::io, "this folder cannot be made", out.string());

    ProgressBar bar;
    phantom::PhantomOptions options;
    options.seed = arguments.seed;
    options.preset = presets.at(arguments.preset);
    options.position = patientPositionFromString(arguments.position);
    options.size = sizes.at(arguments.size);
    options.threads = arguments.threads;
    options.progress = [&](double fraction) { bar.show("phantom", fraction); };
    const auto made = phantom::makePhantom(options);
    if (!made) return tl::make_unexpected(made.error());

    bar.show("write", 0.0);
    const fs::path unfinished =
        out.parent_path() / fmt::format(".tmp-{}-{}", out.filename().string(), ::getpid());
    const auto written =
        writeAll(unfinished, *made, arguments).and_then([&] { return moveInto(out, unfinished); });
    if (!written) {
        fs::remove_all(unfinished, error);
        return written;
    }
    bar.say(fmt::format("colon of {:.0f} mm with {} polyps: {}", made->centerline.lengthMm(),
                        made->polyps.findings.size(), arguments.out.string()));
    return {};
}

template <class T>
std::vector<std::string> namesOf(const std::map<std::string, T>& map) {
    std::vector<std::string> names;
    for (const auto& [name, value] : map)
        names.push_back(name);
    return names;
}

}  // namespace

Command addPhantom(CLI::App& program) {
    auto arguments = std::make_shared<Arguments>();
    CLI::App* command = program.add_subcommand(
        "phantom",
        "Make a synthetic abdominal CT: OUT/series/*.dcm, and beside it OUT/truth with "
        "lumen.nii.gz, untagged.nii.gz, centerline.csv, polyps.json and phantom.json. Equal "
        "options make equal files.");
    command->add_option("OUT", arguments->out, "The folder to make")->required();
    command->add_option("--seed", arguments->seed, "Which patient")
        ->check([](const std::string& text) {
            const bool digits =
                !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            return digits ? std::string() : "\"" + text + "\" is not a whole number of 0 or more";
        })
        ->type_name("N")
        ->capture_default_str();
    command->add_option("--preset", arguments->preset, "How hard to read")
        ->check(CLI::IsMember(namesOf(presets)))
        ->capture_default_str();
    command->add_option("--position", arguments->position, "How the patient lies")
        ->check(CLI::IsMember({"supine", "prone"}))
        ->capture_default_str();
    command->add_option("--size", arguments->size, "small (256³ or so) or full (512×512×400)")
        ->check(CLI::IsMember(namesOf(sizes)))
        ->capture_default_str();
    command->add_flag("--force", arguments->force,
                      "Replace series and truth in a folder that is not empty");
    addThreadsOption(*command, arguments->threads);
    return {command, [arguments] { return runPhantom(*arguments); }};
}

}  // namespace haustra::cli
