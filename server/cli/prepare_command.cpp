// haustra prepare: from a series to the products that a reader needs.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/number_range.h"
#include "cli/progress_bar.h"
#include "cli/text_files.h"
#include "core/case_name.h"
#include "core/durable_file.h"
#include "pipeline/prepare.h"
#include "pipeline/scan_identity.h"
#include "pipeline/source_key.h"
#include "store/products.h"

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

struct PrepareArguments {
    fs::path store, report;
    std::string caseName;
    pipeline::PrepareOptions options;
};

// Of what identifies the scan, since no folder's name does.
Result<std::string> defaultCaseName(const pipeline::PrepareOptions& options) {
    const bool scanned = !options.series.empty();
    const auto content =
        TRY(pipeline::sourceKey(scanned ? options.series : options.lumenMask, options.threads));
    const store::ScanIdentity mask{content, {}, {}};
    return (scanned ? pipeline::identifyScan(options.series, options.seriesUid, content,
                                             options.threads)
                    : mask)
        .map(pipeline::defaultCaseName);
}

std::string checkCaseName(const std::string& name) {
    return isCaseName(name) ? std::string() : "not a case name: \"" + name + "\"";
}

// `quality` is the case's product of that name; empty where it has none.
std::string reportJson(const pipeline::PrepareReport& report, const std::string& quality) {
    auto stages = nlohmann::ordered_json::array();
    double wallSeconds = 0.0, peakMemoryMib = 0.0;
    for (const pipeline::StageReport& stage : report.stages) {
        stages.push_back({{"stage", stage.stage},
                          {"reused", stage.reused},
                          {"wall_seconds", stage.wallSeconds},
                          {"beside_seconds", stage.besideSeconds},
                          {"peak_memory_mib", stage.peakMemoryMib}});
        wallSeconds += stage.wallSeconds - stage.besideSeconds;
        peakMemoryMib = std::max(peakMemoryMib, stage.peakMemoryMib);
    }
    auto bridges = nlohmann::ordered_json::array();
    for (const Bridge& bridge : report.bridges) {
        bridges.push_back({{"from_arc_mm", bridge.fromArcMm},
                           {"to_arc_mm", bridge.toArcMm},
                           {"length_mm", bridge.lengthMm()}});
    }
    nlohmann::ordered_json json{{"case", report.caseName},     {"stages", stages},
                                {"bridges", bridges},          {"bridged_mm2", report.bridgedMm2},
                                {"wall_seconds", wallSeconds}, {"peak_memory_mib", peakMemoryMib},
                                {"notes", report.notes}};
    if (!quality.empty()) json["quality"] = nlohmann::ordered_json::parse(quality, nullptr, false);
    return json.dump(2) + "\n";
}

Result<void> runPrepare(PrepareArguments arguments) {
    const fs::path& source =
        arguments.options.series.empty() ? arguments.options.lumenMask : arguments.options.series;
    // Before a store is made for it.
    std::error_code ignored;
    if (!source.empty() && !fs::exists(source, ignored))
        return fail(ErrorKind::notFound, "there is no such file or folder", source.string());
    if (!arguments.report.empty()) {
        TRY(checkOutputFile(arguments.report));
    }
    if (arguments.caseName.empty()) {
        auto name = TRY(defaultCaseName(arguments.options));
        arguments.caseName = std::move(name);
    }
    const auto store = TRY(store::CaseStore::open(arguments.store, true));

    ProgressBar bar;
    arguments.options.progress = [&](const std::string& stage, double fraction) {
        bar.show(stage, fraction);
    };
    arguments.options.log = [&](const std::string& line) { bar.say(line); };
    const auto report = TRY(pipeline::prepare(store, arguments.caseName, arguments.options));
    for (const std::string& note : report.notes)
        bar.say(note);
    for (const pipeline::StageReport& stage : report.stages) {
        fmt::print("{:<12} {:8.2f} s {:8.0f} MiB{}\n", stage.stage, stage.wallSeconds,
                   stage.peakMemoryMib, stage.reused ? "  reused" : "");
    }
    fmt::print("case {} is prepared\n", report.caseName);
    if (arguments.report.empty()) return {};
    std::string quality;
    if (const auto made = store.openCase(report.caseName);
        made && made->find(store::product::quality)) {
        auto text = TRY(made->readText(store::product::quality));
        quality = std::move(text);
    }
    return writeDurably(arguments.report, reportJson(report, quality));
}

