// The command line as scripts meet it: exit codes, files, formats.
#include "core/centerline.h"
#include "core/findings.h"
#include "core/source_series.h"
#include "end_to_end/run_program.h"
#include "mesh/mesh_file.h"
#include "nifti/nifti_file.h"
#include "store/case_store.h"
#include "store/products.h"

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra {
namespace {

namespace fs = std::filesystem;
using tests::lineCount;
using Arguments = std::vector<std::string>;

tests::Outcome haustra(const Arguments& arguments) {
    return tests::runProgram("haustra", arguments);
}

TEST(CommandLine, AnUnknownCommandIsNamed) {
    EXPECT_NE(haustra({"bogus"}).err.find("bogus"), std::string::npos);
}

TEST(CommandLine, WrongUsageEndsWithTwoAndSaysWhy) {
    ::unsetenv("HAUSTRA_STORE");
    for (const Arguments& wrong : std::vector<Arguments>{
             {},
             {"bogus"},
             {"prepare", "--store", "s"},
             {"prepare", "x"},
             {"prepare", "x", "--store", "s", "--until", "never"},
             {"prepare", "x", "--store", "s", "--case", "../up"},
             {"prepare", "x", "--store", "s", "--scan", "prone"},
             {"prepare", "x", "--store", "s", "--case", "p", "--scan", "../up"},
             {"prepare", "x", "--store", "s", "--seed", "1,2"},
             {"prepare", "x", "--store", "s", "--seed", "1,2,nan"},
             {"prepare", "x", "--store", "s", "--threads", "many"},
             {"prepare", "x", "--store", "s", "--surface-error-mm", "nan"},
             {"prepare", "x", "--store", "s", "--surface-error-mm", "0"},
             {"prepare", "x", "--store", "s", "--area-weight", "1.1"},
             {"prepare", "x", "--store", "s", "--area-weight", "nan"},
             {"prepare", "x", "--store", "s", "--lumen", "m.nii", "--seed", "1,2,3"},
             {"prepare", "x", "--store", "s", "--lumen", "m.nii", "--exclude", "1,2,3"},
             {"prepare", "--store", "s", "--lumen", "m.nii", "--until", "import"},
             {"export", "c", "ct", "file.csv", "--store", "s"},
             {"export", "c", "centerline", "file.nii.gz", "--store", "s"},
             {"export", "c", "biopsy", "file.png", "--store", "s", "--findings"},
             {"export", "c", "findings", "f.json", "--store", "s", "--least-probability", "0.3"},
             {"export", "c", "lungs", "file.nii.gz", "--store", "s"},
             {"export", "c", "flatmap", "file.off", "--store", "s"},
             {"render", "c", "--store", "s", "--out", "x.png"},
             {"render", "c", "--store", "s", "--out", "x.png", "--arc-mm", "1", "--size", "0x7"},
             {"render", "c", "--store", "s", "--out", "x.png", "--arc-mm", "1", "--size", "7"},
             {"render", "c", "--store", "s", "--out", "x.png", "--arc-mm", "1", "--view", "top"},
             {"render", "c", "--store", "s", "--out", "x.png", "--arc-mm", "1", "--window", "40"},
             {"render", "c", "--store", "s", "--out", "x.png", "--arc-mm", "1", "--paint",
              "finding"},
             {"cad", "evaluate", "c", "--store", "s", "--truth", "t", "--froc", "x.gif"},
             {"cad", "train", "c", "--store", "s", "--truth", "t", "--model", "m", "--name",
              "two\nlines"},
             {"cad", "train", "c", "--store", "s", "--truth", "t", "--model", "m", "--without",
              "feature:"},
             {"cad", "train", "c", "--store", "s", "--truth", "t", "--model", "m",
              "--false-positives", "nan"},
             {"phantom"},
             {"phantom", "x", "--preset", "weird"},
             {"phantom", "x", "--noise", "nan"},
             {"evaluate", "c", "--store", "s"}}) {
        const auto outcome = haustra(wrong);
        std::string line;
        for (const std::string& argument : wrong)
            line += argument + " ";
        EXPECT_EQ(outcome.exitCode, 2) << line << outcome.err;
        EXPECT_EQ(lineCount(outcome.err), 1u) << line << outcome.err;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    }
}

TEST(CommandLine, HelpIsThereForEverySubcommand) {
    EXPECT_EQ(haustra({"--help"}).exitCode, 0);
    EXPECT_EQ(haustra({"--version"}).exitCode, 0);
    for (const char* command :
         {"phantom", "prepare", "export", "list", "render", "evaluate", "denoise", "flatten"}) {
        const auto outcome = haustra({command, "--help"});
        EXPECT_EQ(outcome.exitCode, 0);
        EXPECT_NE(outcome.out.find("Usage: haustra " + std::string(command)), std::string::npos)
            << outcome.out;
    }
}

TEST(CommandLine, FailuresEndWithOneAndOneLineThatNamesThePlace) {
    const tests::TemporaryFolder folder;
    const std::string store = folder.path() / "store", nothing = folder.path() / "nothing";
    fs::create_directories(folder.path() / "empty");
    fs::create_directories(folder.path() / "store" / "cases");
    for (const Arguments& bad : std::vector<Arguments>{
             {"prepare", nothing, "--store", store, "--seed", "-10,20.5,-300"},
             {"prepare", "--lumen", nothing, "--store", store},
             {"prepare", folder.path() / "empty", "--store", store},
             {"list", "--store", nothing},
             {"export", "nobody", "ct", folder.path() / "x.nii.gz", "--store", store},
             {"render", "nobody", "--arc-mm", "1", "--out", folder.path() / "x.png", "--store",
              store},
             {"evaluate", "nobody", "--truth", nothing, "--store", store}}) {
        const auto outcome = haustra(bad);
        EXPECT_EQ(outcome.exitCode, 1) << bad[0] << outcome.err;
        const std::size_t last = outcome.err.rfind("haustra: ");
        ASSERT_NE(last, std::string::npos) << outcome.err;
        EXPECT_EQ(lineCount(outcome.err.substr(last)), 1u) << outcome.err;
        EXPECT_NE(outcome.err.find(folder.path().string(), last), std::string::npos) << outcome.err;
    }
    EXPECT_TRUE(fs::is_empty(folder.path() / "store" / "cases"));  // no half-made case stays
}

TEST(CommandLine, LearningAndJudgingRefuseBeforeTheWork) {
    const tests::TemporaryFolder folder;
    const std::string store = folder.path() / "store", truth = folder.path();
    fs::create_directories(folder.path() / "store" / "cases");
    std::ofstream(folder.path() / "broken.json") << "{\"haustra_cad_model\": 1}";
    const auto refusal = [&](int exitCode, Arguments arguments) {
        arguments.insert(arguments.end(), {"--store", store});
        const auto outcome = haustra(arguments);
        EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
        return outcome.err;
    };
    const std::string model = folder.path() / "m.json";
    const auto training = [&](Arguments cases) {
        cases.insert(cases.begin(), {"cad", "train"});
        cases.insert(cases.end(), {"--truth", truth, "--model", model});
        return refusal(2, cases);
    };
    EXPECT_NE(training({"a", "b"}).find("at least 5"), std::string::npos);
    EXPECT_NE(training({"a", "b", "c", "d", "a"}).find("given twice"), std::string::npos);
    EXPECT_FALSE(fs::exists(model));
    // A model that detection cannot use, before the scan is looked at.
    const std::string told =
        refusal(1, {"prepare", folder.path(), "--cad-model", folder.path() / "broken.json"});
    EXPECT_NE(told.find("broken.json"), std::string::npos) << told;
    EXPECT_EQ(told.find("import"), std::string::npos) << told;
    EXPECT_TRUE(fs::is_empty(folder.path() / "store" / "cases"));
}

TEST(CommandLine, TheStoreMayComeFromTheEnvironment) {
    const tests::TemporaryFolder folder;
    fs::create_directories(folder.path() / "cases");
    ::setenv("HAUSTRA_STORE", folder.path().c_str(), 1);
    const auto outcome = haustra({"list"});
    ::unsetenv("HAUSTRA_STORE");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(outcome.out.empty());
}

TEST(CommandLine, OutputsThatCannotBeWrittenAreRefusedBeforeTheWork) {
    const tests::TemporaryFolder folder;
    const auto phantom = haustra({"phantom", folder.path() / "p", "--seed", "-1"});
    EXPECT_EQ(phantom.exitCode, 2) << phantom.err;
    const auto picture = haustra({"render", "case", "--store", folder.path(), "--arc-mm", "1",
                                  "--out", folder.path() / "picture.gif"});
    EXPECT_EQ(picture.exitCode, 2) << picture.err;
    const auto table = haustra({"export", "case", "centerline", folder.path() / "no" / "line.csv",
                                "--store", folder.path()});
    EXPECT_EQ(table.exitCode, 1);
    EXPECT_NE(table.err.find("line.csv: there is no folder"), std::string::npos) << table.err;
}

// One prepared case that the tests below look at: CTest prepares it once, each test has its copy.
class PreparedPhantom : public testing::Test {
protected:
    void SetUp() override {
        const fs::path prepared = tests::phantomFolder().string() + "-store";
        ASSERT_TRUE(fs::exists(prepared)) << "run by ctest, which prepares the phantom";
        // The store never writes into a file that it has published, so a link is a copy.
        std::error_code otherDevice;
        fs::copy(prepared, store(),
                 fs::copy_options::recursive | fs::copy_options::create_hard_links, otherDevice);
        if (otherDevice) {
            fs::remove_all(store());
            fs::copy(prepared, store(), fs::copy_options::recursive);
        }
        fs::remove(fs::path(store()) / "cases" / "p" / ".lock");
    }
    std::string series() const { return tests::phantomFolder() / "series"; }
    std::string truth() const { return tests::phantomFolder() / "truth"; }
    std::string mask() const { return tests::phantomFolder() / "truth" / "lumen.nii.gz"; }
    std::string store() const { return folder_.path() / "store"; }
    std::string file(const std::string& name) const { return folder_.path() / name; }
    store::Case opened() const {
        return store::CaseStore::open(store(), false).value().openCase("p").value();
    }

    template <class T>
    void expectExportEqualsProduct(const std::string& product) {
        const std::string exported = file(product + ".nii.gz");
        const auto outcome = haustra({"export", "p", product, exported, "--store", store()});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const auto back = nifti::readNifti<T>(exported);
        ASSERT_TRUE(back) << describe(back.error());
        const auto stored = opened().readVolume<T>(product).value();
        EXPECT_TRUE(sameGrid(back->grid(), stored.grid()));
        EXPECT_TRUE(std::equal(back->voxels().begin(), back->voxels().end(),
                               stored.voxels().begin(), stored.voxels().end()));
    }

    tests::TemporaryFolder folder_;
};

TEST_F(PreparedPhantom, APlaceBeyondTheCenterlineIsRefused) {
    for (const char* arc : {"-1", "nan", "100000"}) {
        const auto outcome = haustra(
            {"render", "p", "--store", store(), "--arc-mm", arc, "--out", file("beyond.png")});
        EXPECT_EQ(outcome.exitCode, 1) << arc;
        EXPECT_NE(outcome.err.find("the centerline runs from 0 to"), std::string::npos)
            << outcome.err;
        EXPECT_FALSE(fs::exists(file("beyond.png")));
        // What is told can be given.
        const std::string before = "from 0 to ";
        const std::size_t last = outcome.err.find(before);
        ASSERT_NE(last, std::string::npos);
        const std::string length =
            std::to_string(std::stod(outcome.err.substr(last + before.size())));
        const auto end = haustra({"render", "p", "--store", store(), "--arc-mm", length, "--size",
                                  "8x8", "--out", file("end.png")});
        EXPECT_EQ(end.exitCode, 0) << end.err;
    }
}

TEST_F(PreparedPhantom, AResultThatCannotBeWrittenIsNamed) {
    const fs::path missing = file("no/report.json");
    const auto report = haustra({"evaluate", "p", "--store", store(), "--truth",
                                 tests::phantomFolder() / "truth", "--report", missing});
    EXPECT_EQ(report.exitCode, 1);
    EXPECT_EQ(report.out, "");  // before the work
    EXPECT_EQ(report.err.find("haustra: " + missing.string() + ": "), 0u) << report.err;

    const fs::path longest =
        file(std::string(248, 'x') + ".csv");  // its temporary name is too long
    const auto table = haustra({"export", "p", "centerline", longest, "--store", store()});
    EXPECT_EQ(table.exitCode, 1);
    EXPECT_EQ(table.err.find("haustra: " + longest.string() + ": "), 0u) << table.err;
    EXPECT_FALSE(fs::exists(longest));
}

TEST_F(PreparedPhantom, ExportedVolumesEqualTheProducts) {
    expectExportEqualsProduct<std::int16_t>("ct");
    expectExportEqualsProduct<std::int16_t>("cleansed");
    expectExportEqualsProduct<std::uint8_t>("segmentation");
    expectExportEqualsProduct<std::uint8_t>("cleansed-lumen");
    expectExportEqualsProduct<std::uint8_t>("lumen");
    expectExportEqualsProduct<float>("distance");
}

TEST_F(PreparedPhantom, TheMixtureIsExportedAsOneImageOfThree) {
    const auto outcome = haustra({"export", "p", "mixture", file("m.nii"), "--store", store()});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto stored = opened().readVolume<TissueFractions>("mixture").value();
    EXPECT_EQ(fs::file_size(file("m.nii")), 352u + 3u * stored.grid().voxelCount());
}

TEST_F(PreparedPhantom, TheSurfaceIsExportedInEachFormat) {
    const TriMesh stored = opened().readMesh().value();
    for (const char* name : {"s.ply", "s.obj", "s.off", "s.stl"}) {
        const auto outcome = haustra({"export", "p", "surface", file(name), "--store", store()});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const auto back = mesh::readMesh(file(name));
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_EQ(back->triangles.size(), stored.triangles.size()) << name;
        EXPECT_EQ(meshTopology(*back).eulerCharacteristic, 2) << name;
    }
    EXPECT_EQ(haustra({"export", "p", "surface", file("s.nii.gz"), "--store", store()}).exitCode,
              2);
}

// What detection says; of whatever case.
std::string findingsText() {
    Findings findings;
    findings.model = {"haustra", "test", "", "nothing"};
    findings.grid = axisAlignedGrid({8, 8, 8}, {1, 1, 1});
    findings.findings = {{{1.234, -5.678, 9.012}, 7.5, 0.75, ""}};
    return findingsJson(findings);
}

// The phantom's colon has no branches, and nobody has edited it or looked for polyps.
void publishWhatIsMissing(store::Case target) {
    const auto key = store::makeKey("test", 1, "", {});
    const Centerline line = target.readCenterline().value();
    ASSERT_TRUE(target.publishCenterline(store::product::branches, key, line));
    ASSERT_TRUE(target.publishText(store::product::edits, key, "{}"));
    ASSERT_TRUE(target.publishText(store::product::findings, key, findingsText()));
}

TEST_F(PreparedPhantom, EachProductIsExportedInEachOfItsFormatsAndInNoOther) {
    publishWhatIsMissing(store::CaseStore::open(store(), false)->createCase("p").value());
    const auto seen = haustra({"coverage", "p", "--store", store(), "--mode", "vc", "--cameras",
                               "10", "--visibility", "rays"});
    ASSERT_EQ(seen.exitCode, 0) << seen.err;
    const auto exported = [&](const std::string& product, const std::string& name) {
        Arguments arguments{"export", "p", product, file(name), "--store", store()};
        if (product == store::product::flatImage)
            arguments.insert(arguments.end(), {"--width", "100"});
        return haustra(arguments);
    };
    std::set<std::string> allEndings{".txt", ".hvol", ".nii.gz.txt", "nii", ""};
    for (const store::Product& product : store::catalogue().products())
        allEndings.insert(product.endings.begin(), product.endings.end());
    const std::string help = haustra({"export", "--help"}).out;
    for (const store::Product& product : store::catalogue().products()) {
        for (const std::string& ending : allEndings) {
            const std::string name = "exported-" + product.name + ending;
            const auto outcome = exported(product.name, name);
            const bool may = std::ranges::find(product.endings, ending) != product.endings.end();
            EXPECT_EQ(outcome.exitCode, may ? 0 : 2) << name << " " << outcome.err;
            EXPECT_EQ(fs::exists(file(name)) && fs::file_size(file(name)) > 0, may) << name;
        }
        EXPECT_NE(help.find("  " + product.name + " "), std::string::npos) << product.name;
    }
    EXPECT_NE(help.find(store::catalogue().exportHelp()), std::string::npos) << help;
    EXPECT_NE(haustra({"prepare", "--help"}).out.find(store::catalogue().stageHelp()),
              std::string::npos);
    EXPECT_NE(haustra({"list", "--help"}).out.find(store::catalogue().keptHelp()),
              std::string::npos);
}

TEST_F(PreparedPhantom, FindingsAreExportedAsAReportOfTheScansSeries) {
    publishWhatIsMissing(store::CaseStore::open(store(), false)->createCase("p").value());
    const auto exported = [&](const std::string& name, const Arguments& more = {}) {
        Arguments arguments{"export", "p", "findings", file(name), "--store", store()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return haustra(arguments);
    };
    ASSERT_EQ(exported("findings.json").exitCode, 0);
    EXPECT_EQ(tests::fileContent(file("findings.json")), findingsText());
    ASSERT_EQ(exported("nameless.dcm").exitCode, 0);
    const auto named = exported("named.dcm", {"--series", series()});
    ASSERT_EQ(named.exitCode, 0) << named.err;
    EXPECT_EQ(tests::fileContent(file("nameless.dcm")).find("HAUSTRA^PHANTOM"), std::string::npos);
    EXPECT_NE(tests::fileContent(file("named.dcm")).find("HAUSTRA^PHANTOM"), std::string::npos);
    EXPECT_EQ(exported("x.json", {"--series", series()}).exitCode, 2);
    const auto other = exported("x.dcm", {"--series", truth()});
    EXPECT_EQ(other.exitCode, 1);
    EXPECT_EQ(lineCount(other.err), 1u) << other.err;

    // Every slice of the series is in the evidence.
    const auto source = sourceSeriesOfJson(
        store::CaseStore::open(store(), false)->openCase("p")->readText("source").value());
    ASSERT_TRUE(source) << describe(source.error());
    const std::string report = tests::fileContent(file("nameless.dcm"));
    EXPECT_FALSE(source->images.empty());
    for (const SourceImage& image : source->images)
        EXPECT_NE(report.find(image.sopInstanceUid), std::string::npos);
    EXPECT_NE(report.find(source->seriesUid), std::string::npos);
}

TEST(CommandLine, AReportNeedsASeriesAndASoundSource) {
    const tests::TemporaryFolder folder;
    const std::string store = folder.path() / "store";
    const auto key = store::makeKey("test", 1, "", {});
    const auto publish = [&](const char* product, const std::string& text) {
        auto target = store::CaseStore::open(store, true)->createCase("c").value();
        ASSERT_TRUE(target.publishText(product, key, text));
    };
    const auto expectRefused = [&](const std::string& why) {
        const std::string file = folder.path() / "report.dcm";
        const auto outcome = haustra({"export", "c", "findings", file, "--store", store});
        EXPECT_EQ(outcome.exitCode, 1);
        EXPECT_NE(outcome.err.find(why), std::string::npos) << outcome.err;
        EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
        EXPECT_FALSE(fs::exists(file));
    };
    publish(store::product::findings, findingsText());
    expectRefused("needs the DICOM series");
    EXPECT_EQ(
        haustra({"export", "c", "findings", folder.path() / "x.json", "--store", store}).exitCode,
        0);
    publish(store::product::source, "{\"study\": \"../1\"}");
    expectRefused("no source series");
    publish(store::product::source, sourceSeriesJson({}));
    expectRefused("needs the DICOM series");
}

TEST_F(PreparedPhantom, TheFlatMapIsExportedWithItsFlatCoordinates) {
    const auto map = store::CaseStore::open(store(), false)->openCase("p")->readFlatMap().value();
    for (const char* name : {"f.obj", "f.ply"}) {
        const auto outcome = haustra({"export", "p", "flatmap", file(name), "--store", store()});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        const auto mesh = mesh::readMesh(file(name));
        ASSERT_TRUE(mesh) << describe(mesh.error());
        EXPECT_EQ(mesh->vertices, map.surface.vertices);
        EXPECT_EQ(mesh->triangles, map.surface.triangles);
    }
    std::istringstream obj(tests::fileContent(file("f.obj")));
    std::string line;
    for (std::size_t v = 0; std::getline(obj, line);) {
        if (!line.starts_with("vt ")) continue;
        double x = -1.0, y = -1.0;
        ASSERT_EQ(std::sscanf(line.c_str(), "vt %lf %lf", &x, &y), 2);
        ASSERT_EQ(glm::dvec2(x, y), map.flat.at(v++));
    }
}

TEST_F(PreparedPhantom, TheExportedCenterlineHasALineForEachSample) {
    ASSERT_EQ(haustra({"export", "p", "centerline", file("c.csv"), "--store", store()}).exitCode,
              0);
    const Centerline stored = opened().readCenterline().value();
    std::istringstream csv(tests::fileContent(file("c.csv")));
    std::string line;
    std::getline(csv, line);
    EXPECT_EQ(line, "x_mm,y_mm,z_mm,arc_mm,radius_mm,gap");
    for (const CenterlinePoint& p : stored.points) {
        ASSERT_TRUE(std::getline(csv, line));
        double x, y, z, arc, radius;
        int gap;
        ASSERT_EQ(
            std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf,%d", &x, &y, &z, &arc, &radius, &gap),
            6);
        EXPECT_LT(glm::distance(glm::dvec3(x, y, z), p.positionMm), 2e-6);
        EXPECT_NEAR(arc, p.arcMm, 2e-6);
        EXPECT_NEAR(radius, p.radiusMm, 2e-6);
        EXPECT_EQ(gap != 0, p.gap);
    }
    EXPECT_FALSE(std::getline(csv, line));
}

TEST_F(PreparedPhantom, TheReportHasTimeAndMemoryOfEachStage) {
    ASSERT_EQ(haustra({"prepare", series(), "--lumen", mask(), "--store", file("fresh"), "--case",
                       "p", "--report", file("report.json")})
                  .exitCode,
              0);
    const auto report = nlohmann::json::parse(tests::fileContent(file("report.json")));
    EXPECT_EQ(report["case"], "p");
    std::vector<std::string> names;
    for (const auto& stage : report["stages"]) {
        names.push_back(stage["stage"]);
        EXPECT_FALSE(stage["reused"].get<bool>());
        EXPECT_GT(stage["wall_seconds"].get<double>(), 0.0);
        EXPECT_GT(stage["peak_memory_mib"].get<double>(), 1.0);
    }
    EXPECT_EQ(names, (std::vector<std::string>{"import", "segmentation", "mixture", "cleansing",
                                               "denoising", "distance", "centerline", "surface",
                                               "flattening", "cad"}));

    ASSERT_EQ(haustra({"prepare", series(), "--lumen", mask(), "--store", store(), "--case", "p",
                       "--report", file("again.json")})
                  .exitCode,
              0);
    const auto again = nlohmann::json::parse(tests::fileContent(file("again.json")));
    for (const auto& stage : again["stages"])
        EXPECT_TRUE(stage["reused"].get<bool>()) << stage;
}

// Two discs, each with a folder of the usual name.
TEST_F(PreparedPhantom, DiscsWithFoldersOfOneNameAreTwoCases) {
    fs::create_directories(file("disc-1"));
    fs::create_directories(file("disc-2/DICOM"));
    fs::create_directory_symlink(series(), file("disc-1/DICOM"));
    ASSERT_EQ(
        haustra({"phantom", file("prone"), "--size", "small", "--position", "prone"}).exitCode, 0);
    fs::rename(file("prone/series"), file("disc-2/DICOM/1"));
    for (const char* disc : {"disc-1/DICOM", "disc-2/DICOM"}) {
        const auto outcome =
            haustra({"prepare", file(disc), "--store", file("two"), "--until", "import"});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(outcome.out.find("DICOM"), std::string::npos) << outcome.out;
    }
    const auto names = store::CaseStore::open(file("two"), false)->cases().value();
    ASSERT_EQ(names.size(), 2u);
    // One patient on the back and on the belly: of one study, and listed so.
    EXPECT_EQ(names[0].substr(0, names[0].find('.')), names[1].substr(0, names[1].find('.')));
    const std::string list = haustra({"list", "--store", file("two")}).out;
    EXPECT_NE(list.find("prone"), std::string::npos) << list;
    EXPECT_NE(list.find("supine"), std::string::npos) << list;

    const auto refused = haustra({"prepare", file("disc-2/DICOM"), "--store", file("two"), "--case",
                                  names[0], "--until", "import"});
    const auto other = haustra({"prepare", file("disc-2/DICOM"), "--store", file("two"), "--case",
                                names[1], "--until", "import"});
    EXPECT_EQ(refused.exitCode + other.exitCode, 1) << "its own name and no other takes a series";
    EXPECT_NE((refused.err + other.err).find("another series of the same study"),
              std::string::npos);
}

TEST_F(PreparedPhantom, TheListNamesCasesProductsAndSizes) {
    const auto outcome = haustra({"list", "--store", store()});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(lineCount(outcome.out), 15u) << outcome.out;
    for (const char* word :
         {"p  study ", "  supine\n", "colon found with confidence", "ct", "source", "segmentation",
          "quality", "mixture", "cleansed", "cleansed-lumen", "lumen", "distance", "centerline",
          "surface", "flatmap", "findings", " MB"}) {
        EXPECT_NE(outcome.out.find(word), std::string::npos) << word;
    }
}

TEST_F(PreparedPhantom, TheListSaysWhatIsDamaged) {
    const fs::path folder = fs::path(store()) / "cases" / "p";
    const std::string ct = opened().find("ct")->file;
    // A link to what other tests read, too.
    fs::copy(folder / ct, folder / "copy");
    fs::rename(folder / "copy", folder / ct);
    fs::resize_file(folder / ct, fs::file_size(folder / ct) / 2);
    const auto outcome = haustra({"list", "--store", store()});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_NE(outcome.out.find(ct + "  the product is damaged"), std::string::npos) << outcome.out;
    const std::string surface = opened().find("surface")->file;
    EXPECT_NE(outcome.out.find(surface + "\n"), std::string::npos) << outcome.out;
}

TEST_F(PreparedPhantom, AListThatIsLostOnTheWayIsAFailure) {
    const auto runInShell = [&](const std::string& to) {
        const std::string command = tests::programPath("haustra").string() + " list --store " +
                                    store() + " > " + to + " 2> /dev/null";
        return WEXITSTATUS(std::system(command.c_str()));
    };
    EXPECT_EQ(runInShell("/dev/null"), 0);
    EXPECT_EQ(runInShell("/dev/full"), 1);
}

TEST_F(PreparedPhantom, TheTruthScoresNearlyAsTheTruth) {
    const auto outcome = haustra(
        {"evaluate", "p", "--truth", truth(), "--store", store(), "--report", file("e.json")});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto scores = nlohmann::json::parse(tests::fileContent(file("e.json")));
    // Prepared from the true mask: what differs is what cleansing and the cutting of handles move.
    EXPECT_GT(scores["dice"].get<double>(), 0.995);
    EXPECT_LT(scores["over_ml"].get<double>() + scores["missed_ml"].get<double>(), 15.0);
    EXPECT_EQ(scores["false_ml"], 0.0);
    EXPECT_LT(scores["centerline_mean_error_mm"].get<double>(), 10.0);
}

TEST_F(PreparedPhantom, APictureIsAPngOfItsSizeAndTheSameEachTime) {
    const Arguments draw{"render", "p",       "--arc-mm", "300",  "--size",
                         "96x64",  "--store", store(),    "--out"};
    const auto drawn = [&](const std::string& name, const Arguments& more) {
        Arguments all = draw;
        all.push_back(file(name));
        all.insert(all.end(), more.begin(), more.end());
        const auto outcome = haustra(all);
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        return tests::fileContent(file(name));
    };
    const std::string picture = drawn("a.png", {});
    ASSERT_GT(picture.size(), 1000u);
    EXPECT_EQ(picture.substr(1, 3), "PNG");
    EXPECT_EQ(picture.substr(16, 8), std::string("\0\0\0\x60\0\0\0\x40", 8));
    EXPECT_EQ(drawn("b.png", {}), picture);
    EXPECT_NE(drawn("c.png", {"--direction", "retrograde"}), picture);
    for (const char* plane : {"axial", "coronal", "sagittal"})
        EXPECT_GT(drawn("s.png", {"--view", plane}).size(), 1000u);
}

// From the DICOM files on, with the lumen found in the scan.
TEST_F(PreparedPhantom, ProductsDoNotDependOnTheNumberOfThreads) {
    std::map<std::string, std::string> first;
    for (const char* threads : {"1", "3"}) {
        const auto outcome = haustra({"prepare", series(), "--store", store(), "--case",
                                      std::string("threads-") + threads, "--threads", threads});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        std::map<std::string, std::string> files;
        const fs::path made = fs::path(store()) / "cases" / (std::string("threads-") + threads);
        for (const auto& file : fs::directory_iterator(made)) {
            files[file.path().filename().string()] = tests::fileContent(file.path());
        }
        EXPECT_EQ(files.size(), 15u);  // thirteen products, the index, the lock
        if (first.empty()) first = files;
        EXPECT_TRUE(files == first) << threads;
    }
}

TEST_F(PreparedPhantom, ACaseThatIsBeingWrittenIsRefused) {
    const auto held = store::CaseStore::open(store(), false).value().createCase("p");
    ASSERT_TRUE(held);
    const auto outcome = haustra({"prepare", series(), "--store", store(), "--case", "p"});
    EXPECT_EQ(outcome.exitCode, 1);
    EXPECT_NE(outcome.err.find("being written"), std::string::npos) << outcome.err;
}

TEST_F(PreparedPhantom, APhantomDoesNotOverwriteAFolderUnlessTold) {
    fs::create_directories(file("full"));
    { std::ofstream(file("full/mine.txt")) << "keep"; }
    const Arguments make{"phantom", file("full"), "--size", "small", "--preset", "easy"};
    const auto refused = haustra(make);
    EXPECT_EQ(refused.exitCode, 1);
    EXPECT_NE(refused.err.find("not empty"), std::string::npos);
    EXPECT_FALSE(fs::exists(file("full/series")));

    Arguments forced = make;
    forced.push_back("--force");
    EXPECT_EQ(haustra(forced).exitCode, 0);
    EXPECT_EQ(tests::fileContent(file("full/mine.txt")), "keep");
    for (const char* name : {"lumen.nii.gz", "sites.nii.gz", "untagged.nii.gz", "centerline.csv",
                             "polyps.json", "structure.json", "phantom.json"}) {
        EXPECT_GT(fs::file_size(fs::path(file("full/truth")) / name), 0u) << name;
    }
    for (const auto& left : fs::directory_iterator(folder_.path())) {
        EXPECT_NE(left.path().filename().string().rfind(".tmp-", 0), 0u) << left.path();
    }
}

}  // namespace
}  // namespace haustra
