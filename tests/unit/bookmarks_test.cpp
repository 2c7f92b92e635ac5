// The bookmark store keeps what it acknowledged, once.
#include "records/bookmarks.h"

#include "end_to_end/run_program.h"
#include "protocol/limits.h"

#include <fstream>

#include <gtest/gtest.h>
#include <sqlite3.h>

namespace haustra::records {
namespace {

NewBookmark bookmark(const std::string& scan, int n) {
    NewBookmark added;
    added.caseName = "the case of " + scan;
    added.scan = scan;
    added.clientKey = "key-" + std::to_string(n);
    added.positionMm = {0.1 * n, -1.0 / 3.0, 1e-17};
    added.forward = {0, 0, 1};
    added.up = {0, -1, 0};
    added.arcMm = 1000.0 / (n + 1);
    added.note = "polyp? n\xc2\xb0 " + std::to_string(n) + " '); DROP TABLE bookmarks; --";
    return added;
}

void expectSame(const Bookmark& stored, const NewBookmark& added) {
    EXPECT_EQ(stored.caseName, added.caseName);
    EXPECT_EQ(stored.scan, added.scan);
    EXPECT_EQ(stored.clientKey, added.clientKey);
    EXPECT_EQ(stored.positionMm, added.positionMm);
    EXPECT_EQ(stored.forward, added.forward);
    EXPECT_EQ(stored.up, added.up);
    EXPECT_EQ(stored.arcMm, added.arcMm);
    EXPECT_EQ(stored.note, added.note);
}

class Bookmarks : public ::testing::Test {
protected:
    BookmarkStore open() {
        auto store = BookmarkStore::open(folder_.path() / "records.sqlite3");
        EXPECT_TRUE(store) << describe(store.error());
        return std::move(*store);
    }
    tests::TemporaryFolder folder_;
};

// Notes and readers' names.
TEST_F(Bookmarks, AreNotForOtherUsersOfTheMachine) {
    namespace fs = std::filesystem;
    const fs::path file = folder_.path() / "records.sqlite3";
    const auto others = [](const fs::path& of) {
        return fs::status(of).permissions() & fs::perms::others_all;
    };
    const auto check = [&] {
        BookmarkStore store = open();
        ASSERT_TRUE(store.add({bookmark("a", 1)}));
        for (const auto& entry : fs::directory_iterator(folder_.path()))
            EXPECT_EQ(others(entry.path()), fs::perms::none) << entry.path();
    };
    check();
    // As an older Haustra left them, which still writes.
    const BookmarkStore older = open();
    for (const auto& entry : fs::directory_iterator(folder_.path()))
        fs::permissions(entry.path(), fs::perms::others_read, fs::perm_options::add);
    EXPECT_NE(others(file), fs::perms::none);
    check();
}

TEST_F(Bookmarks, AreThereAfterReopeningInTheirOrder) {
    {
        BookmarkStore store = open();
        for (int n = 0; n < 20; ++n) {
            const auto added = store.add({bookmark("a", 2 * n), bookmark("b", 2 * n + 1)});
            ASSERT_TRUE(added);
            for (const auto& one : *added)
                ASSERT_TRUE(one) << describe(one.error());
        }
    }
    BookmarkStore store = open();
    const auto listed = store.list("a");
    ASSERT_TRUE(listed);
    ASSERT_EQ(listed->size(), 20u);
    for (int n = 0; n < 20; ++n) {
        expectSame((*listed)[std::size_t(n)], bookmark("a", 2 * n));
        EXPECT_EQ((*listed)[std::size_t(n)].createdUtc.size(),
                  std::size("2020-01-31T23:59:59Z") - 1);
        EXPECT_TRUE(n == 0 || (*listed)[std::size_t(n)].id > (*listed)[std::size_t(n) - 1].id);
    }
    EXPECT_TRUE(store.list("nobody's")->empty());
}

TEST_F(Bookmarks, OneAddedAgainIsTheSame) {
    const NewBookmark added = bookmark("a", 1);
    const auto first = open().add({added});
    BookmarkStore store = open();
    NewBookmark changed = added;
    changed.note = "another text under the same key";
    const auto again = store.add({added, changed, added});
    ASSERT_TRUE(first && again);
    for (const auto& one : *again) {
        ASSERT_TRUE(one);
        EXPECT_EQ(one->id, (*first)[0]->id);
        EXPECT_EQ(one->createdUtc, (*first)[0]->createdUtc);
        expectSame(*one, added);
    }
    EXPECT_EQ(store.list("a")->size(), 1u);
    // The key counts within its scan.
    NewBookmark elsewhere = added;
    elsewhere.scan = "b";
    EXPECT_NE((*store.add({elsewhere}))[0]->id, (*first)[0]->id);
}

TEST_F(Bookmarks, BelongToTheirScanWhateverTheCaseIsCalled) {
    BookmarkStore store = open();
    NewBookmark ofA = bookmark("a", 1), ofB = bookmark("b", 2), renamed = bookmark("a", 3);
    ofA.caseName = ofB.caseName = "DICOM";
    renamed.caseName = "elsewhere";
    ASSERT_TRUE(store.add({ofA, ofB, renamed}));
    ASSERT_EQ(store.list("a")->size(), 2u);
    expectSame(store.list("a")->at(0), ofA);
    expectSame(store.list("a")->at(1), renamed);
    ASSERT_EQ(store.list("b")->size(), 1u);
    expectSame(store.list("b")->at(0), ofB);
}

// A file of before bookmarks had scans: nothing of it is lost, and the first scan that its case is
// opened with has it, later ones do not.
TEST_F(Bookmarks, OfBeforeScansGoToTheScanThatTheirCaseIsOf) {
    const auto file = folder_.path() / "records.sqlite3";
    sqlite3* former = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &former), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(former, R"(
        CREATE TABLE bookmarks(
            id INTEGER PRIMARY KEY AUTOINCREMENT, case_name TEXT NOT NULL, client_key TEXT NOT NULL,
            position_x REAL NOT NULL, position_y REAL NOT NULL, position_z REAL NOT NULL,
            forward_x REAL NOT NULL, forward_y REAL NOT NULL, forward_z REAL NOT NULL,
            up_x REAL NOT NULL, up_y REAL NOT NULL, up_z REAL NOT NULL, arc_mm REAL NOT NULL,
            note TEXT NOT NULL, created_utc TEXT NOT NULL, UNIQUE(case_name, client_key));
        INSERT INTO bookmarks VALUES
            (7, 'p', 'k', 1, 2, 3, 0, 0, 1, 0, -1, 0, 40.5, 'of p', '2020-01-31T23:59:59Z'),
            (9, 'q', 'k', 1, 2, 3, 0, 0, 1, 0, -1, 0, 40.5, 'of q', '2020-01-31T23:59:59Z');)",
                           nullptr, nullptr, nullptr),
              SQLITE_OK);
    sqlite3_close(former);
    for (int opening = 0; opening < 2; ++opening) {
        BookmarkStore store = open();
        ASSERT_TRUE(store.adopt("p", "first scan"));
        ASSERT_TRUE(store.adopt("p", "second scan"));
        EXPECT_TRUE(store.list("second scan")->empty());
        const auto listed = store.list("first scan");
        ASSERT_EQ(listed->size(), 1u);
        EXPECT_EQ(listed->front().id, 7u);
        EXPECT_EQ(listed->front().note, "of p");
        EXPECT_EQ(listed->front().createdUtc, "2020-01-31T23:59:59Z");
    }
    BookmarkStore store = open();
    ASSERT_TRUE(store.adopt("q", "another"));
    EXPECT_EQ(store.list("another")->size(), 1u);
    EXPECT_GT((*store.add({bookmark("another", 1)}))[0]->id, 9u);
}

