// What readers have seen is kept, each reader's for itself, and nothing that was kept is lost.
#include "records/seen_walls.h"

#include "protocol/limits.h"
#include "temporary_folder.h"

#include <numeric>

#include <gtest/gtest.h>
#include <sqlite3.h>

namespace haustra::records {
namespace {

class SeenWalls : public ::testing::Test {
protected:
    SeenStore open() {
        auto store = SeenStore::open(file_);
        EXPECT_TRUE(store) << describe(store.error());
        return std::move(*store);
    }
    static Ledger ledger(const std::string& reader, const std::string& wall,
                         std::vector<std::uint32_t> times, SeenLimits limits = {}) {
        return {{reader, wall, limits}, "a case", "a scan", std::move(times)};
    }
    static void keep(SeenStore& store, const std::vector<Ledger>& ledgers) {
        const auto kept = store.keep(ledgers);
        ASSERT_TRUE(kept) << describe(kept.error());
        for (const auto& one : *kept)
            ASSERT_TRUE(one) << describe(one.error());
    }
    static std::vector<std::uint32_t> timesOf(SeenStore& store, const LedgerKey& key) {
        const auto found = store.find(key);
        EXPECT_TRUE(found) << describe(found.error());
        return found && *found ? (*found)->times : std::vector<std::uint32_t>();
    }
    void run(const std::string& sql) {
        sqlite3* database = nullptr;
        ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
        EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
            << sqlite3_errmsg(database);
        sqlite3_close(database);
    }