void addSource(CLI::App& command, PrepareArguments& arguments) {
    pipeline::PrepareOptions& options = arguments.options;
    command
        .add_option("SERIES", options.series,
                    "DICOM folder (files in any order and depth) or file, or one NIfTI file")
        ->type_name("PATH");
    addStoreOption(command, arguments.store);
    CLI::Option* name =
        command
            .add_option("--case", arguments.caseName,
                        "The case's name: letters, digits, '.', '_', '-' (default: one made from "
                        "the study's and the series' UIDs, or from a NIfTI file's content). A case "
                        "is of one scan: another one is refused")
            ->type_name("NAME")
            ->check(checkCaseName);
    command
        .add_option("--scan", options.scan,
                    "One of several scans of CASE, such as supine and prone of one study: it is "
                    "kept beside them, as CASE.SCAN; a series of another study is refused")
        ->type_name("SCAN")
        ->check(checkCaseName)
        ->needs(name);
    command.add_flag("--replace", options.replace,
                     "Let this scan take the place of another one that the case is of. Its "
                     "products go; bookmarks stay with their scan, and are there again when it is");
    command
        .add_option("--organ", options.organ,
                    "How the organ is found, shaped and ended: colon (default), bladder, vessel, "
                    "or a profile of your own (processing/organs/README.md has the format)")
        ->type_name("NAME|FILE.json");
    command.add_option("--until", options.until, "The last stage to run")
        ->type_name("STAGE")
        ->check(CLI::IsMember(pipeline::stageNames()));
}

// What the reader knows of where the organ is.
void addEdits(CLI::App& command, pipeline::PrepareOptions& options) {
    CLI::Option* lumen =
        command
            .add_option("--lumen", options.lumenMask,
                        "A segmentation of the lumen made elsewhere, on the series' grid: 0 "
                        "outside, 2 tagged, 4 fluid without tagging, else air; it takes the place "
                        "of the segmentation "
                        "stage. Without SERIES it is the case's own scan's, or stands alone: then "
                        "nothing is cleansed, and the surface is the mask's")
            ->type_name("MASK.nii.gz");
    command.add_option("--series", options.seriesUid, "Which series of the folder, by its UID")
        ->type_name("UID");
    addPointsOption(command, "--seed", options.seedsMm,
                    "The air or fluid at this point (LPS, mm) is the organ; may be repeated")
        ->excludes(lumen);
    addPointsOption(command, "--exclude", options.excludesMm,
                    "The air or fluid at this point (LPS, mm) is not the organ; may be repeated")
        ->excludes(lumen);
    addBallsOption(
        command, "--cut", options.cuts,
        "There is no lumen in the ball at this point (LPS, mm; 3 mm where no radius is "
        "given): a wall that the scan does not show, as where a stoma is open to the room; may "
        "be repeated")
        ->excludes(lumen);
    addPairsOption(
        command, "--join", options.joins,
        "The colon goes on from the first point to the second (LPS, mm); may be repeated")
        ->excludes(lumen);
    command.add_flag("--forget-edits", options.forgetEdits,
                     "Forget the points that earlier calls gave; without it they stand where this "
                     "call gives none");
}

void addSurface(CLI::App& command, pipeline::PrepareOptions& options) {
    command
        .add_option("--surface-error-mm", options.surfaceErrorMm,
                    "How far the simplified surface may be from the finest one, mm, at the samples "
                    "where it is held to it: corners, middles of edges and triangles; between "
                    "them it may be farther at a few places")
        ->type_name("MM")
        ->check(numberRange(0.001, 10.0))
        ->capture_default_str();
    addAreaWeightOption(command, options.areaWeight);
    command
        .add_option("--cad-model", options.cadModel,
                    "What polyp detection has learnt, as haustra cad train and calibrate write it "
                    "(default: the built-in model, of phantoms)")
        ->type_name("FILE.json")
        ->check(CLI::ExistingFile);
}

}  // namespace

Command addPrepare(CLI::App& program) {
    auto arguments = std::make_shared<PrepareArguments>();
    CLI::App* command = program.add_subcommand(
        "prepare",
        "Make a case's products from a CT series. Work that the store holds already is not done "
        "again.");
    command->footer(store::catalogue().stageHelp());
    addSource(*command, *arguments);
    addEdits(*command, arguments->options);
    addSurface(*command, arguments->options);
    command
        ->add_option("--report", arguments->report,
                     "Write wall seconds of each stage (beside_seconds of them passed beside "
                     "the stages before it) and its peak memory, the bridges over collapsed "
                     "segments with their lengths, notes, and how sure the colon is, as "
                     "JSON")
        ->type_name("FILE.json");
    addThreadsOption(*command, arguments->options.threads);
    command->callback([arguments] {
        if (arguments->options.series.empty() && arguments->options.lumenMask.empty()) {
            throw CLI::RequiredError("SERIES or --lumen");
        }
        if (arguments->options.series.empty() && arguments->options.until == "import")
            throw CLI::ValidationError("--until import", "a mask has no import without SERIES");
    });
    return {.app = command,
            .run = [arguments] { return runPrepare(*arguments); },
            .wantsLargePages = true};
}

}  // namespace haustra::cli