TEST_F(Bookmarks, AScanHoldsSoManyAndOthersGoOn) {
    BookmarkStore store = open();
    const auto long1 = [](int n) {
        NewBookmark added = bookmark("a", n);
        added.note = std::string(2000, 'x');
        return added;
    };
    std::vector<NewBookmark> many;
    for (int n = 0; n < 2000; ++n)
        many.push_back(long1(n));
    const auto added = store.add(many);
    ASSERT_TRUE(added);
    std::size_t kept = 0;
    for (const auto& one : *added)
        kept += one.has_value();
    EXPECT_GT(kept, 1000u);
    EXPECT_LT(kept, 2000u);
    EXPECT_EQ(store.list("a")->size(), kept);
    EXPECT_FALSE((*added).back());
    EXPECT_TRUE((*store.add({bookmark("b", 1)}))[0]);
    // A retry of one that is stored is not an addition; and a restart does not make room.
    EXPECT_TRUE((*store.add({long1(0)}))[0]);
    EXPECT_FALSE((*open().add({long1(5000)}))[0]);
}

// A list that is too long for one message could never be read again.
TEST_F(Bookmarks, TwoServersTogetherKeepAScansBound) {
    BookmarkStore one = open(), other = open();
    std::size_t bytes = 0;
    for (int n = 0; n < 2000; n += 50) {
        std::vector<NewBookmark> batch;
        for (int k = n; k < n + 50; ++k) {
            batch.push_back(bookmark("a", k));
            batch.back().note = std::string(2000, 'x');
        }
        ASSERT_TRUE((n % 100 == 0 ? one : other).add(batch));
    }
    const auto listed = one.list("a");
    ASSERT_TRUE(listed);
    for (const Bookmark& added : *listed)
        bytes += added.note.size() + added.clientKey.size() + protocol::bookmarkOverheadBytes;
    EXPECT_LE(bytes, protocol::maxScanBookmarkBytes);
    EXPECT_GT(bytes, protocol::maxScanBookmarkBytes - 2400);
}

TEST_F(Bookmarks, AFileThatIsNoDatabaseIsRefused) {
    std::ofstream(folder_.path() / "records.sqlite3") << std::string(8192, 'x');
    const auto store = BookmarkStore::open(folder_.path() / "records.sqlite3");
    ASSERT_FALSE(store);
    EXPECT_EQ(store.error().kind, ErrorKind::io);
    EXPECT_NE(describe(store.error()).find("records.sqlite3"), std::string::npos)
        << describe(store.error());
    EXPECT_FALSE(BookmarkStore::open(folder_.path() / "no" / "such" / "folder"));
}

}  // namespace
}  // namespace haustra::records
