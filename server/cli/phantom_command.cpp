// haustra phantom: a synthetic abdomen as a DICOM series, with its truth.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/number_range.h"
#include "cli/progress_bar.h"
#include "cli/text_files.h"
#include "core/durable_file.h"
#include "core/version.h"
#include "dicom/write_series.h"
#include "nifti/nifti_file.h"
#include "phantom/growth_truth.h"
#include "phantom/phantom.h"

#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <type_traits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

// The options as text: chosen on the command line, and written into phantom.json. What is not
// given is the preset's.
struct PhantomArguments {
    fs::path out;
    std::uint64_t seed = 1;
    std::string preset = "standard", position = "supine", size = "full";
    std::optional<double> ileumMm, ileumCalibreMm, septumMm, redundantSigmoidMm;
    std::optional<std::string> valve, insufflated, rectalTube, metalHip, feetFirst;
    std::vector<double> collapsesMm;
    std::optional<double> untagged, layered, full;
    std::optional<int> diverticula;
    phantom::GrowthOptions growths;
    std::optional<double> fieldOfViewMm, overshoot, noiseSdHu, grainMm, pseudoEnhancementHu,
        streakHu;
    std::vector<double> blurMm;
    bool force = false;
    int threads = 0;
};

constexpr const char* wildName = "wild";
const std::map<std::string, phantom::Preset> presets{{"easy", phantom::Preset::easy},
                                                     {"standard", phantom::Preset::standard},
                                                     {"hard", phantom::Preset::hard}};
const std::map<std::string, phantom::Size> sizes{
    {"small", phantom::Size::small},
    {"full", phantom::Size::full},
    {"photon-counting", phantom::Size::photonCounting}};

phantom::PhantomOptions optionsOf(const PhantomArguments& arguments) {
    phantom::PhantomOptions options;
    if (arguments.preset == wildName) {
        options = phantom::wildOptions(arguments.seed);
    } else {
        options.preset = presets.at(arguments.preset);
    }
    options.seed = arguments.seed;
    options.position = patientPositionFromString(arguments.position);
    options.size = sizes.at(arguments.size);
    options.threads = arguments.threads;
    phantom::BowelOptions& bowel = options.bowel;
    const auto take = [](const auto& given, auto& value) {
        if (given) value = *given;
    };
    take(arguments.ileumMm, bowel.ileumMm), take(arguments.ileumCalibreMm, bowel.ileumCalibreMm);
    take(arguments.septumMm, bowel.septumMm);
    take(arguments.redundantSigmoidMm, bowel.redundantSigmoidMm);
    take(arguments.untagged, bowel.untagged), take(arguments.layered, bowel.layered);
    take(arguments.full, bowel.full), take(arguments.diverticula, bowel.diverticula);
    if (!arguments.collapsesMm.empty()) bowel.collapsesMm = arguments.collapsesMm;
    if (arguments.valve) bowel.valveOpen = *arguments.valve == "open";
    if (arguments.insufflated) bowel.insufflated = *arguments.insufflated == "yes";
    if (arguments.rectalTube) bowel.rectalTube = *arguments.rectalTube == "yes";
    options.growths = arguments.growths;
    phantom::ScanOptions& scan = options.scan;
    take(arguments.fieldOfViewMm, scan.fieldOfViewMm), take(arguments.overshoot, scan.overshoot);
    take(arguments.noiseSdHu, scan.noiseSdHu), take(arguments.grainMm, scan.grainMm);
    take(arguments.pseudoEnhancementHu, scan.pseudoEnhancementHu);
    take(arguments.streakHu, scan.streakHu);
    if (arguments.metalHip) scan.metalHip = *arguments.metalHip == "yes";
    if (arguments.feetFirst) scan.feetFirst = *arguments.feetFirst == "yes";
    if (!arguments.blurMm.empty())
        scan.blurMm = {arguments.blurMm[0], arguments.blurMm[1], arguments.blurMm[2]};
    return options;
}

nlohmann::ordered_json pointJson(glm::dvec3 p) {
    return {p.x, p.y, p.z};
}

nlohmann::ordered_json scanJson(const phantom::ScanOptions& scan) {
    nlohmann::ordered_json json{{"field_of_view_mm", scan.fieldOfViewMm},
                                {"blur_mm", {scan.blurMm.x, scan.blurMm.y, scan.blurMm.z}},
                                {"overshoot", scan.overshoot},
                                {"noise_sd_hu", scan.noiseSdHu},
                                {"grain_mm", scan.grainMm},
                                {"pseudo_enhancement_hu", scan.pseudoEnhancementHu}};
    // Only what is there, so that phantoms from before these options stay the same files.
    if (scan.streakHu > 0.0) json["streak_hu"] = scan.streakHu;
    if (scan.metalHip) json["metal_hip"] = true;
    if (scan.feetFirst) json["feet_first"] = true;
    return json;
}

