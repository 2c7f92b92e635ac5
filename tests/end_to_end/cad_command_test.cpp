// haustra cad: a model is learnt from cases and judged by others, as somebody does who has truths.
#include "ball_colon.h"
#include "cad/model.h"
#include "end_to_end/run_program.h"
#include "nifti/nifti_file.h"
#include "pipeline/product_attributes.h"
#include "store/case_store.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra::tests {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using nlohmann::json;

Outcome haustra(const Arguments& arguments) {
    return runProgram("haustra", arguments);
}

void writeText(const fs::path& file, const std::string& text) {
    fs::create_directories(file.parent_path());
    std::ofstream(file) << text;
}

json placeJson(glm::dvec3 p) {
    return {p.x, p.y, p.z};
}

// Balls of gas, each with bumps of 8 mm, which are polyps, and as many of 4 mm, which are stool:
// what is large is a polyp.
class CadCommand : public testing::Test {
protected:
    static constexpr int bumpsOfAKind = 3;
    static constexpr double polypRadiusMm = 4.0, stoolRadiusMm = 2.0;

    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        for (int n = 0; n < 8; ++n)
            makeCase(n, name(n));
    }
    static void TearDownTestSuite() { folder_.reset(); }

    static std::string store() { return folder_->path() / "store"; }
    static std::string truth() { return folder_->path() / "truth"; }
    static std::string name(int n) { return "ball-" + std::to_string(n); }

    static Arguments training() {
        Arguments arguments{"cad", "train"};
        for (int n = 0; n < 6; ++n)
            arguments.push_back(name(n));
        arguments.insert(arguments.end(), {"--store", store(), "--truth", truth()});
        return arguments;
    }
    static Arguments judging(const Arguments& cases) {
        Arguments arguments{"cad", "evaluate", "--store", store(), "--truth", truth()};
        arguments.insert(arguments.end(), cases.begin(), cases.end());
        return arguments;
    }
    static Arguments with(Arguments arguments, const Arguments& more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        return arguments;
    }

    // A case that is like number's, of the scan that is told.
    static void makeCase(int number, const std::string& name,
                         const std::optional<store::ScanIdentity>& scan = std::nullopt) {
        // Places all around, far enough from each other, turned otherwise in each case.
        std::mt19937 random{unsigned(number)};
        const double turn = double(random() % 1000) / 1000.0;
        std::vector<Bump> onIt;
        json growths = json::array();
        for (int n = 0; n < 2 * bumpsOfAKind; ++n) {
            const double z = 0.7 - 1.4 * (n + 0.5) / (2 * bumpsOfAKind),
                         around = 2.0 * M_PI * (turn + n * 0.381966);
            const glm::dvec3 way(std::sqrt(1.0 - z * z) * std::cos(around),
                                 std::sqrt(1.0 - z * z) * std::sin(around), z);
            const bool polyp = n % 2 == 0;
            const double radius =
                (polyp ? polypRadiusMm : stoolRadiusMm) + 0.2 * double(random() % 5) / 5.0;
            onIt.push_back({(lumenMm - 0.3 * radius) * way, radius});
            growths.push_back({{"kind", polyp ? "sessile" : "untagged_stool"},
                               {"neoplastic", polyp},
                               {"position_mm", placeJson(onIt.back().centerMm)},
                               {"wall_mm", placeJson(lumenMm * way)},
                               {"diameter_mm", 2.0 * radius}});
        }
        const BallColon ball(glm::dmat3(1.0), glm::ivec3(0), 0.0, onIt);
        auto made = store::CaseStore::open(store(), true).value().createCase(name).value();
        if (scan) {
            ASSERT_TRUE(made.bind(*scan));
        }
        const auto key = [&](const char* product) {
            return store::makeKey(product, number, "", {});
        };
        store::Attributes tissue;
        pipeline::setTissueModel(tissue, ball.tissue);
        ASSERT_TRUE(made.publishVolume("ct", key("ct"), ball.hu));
        ASSERT_TRUE(made.publishVolume("segmentation", key("segmentation"), ball.lumen, tissue));
        ASSERT_TRUE(made.publishVolume("lumen", key("lumen"), ball.lumen));
        ASSERT_TRUE(made.publishCenterline("centerline", key("centerline"), ball.centerline));
        ASSERT_TRUE(made.publishMesh("surface", key("surface"), ball.surface));
        writeText(fs::path(truth()) / name / "truth" / "growths.json",
                  json{{"growths", growths}}.dump());
    }

