// haustra denoise: a mesh without its handles.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/progress_bar.h"
#include "cli/text_files.h"
#include "core/durable_file.h"
#include "handles/handle_removal.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

struct DenoiseArguments {
    fs::path mesh, out, report;
    int threads = 0;
};

glm::dvec3 middleOf(const std::vector<glm::dvec3>& loop) {
    glm::dvec3 sum(0.0);
    for (const glm::dvec3& p : loop)
        sum += p;
    return sum / double(loop.size());
}

std::size_t crossingsOf(const handles::HandleRemoval& removal) {
    std::size_t crossings = 0;
    for (const handles::RemovedHandle& handle : removal.handles)
        crossings += handle.crossings;
    return crossings;
}

/// What a line says of crossings: nothing where there are none.
std::string tellCrossings(const char* before, std::size_t crossings) {
    if (crossings == 0) return {};
    return fmt::format("{}{} pair{} of triangles cross", before, crossings,
                       crossings == 1 ? "" : "s");
}

nlohmann::ordered_json reportOf(const TriMesh& before, const handles::HandleRemoval& removal) {
    auto handles = nlohmann::ordered_json::array();
    for (const handles::RemovedHandle& handle : removal.handles) {
        const glm::dvec3 at = middleOf(handle.loopMm);
        auto loop = nlohmann::ordered_json::array();
        for (const glm::dvec3& p : handle.loopMm)
            loop.push_back({p.x, p.y, p.z});
        handles.push_back({{"length_mm", handle.lengthMm},
                           {"position_mm", {at.x, at.y, at.z}},
                           {"filled_area_mm2", handle.filledAreaMm2},
                           {"crossings", handle.crossings},
                           {"loop_mm", loop}});
    }
    const MeshTopology was = meshTopology(before), is = meshTopology(removal.mesh);
    return {{"genus_before", was.genus()},
            {"genus_after", is.genus()},
            {"pieces", is.components},
            {"triangles_before", before.triangles.size()},
            {"triangles_after", removal.mesh.triangles.size()},
            {"area_change_mm2", removal.areaChangeMm2},
            {"crossings", crossingsOf(removal)},
            {"handles", handles}};
}

Result<void> runDenoise(const DenoiseArguments& arguments) {
    for (const fs::path& file : {arguments.out, arguments.report}) {
        if (file.empty()) continue;
        TRY(checkOutputFile(file));
    }
    const auto mesh = TRY(mesh::readMesh(arguments.mesh));
    handles::HandleRemovalOptions options;
    options.threads = arguments.threads;
    auto removal = [&] {
        ProgressBar bar;
        options.progress = [&](double fraction) { bar.show("handles", fraction); };
        return handles::removeHandles(mesh, options);
    }();
    if (!removal) {
        const Error& error = removal.error();
        return fail(error.kind, error.message, arguments.mesh.string());
    }
    TRY(mesh::writeMesh(arguments.out, removal->mesh));

    const auto report = reportOf(mesh, *removal);
    for (std::size_t i = 0; i < removal->handles.size(); ++i) {
        const handles::RemovedHandle& handle = removal->handles[i];
        const glm::dvec3 at = middleOf(handle.loopMm);
        fmt::print("handle {}: loop {:.2f} mm at {:.1f},{:.1f},{:.1f}, {:.2f} mm² filled{}\n",
                   i + 1, handle.lengthMm, at.x, at.y, at.z, handle.filledAreaMm2,
                   tellCrossings(", where ", handle.crossings));
    }
    fmt::print("genus {} before, {} after; area changed by {:+.2f} mm²{}\n",
               report["genus_before"].get<long>(), report["genus_after"].get<long>(),
               removal->areaChangeMm2, tellCrossings("; in all ", crossingsOf(*removal)));
    if (arguments.report.empty()) return {};
    return writeDurably(arguments.report, report.dump(2) + "\n");
}

void checkMeshName(const char* argument, const fs::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (ending == ".ply" || ending == ".obj" || ending == ".off" || ending == ".stl") return;
    throw CLI::ValidationError(argument,
                               "a mesh file's name ends in .ply, .obj, .off or .stl, not \"" +
                                   file.filename().string() + "\"");
}

}  // namespace

Command addDenoise(CLI::App& program) {
    auto arguments = std::make_shared<DenoiseArguments>();
    CLI::App* command = program.add_subcommand(
        "denoise",
        "Remove the handles of a closed manifold triangle mesh: each is cut along its shortest "
        "loop, and both holes are filled, until every piece of the mesh is a sphere. Thin handles "
        "break and narrow tunnels are plugged, but for those that a part of the mesh goes through: "
        "there up to three other ways round are tried. All vertices off the loops keep their "
        "places, exactly but in STL, whose coordinates are floats. Prints each loop's length, "
        "middle and filled area, how many pairs of triangles cross there if no way was clear, and "
        "the genus before and after.");
    command->add_option("MESH", arguments->mesh, "The mesh: .ply, .obj, .off or .stl, in mm")
        ->required();
    command
        ->add_option("OUT", arguments->out,
                     "Where to, in any of these formats; replaced in one step. May be MESH")
        ->required();
    command->add_option("--report", arguments->report, "Write the handles and totals as JSON")
        ->type_name("FILE.json");
    addThreadsOption(*command, arguments->threads);
    command->callback([arguments] {
        checkMeshName("MESH", arguments->mesh);
        checkMeshName("OUT", arguments->out);
    });
    return {command, [arguments] { return runDenoise(*arguments); }};
}

}  // namespace haustra::cli