nlohmann::ordered_json bowelJson(const phantom::BowelOptions& bowel) {
    return {{"ileum_mm", bowel.ileumMm},
            {"ileum_calibre_mm", bowel.ileumCalibreMm},
            {"valve", bowel.valveOpen ? "open" : "closed"},
            {"septum_mm", bowel.septumMm},
            {"collapses_mm", bowel.collapsesMm},
            {"redundant_sigmoid_mm", bowel.redundantSigmoidMm},
            {"untagged_fluid", bowel.untagged},
            {"layered_fluid", bowel.layered},
            {"full_sections", bowel.full},
            {"diverticula", bowel.diverticula},
            {"insufflated", bowel.insufflated},
            {"rectal_tube", bowel.rectalTube}};
}

nlohmann::ordered_json growthOptionsJson(const phantom::GrowthOptions& growths) {
    nlohmann::ordered_json json{{"plain_cores", growths.plainCores},
                                {"more_polyps", growths.morePolyps},
                                {"more_untagged_stool", growths.moreUntaggedStool}};
    // Only where there are any, so that phantoms from before these options stay the same files.
    if (growths.moreFlat > 0) json["more_flat"] = growths.moreFlat;
    if (growths.polypHu != 0.0) json["polyp_hu"] = growths.polypHu;
    if (growths.polypSdHu > 0.0) json["polyp_sd_hu"] = growths.polypSdHu;
    if (growths.coated > 0.0) json["coated"] = growths.coated;
    if (growths.films > 0) json["films"] = growths.films;
    return json;
}

std::string structureJson(const phantom::Structure& structure) {
    using nlohmann::ordered_json;
    ordered_json segments = ordered_json::array(), collapses = segments, contacts = segments,
                 diverticula = segments;
    double begin = 0.0;
    for (std::size_t n = 0; n < structure.segmentEndsMm.size(); ++n) {
        const double end = structure.segmentEndsMm[n];
        segments.push_back(
            {{"name", phantom::segmentNames[n]}, {"begin_mm", begin}, {"end_mm", end}});
        begin = end;
    }
    for (const auto& c : structure.collapses) {
        collapses.push_back({{"begin_mm", c.beginMm},
                             {"end_mm", c.endMm},
                             {"length_mm", c.lengthMm()},
                             {"begin_at_mm", pointJson(c.beginAtMm)},
                             {"end_at_mm", pointJson(c.endAtMm)}});
    }
    for (const auto& c : structure.contacts) {
        contacts.push_back({{"with", c.ileum ? "ileum" : "colon"},
                            {"arc_mm", c.arcMm},
                            {"other_arc_mm", c.otherArcMm},
                            {"position_mm", pointJson(c.positionMm)},
                            {"least_mm", c.leastMm},
                            {"area_mm2", c.areaMm2}});
    }
    for (const auto& d : structure.diverticula) {
        diverticula.push_back(
            {{"position_mm", pointJson(d.positionMm)}, {"diameter_mm", d.diameterMm}});
    }
    ordered_json valve;
    if (structure.valve) {
        valve = {{"position_mm", pointJson(structure.valve->positionMm)},
                 {"inward", pointJson(structure.valve->inward)},
                 {"arc_mm", structure.valve->arcMm},
                 {"open", structure.valve->open}};
    }
    ordered_json tube;
    if (const auto& device = structure.rectalTube) {
        ordered_json axis = ordered_json::array();
        for (const glm::dvec3& point : device->axisMm)
            axis.push_back(pointJson(point));
        tube = {{"axis_mm", axis},
                {"shaft_radius_mm", device->shaftRadiusMm},
                {"balloon_mm", pointJson(device->balloonMm)},
                {"balloon_radius_mm", device->balloonRadiusMm},
                {"balloon_half_length_mm", device->balloonHalfLengthMm}};
    }
    ordered_json json{{"segments", segments},
                      {"collapses", collapses},
                      {"contacts", contacts},
                      {"valve", valve},
                      {"diverticula", diverticula},
                      {"ileum_mm", structure.ileumMm},
                      {"ileum_ml", structure.ileumMl},
                      {"air_ml", structure.airMl},
                      {"tagged_ml", structure.taggedMl},
                      {"untagged_ml", structure.untaggedMl}};
    if (!tube.is_null()) json["rectal_tube"] = tube;
    return json.dump(2) + "\n";
}