private:
    static inline std::unique_ptr<TemporaryFolder> folder_;
};

// Else a model would be learnt from other cases than were named, without a word.
TEST_F(CadCommand, AStoreThatIsGivenGoesBeforeTheEnvironments) {
    const std::string nowhere = store() + "-nowhere", model = truth() + "-model.json";
    setenv("HAUSTRA_STORE", store().c_str(), 1);
    for (const char* command : {"train", "calibrate", "evaluate"}) {
        Arguments arguments{"cad", command, "--store", nowhere, "--truth", truth()};
        if (command != std::string("evaluate"))
            arguments.insert(arguments.end(), {"--model", model});
        for (int n = 0; n < 6; ++n)
            arguments.push_back(name(n));
        const Outcome outcome = haustra(arguments);
        EXPECT_NE(outcome.exitCode, 0) << command;
        EXPECT_NE(outcome.err.find(nowhere), std::string::npos) << command << ": " << outcome.err;
        EXPECT_FALSE(fs::exists(model));
    }
    unsetenv("HAUSTRA_STORE");
}

TEST_F(CadCommand, LearnsWhatAPolypIsAndFindsThoseOfOtherCases) {
    const TemporaryFolder out;
    const std::string model = out.path() / "model.json", kept = out.path() / "kept";
    const Arguments learn = with(training(), {"--candidates", kept, "--name", "balls"});
    const auto learnt = haustra(with(learn, {"--model", model}));
    ASSERT_EQ(learnt.exitCode, 0) << learnt.err;
    EXPECT_NE(learnt.err.find("3,046"), std::string::npos) << "no figure without the field's";
    const auto read = cad::modelOfText(fileContent(model));
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(read->name, "balls");
    EXPECT_EQ(read->trainingScans.size(), 6u);

    const std::string report = out.path() / "report.json", curve = out.path() / "curve.csv";
    const auto judged = haustra(
        with(judging({name(6), name(7)}), {"--model", model, "--report", report, "--froc", curve}));
    ASSERT_EQ(judged.exitCode, 0) << judged.err;
    EXPECT_NE(judged.out.find("3,046"), std::string::npos);
    const json figures = json::parse(fileContent(report)), all = figures.at("all");
    EXPECT_TRUE(figures.at("missed").empty());
    EXPECT_TRUE(figures.at("false_findings").empty());
    EXPECT_EQ(all.at("from_6_mm").at("of"), 2 * bumpsOfAKind);
    EXPECT_EQ(all.at("from_6_mm").at("hit"), 2 * bumpsOfAKind);
    EXPECT_EQ(all.at("false_positives_per_scan"), 0.0);
    EXPECT_GE(all.at("before_reduction_per_scan"), double(bumpsOfAKind)) << "stool is candidates";
    const std::string table = fileContent(curve);
    EXPECT_EQ(table.front(), '#');
    EXPECT_NE(table.find("\nfalse_positives_per_scan,"), std::string::npos);

    // What it has learnt from it is not judged by.
    const auto same = haustra(with(judging({name(0)}), {"--model", model}));
    EXPECT_EQ(same.exitCode, 1);
    EXPECT_NE(same.err.find(name(0)), std::string::npos);

    // From kept candidates the same is learnt; not from those of another truth.
    const std::string again = out.path() / "again.json";
    ASSERT_EQ(haustra(with(learn, {"--model", again})).exitCode, 0);
    EXPECT_TRUE(fileContent(again) == fileContent(model));
    const auto files = [&] {
        return std::distance(fs::directory_iterator(kept), fs::directory_iterator());
    };
    const auto before = files();
    const fs::path own = fs::path(truth()) / name(0) / "truth" / "growths.json";
    const std::string text = fileContent(own);
    json fewer = json::parse(text);
    fewer.at("growths").erase(0);
    writeText(own, fewer.dump());
    const auto other = haustra(with(learn, {"--model", again}));
    writeText(own, text);
    EXPECT_EQ(other.exitCode, 0) << other.err;
    EXPECT_GT(files(), before);
}

