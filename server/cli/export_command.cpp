// haustra export: a product in a format that other programs read.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/flat_image_export.h"
#include "cli/text_files.h"
#include "core/bridges.h"
#include "mesh/flat_map_file.h"
#include "mesh/mesh_file.h"
#include "nifti/nifti_file.h"
#include "store/case_store.h"

#include <algorithm>
#include <map>
#include <memory>

#include <CLI/CLI.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

using Endings = std::vector<std::string>;

// Products and the endings of the files they are written to.
const std::map<std::string, Endings>& formats() {
    static const Endings volume{".nii.gz", ".nii"};
    static const std::map<std::string, Endings> endings{
        {"ct", volume},
        {"segmentation", volume},
        {"mixture", volume},
        {"cleansed", volume},
        {"cleansed-lumen", volume},
        {"lumen", volume},
        {"distance", volume},
        {"centerline", {".csv"}},
        {"branches", {".csv"}},
        {"surface", {".ply", ".obj", ".off", ".stl"}},
        {"flatmap", {".obj", ".ply"}},
        {"quality", {".json"}},
        {"edits", {".json"}},
        {"flat-image", {".png"}}};
    return endings;
}

std::vector<std::string> productNames() {
    std::vector<std::string> names;
    for (const auto& [product, endings] : formats())
        names.push_back(product);
    return names;
}

struct ExportArguments {
    fs::path store, file;
    std::string caseName, product;
    FlatImageOptions flatImage;
};

bool endsIn(const std::string& text, const std::string& ending) {
    return text.size() > ending.size() &&
           text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

template <class T>
Result<void> exportVolume(const store::Case& source, const ExportArguments& arguments) {
    const auto volume = TRY(source.readVolume<T>(arguments.product));
    return nifti::writeNifti(arguments.file, volume);
}

Result<void> runExport(const ExportArguments& arguments) {
    TRY(checkOutputFile(arguments.file));
    const auto source =
        TRY(store::CaseStore::open(arguments.store, false).and_then([&](const auto& s) {
            return s.openCase(arguments.caseName);
        }));
    if (arguments.product == "flat-image")
        return exportFlatImage(source, arguments.file, arguments.flatImage);
    // What leaves the store for other programs has been read whole and found sound.
    TRY(source.verify(arguments.product));
    const std::string& product = arguments.product;
    if (product == "centerline" || product == "branches") {
        const auto centerline = TRY(source.readCenterline(product));
        return writeTextFile(arguments.file, centerlineCsv(centerline));
    }
    if (product == "quality" || product == "edits") {
        const auto text = TRY(source.readText(product));
        return writeTextFile(arguments.file, text);
    }
    if (product == "surface") {
        const auto mesh = TRY(source.readMesh());
        return mesh::writeMesh(arguments.file, mesh);
    }
    if (product == "flatmap") {
        const auto map = TRY(source.readFlatMap());
        std::vector<std::uint8_t> bridged;
        if (source.find("lumen")) {
            const auto lumen = TRY(source.readVolume<std::uint8_t>("lumen"));
            bridged = bridgedTriangles(map.surface, lumen);
        }
        return mesh::writeFlatMap(arguments.file, map, bridged);
    }
    if (product == "mixture") {
        const auto mixture = TRY(source.readVolume<TissueFractions>(product));
        return nifti::writeFractions(arguments.file, mixture);
    }
    if (product == "distance") return exportVolume<float>(source, arguments);
    if (product == "ct" || product == "cleansed")
        return exportVolume<std::int16_t>(source, arguments);
    return exportVolume<std::uint8_t>(source, arguments);  // labels
}

}  // namespace

Command addExport(CLI::App& program) {
    auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command = program.add_subcommand(
        "export",
        "Write a product to a file that other programs read: ct and cleansed (int16, HU), "
        "segmentation, cleansed-lumen and lumen (uint8: 0 outside, 1 air, 2 tagged, 3 bridge over "
        "a collapse, 4 fluid without tagging), mixture (4-D uint8: air, soft tissue, tagged, in "
        "255ths) and distance "
        "(float, mm) as .nii.gz; centerline as .csv (x_mm,y_mm,z_mm,arc_mm,radius_mm,gap in LPS, "
        "rectum to cecum) and branches likewise, each from an arc of 0 on; surface as .ply, .obj, "
        ".off or .stl (LPS, mm); flatmap, the cut surface, as .obj (vt: flat coordinates in "
        "circumferences) or .ply (s, t, and of each vertex the camera on the centerline that sees "
        "it, its index and arc_mm, and of each face whether it encloses a bridge); flat-image, the "
        "whole flattened wall seen from within, the rectum at the bottom, black where the surface "
        "crosses air and hatched along bridges, as .png; quality, how sure the colon is and where "
        "to "
        "look, and edits, what a person said of it, as .json.");
    command->add_option("CASE", arguments->caseName, "The case's name")->required();
    command->add_option("PRODUCT", arguments->product, "What to write")
        ->required()
        ->check(CLI::IsMember(productNames()));
    command->add_option("FILE", arguments->file, "Where to; replaced in one step")->required();
    addStoreOption(*command, arguments->store);
    addFlatImageOptions(*command, arguments->flatImage);
    command->callback([arguments, command] {
        for (const char* option :
             {"--width", "--seam-margin", "--transfer-function", "--threads"}) {
            if (arguments->product != "flat-image" && command->count(option) > 0)
                throw CLI::ValidationError(option, "is an option of flat-image");
        }
        const Endings& endings = formats().at(arguments->product);
        const std::string name = arguments->file.filename().string();
        const bool fits = std::any_of(endings.begin(), endings.end(),
                                      [&](const auto& ending) { return endsIn(name, ending); });
        if (!fits) {
            throw CLI::ValidationError("FILE", arguments->product + " is written as " +
                                                   CLI::detail::join(endings, " or ") +
                                                   ", not as \"" + name + "\"");
        }
    });
    return {command, [arguments] { return runExport(*arguments); }};
}

}  // namespace haustra::cli
