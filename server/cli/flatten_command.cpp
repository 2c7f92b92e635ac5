// haustra flatten: a mesh on the plane, and how much that bends it.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "cli/text_files.h"
#include "core/durable_file.h"
#include "flatten/general/surface_flattening.h"
#include "mesh/flat_map_file.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <cctype>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

using Json = nlohmann::ordered_json;

struct FlattenArguments {
    fs::path mesh, out, report;
    std::vector<glm::dvec3> endsMm;
    flatten::SurfaceFlatteningOptions options;
    const CLI::App* command = nullptr;
};

Json spreadOf(const flatten::Spread& spread) {
    return {
        {"mean", spread.mean}, {"p95", spread.p95}, {"p99_9", spread.p999}, {"max", spread.max}};
}

Json distortionOf(const flatten::Distortion& distortion) {
    return {{"angle_error_degrees", spreadOf(distortion.angleErrorDegrees)},
            {"angle_floor_degrees", distortion.angleFloorDegrees},
            {"dilatation", spreadOf(distortion.dilatation)},
            {"log_area_deviation", distortion.logAreaDeviation},
            {"area_range", distortion.areaRange}};
}

Json reportOf(const TriMesh& mesh, const flatten::SurfaceFlattening& flat) {
    Json report{{"genus", flat.shape.genus},
                {"boundary_loops", flat.shape.boundaryLoops},
                {"vertices", mesh.vertices.size()},
                {"triangles", mesh.triangles.size()},
                {"flat_vertices", flat.map.flat.size()},
                {"flat_triangles", flat.map.surface.triangles.size()},
                {"certificate", flat.certificate}};
    if (flat.strip) {
        report["modulus"] = flat.strip->modulus;
        report["height"] = flat.map.height;
        report["seam_mismatch"] = flat.strip->seamMismatch;
        report["repaired_vertices"] = flat.strip->repaired;
        report["area_weight"] = flat.strip->areaWeight;
        report["pouches"] = flat.strip->pouches;
        report["pouch_area_mm2"] = flat.strip->pouchAreaMm2;
        if (flat.strip->pouches > 0) report["outside"] = distortionOf(flat.strip->outside);
    }
    if (flat.punched) {
        report["cap_area_mm2"] = {flat.punched->capAreaMm2[0], flat.punched->capAreaMm2[1]};
        report["rim_length_mm"] = {flat.punched->rimLengthMm[0], flat.punched->rimLengthMm[1]};
    }
    if (flat.tau) {
        report["modulus"] = flat.tau->imag();
        report["tau"] = {flat.tau->real(), flat.tau->imag()};
    }
    if (!flat.strip && !flat.tau) report["form_zeros"] = flat.formZeros;
    report.update(distortionOf(flat.distortion));
    report["flips"] = flat.flips;
    if (flat.strip && flat.strip->areaWeight > 0.0)
        report["conformal"] = distortionOf(flat.strip->conformal);
    return report;
}

std::string counted(auto count, const char* one) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
}

void tell(const char* name, const flatten::Distortion& distortion) {
    const flatten::Spread &angle = distortion.angleErrorDegrees, &stretch = distortion.dilatation;
    fmt::print(
        "{}angles off by {:.3f}° in the mean (no map: below {:.3f}°), 95 % {:.2f}°, 99.9 % "
        "{:.2f}°, at most {:.1f}°\n",
        name, angle.mean, distortion.angleFloorDegrees, angle.p95, angle.p999, angle.max);
    fmt::print(
        "{}dilatation {:.5g} in the mean, 99.9 % {:.3g}; magnification of areas: deviation "
        "of its logarithm {:.3f}, range {:.3g}\n",
        name, stretch.mean, stretch.p999, distortion.logAreaDeviation, distortion.areaRange);
}