TEST_F(CadCommand, TextureThatIsTakenLeavesKeptCandidatesValid) {
    const TemporaryFolder out;
    const std::string first = out.path() / "first.json", second = out.path() / "second.json",
                      kept = out.path() / "kept";
    ASSERT_EQ(haustra(with(training(), {"--candidates", kept, "--model", first})).exitCode, 0);
    const auto files = [&] {
        return std::distance(fs::directory_iterator(kept), fs::directory_iterator());
    };
    const auto before = files();
    // One case less, one more: only that one is looked at.
    Arguments others{"cad", "train"};
    for (int n = 1; n < 7; ++n)
        others.push_back(name(n));
    const auto learnt =
        haustra(with(others, {"--store", store(), "--truth", truth(), "--candidates", kept,
                              "--texture", first, "--model", second}));
    ASSERT_EQ(learnt.exitCode, 0) << learnt.err;
    EXPECT_EQ(files(), before + 1);
    const auto from = cad::modelOfText(fileContent(first)),
               read = cad::modelOfText(fileContent(second));
    ASSERT_TRUE(from && read);
    EXPECT_EQ(cad::textureText(read->texture), cad::textureText(from->texture));
    EXPECT_EQ(read->textureFrom, from->name);
    EXPECT_EQ(from->textureFrom, "");
    // The case that texture alone was learnt from has been seen, too.
    EXPECT_EQ(read->trainingScans.size(), 7u);
    EXPECT_EQ(haustra(with(judging({name(0)}), {"--model", second})).exitCode, 1);
    EXPECT_EQ(haustra(with(judging({name(7)}), {"--model", second})).exitCode, 0);
    const std::string other = out.path() / "other.json";
    const auto refused = [&](const Arguments& more, int exitCode) {
        const auto outcome = haustra(with(training(), with({"--model", other}, more)));
        EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
        EXPECT_FALSE(fs::exists(other));
        return outcome.err;
    };
    for (const char* part : {"pca", "automatic-transfer", "cleansing"})
        EXPECT_NE(refused({"--texture", first, "--without", part}, 2).find(part),
                  std::string::npos);
    EXPECT_NE(refused({"--texture", out.path() / "none.json"}, 2).find("none.json"),
              std::string::npos);
    const std::string broken = out.path() / "broken.json";
    writeText(broken, fileContent(first).substr(0, 100));
    EXPECT_NE(refused({"--texture", broken}, 1).find(broken), std::string::npos);
    const auto shipped = cad::modelOfText(cad::builtInModelText());
    ASSERT_EQ(haustra(with(training(), {"--texture", "built-in", "--model", other})).exitCode, 0);
    EXPECT_EQ(cad::textureText(cad::modelOfText(fileContent(other))->texture),
              cad::textureText(shipped->texture));
}

TEST_F(CadCommand, AModelIsCalibratedOnCasesThatItHasNotSeen) {
    const TemporaryFolder out;
    const std::string model = out.path() / "model.json", other = out.path() / "other.json";
    ASSERT_EQ(haustra(with(training(), {"--name", "balls", "--model", model})).exitCode, 0);
    const auto calibrate = [&](const Arguments& cases, const Arguments& more,
                               std::string from = {}) {
        if (from.empty()) from = model;
        return haustra(with(with({"cad", "calibrate", "--store", store(), "--truth", truth(),
                                  "--from", from, "--model", other},
                                 cases),
                            more));
    };
    const auto seen = calibrate({name(0)}, {});
    EXPECT_EQ(seen.exitCode, 1);
    EXPECT_NE(seen.err.find(name(0)), std::string::npos) << seen.err;
    EXPECT_EQ(calibrate({name(6)}, {"--without", "past"}).exitCode, 2);
    EXPECT_FALSE(fs::exists(other));
    EXPECT_EQ(calibrate({name(6)}, {}, out.path() / "none.json").exitCode, 2);
    const std::string broken = out.path() / "broken.json";
    writeText(broken, fileContent(model).substr(0, 100));
    const auto unread = calibrate({name(6)}, {}, broken);
    EXPECT_EQ(unread.exitCode, 1);
    EXPECT_NE(unread.err.find(broken), std::string::npos) << unread.err;
    // A case without polyps.
    makeCase(7, "bare");
    const fs::path truths = fs::path(truth()) / "bare" / "truth" / "growths.json";
    writeText(truths, R"({"growths": []})");
    const auto bare = calibrate({"bare"}, {});
    EXPECT_EQ(bare.exitCode, 1);
    EXPECT_NE(bare.err.find("no polyp"), std::string::npos) << bare.err;
    EXPECT_FALSE(fs::exists(other));
    const auto made = calibrate({name(6)}, {"--false-positives", "1"});
    ASSERT_EQ(made.exitCode, 0) << made.err;
    EXPECT_NE(made.err.find("3,046"), std::string::npos) << "no figure without the field's";
    const auto was = cad::modelOfText(fileContent(model)),
               is = cad::modelOfText(fileContent(other));
    ASSERT_TRUE(was && is);
    EXPECT_EQ(is->name, "balls-calibrated");
    EXPECT_EQ(is->trainingScans.size(), was->trainingScans.size() + 1);
    EXPECT_NE(is->trainingSha256, was->trainingSha256);
    EXPECT_NE(is->trainedOn.find("calibrated on 1 other case"), std::string::npos);
    EXPECT_TRUE(is->placeA != was->placeA && is->placeB != was->placeB);
    // But for that it is the same.
    cad::CadModel back = *is;
    back.name = was->name, back.trainingSha256 = was->trainingSha256;
    back.trainingScans = was->trainingScans, back.operatingPoint = was->operatingPoint;
    back.trainedOn = was->trainedOn, back.placeA = was->placeA, back.placeB = was->placeB;
    EXPECT_EQ(cad::modelText(back), cad::modelText(*was));
    EXPECT_EQ(haustra(with(judging({name(6)}), {"--model", other})).exitCode, 1);
    EXPECT_EQ(haustra(with(judging({name(7)}), {"--model", other})).exitCode, 0);
    // Fewer false findings ask for a higher operating point; a description is taken as it is.
    ASSERT_EQ(
        calibrate({name(6)}, {"--false-positives", "0.1", "--description", "balls alone"}).exitCode,
        0);
    const auto strict = cad::modelOfText(fileContent(other));
    EXPECT_GE(strict->operatingPoint, is->operatingPoint);
    EXPECT_EQ(strict->trainedOn, "balls alone");
    // What one generator found can be left out: candidates that were kept are numbered anew.
    const std::string kept = out.path() / "kept";
    for (int round = 0; round < 2; ++round)
        EXPECT_EQ(haustra(with(judging({name(7)}),
                               {"--model", model, "--candidates", kept, "--without", "texture"}))
                      .exitCode,
                  0);
}

