// haustra evaluate: a case against a phantom's truth.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/text_files.h"
#include "core/durable_file.h"
#include "phantom/score.h"
#include "pipeline/read_inputs.h"
#include "store/case_store.h"
#include "store/products.h"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

struct EvaluateArguments {
    fs::path store, truth, report;
    std::string caseName;
};

struct Row {
    const char *field, *text;
    double value;
    const char* unit;
};

std::vector<Row> rowsOf(const phantom::LumenScore& score) {
    return {
        {"dice", "Dice, lumen", score.dice, ""},
        {"dice_air", "Dice, air", score.diceAir, ""},
        {"dice_tagged", "Dice, tagged", score.diceTagged, ""},
        {"over_ml", "volume too much", score.overMl, "ml"},
        {"false_ml", "false volume", score.falseMl, "ml"},
        {"missed_ml", "missed volume", score.missedMl, "ml"},
        {"missed_centerline_mm", "missed centerline", score.missedCenterlineMm, "mm"},
        {"missed_centerline_percent", "missed centerline", 100.0 * score.missedCenterlineShare,
         "%"},
        {"centerline_mean_error_mm", "centerline, mean error", score.centerlineMeanErrorMm, "mm"},
        {"centerline_max_error_mm", "centerline, largest error", score.centerlineMaxErrorMm, "mm"}};
}

Result<void> runEvaluate(const EvaluateArguments& arguments) {
    if (!arguments.report.empty()) TRY(checkOutputFile(arguments.report));
    const auto found =
        TRY(store::CaseStore::open(arguments.store, false).and_then([&](const auto& s) {
            return s.openCase(arguments.caseName);
        }));
    const auto labels = TRY(found.readVolume<std::uint8_t>(store::product::lumen));
    const auto centerline = TRY(found.readCenterline());
    const Grid grid = labels.grid();
    const auto truth = TRY(pipeline::readLumenMask(arguments.truth / "lumen.nii.gz", &grid));
    const auto trueCenterline = TRY(readCenterlineCsv(arguments.truth / "centerline.csv"));
    const auto score = TRY(phantom::scoreLumen(truth.labels, trueCenterline, labels, centerline));

    nlohmann::ordered_json report{{"case", arguments.caseName}};
    for (const Row& row : rowsOf(score)) {
        fmt::print("{:<28} {:10.3f} {}\n", row.text, row.value, row.unit);
        report[row.field] = row.value;
    }
    if (arguments.report.empty()) return {};
    return writeDurably(arguments.report, report.dump(2) + "\n");
}

}  // namespace

Command addEvaluate(CLI::App& program) {
    auto arguments = std::make_shared<EvaluateArguments>();
    CLI::App* command = program.add_subcommand(
        "evaluate", "Score a case's lumen and centerline against a phantom's truth.");
    command->add_option("CASE", arguments->caseName, "The case's name")->required();
    addStoreOption(*command, arguments->store);
    command->add_option("--truth", arguments->truth, "The phantom's truth folder")
        ->type_name("DIR")
        ->required();
    command->add_option("--report", arguments->report, "Write the scores as JSON")
        ->type_name("FILE.json");
    return {command, [arguments] { return runEvaluate(*arguments); }};
}

}  // namespace haustra::cli
