// What every stage makes of phantoms of each preset in both positions, against their truth, as
// Markdown tables. Each phantom has a process of its own, so that one that crashes costs its row
// alone. `--help` tells the options.
#include "bench/phantom_study.h"
#include "mesh/mesh_file.h"
#include "phantom/phantom.h"

#include <cstdio>
#include <map>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

using namespace haustra;
using namespace haustra::bench;

namespace {

constexpr const char* wildName = "wild";
const std::map<std::string, phantom::Preset> presetNamed{{"easy", phantom::Preset::easy},
                                                         {"standard", phantom::Preset::standard},
                                                         {"hard", phantom::Preset::hard}};

/// The figures of the Colon table that are summed up, of one phantom.
struct ColonFigures {
    double dice = 0, falseMl = 0, missedMl = 0, missedMm = 0, coverage = 0, wrongMm = 0,
           meanErrorMm = 0, wrongSteps = 0, unwarned = 0, collapses = 0, crossed = 0, bridges = 0,
           confidence = 0, flips = 0, failed = 0;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ColonFigures, dice, falseMl, missedMl, missedMm, coverage,
                                   wrongMm, meanErrorMm, wrongSteps, unwarned, collapses, crossed,
                                   bridges, confidence, flips, failed)

struct Row {
    std::string name, preset;  ///< the name has preset, position and seed
    std::string failed;        ///< why there are no figures; empty: there are
    std::map<std::string, std::vector<std::string>> tables;  ///< lines under each heading
    ColonFigures colon;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Row, name, preset, failed, tables, colon)

struct Table {
    const char* heading;
    const char* columns;
    std::vector<std::string> (*cells)(const PhantomStudy&);
};

void printHead(const Table& table) {
    fmt::print("\n{}\n\n| phantom | {} |\n| --- |", table.heading, table.columns);
    for (const char* c = table.columns; *c; ++c) {
        if (*c == '|') fmt::print(" --- |");
    }
    fmt::print(" --- |\n");
}

void printRow(const Table& table, const Row& row) {
    if (!row.failed.empty()) fmt::print("| {} | {} |\n", row.name, row.failed);
    if (const auto lines = row.tables.find(table.heading); lines != row.tables.end()) {
        for (const std::string& line : lines->second)
            fmt::print("| {} | {} |\n", row.name, line);
    }
    std::fflush(stdout);
}

ColonFigures colonFigures(const PhantomStudy& study) {
    const phantom::ColonScore& score = study.colon.score;
    const auto warned = std::count_if(score.wrongSteps.begin(), score.wrongSteps.end(),
                                      [](const auto& step) { return step.warned; });
    return {study.lumen.dice,
            score.falseIleumMl + score.falseOtherBowelMl + score.falseElsewhereMl,
            study.lumen.missedMl,
            score.missedMm,
            score.coverage(),
            score.wrongMm,
            study.lumen.centerlineMeanErrorMm,
            double(score.wrongSteps.size()),
            double(score.wrongSteps.size()) - double(warned),
            double(score.collapses),
            double(score.collapsesCrossed),
            double(score.bridges),
            study.colon.confidence,
            double(study.colon.flips),
            study.colon.failed.empty() ? 0.0 : 1.0};
}

std::vector<std::string> colonCells(const PhantomStudy& study) {
    const phantom::ColonScore& score = study.colon.score;
    const ColonFigures f = colonFigures(study);
    std::string steps;
    for (const phantom::WrongStep& step : score.wrongSteps) {
        steps += fmt::format("{}{} {:.0f}–{:.0f} mm at ({:.0f}, {:.0f}, {:.0f}){}",
                             steps.empty() ? "" : "; ", toString(step.kind), step.fromArcMm,
                             step.toArcMm, step.placeMm.x, step.placeMm.y, step.placeMm.z,
                             step.warned ? "" : " NOT WARNED");
    }
    return {fmt::format(
        "{:.4f} | {:.1f} ({:.1f}, {:.1f}, {:.1f}) | {:.1f} | {:.0f} | {:.0f} ({:.1f}) | {:.0f} | "
        "{:.2f} | {:.0f} ({:.0f}) | {} of {} | {} | {:.2f}, {} | {} | {:.0f} | {}{}{}",
        f.dice, f.falseMl, score.falseIleumMl, score.falseOtherBowelMl, score.falseElsewhereMl,
        f.missedMl, score.trueMm, f.missedMm, 100.0 * f.coverage, f.wrongMm, f.meanErrorMm,
        f.wrongSteps, f.unwarned, score.collapsesCrossed, score.collapses, score.bridges,
        f.confidence, study.colon.warnings, study.colon.flips,
        study.segmentationSeconds + study.mixtureSeconds + study.cleansingSeconds +
            study.denoisingSeconds + study.centerlineSeconds + study.colon.surfaceSeconds +
            study.colon.flatteningSeconds,
        steps, steps.empty() || study.colon.failed.empty() ? "" : "; ", study.colon.failed)};
}

/// Of all phantoms of a preset: the worst of each figure, and the sum where it has one.
void printSummary(const std::vector<Row>& rows) {
    fmt::print(
        "\nColon, worst / sum of each preset\n\n| preset | Dice | false ml | missed ml | missed mm "
        "| covers % | wrong mm | mean error mm | wrong junctions (not warned) | collapses bridged "
        "| "
        "bridges | least confidence | flips | failed |\n| --- | --- | --- | --- | --- | --- | --- "
        "| "
        "--- | --- | --- | --- | --- | --- | --- |\n");
    std::vector<std::string> presets;
    for (const Row& row : rows) {
        if (std::find(presets.begin(), presets.end(), row.preset) == presets.end())
            presets.push_back(row.preset);
    }
    for (const std::string& preset : presets) {
        ColonFigures sum, worst;
        worst.dice = worst.coverage = worst.confidence = 1.0;
        int count = 0;
        for (const Row& row : rows) {
            if (row.preset != preset) continue;
            ++count;
            sum.failed += row.failed.empty() ? row.colon.failed : 1.0;
            if (!row.failed.empty()) continue;
            for (const auto figure :
                 {&ColonFigures::falseMl, &ColonFigures::missedMl, &ColonFigures::missedMm,
                  &ColonFigures::wrongMm, &ColonFigures::meanErrorMm, &ColonFigures::wrongSteps,
                  &ColonFigures::unwarned, &ColonFigures::collapses, &ColonFigures::crossed,
                  &ColonFigures::bridges, &ColonFigures::flips}) {
                sum.*figure += row.colon.*figure;
                worst.*figure = std::max(worst.*figure, row.colon.*figure);
            }
            for (const auto figure :
                 {&ColonFigures::dice, &ColonFigures::coverage, &ColonFigures::confidence})
                worst.*figure = std::min(worst.*figure, row.colon.*figure);
        }
        fmt::print(
            "| {}, {} | {:.4f} | {:.1f} / {:.1f} | {:.1f} / {:.1f} | {:.0f} / {:.0f} | {:.1f} | "
            "{:.0f} / {:.0f} | {:.2f} | {:.0f} ({:.0f}) | {:.0f} of {:.0f} | {:.0f} | {:.2f} | "
            "{:.0f} | {:.0f} |\n",
            preset, count, worst.dice, worst.falseMl, sum.falseMl, worst.missedMl, sum.missedMl,
            worst.missedMm, sum.missedMm, 100.0 * worst.coverage, worst.wrongMm, sum.wrongMm,
            worst.meanErrorMm, sum.wrongSteps, sum.unwarned, sum.crossed, sum.collapses,
            sum.bridges, worst.confidence, sum.flips, sum.failed);
    }
}

std::vector<std::string> lumenCells(const PhantomStudy& study) {
    const phantom::LumenScore &rough = study.segmentation, &score = study.lumen;
    return {fmt::format(
        "{:.0f} | {:.0f} | {:.4f}, {:.4f}, {:.4f} | {:.4f}, {:.4f}, {:.4f} | {:.0f} ({:.2f}) | "
        "{:.1f} | {:.1f} | {:.1f} | {:.2f} / {:.1f} | {:.1f} + {:.1f}",
        study.lengthMm, study.lumenMl, rough.dice, rough.diceAir, rough.diceTagged, score.dice,
        score.diceAir, score.diceTagged, score.missedCenterlineMm,
        100.0 * score.missedCenterlineShare, score.missedMl, score.falseMl, score.overMl,
        score.centerlineMeanErrorMm, score.centerlineMaxErrorMm, study.segmentationSeconds,
        study.centerlineSeconds)};
}

std::vector<std::string> cleansingCells(const PhantomStudy& study) {
    const phantom::CleansingScore& score = study.cleansing;
    const auto region = [](const phantom::RegionError& error) {
        return fmt::format("{:.1f}, {:+.1f}", error.rmseHu, error.biasHu);
    };
    return {fmt::format("{:.1f} | {} | {:.2f} | {} | {} | {} | {} ({:.0f} HU) | {:.1f} + {:.1f}",
                        study.noiseSdHu, region(score.fluid), score.fluid.rmseHu / study.noiseSdHu,
                        region(score.interface), region(score.wall), region(score.rim),
                        score.voxelsChangedBeyond, score.maxChangeBeyondHu, study.mixtureSeconds,
                        study.cleansingSeconds)};
}

std::vector<std::string> polypCells(const PhantomStudy& study) {
    std::vector<std::string> lines;
    for (const phantom::SubmergedPolyp& polyp : study.cleansing.polyps) {
        lines.push_back(fmt::format(
            "{} {:.1f} mm | {:.0f} | {} | {:.1f}, {:+.1f} | {:.1f} | {:.1f}", polyp.polyp.kind,
            polyp.polyp.diameterMm, 100.0 * polyp.submergedShare, polyp.voxels, polyp.rmseHu,
            polyp.biasHu, 100.0 * polyp.volumeShare, 100.0 * polyp.excessShare));
    }
    return lines;
}

std::vector<std::string> topologyCells(const PhantomStudy& study) {
    const auto numbers = [](const topology::DigitalTopology& t) {
        return fmt::format("{}, {}, {} ({})", t.components, t.cavities, t.handles(),
                           t.eulerCharacteristic);
    };
    return {fmt::format("{} | {} | {} | {} | {} | {:.1f}", numbers(study.before),
                        numbers(study.after), study.cut.handlesCut, study.cut.voxelsRemoved,
                        study.cut.voxelsAdded, study.denoisingSeconds)};
}

std::string surfaceLine(const SurfaceStudy& surface) {
    const phantom::SurfaceScore& score = surface.score;
    const auto farthest = score.fromMesh.maxMm >= score.fromTruth.maxMm
                              ? score.fromMesh.farthestMm
                              : score.fromTruth.farthestMm;
    return fmt::format(
        "{} | {} | {}, {}, {} | {} | {:.2f}, {:.1f}, {:.1f} ({:.3f}) | {:.3f}, {:.3f} | {:.3f}, "
        "{:.3f} | {:.2f}, {:.2f} | {:+.3f} | {:.1f}, {:.1f}, {:.1f} | {:.1f}",
        surface.what, surface.triangles, surface.topology.eulerCharacteristic,
        surface.topology.components,
        surface.topology.nonManifoldEdges + surface.topology.boundaryEdges,
        surface.selfIntersections, surface.angles.least, surface.angles.p1, surface.angles.median,
        100.0 * surface.angles.shareBelow10, score.fromMesh.meanMm, score.fromTruth.meanMm,
        score.fromMesh.p95Mm, score.fromTruth.p95Mm, score.fromMesh.maxMm, score.fromTruth.maxMm,
        score.biasMm, farthest.x, farthest.y, farthest.z, surface.seconds);
}

std::vector<std::string> surfaceCells(const PhantomStudy& study) {
    std::vector<std::string> lines;
    for (const SurfaceStudy& surface : study.surfaces)
        lines.push_back(surfaceLine(surface));
    return lines;
}

std::vector<std::string> worstCells(const PhantomStudy& study) {
    std::vector<std::string> lines;
    const auto add = [&](const char* name, const phantom::RegionError& error) {
        for (const phantom::WorstPlace& place : error.worst) {
            lines.push_back(fmt::format("{} | {} {} {} | {} | {:.1f} | {:+.1f}", name,
                                        place.voxel.x, place.voxel.y, place.voxel.z, place.voxels,
                                        place.rmseHu, place.biasHu));
        }
    };
    add("fluid", study.cleansing.fluid);
    add("interface", study.cleansing.interface);
    add("wall", study.cleansing.wall);
    return lines;
}

constexpr const char* surfaceColumns =
    "surface | triangles | Euler, components, bad edges | self-intersections | smallest angles: "
    "least, 1 %, median (% below 10°) | mean mm from mesh, from truth | 95 % mm | maximum mm | "
    "bias mm | farthest at mm | seconds";

constexpr Table colonTable{
    "Colon",
    "Dice | false ml (ileum, other bowel, elsewhere) | missed ml | true mm | missed mm (covers %) "
    "| "
    "wrong mm | mean error mm | wrong junctions (not warned) | collapses bridged | bridges | "
    "confidence, warnings | flips | seconds | what is wrong, at true arcs",
    colonCells};

/// The other tables that were asked for.
std::vector<Table> tablesOf(const StudyOptions& options, bool worst) {
    std::vector<Table> tables;
    if (options.cleansing) {
        tables.push_back(
            {"Lumen",
             "length mm | lumen ml | Dice of the segmentation: all, air, fluid | Dice of the "
             "denoised lumen | missed line mm (%) | missed ml | false ml | over ml | centerline "
             "error mm, mean / max | seconds: lumen, centerline",
             lumenCells});
        tables.push_back(
            {"Cleansing: RMSE, bias in HU",
             "noise sd | fluid | fluid RMSE / sd | air–fluid ±2 | fluid–wall ±2 | both | voxels "
             "changed beyond 4 (most) | seconds: mixture, cleansing",
             cleansingCells});
        tables.push_back({"Submerged polyps",
                          "polyp | submerged % | voxels | RMSE, bias HU | volume kept % | excess %",
                          polypCells});
        tables.push_back(
            {"Topology",
             "before: components, cavities, handles (Euler) | after | handles cut | voxels "
             "removed | added | seconds",
             topologyCells});
    }
    if (options.surface) tables.push_back({"Surface", surfaceColumns, surfaceCells});
    if (worst)
        tables.push_back(
            {"Worst places", "region | voxel | voxels | RMSE HU | bias HU", worstCells});
    return tables;
}

Row filled(Row row, const PhantomStudy& study, bool colon, const std::vector<Table>& tables) {
    for (const Table& table : tables)
        row.tables[table.heading] = table.cells(study);
    if (colon) {
        row.tables[colonTable.heading] = colonCells(study);
        row.colon = colonFigures(study);
    }
    return row;
}

/// A line of JSON, whole or not at all.
bool writeRow(int file, const Row& row) {
    const std::string text = nlohmann::json(row).dump() + "\n";
    for (std::size_t at = 0; at < text.size();) {
        const ssize_t wrote = write(file, text.data() + at, text.size() - at);
        if (wrote <= 0) return false;
        at += std::size_t(wrote);
    }
    return true;
}

/// Writes what is known before the flattening, and all in the end.
bool studyRow(int file, Row row, StudyOptions options, const std::vector<Table>& tables) {
    options.beforeFlattening = [&](const PhantomStudy& study) {
        writeRow(file, filled(row, study, options.colon, {}));
    };
    const auto study = studyPhantom(options);
    if (!study) row.failed = describe(study.error());
    return writeRow(file, study ? filled(row, *study, options.colon, tables) : row);
}

/// studyRow in a process of its own, which is ended after `limitSeconds` (0: never).
Row studyApart(const Row& row, const StudyOptions& options, const std::vector<Table>& tables,
               unsigned limitSeconds) {
    Row failed = row;
    int ends[2];
    std::fflush(nullptr);
    if (pipe(ends) != 0) return failed.failed = "no pipe", failed;
    const pid_t child = fork();
    if (child < 0) return failed.failed = "no process", failed;
    if (child == 0) {
        close(ends[0]);
        alarm(limitSeconds);
        _exit(studyRow(ends[1], row, options, tables) ? 0 : 1);
    }
    close(ends[1]);
    std::string text;
    char part[4096];
    for (ssize_t got; (got = read(ends[0], part, sizeof part)) > 0;)
        text.append(part, std::size_t(got));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    if (const auto last = text.rfind('\n'); last != std::string::npos) {
        const auto before = text.rfind('\n', last - 1);
        return nlohmann::json::parse(text.substr(before == std::string::npos ? 0 : before + 1));
    }
    failed.failed = WIFSIGNALED(status) && WTERMSIG(status) == SIGALRM
                        ? fmt::format("not done after {} s", limitSeconds)
                        : fmt::format("crashed (status {})", status);
    return failed;
}

/// Scores a mesh of elsewhere against the phantom.
Result<void> scoreMesh(const std::string& file, const phantom::PhantomOptions& options) {
    const auto mesh = TRY(mesh::readMesh(file));
    const auto truth = TRY(phantom::makePhantom(options));
    const auto study = TRY(
        studySurface(file, mesh, phantom::trueLumenSurface(options, truth.lumen), options.threads));
    fmt::print("{}\n{}\n", surfaceColumns, surfaceLine(study));
    return {};
}

phantom::PhantomOptions phantomOf(const std::string& preset, const std::string& position,
                                  std::uint64_t seed, const phantom::PhantomOptions& base) {
    phantom::PhantomOptions options = base;
    if (preset == wildName) {
        options = phantom::wildOptions(seed);
        options.size = base.size, options.threads = base.threads;
    } else {
        options.preset = presetNamed.at(preset);
    }
    options.seed = seed;
    options.position = patientPositionFromString(position);
    return options;
}

}  // namespace