TEST_F(CadCommand, AScanOrStudyThatWasLearntFromIsKnownUnderAnyName) {
    const auto key = [](const char* of) { return store::makeKey("scan", 1, of, {}); };
    makeCase(0, "visit-supine", {{key("supine"), "2.25.7", "2.25.71"}});
    makeCase(1, "visit-prone", {{key("prone"), "2.25.7", "2.25.72"}});
    makeCase(7, "visit-copy", {{key("supine"), "2.25.7", "2.25.71"}});
    makeCase(6, "other-supine", {{key("other"), "2.25.8", "2.25.81"}});
    const TemporaryFolder out;
    const std::string model = out.path() / "model.json";
    const auto learn = [&](const Arguments& cases) {
        return haustra(with(with({"cad", "train"}, cases),
                            {"--store", store(), "--truth", truth(), "--model", model}));
    };
    const auto copied = learn({name(2), name(3), name(4), name(5), "visit-supine", "visit-copy"});
    EXPECT_EQ(copied.exitCode, 1);
    EXPECT_NE(copied.err.find("visit-copy"), std::string::npos) << copied.err;
    // A study is left out as one: two scans of it are one of the five parts.
    const auto few = learn({name(3), name(4), name(5), "visit-supine", "visit-prone"});
    EXPECT_EQ(few.exitCode, 1);
    EXPECT_NE(few.err.find("the 5 cases are of 4 studies"), std::string::npos) << few.err;
    EXPECT_FALSE(fs::exists(model));
    const auto learnt = learn({name(2), name(3), name(4), name(5), "visit-supine"});
    ASSERT_EQ(learnt.exitCode, 0) << learnt.err;
    for (const char* seen : {"visit-supine", "visit-prone", "visit-copy"}) {
        const auto judged = haustra(with(judging({seen}), {"--model", model}));
        EXPECT_EQ(judged.exitCode, 1) << seen;
        EXPECT_NE(judged.err.find(seen), std::string::npos) << judged.err;
    }
    EXPECT_EQ(haustra(with(judging({"other-supine"}), {"--model", model})).exitCode, 0);
}

