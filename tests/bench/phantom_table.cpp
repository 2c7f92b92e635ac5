// What every stage up to the surface makes of phantoms of each preset in both positions, against
// their truth, as Markdown tables. `--help` tells the options.
#include "bench/phantom_study.h"
#include "mesh/mesh_file.h"

#include <cstdio>
#include <map>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

using namespace haustra;
using namespace haustra::bench;

namespace {

const std::map<std::string, phantom::Preset> kPresets{{"easy", phantom::Preset::easy},
                                                      {"standard", phantom::Preset::standard},
                                                      {"hard", phantom::Preset::hard}};

struct Row {
    std::string name;  ///< preset, position and seed
    Result<PhantomStudy> study;
};

/// Prints a heading, the columns and a line for each phantom that came through.
template <class Cells>
void printTable(const std::vector<Row>& rows, const char* heading, const char* columns,
                const Cells& cells) {
    fmt::print("\n{}\n\n| phantom | {} |\n| --- |", heading, columns);
    for (const char* c = columns; *c; ++c) {
        if (*c == '|') fmt::print(" --- |");
    }
    fmt::print(" --- |\n");
    for (const Row& row : rows) {
        if (!row.study) {
            fmt::print("| {} | {} |\n", row.name, describe(row.study.error()));
            continue;
        }
        for (const std::string& line : cells(*row.study))
            fmt::print("| {} | {} |\n", row.name, line);
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

constexpr const char* kSurfaceColumns =
    "surface | triangles | Euler, components, bad edges | self-intersections | smallest angles: "
    "least, 1 %, median (% below 10°) | mean mm from mesh, from truth | 95 % mm | maximum mm | "
    "bias mm | farthest at mm | seconds";

void printTables(const std::vector<Row>& rows, bool surface, bool worst) {
    printTable(rows, "Lumen",
               "length mm | lumen ml | Dice of the segmentation: all, air, fluid | Dice of the "
               "denoised lumen | missed line mm (%) | missed ml | false ml | over ml | centerline "
               "error mm, mean / max | seconds: lumen, centerline",
               lumenCells);
    printTable(rows, "Cleansing: RMSE, bias in HU",
               "noise sd | fluid | fluid RMSE / sd | air–fluid ±2 | fluid–wall ±2 | both | voxels "
               "changed beyond 4 (most) | seconds: mixture, cleansing",
               cleansingCells);
    printTable(rows, "Submerged polyps",
               "polyp | submerged % | voxels | RMSE, bias HU | volume kept % | excess %",
               polypCells);
    printTable(rows, "Topology",
               "before: components, cavities, handles (Euler) | after | handles cut | voxels "
               "removed | added | seconds",
               topologyCells);
    if (surface) printTable(rows, "Surface", kSurfaceColumns, surfaceCells);
    if (worst)
        printTable(rows, "Worst places", "region | voxel | voxels | RMSE HU | bias HU", worstCells);
}

/// Scores a mesh of elsewhere against the phantom.
Result<void> scoreMesh(const std::string& file, const phantom::PhantomOptions& options) {
    const auto mesh = mesh::readMesh(file);
    if (!mesh) return tl::make_unexpected(mesh.error());
    const auto truth = phantom::makePhantom(options);
    if (!truth) return tl::make_unexpected(truth.error());
    const auto study = studySurface(file, *mesh, phantom::trueLumenSurface(options, truth->lumen),
                                    options.threads);
    if (!study) return tl::make_unexpected(study.error());
    fmt::print("{}\n{}\n", kSurfaceColumns, surfaceLine(*study));
    return {};
}

}  // namespace

int main(int count, char** arguments) {
    CLI::App program("Scores every stage on phantoms, as Markdown tables.");
    std::vector<std::string> presets = {"easy", "standard", "hard"},
                             positions = {"supine", "prone"};
    StudyOptions options;
    std::uint64_t seed = 1;
    int seeds = 1;
    bool small = false, noSurface = false, worst = false;
    std::string mesh;
    program.add_option("--preset", presets, "easy, standard, hard; some of them")
        ->check(CLI::IsMember(kPresets));
    program.add_option("--position", positions, "supine, prone, or both")
        ->check(CLI::IsMember({"supine", "prone"}));
    program.add_flag("--small", small, "Phantoms of 256×256×200 voxels");
    program.add_option("--seed", seed, "The first patient");
    program.add_option("--seeds", seeds, "How many patients")->check(CLI::Range(1, 1000));
    program.add_option("--bound", options.errorBoundsMm, "Simplify to within these, mm")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    program.add_flag("--no-surface", noSurface, "Stop before the surface");
    program.add_flag("--worst", worst, "List where the cleansing is worst, too");
    program.add_option("--out", options.out, "Folder for the cleansed scans, lumens and meshes");
    program.add_option("--mesh", mesh, "Only score this mesh against the first phantom");
    program.add_option("--threads", options.phantom.threads, "0: all cores");
    CLI11_PARSE(program, count, arguments);

    options.surface = !noSurface;
    options.phantom.size = small ? phantom::Size::small : phantom::Size::full;
    const std::filesystem::path out = options.out;
    std::vector<Row> rows;
    bool failed = false;
    for (int s = 0; s < seeds; ++s) {
        for (const std::string& preset : presets) {
            for (const std::string& position : positions) {
                options.phantom.seed = seed + std::uint64_t(s);
                options.phantom.preset = kPresets.at(preset);
                options.phantom.position = patientPositionFromString(position);
                if (!mesh.empty()) {
                    const auto scored = scoreMesh(mesh, options.phantom);
                    if (!scored) fmt::print(stderr, "{}\n", describe(scored.error()));
                    return scored ? 0 : 1;
                }
                const std::string name =
                    fmt::format("{} {} {}", preset, position, options.phantom.seed);
                options.log = [&](const std::string& stage) {
                    fmt::print(stderr, "{}: {}\n", name, stage);
                };
                if (!out.empty()) options.out = out / name;
                rows.push_back({name, studyPhantom(options)});
                failed = failed || !rows.back().study;
            }
        }
    }
    printTables(rows, options.surface, worst);
    return failed ? 1 : 0;
}