Result<void> writeAll(const fs::path& folder, const phantom::Phantom& made,
                      const PhantomArguments& arguments, const phantom::PhantomOptions& options) {
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
    if (const std::string bowel = bowelJson(options.bowel).dump(); bowel != bowelJson({}).dump()) {
        writing.uidSeed += " " + bowel;
        writing.studySeed += " " + bowel;
    }
    if (const std::string scanner = scanJson(options.scan).dump(); scanner != scanJson({}).dump())
        writing.uidSeed += " " + scanner;
    const nlohmann::ordered_json growths = growthOptionsJson(options.growths);
    const bool grown = growths != growthOptionsJson({});
    if (grown) {
        writing.uidSeed += " " + growths.dump();
        writing.studySeed += " " + growths.dump();
    }
    writing.feetFirst = options.scan.feetFirst;
    nlohmann::ordered_json facts{{"version", phantom::phantomVersion},
                                 {"seed", arguments.seed},
                                 {"preset", arguments.preset},
                                 {"position", arguments.position},
                                 {"size", arguments.size},
                                 {"bowel", bowelJson(options.bowel)},
                                 {"scan", scanJson(options.scan)},
                                 {"centerline_mm", made.centerline.lengthMm()},
                                 {"polyps", made.polyps.findings.size()},
                                 {"noise_sd_hu", made.noiseSdHu},
                                 {"haustra", softwareVersion}};
    if (grown) facts["growths"] = growths;
    const fs::path truth = folder / "truth";
    return dicom::writeSeries(folder / "series", made.scan, writing)
        .and_then([&] { return nifti::writeNifti(truth / "lumen.nii.gz", made.lumen); })
        .and_then([&] { return nifti::writeNifti(truth / "sites.nii.gz", made.sites); })
        .and_then([&] { return nifti::writeNifti(truth / "untagged.nii.gz", made.untaggedHu); })
        .and_then(
            [&] { return writeDurably(truth / "centerline.csv", centerlineCsv(made.centerline)); })
        .and_then([&] { return writeDurably(truth / "polyps.json", findingsJson(made.polyps)); })
        .and_then([&] {
            return writeDurably(truth / "growths.json", phantom::growthsJson(made.growths));
        })
        .and_then(
            [&] { return writeDurably(truth / "structure.json", structureJson(made.structure)); })
        .and_then([&] { return writeDurably(truth / "phantom.json", facts.dump(2) + "\n"); });
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

Result<void> runPhantom(const PhantomArguments& arguments) {
    std::error_code error;
    TRY(checkOutputFolder(arguments.out));
    fs::path out = fs::weakly_canonical(arguments.out, error);
    if (!arguments.force && fs::exists(out, error) && !fs::is_empty(out, error)) {
        return fail(ErrorKind::badInput,
                    "the folder is not empty (--force replaces series and truth)", out.string());
    }
    fs::create_directories(out.parent_path(), error);
    if (auto fit = checkOutputFile(out.parent_path() / (out.filename().string() + ".new")); !fit)
        return fail(ErrorKind::io, "this folder cannot be made", out.string());

    ProgressBar bar;
    phantom::PhantomOptions options = optionsOf(arguments);
    options.progress = [&](double fraction) { bar.show("phantom", fraction); };
    const auto made = TRY(phantom::makePhantom(options));

    bar.show("write", 0.0);
    const fs::path unfinished =
        out.parent_path() / fmt::format(".tmp-{}-{}", out.filename().string(), ::getpid());
    const auto written = writeAll(unfinished, made, arguments, options).and_then([&] {
        return moveInto(out, unfinished);
    });
    if (!written) {
        fs::remove_all(unfinished, error);
        return written;
    }
    bar.say(fmt::format("colon of {:.0f} mm with {} polyps: {}", made.centerline.lengthMm(),
                        made.polyps.findings.size(), arguments.out.string()));
    return {};
}

template <class T>
std::vector<std::string> namesOf(const std::map<std::string, T>& map) {
    std::vector<std::string> names;
    for (const auto& [name, value] : map)
        names.push_back(name);
    return names;
}

/// What a patient's bowel may have beyond the preset's; phantom/bowel_options.h tells more.
void addBowelOptions(CLI::App& command, PhantomArguments& arguments) {
    constexpr const char* group = "Bowel (each adds to the preset; wild draws what is not given)";
    const auto share = numberRange(0.0, 1.0);
    command
        .add_option("--ileum", arguments.ileumMm,
                    "Length of a gas-filled ileum that joins the cecum and runs along the colon, "
                    "0 to 2000")
        ->check(numberRange(0.0, 2000.0))
        ->type_name("MM")
        ->group(group);
    command.add_option("--ileum-calibre", arguments.ileumCalibreMm, "Its inner diameter, 12 to 30")
        ->check(numberRange(12.0, 30.0))
        ->type_name("MM")
        ->group(group);
    command.add_option("--valve", arguments.valve, "Whether gas passes the ileocecal valve's lips")
        ->check(CLI::IsMember({"open", "closed"}))
        ->group(group);
    command
        .add_option("--septum", arguments.septumMm,
                    "Least tissue between loops that touch, 0.5 to 5 (3.2)")
        ->check(numberRange(0.5, 5.0))
        ->type_name("MM")
        ->group(group);
    command
        .add_option("--collapse", arguments.collapsesMm,
                    "Lengths of collapsed stretches, 5 to 60, in place of the preset's")
        ->check(numberRange(5.0, 60.0))
        ->type_name("MM …")
        ->group(group);
    command
        .add_option("--redundant-sigmoid", arguments.redundantSigmoidMm,
                    "How much longer the sigmoid's loops are, 0 to 400")
        ->check(numberRange(0.0, 400.0))
        ->type_name("MM")
        ->group(group);
    command
        .add_option("--untagged-fluid", arguments.untagged, "Share of the pools without tagging")
        ->check(share)
        ->type_name("SHARE")
        ->group(group);
    command
        .add_option("--layered-fluid", arguments.layered,
                    "Share of the pools where water stands over tagged sediment")
        ->check(share)
        ->type_name("SHARE")
        ->group(group);
    command
        .add_option("--full-sections", arguments.full,
                    "Share of the pools as full as gravity lets them be, up to the roof")
        ->check(share)
        ->type_name("SHARE")
        ->group(group);
    command
        .add_option("--diverticula", arguments.diverticula,
                    "How many, 0 to 500; most of them in the sigmoid")
        ->check(CLI::Range(0, 500))
        ->type_name("N")
        ->group(group);
    command
        .add_option("--insufflated", arguments.insufflated,
                    "no: an abdominal CT without colonography, the colon collapsed but for a "
                    "little gas and stool")
        ->check(CLI::IsMember({"yes", "no"}))
        ->group(group);
    command.add_option("--rectal-tube", arguments.rectalTube, "A tube with an inflated balloon")
        ->check(CLI::IsMember({"yes", "no"}))
        ->group(group);
}

/// How the patient is scanned; phantom/phantom.h tells more.
void addScanOptions(CLI::App& command, PhantomArguments& arguments) {
    constexpr const char* group = "Scanner (in place of what the preset draws)";
    const auto add = [&](const char* name, std::optional<double>& value, const char* help,
                         double low, double high, const char* unit) {
        command.add_option(name, value, help)
            ->check(numberRange(low, high))
            ->type_name(unit)
            ->group(group);
    };
    add("--fov", arguments.fieldOfViewMm, "Width of the field of view, 250 to 500", 250, 500, "MM");
    command
        .add_option("--blur", arguments.blurMm,
                    "Full widths of the point spread along x, y and z, 0.3 to 6")
        ->check(numberRange(0.3, 6.0))
        ->expected(3)
        ->type_name("MM")
        ->group(group);
    add("--overshoot", arguments.overshoot, "Edge enhancement of a sharp kernel, 0 to 0.6", 0, 0.6,
        "SHARE");
    add("--noise", arguments.noiseSdHu, "Standard deviation of the noise, 1 to 100", 1, 100, "HU");
    add("--grain", arguments.grainMm, "Full width of the noise's grain, 0.5 to 4", 0.5, 4, "MM");
    add("--pseudo-enhancement", arguments.pseudoEnhancementHu,
        "How much brighter tissue is at the edge of a large tagged pool, 0 to 100", 0, 100, "HU");
    add("--streaks", arguments.streakHu,
        "Streak noise where few photons pass: its standard deviation where all rays cross 400 mm "
        "of water, 0 to 100",
        0, 100, "HU");
    command.add_option("--metal-hip", arguments.metalHip, "A hip prosthesis, with its streaks")
        ->check(CLI::IsMember({"yes", "no"}))
        ->group(group);
    command
        .add_option("--feet-first", arguments.feetFirst,
                    "The patient enters feet first: the series has its rows and slices the other "
                    "way round")
        ->check(CLI::IsMember({"yes", "no"}))
        ->group(group);
}

constexpr const char* growthGroup = "Growths (each adds to the preset; wild draws none of these)";

/// What grows on the wall beyond the preset's; phantom/growth_options.h tells more.
void addGrowthOptions(CLI::App& command, PhantomArguments& arguments) {
    phantom::GrowthOptions& growths = arguments.growths;
    const auto add = [&](const char* name, auto& value, auto most, const char* help) {
        constexpr bool isCount = std::is_integral_v<decltype(most)>;
        command.add_option(name, value, help)
            ->check(isCount ? CLI::Validator(CLI::Range(0, int(most))) : numberRange(0.0, most))
            ->type_name(isCount ? "N" : "SHARE")
            ->group(growthGroup);
    };
    add("--plain-cores", growths.plainCores, 1.0,
        "Share of the polyps that are no denser inside than outside, 0 to 1");
    const auto addHu = [&](const char* name, double& hu, double least, double most,
                           const char* help) {
        command.add_option(name, hu, help)
            ->check(numberRange(least, most))
            ->type_name("HU")
            ->group(growthGroup);
    };
    addHu("--polyp-hu", growths.polypHu, -60.0, 60.0,
          "How much denser than the wall polyps are in the mean, −60 to 60");
    addHu("--polyp-sd", growths.polypSdHu, 0.0, 30.0, "Its deviation from polyp to polyp, 0 to 30");
    add("--more-polyps", growths.morePolyps, 40,
        "More polyps of 4 to 15 mm, 0 to 40, of more shapes than the preset's");
    add("--more-flat", growths.moreFlat, 40,
        "More flat lesions of 6 to 18 mm, 1 to 2.5 mm high, with sides that slope, 0 to 40");
    add("--coated", growths.coated, 1.0,
        "Share of the polyps and bumps over which a film of tagged residue lies, 0 to 1");
    add("--films", growths.films, 40, "Films of tagged residue on the bare wall, 0 to 40");
    add("--more-untagged-stool", growths.moreUntaggedStool, 40,
        "More lumps of stool without tagging, 0 to 40");
}

}  // namespace