void tell(const TriMesh& mesh, const flatten::SurfaceFlattening& flat, double areaWeight) {
    fmt::print("genus {}, {}, {}\n", flat.shape.genus,
               counted(flat.shape.boundaryLoops, "boundary loop"),
               counted(mesh.triangles.size(), "triangle"));
    if (flat.punched) {
        fmt::print("ends opened: {:.1f} and {:.1f} mm² with rims of {:.1f} and {:.1f} mm\n",
                   flat.punched->capAreaMm2[0], flat.punched->capAreaMm2[1],
                   flat.punched->rimLengthMm[0], flat.punched->rimLengthMm[1]);
    }
    if (flat.strip) {
        fmt::print("modulus {:.6f}, certificate {:.2e}, seam mismatch {:.1e}\n",
                   flat.strip->modulus, flat.certificate, flat.strip->seamMismatch);
    } else if (flat.tau) {
        fmt::print("period ratio {:.6f} + {:.6f} i, certificate {:.2e}\n", flat.tau->real(),
                   flat.tau->imag(), flat.certificate);
    } else {
        fmt::print("a holomorphic form with {}, certificate {:.2e}\n",
                   counted(flat.formZeros, "zero"), flat.certificate);
    }
    if (flat.strip && flat.strip->areaWeight > 0.0) {
        tell("conformal: ", flat.strip->conformal);
    } else if (flat.strip && areaWeight > 0.0) {
        fmt::print(
            "warning: areas are not weighted, as the strip would fold, or has a large blind "
            "finger: "
            "it is the conformal one\n");
    }
    tell("", flat.distortion);
    if (flat.strip && flat.strip->pouches > 0) {
        fmt::print("{} of {:.0f} mm² in all mapped apart\n",
                   counted(flat.strip->pouches, "blind finger"), flat.strip->pouchAreaMm2);
        tell("outside: ", flat.strip->outside);
    }
    fmt::print("{} flipped\n", counted(flat.flips, "triangle"));
    if (flat.shape.genus > 0 && flat.flips > 0) {
        fmt::print(
            "a small handle leaves the rest of a long surface no room that numbers can tell: "
            "`haustra denoise` takes handles out\n");
    }
}

/// Throws what wrong usage is where an option says nothing about a surface of this shape.
Result<void> checkApplies(const TriMesh& mesh, const FlattenArguments& arguments) {
    const auto given = [&](const char* option) { return arguments.command->count(option) > 0; };
    if (!given("--ends") && !given("--rim-mm") && !given("--area-weight")) return {};
    const auto shape = flatten::shapeOf(mesh);
    if (!shape) return fail(shape.error().kind, shape.error().message, arguments.mesh.string());
    const auto [parts, genus, loops] = *shape;
    const bool isSphere = genus == 0 && loops == 0,
               isStrip = isSphere || (genus == 0 && loops == 2);
    const std::string has =
        fmt::format(", and the mesh has genus {} and {}", genus, counted(loops, "boundary loop"));
    for (const char* option : {"--ends", "--rim-mm"}) {
        if (given(option) && !isSphere)
            throw CLI::ValidationError(option, "is for a closed surface of genus 0" + has);
    }
    if (given("--area-weight") && !isStrip) {
        throw CLI::ValidationError("--area-weight",
                                   "is for a tube or a closed surface of genus 0" + has);
    }
    return {};
}

Result<void> runFlatten(const FlattenArguments& arguments) {
    for (const fs::path& file : {arguments.out, arguments.report}) {
        if (file.empty()) continue;
        TRY(checkOutputFile(file));
    }
    const auto mesh = TRY(mesh::readMesh(arguments.mesh));
    TRY(checkApplies(mesh, arguments));
    flatten::SurfaceFlatteningOptions options = arguments.options;
    if (!arguments.endsMm.empty()) options.endsMm = {arguments.endsMm[0], arguments.endsMm[1]};
    const auto flat = [&] {
        ProgressBar bar;
        options.progress = [&](double fraction) { bar.show("flattening", fraction); };
        return flatten::flattenSurface(mesh, options);
    }();
    if (!flat) {
        const Error& error = flat.error();
        return fail(error.kind, error.message, arguments.mesh.string());
    }
    TRY(mesh::writeFlatMap(arguments.out, flat->map));
    tell(mesh, *flat, options.areaWeight);
    if (arguments.report.empty()) return {};
    return writeDurably(arguments.report, reportOf(mesh, *flat).dump(2) + "\n");
}