// As of another scan, or RAS for LPS: else a detector would seem to find nothing.
TEST_F(CadCommand, TruthThatLiesElsewhereIsToldOf) {
    const TemporaryFolder elsewhere;
    json growths = json::parse(fileContent(fs::path(truth()) / name(6) / "truth" / "growths.json"));
    for (json& growth : growths["growths"]) {
        for (const char* place : {"position_mm", "wall_mm"})
            growth[place] = placeJson(glm::dvec3(28.0));  // a corner of the scan
    }
    writeText(elsewhere.path() / name(6) / "growths.json", growths.dump());
    const std::string word = name(6) + ": warning: not one of its truth's 3 polyps";
    const auto right = haustra(judging({name(6)}));
    EXPECT_EQ(right.exitCode, 0) << right.err;
    EXPECT_EQ(right.err.find(word), std::string::npos) << right.err;
    const auto wrong =
        haustra({"cad", "evaluate", "--store", store(), "--truth", elsewhere.path(), name(6)});
    EXPECT_EQ(wrong.exitCode, 0) << wrong.err;
    EXPECT_NE(wrong.err.find(word), std::string::npos) << wrong.err;
}

TEST_F(CadCommand, WhatTellsNothingApartIsNoModel) {
    const TemporaryFolder out;
    const std::string model = out.path() / "model.json";
    // Without both measures of height nothing is known to rise.
    const auto learnt = haustra(with(training(), {"--without", "feature:height", "--without",
                                                  "feature:lift", "--model", model}));
    EXPECT_EQ(learnt.exitCode, 1);
    EXPECT_NE(learnt.err.find("nothing was learnt"), std::string::npos) << learnt.err;
    EXPECT_FALSE(fs::exists(model));
}

// A model whose text nobody could read again.
TEST_F(CadCommand, AModelsNameIsText) {
    const TemporaryFolder out;
    const auto named = haustra(with(
        training(), {"--model", out.path() / "model.json", "--name", std::string(100, '\xe9')}));
    EXPECT_EQ(named.exitCode, 2);
    EXPECT_NE(named.err.find("UTF-8"), std::string::npos) << named.err;
}

TEST_F(CadCommand, PolypsOfOneStudyAloneTeachNothing) {
    const TemporaryFolder out;
    for (int n = 0; n < 6; ++n)
        writeText(out.path() / name(n) / "growths.json",
                  n == 0 ? fileContent(fs::path(truth()) / name(n) / "truth" / "growths.json")
                         : R"({"growths": []})");
    Arguments arguments = training();
    arguments.back() = out.path();
    const auto learnt = haustra(with(arguments, {"--model", out.path() / "model.json"}));
    EXPECT_EQ(learnt.exitCode, 1);
    EXPECT_NE(learnt.err.find("of the same few studies"), std::string::npos) << learnt.err;
    EXPECT_FALSE(fs::exists(out.path() / "model.json"));
}

TEST(ThinScan, IsRefusedInOneSentenceAndKeepsWhatWasMade) {
    const TemporaryFolder folder;
    const Grid grid = axisAlignedGrid({80, 40, 3}, glm::dvec3(1.0), {-40, -20, 0});
    Volume<std::int16_t> hu(grid);
    Volume<std::uint8_t> mask(grid);
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        const bool bump = glm::distance(glm::dvec2(v), glm::dvec2(40, 15)) < 4.0;
        const bool inside = v.x >= 8 && v.x < 72 && std::abs(v.y - 20) <= 5 && v.z == 1 && !bump;
        mask.writable()[n] = inside;
        hu.writable()[n] = inside ? -1000 : std::int16_t(30 + n % 20);
    }
    ASSERT_TRUE(nifti::writeNifti(folder.path() / "scan.nii", hu));
    ASSERT_TRUE(nifti::writeNifti(folder.path() / "mask.nii", mask));
    const std::string store = folder.path() / "store";
    const auto prepared = haustra({"prepare", folder.path() / "scan.nii", "--lumen",
                                   folder.path() / "mask.nii", "--store", store, "--case", "thin"});
    EXPECT_EQ(prepared.exitCode, 1);
    EXPECT_NE(prepared.err.find("80x40x3 voxels"), std::string::npos) << prepared.err;
    EXPECT_EQ(
        haustra({"export", "thin", "surface", folder.path() / "s.ply", "--store", store}).exitCode,
        0);
    const auto biopsy =
        haustra({"export", "thin", "biopsy", folder.path() / "b.png", "--store", store});
    EXPECT_EQ(biopsy.exitCode, 1);
    EXPECT_NE(biopsy.err.find("80x40x3 voxels"), std::string::npos) << biopsy.err;
    EXPECT_FALSE(fs::exists(folder.path() / "b.png"));
}