Command addPhantom(CLI::App& program) {
    auto arguments = std::make_shared<PhantomArguments>();
    CLI::App* command = program.add_subcommand(
        "phantom",
        "Make a synthetic abdominal CT: OUT/series/*.dcm, and beside it OUT/truth with "
        "lumen.nii.gz, sites.nii.gz (what else is where: 1 ileum, 2 other bowel, 3 lung, 4 outside "
        "the body, 5 colon wall, 6 rectal tube, 7 fluid without tagging), untagged.nii.gz, "
        "centerline.csv, polyps.json, growths.json (polyps and what resembles them), "
        "structure.json (segments, collapses, contacts, valve, rectal tube, "
        "diverticula, volumes) and phantom.json. Equal options make equal files.");
    command->add_option("OUT", arguments->out, "The folder to make")->required();
    command->add_option("--seed", arguments->seed, "Which patient")
        ->check([](const std::string& text) {
            const bool digits =
                !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
            return digits ? std::string() : "\"" + text + "\" is not a whole number of 0 or more";
        })
        ->type_name("N")
        ->capture_default_str();
    std::vector<std::string> presetNames = namesOf(presets);
    presetNames.emplace_back(wildName);
    command
        ->add_option("--preset", arguments->preset,
                     "How hard to read; wild draws from all the options below")
        ->check(CLI::IsMember(presetNames))
        ->capture_default_str();
    command->add_option("--position", arguments->position, "How the patient lies")
        ->check(CLI::IsMember({"supine", "prone", "left-decubitus", "right-decubitus"}))
        ->capture_default_str();
    command
        ->add_option("--size", arguments->size,
                     "small (256³ or so), full (512×512×400) or photon-counting (1024×1024×1000; "
                     "10 GiB of memory)")
        ->check(CLI::IsMember(namesOf(sizes)))
        ->capture_default_str();
    command->add_flag("--force", arguments->force,
                      "Replace series and truth in a folder that is not empty");
    addThreadsOption(*command, arguments->threads);
    addBowelOptions(*command, *arguments);
    addGrowthOptions(*command, *arguments);
    addScanOptions(*command, *arguments);
    return {command, [arguments] { return runPhantom(*arguments); }};
}

}  // namespace haustra::cli