void checkNames(const FlattenArguments& arguments) {
    const auto fits = [](const fs::path& file, std::initializer_list<const char*> endings) {
        std::string ending = file.extension().string();
        for (char& c : ending)
            c = char(std::tolower(static_cast<unsigned char>(c)));
        return std::find(endings.begin(), endings.end(), ending) != endings.end();
    };
    if (!fits(arguments.mesh, {".ply", ".obj", ".off", ".stl"})) {
        throw CLI::ValidationError("MESH",
                                   "a mesh file's name ends in .ply, .obj, .off or .stl, not \"" +
                                       arguments.mesh.filename().string() + "\"");
    }
    if (!fits(arguments.out, {".obj", ".ply"})) {
        throw CLI::ValidationError("OUT", "a flat mesh is written as .obj or .ply, not as \"" +
                                              arguments.out.filename().string() + "\"");
    }
    std::error_code ignored;
    if (fs::equivalent(arguments.mesh, arguments.out, ignored))
        throw CLI::ValidationError("OUT", "the mesh would be replaced by its own cut surface");
    const auto resolved = [&](const fs::path& file) { return fs::weakly_canonical(file, ignored); };
    if (!arguments.report.empty() && (resolved(arguments.report) == resolved(arguments.mesh) ||
                                      resolved(arguments.report) == resolved(arguments.out)))
        throw CLI::ValidationError("--report", "the report would replace the mesh");
}

}  // namespace

Command addFlatten(CLI::App& program) {
    auto arguments = std::make_shared<FlattenArguments>();
    flatten::SurfaceFlatteningOptions& options = arguments->options;
    CLI::App* command = program.add_subcommand(
        "flatten",
        "Map a triangle mesh conformally to the plane: a tube, with two boundary loops, to a "
        "rectangle whose left and right sides are one seam; a closed surface of genus 0 likewise, "
        "once a small hole is made at each of its ends; a torus to the parallelogram of its "
        "periods; any other but a disc by a holomorphic form on a fundamental domain. Prints "
        "genus, "
        "boundary loops, modulus (length over circumference) or period ratio, its certificate, and "
        "the "
        "distortion of angles and areas.");
    command->add_option("MESH", arguments->mesh, "The mesh: .ply, .obj, .off or .stl, in mm")
        ->required();
    command
        ->add_option("OUT", arguments->out,
                     "The cut mesh with its flat coordinates, in circumferences: .obj (vt) or .ply "
                     "(s, t); replaced in one step")
        ->required();
    addEndsOption(*command, arguments->endsMm,
                  "Where the holes of a closed surface of genus 0 are made: the vertices nearest "
                  "to these points, the first at the bottom (default: the two that are farthest "
                  "apart along the surface)");
    command
        ->add_option("--rim-mm", options.rimMm,
                     "How long their rims are, mm (default: 15, less on a small surface)")
        ->type_name("MM")
        ->check(
            [](const std::string& text) {
                const auto number = parseNumbers(text, ',', 1);
                return number && (*number)[0] > 0.0 ? std::string()
                                                    : "\"" + text + "\" is no length";
            },
            "FLOAT > 0");
    addAreaWeightOption(*command, options.areaWeight);
    command->add_option("--report", arguments->report, "Write all figures as JSON")
        ->type_name("FILE.json");
    addThreadsOption(*command, options.threads);
    arguments->command = command;
    command->callback([arguments] { checkNames(*arguments); });
    return {command, [arguments] { return runFlatten(*arguments); }};
}

}  // namespace haustra::cli