int main(int count, char** arguments) {
    CLI::App program("Scores every stage on phantoms, as Markdown tables.");
    std::vector<std::string> presets = {"easy", "standard", "hard", wildName},
                             positions = {"supine", "prone"};
    StudyOptions options;
    std::uint64_t seed = 1;
    int seeds = 1;
    unsigned limitSeconds = 0;
    bool small = false, noSurface = false, onlyColon = false, worst = false;
    std::string mesh;
    program.add_option("--preset", presets, "easy, standard, hard, wild; some of them")
        ->check(CLI::IsMember({"easy", "standard", "hard", wildName}));
    program.add_option("--position", positions, "supine, prone …; default: both of these")
        ->check(CLI::IsMember({"supine", "prone", "left-decubitus", "right-decubitus"}));
    program.add_flag("--small", small, "Phantoms of 256×256×200 voxels");
    program.add_option("--seed", seed, "The first patient");
    program.add_option("--seeds", seeds, "How many patients")->check(CLI::Range(1, 1000));
    program.add_flag("--colon", onlyColon,
                     "Only the Colon table: which chain was found, its path, its flat map");
    program.add_flag("--segmentation", options.onlySegmentation,
                     "With --colon: neither cleanse nor flatten; the path of what was segmented");
    program.add_option("--limit", limitSeconds, "Seconds that one phantom may take; 0: any");
    program.add_option("--bound", options.errorBoundsMm, "Simplify to within these, mm")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    program.add_flag("--no-surface", noSurface, "Stop before the surface");
    program.add_flag("--worst", worst, "List where the cleansing is worst, too");
    program.add_option("--out", options.out,
                       "Folder for the scans, cleansed scans, lumens, truths and meshes");
    program.add_option("--mesh", mesh, "Only score this mesh against the first phantom");
    program.add_option("--threads", options.phantom.threads, "0: all cores");
    CLI11_PARSE(program, count, arguments);

    options.colon = onlyColon || !noSurface;
    options.cleansing = !onlyColon;
    options.surface = !onlyColon && !noSurface;
    phantom::PhantomOptions base = options.phantom;
    base.size = small ? phantom::Size::small : phantom::Size::full;
    if (!mesh.empty()) {
        const auto scored =
            scoreMesh(mesh, phantomOf(presets.front(), positions.front(), seed, base));
        if (!scored) fmt::print(stderr, "{}\n", describe(scored.error()));
        return scored ? 0 : 1;
    }
    const std::vector<Table> tables = tablesOf(options, worst);
    const std::filesystem::path out = options.out;
    std::vector<Row> rows;
    bool failed = false;
    if (options.colon) printHead(colonTable);
    for (int s = 0; s < seeds; ++s) {
        for (const std::string& preset : presets) {
            for (const std::string& position : positions) {
                options.phantom = phantomOf(preset, position, seed + std::uint64_t(s), base);
                const std::string name =
                    fmt::format("{} {} {}", preset, position, options.phantom.seed);
                options.log = [&](const std::string& stage) {
                    fmt::print(stderr, "{}: {}\n", name, stage);
                };
                if (!out.empty()) options.out = out / name;
                rows.push_back(
                    studyApart({name, preset, "", {}, {}}, options, tables, limitSeconds));
                failed = failed || !rows.back().failed.empty();
                if (options.colon) printRow(colonTable, rows.back());
            }
        }
    }
    if (options.colon) printSummary(rows);
    for (const Table& table : tables) {
        printHead(table);
        for (const Row& row : rows)
            printRow(table, row);
    }
    return failed ? 1 : 0;
}
