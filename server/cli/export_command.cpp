// haustra export: a product in a format that other programs read.
#include "cli/arguments.h"
#include "cli/biopsy_export.h"
#include "cli/commands.h"
#include "cli/flat_image_export.h"
#include "cli/text_files.h"
#include "core/bridges.h"
#include "core/durable_file.h"
#include "core/findings.h"
#include "core/source_series.h"
#include "coverage/coverage_report.h"
#include "coverage/fine_wall.h"
#include "dicom/colon_cad_report.h"
#include "mesh/flat_map_file.h"
#include "mesh/mesh_file.h"
#include "nifti/nifti_file.h"
#include "pictures/picture_file.h"
#include "store/case_store.h"
#include "store/products.h"

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

namespace product = store::product;

struct ExportArguments {
    fs::path store, file;
    std::string caseName, product;
    fs::path series;
    FlatImageOptions flatImage;
    BiopsyImageOptions biopsy;
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

Result<void> exportFlatMap(const store::Case& source, const ExportArguments& arguments) {
    const auto map = TRY(source.readFlatMap(arguments.product));
    std::vector<std::uint8_t> bridged;
    if (source.find(product::lumen)) {
        const auto lumen = TRY(source.readVolume<std::uint8_t>(product::lumen));
        bridged = bridgedTriangles(map.surface, lumen);
    }
    return mesh::writeFlatMap(arguments.file, map, bridged);
}

Result<void> exportReport(const store::Case& source, const ExportArguments& arguments) {
    if (!source.find(product::source)) {
        return fail(ErrorKind::noResult,
                    "a DICOM report needs the DICOM series that the scan came from: the case has "
                    "none, or was prepared before Haustra kept it (run prepare on the series "
                    "again); findings are exported as .json",
                    "case " + source.name());
    }
    const auto before = TRY(source.scan());
    TRY(source.verify(product::source));
    const std::string place = "case " + source.name() + ", ";
    const auto findings = TRY(source.readText(product::findings).and_then([&](const auto& text) {
        return findingsOfJson(text, place + product::findings);
    }));
    const auto series = TRY(source.readText(product::source).and_then([&](const auto& text) {
        return sourceSeriesOfJson(text, place + product::source);
    }));
    // Two products were read one after the other, and both must be of one scan.
    const auto after = TRY(source.scan());
    const auto keyOf = [](const auto& scan) { return scan ? scan->key.hex : std::string(); };
    if (keyOf(before) != keyOf(after))
        return fail(ErrorKind::io, "the case became one of another scan while it was exported",
                    "case " + source.name());
    return dicom::writeColonCadReport(arguments.file, findings, series,
                                      {.series = arguments.series});
}

Result<void> exportCoverageWall(const store::Case& source, const ExportArguments& arguments) {
    const std::string text = TRY(source.readText(product::coverage));
    const auto fine = coverage::fineWall(TRY(source.readMesh()));
    const auto flags = TRY(coverage::triangleFlagsOf(text, fine.mesh.triangles.size()));
    return mesh::writePly(arguments.file, fine.mesh, "visibility", flags);
}

bool isReport(const ExportArguments& arguments) {
    return arguments.product == product::findings &&
           endsIn(arguments.file.filename().string(), ".dcm");
}

// One kind of content is written in one way, whichever product it is of.
Result<void> exportContent(const store::Case& source, store::Content content,
                           const ExportArguments& arguments) {
    switch (content) {
        case store::Content::int16Volume:
            return exportVolume<std::int16_t>(source, arguments);
        case store::Content::uint8Volume:
            return exportVolume<std::uint8_t>(source, arguments);
        case store::Content::floatVolume:
            return exportVolume<float>(source, arguments);
        case store::Content::fractionsVolume: {
            const auto fractions = TRY(source.readVolume<TissueFractions>(arguments.product));
            return nifti::writeFractions(arguments.file, fractions);
        }
        case store::Content::centerline: {
            const auto centerline = TRY(source.readCenterline(arguments.product));
            return writeDurably(arguments.file, centerlineCsv(centerline));
        }
        case store::Content::mesh: {
            const auto mesh = TRY(source.readMesh(arguments.product));
            return mesh::writeMesh(arguments.file, mesh);
        }
        case store::Content::flatMap:
            return exportFlatMap(source, arguments);
        case store::Content::text: {
            const auto text = TRY(source.readText(arguments.product));
            return writeDurably(arguments.file, text);
        }
    }
    return fail(ErrorKind::unsupported, "there is no file format for this product",
                arguments.product);
}

Result<void> runExport(const ExportArguments& arguments) {
    TRY(checkOutputFile(arguments.file));
    const auto source =
        TRY(store::CaseStore::open(arguments.store, false).and_then([&](const auto& s) {
            return s.openCase(arguments.caseName);
        }));
    if (arguments.product == product::flatImage)
        return exportFlatImage(source, arguments.file, arguments.flatImage);
    if (arguments.product == product::biopsy) {
        BiopsyImageOptions options = arguments.biopsy;
        options.threads = arguments.flatImage.threads;
        return exportBiopsyImage(source, arguments.file, options);
    }
    // What leaves the store for other programs has been read whole and found sound.
    TRY(source.verify(arguments.product));
    if (isReport(arguments)) return exportReport(source, arguments);
    if (arguments.product == product::coverage &&
        endsIn(arguments.file.filename().string(), ".ply"))
        return exportCoverageWall(source, arguments);
    return exportContent(source, store::catalogue().find(arguments.product)->content.value(),
                         arguments);
}

}  // namespace

Command addExport(CLI::App& program) {
    auto arguments = std::make_shared<ExportArguments>();
    CLI::App* command =
        program.add_subcommand("export", "Write a product to a file that other programs read.");
    command->footer(store::catalogue().exportHelp());
    command->add_option("CASE", arguments->caseName, "The case's name")->required();
    command->add_option("PRODUCT", arguments->product, "What to write")
        ->required()
        ->check(CLI::IsMember(store::catalogue().exported()));
    command->add_option("FILE", arguments->file, "Where to; replaced in one step")->required();
    command->add_option("--series", arguments->series,
                        "Of findings as .dcm: the scan's own DICOM series, whose patient and "
                        "study the report names; else it names no patient");
    addStoreOption(*command, arguments->store);
    addFlatImageOptions(*command, arguments->flatImage);
    addBiopsyImageOptions(*command, arguments->biopsy);
    command->callback([arguments, command] {
        const auto belongs = [&](const char* option, const std::set<std::string>& products) {
            if (products.contains(arguments->product) || command->count(option) == 0) return;
            throw CLI::ValidationError(
                option,
                std::string("is an option of ") +
                    CLI::detail::join(std::vector<std::string>(products.begin(), products.end()),
                                      " and "));
        };
        for (const char* option : {"--width", "--seam-margin", "--caption", "--transfer-function"})
            belongs(option, {product::flatImage});
        for (const char* option : {"--length", "--around", "--finer", "--fixed-transfer"})
            belongs(option, {product::biopsy});
        for (const char* option : {"--findings", "--least-probability"})
            belongs(option, {product::flatImage});
        belongs("--threads", {product::biopsy, product::flatImage});
        if (!isReport(*arguments) && command->count("--series") > 0)
            throw CLI::ValidationError("--series", "is an option of findings as .dcm");
        const auto& endings = store::catalogue().find(arguments->product)->endings;
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