    tests::TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_.path() / "records.sqlite3";
};

TEST_F(SeenWalls, AreThereAfterReopeningEachForItself) {
    std::vector<std::uint32_t> times(100'000);
    for (std::size_t t = 0; t < times.size(); ++t)
        times[t] = t % 7 == 0 ? 300'000 : std::uint32_t(t * 2654435761u % 300'000);
    const SeenLimits strict{2.0, 1000};
    {
        SeenStore store = open();
        keep(store, {ledger("ada", "w", times), ledger("ada", "w", {1, 2}, strict),
                     ledger("bob'; --", "w", {3}), ledger("ada", "another wall", {4})});
    }
    SeenStore store = open();
    EXPECT_EQ(timesOf(store, {"ada", "w", {}}), times);
    EXPECT_EQ(timesOf(store, {"ada", "w", strict}), std::vector<std::uint32_t>({1, 2}));
    EXPECT_EQ(timesOf(store, {"bob'; --", "w", {}}), std::vector<std::uint32_t>({3}));
    EXPECT_EQ(timesOf(store, {"ada", "another wall", {}}), std::vector<std::uint32_t>({4}));
    EXPECT_FALSE(*store.find({"eve", "w", {}}));
    const auto all = store.ofWall("w", 10);
    ASSERT_TRUE(all);
    EXPECT_EQ(all->size(), 3u);
    EXPECT_EQ(store.ofWall("w", 2)->size(), 2u);
    for (const Ledger& one : *all) {
        EXPECT_EQ(one.caseName, "a case");
        EXPECT_EQ(one.changedUtc.size(), 20u);
    }
    ASSERT_TRUE(store.forget({"ada", "w", {}}));
    EXPECT_FALSE(*store.find({"ada", "w", {}}));
    EXPECT_EQ(timesOf(store, {"bob'; --", "w", {}}), std::vector<std::uint32_t>({3}));
}

TEST_F(SeenWalls, TheLongerTimeCounts) {
    SeenStore store = open(), other = open();
    keep(store, {ledger("ada", "w", {5, 0, 9})});
    keep(other, {ledger("ada", "w", {1, 7, 9})});
    EXPECT_EQ(timesOf(store, {"ada", "w", {}}), std::vector<std::uint32_t>({5, 7, 9}));
}

TEST_F(SeenWalls, ManyReadersHaveRoomAndNotAnyNumber) {
    SeenStore store = open();
    std::vector<Ledger> all;
    for (int n = 0; n < protocol::maxWallLedgers; ++n)
        all.push_back(ledger("reader " + std::to_string(n), "w", {std::uint32_t(n)}));
    keep(store, all);
    const auto more =
        store.keep(std::vector{ledger("one too many", "w", {1}), ledger("reader 0", "w", {99}),
                               ledger("one too many", "another", {1})});
    ASSERT_TRUE(more);
    EXPECT_FALSE((*more)[0]);
    EXPECT_TRUE((*more)[1]);
    EXPECT_TRUE((*more)[2]);
    EXPECT_EQ(timesOf(store, {"reader 0", "w", {}}), std::vector<std::uint32_t>({99}));
}

TEST_F(SeenWalls, OneReaderHasRoomForSoManyChoicesAndItsOldestGoes) {
    SeenStore store = open();
    const auto limits = [](int n) { return SeenLimits{1.0, 100 + n}; };
    std::vector<Ledger> all{ledger("ada", "w", {1}), ledger("bob", "w", {2}, limits(0)),
                            ledger("ada", "another", {3}, limits(0))};
    for (int n = 0; n < protocol::maxReaderLedgers - 1; ++n)
        all.push_back(ledger("ada", "w", {std::uint32_t(n)}, limits(n)));
    keep(store, all);
    run("UPDATE seen_walls SET changed_utc = '2020-01-01T00:00:' || (least_ms - 70) || 'Z' "
        "WHERE least_ms <> 300");
    run("UPDATE seen_walls SET changed_utc = '2019-01-01T00:00:00Z' WHERE least_ms = 300");
    keep(store, {ledger("ada", "w", {7}, limits(0))});
    EXPECT_EQ(timesOf(store, {"ada", "w", limits(1)}), std::vector<std::uint32_t>({1}))
        << "one that is there already needs no room";
    keep(store, {ledger("ada", "w", {8}, limits(50))});
    EXPECT_FALSE(*store.find({"ada", "w", limits(1)})) << "it has changed longest ago";
    EXPECT_EQ(timesOf(store, {"ada", "w", {}}), std::vector<std::uint32_t>({1}))
        << "that of the usual limits is the last to go";
    EXPECT_EQ(timesOf(store, {"ada", "w", limits(0)}), std::vector<std::uint32_t>({7}));
    EXPECT_EQ(timesOf(store, {"ada", "w", limits(50)}), std::vector<std::uint32_t>({8}));
    EXPECT_EQ(store.ofWall("w", 100)->size(), std::size_t(protocol::maxReaderLedgers) + 1);
    EXPECT_EQ(timesOf(store, {"bob", "w", limits(0)}), std::vector<std::uint32_t>({2}));
    EXPECT_EQ(timesOf(store, {"ada", "another", limits(0)}), std::vector<std::uint32_t>({3}));
}

TEST_F(SeenWalls, DamageIsToldAndNotOverwritten) {
    {
        SeenStore store = open();
        keep(store, {ledger("ada", "w", std::vector<std::uint32_t>(1000, 8))});
    }
    for (const char* damage :
         {"UPDATE seen_walls SET times = x'00'", "UPDATE seen_walls SET triangles = 999",
          "UPDATE seen_walls SET triangles = 1000000000000", "UPDATE seen_walls SET triangles = -1",
          "UPDATE seen_walls SET times = ''"}) {
        run((std::string(damage) + " WHERE reader = 'ada'").c_str());
        SeenStore store = open();
        const auto found = store.find({"ada", "w", {}});
        ASSERT_FALSE(found) << damage;
        EXPECT_EQ(found.error().kind, ErrorKind::io);
        EXPECT_FALSE(store.ofWall("w", 10));
        // Whoever waits in the same commit is kept.
        const auto kept = store.keep(std::vector{ledger("ada", "w", {1}), ledger("bob", "x", {2})});
        ASSERT_TRUE(kept);
        EXPECT_FALSE((*kept)[0]);
        EXPECT_TRUE((*kept)[1]);
        EXPECT_FALSE(store.find({"ada", "w", {}}));
    }
}

TEST_F(SeenWalls, FilesOfEarlierVersionsAreTakenUp) {
    {
        SeenStore store = open();
        keep(store, {ledger("ada", "w", {7, 8})});
    }
    run("ALTER TABLE seen_walls ADD COLUMN share REAL NOT NULL DEFAULT 0.5");
    for (int opened = 0; opened < 2; ++opened) {
        SeenStore store = open();
        EXPECT_EQ(timesOf(store, {"ada", "w", {}}), std::vector<std::uint32_t>({7, 8}));
        keep(store, {ledger("bob", "w", {1, 2})});
    }
}

TEST_F(SeenWalls, ATransactionThatThrowsIsTakenBack) {
    auto database = openDatabase(file_, "CREATE TABLE IF NOT EXISTS t(x INTEGER);");
    ASSERT_TRUE(database);
    EXPECT_THROW((void)inTransaction(database->get(),
                                     [&]() -> Result<void> {
                                         TRY(haustra::records::run(database->get(),
                                                                   "INSERT INTO t VALUES(1)", "x"));
                                         throw std::bad_alloc();
                                     }),
                 std::bad_alloc);
    ASSERT_TRUE(inTransaction(database->get(), [&]() -> Result<void> {
        return haustra::records::run(database->get(), "INSERT INTO t VALUES(2)", "x");
    }));
    auto count = Statement::prepare(database->get(), "SELECT count(*) FROM t");
    ASSERT_TRUE(count && *count->step());
    EXPECT_EQ(count->integer(0), 1);
}

}  // namespace
}  // namespace haustra::records
