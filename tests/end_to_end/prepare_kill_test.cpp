// kill -9 of `haustra prepare`: the store stays sound, and the next run finishes the work.
#include "end_to_end/run_program.h"
#include "nifti/nifti_file.h"
#include "store/case_store.h"

#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

namespace haustra {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono;

constexpr int productCount = 12;

class PrepareKilled : public testing::Test {
protected:
    // A bent tube of air in soft tissue, and its mask: each stage has work, none takes long.
    void SetUp() override {
        const Grid grid = axisAlignedGrid({96, 80, 110}, {0.8, 0.8, 1.2}, {-20.0, 5.0, -300.0});
        Volume<std::int16_t> hu(grid);
        Volume<std::uint8_t> mask(grid);
        for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
            const glm::ivec3 v = grid.voxelAt(n);
            const glm::dvec2 axis(48.0 + 16.0 * std::sin(v.z * 0.06), 40.0);
            const bool inside =
                0.8 * glm::distance(glm::dvec2(v), axis) < 14.0 && v.z > 4 && v.z < 105;
            mask.writable()[n] = inside;
            hu.writable()[n] = inside ? -1000 : std::int16_t(40 + n % 7);
        }
        ASSERT_TRUE(nifti::writeNifti(folder_.path() / "scan.nii", hu));
        ASSERT_TRUE(nifti::writeNifti(folder_.path() / "mask.nii", mask));
    }

    tests::Outcome prepare(const fs::path& store,
                           std::optional<microseconds> killAfter = std::nullopt) {
        return tests::runProgram("haustra",
                                 {"prepare", folder_.path() / "scan.nii", "--lumen",
                                  folder_.path() / "mask.nii", "--store", store, "--case", "tube"},
                                 killAfter);
    }

    // Every product that the index names reads whole and is what was published.
    static int soundProducts(const fs::path& folder) {
        const auto store = store::CaseStore::open(folder, false);
        if (!store) return 0;
        const auto opened = store->openCase("tube");
        if (!opened) return 0;
        const auto entries = opened->products();
        EXPECT_TRUE(entries) << describe(entries.error());
        if (!entries) return 0;
        for (const auto& entry : *entries) {
            const auto sound = opened->verify(entry.product);
            EXPECT_TRUE(sound) << describe(sound.error());
        }
        return int(entries->size());
    }

    static std::map<std::string, std::string> filesOf(const fs::path& store) {
        std::map<std::string, std::string> files;
        for (const auto& file : fs::directory_iterator(store / "cases" / "tube")) {
            files[file.path().filename().string()] = tests::fileContent(file.path());
        }
        return files;
    }

    tests::TemporaryFolder folder_;
};

TEST_F(PrepareKilled, AtAnyMomentTheStoreStaysSoundAndTheNextRunFinishes) {
    const auto start = steady_clock::now();
    ASSERT_EQ(prepare(folder_.path() / "undisturbed").exitCode, 0);
    const double undisturbedUs = duration<double, std::micro>(steady_clock::now() - start).count();
    const auto expected = filesOf(folder_.path() / "undisturbed");
    ASSERT_EQ(int(expected.size()), productCount + 2);  // the index, the lock

    constexpr int kills = 8;
    std::mt19937 random(20);
    std::uniform_real_distribution<double> within(0.0, 1.0);
    int killed = 0, halfDone = 0;
    for (int round = 0; round < kills; ++round) {
        const fs::path store = folder_.path() / std::to_string(round);
        const auto moment =
            microseconds(std::int64_t((round + within(random)) / kills * undisturbedUs));
        killed += prepare(store, moment).exitCode == -1;
        const int products = soundProducts(store);
        halfDone += products > 0 && products < productCount;

        const auto finished = prepare(store);
        ASSERT_EQ(finished.exitCode, 0) << finished.err;
        EXPECT_EQ(soundProducts(store), productCount);
        EXPECT_TRUE(filesOf(store) == expected) << "killed after " << moment.count() << " us";
        fs::remove_all(store);
    }
    EXPECT_GE(killed, kills / 2);
    RecordProperty("killed", killed);
    RecordProperty("half_done", halfDone);
}

TEST_F(PrepareKilled, AgainAndAgainItStillGetsThere) {
    const fs::path store = folder_.path() / "store";
    std::mt19937 random(21);
    int before = 0;
    for (int attempt = 0; attempt < 8; ++attempt) {
        prepare(store, milliseconds(random() % 400));
        const int products = soundProducts(store);
        EXPECT_GE(products, before);  // what was done stays done
        before = products;
    }
    EXPECT_EQ(prepare(store).exitCode, 0);
    EXPECT_EQ(soundProducts(store), productCount);
}

}  // namespace
}  // namespace haustra