TEST_F(CadCommand, DrawsItsCurve) {
    const TemporaryFolder out;
    const fs::path picture = out.path() / "curve.png";
    const auto judged = haustra(with(judging({name(6)}), {"--froc", picture}));
    ASSERT_EQ(judged.exitCode, 0) << judged.err;
    EXPECT_EQ(fileContent(picture).substr(1, 3), "PNG");
}

// Before the first case is measured, and naming what is wrong.
TEST_F(CadCommand, RefusesFilesThatItCannotReadOrWrite) {
    const TemporaryFolder out;
    const std::string folder = out.path().string(), picture = folder + "/model.png",
                      file = folder + "/file", same = folder + "/curve.csv";
    writeText(picture, "\x89PNG\r\n");
    writeText(file, "no folder");
    const auto refused = [&](const Arguments& more, int exitCode) {
        const auto outcome = haustra(with(judging({name(6)}), more));
        EXPECT_EQ(outcome.exitCode, exitCode) << outcome.err;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        return outcome.err;
    };
    const auto holds = [](const std::string& text, const std::string& words) {
        return text.find(words) != std::string::npos;
    };
    for (const std::string& none : {folder, folder + "/none"})
        EXPECT_PRED2(holds, refused({"--model", none}, 2), "neither a file nor the word built-in");
    const std::string noText = refused({"--model", picture}, 1);
    EXPECT_PRED2(holds, noText, "\\x89");
    EXPECT_TRUE(std::ranges::all_of(noText, [](char c) {
        return c == '\n' || (c >= ' ' && c <= '~');
    })) << noText;
    EXPECT_PRED2(holds, refused({"--candidates", file}, 1),
                 file + ": this is a file, not a folder");
    EXPECT_PRED2(holds, refused({"--candidates", file + "/in/it"}, 1),
                 file + ": this is a file, not a folder");
    EXPECT_PRED2(holds, refused({"--candidates", ""}, 1), "a folder's name is empty");
    EXPECT_PRED2(holds, refused({"--froc", same, "--report", folder + "/./curve.csv"}, 2),
                 "--report writes the same file");
    EXPECT_FALSE(fs::exists(same));
}

TEST_F(CadCommand, SaysWhatIsWrongWithATruth) {
    const TemporaryFolder other;
    const fs::path file = other.path() / name(6) / "truth" / "growths.json";
    const auto told = [&](const std::string& text, const Arguments& more = {}) {
        writeText(file, text);
        Arguments arguments{"cad",   "evaluate", name(6),     "--store",
                            store(), "--truth",  other.path()};
        return haustra(with(arguments, more));
    };
    const auto refused = [&](const std::string& text, const Arguments& more = {}) {
        const auto outcome = told(text, more);
        EXPECT_EQ(outcome.exitCode, 1) << text;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        EXPECT_NE(outcome.err.find(other.path().string()), std::string::npos) << outcome.err;
        return outcome.err;
    };
    const auto lesion = [](glm::dvec3 at, double diameterMm) {
        return json{{"growths", {{{"position_mm", placeJson(at)}, {"diameter_mm", diameterMm}}}}}
            .dump();
    };
    EXPECT_NE(refused(lesion({400, 0, 0}, 8)).find("another scan"), std::string::npos);
    EXPECT_NE(refused(lesion({1e9, 0, 0}, 8)).find("outside any body"), std::string::npos);
    EXPECT_NE(refused(lesion({0, 0, 0}, 1e9)).find("diameter"), std::string::npos);
    refused("{\"growths\": {}}");
    EXPECT_NE(refused("[1]").find("neither growths nor findings"), std::string::npos);
    EXPECT_NE(refused(R"({"growths": [{"position_mm": [0, 0, 0], "diameter_mm": 8},
                                      {"position_mm": [0, 0, 0]}]})")
                  .find("lesion 2: key 'diameter_mm' not found"),
              std::string::npos);
    EXPECT_NE(refused("{\"growths\": [").find("no truth: parse error at line 1"),
              std::string::npos);
    // Nothing to be found: there are false findings to count, but no curve.
    const auto none = told("{\"growths\": []}");
    EXPECT_EQ(none.exitCode, 0) << none.err;
    EXPECT_NE(none.out.find("No polyp"), std::string::npos) << none.out;
    const std::string curve = other.path() / "curve.csv";
    refused("{\"growths\": []}", {"--froc", curve});
    EXPECT_FALSE(fs::exists(curve));
}

}  // namespace
}  // namespace haustra::tests
