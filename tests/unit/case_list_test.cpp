// What is told of the store's cases is what opening them would find, and stays cheap.
#include "session/case_list.h"

#include "end_to_end/run_program.h"
#include "session/open_case.h"
#include "store/products.h"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

using State = CaseSummary::State;
using Clock = std::chrono::steady_clock;

class CaseList : public testing::Test {
protected:
    static store::ProductKey key(const std::string& of) { return store::makeKey(of, 1, "", {}); }
    static Volume<std::int16_t> scan() {
        return Volume<std::int16_t>(axisAlignedGrid({11, 12, 13}, {0.7, 0.8, 0.9}),
                                    std::int16_t(-1000));
    }
    store::Case made(const std::string& name) { return store_.createCase(name).value(); }
    void makeScan(const std::string& name) {
        ASSERT_TRUE(made(name).publishVolume("ct", key("ct of " + name), scan()));
    }
    CaseSummary of(const std::string& name) {
        const auto all = reader_.read(bookmarks_);
        EXPECT_TRUE(all) << describe(all.error());
        for (const CaseSummary& one : *all)
            if (one.name == name) return one;
        ADD_FAILURE() << "no case " << name;
        return {};
    }
    std::filesystem::path fileOf(const std::string& name, const std::string& product) {
        const auto source = store_.openCase(name).value();
        return source.folder() / source.find(product)->file;
    }

    tests::TemporaryFolder folder_;
    store::CaseStore store_ = store::CaseStore::open(folder_.path(), true).value();
    records::BookmarkStore bookmarks_ =
        records::BookmarkStore::open(folder_.path() / "records.sqlite3").value();
    CaseReader reader_{store_};
};

TEST_F(CaseList, TellsWhatTheProductsSay) {
    const auto before = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    makeScan("bare");
    {
        auto full = made("full");
        ASSERT_TRUE(full.publishVolume("ct", key("ct"), scan()));
        ASSERT_TRUE(full.publishVolume("cleansed", key("cleansed"), scan()));
        ColonRecord record;
        for (const double z : {0.0, 200.0, 400.0})
            record.pieces.push_back({ColonPart::sigmoid, {0.0, 0.0, z}, 15.0, 200.0, 100.0});
        record.junctions.resize(2);
        record.confidence = 0.6;
        record.warnings = {"one", "two"};
        ASSERT_TRUE(full.publishText("quality", key("quality"), qualityJson(record)));
    }
    const auto all = reader_.read(bookmarks_);
    ASSERT_TRUE(all);
    ASSERT_EQ(all->size(), 2u);
    for (const CaseSummary& one : *all) {
        EXPECT_EQ(one.state, State::ready) << one.reason;
        EXPECT_EQ(one.size, glm::ivec3(11, 12, 13));
        EXPECT_LT(glm::distance(one.spacingMm, glm::dvec3(0.7, 0.8, 0.9)), 1e-9);
        EXPECT_FALSE(one.flattened);
        EXPECT_EQ(one.bookmarks, 0u);
        std::tm parts{};
        std::istringstream in(one.preparedUtc);
        in >> std::get_time(&parts, "%Y-%m-%dT%H:%M:%SZ");
        ASSERT_FALSE(in.fail()) << one.preparedUtc;
        const auto at = std::chrono::system_clock::from_time_t(timegm(&parts));
        EXPECT_GE(at, before - std::chrono::seconds(2));
        EXPECT_LE(at, std::chrono::system_clock::now());
    }
    EXPECT_EQ((*all)[0].name, "bare");
    EXPECT_FALSE((*all)[0].cleansed);
    EXPECT_FALSE((*all)[0].confidence);
    EXPECT_TRUE((*all)[1].cleansed);
    EXPECT_EQ((*all)[1].confidence, 0.6);
    EXPECT_EQ((*all)[1].warnings, 2u);
}

TEST_F(CaseList, ACaseIsReadyWhereItCanBeOpened) {
    makeScan("scan");
    EXPECT_EQ(of("scan").state, State::ready);
    ASSERT_TRUE(made("empty").publishText("quality", key("quality"), qualityJson(ColonRecord{})));
    EXPECT_EQ(of("empty").state, State::incomplete);
    EXPECT_FALSE(of("empty").reason.empty());

    // Its file is cut short, after it has been found whole.
    const auto file = fileOf("scan", "ct");
    const auto bytes = std::filesystem::file_size(file);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    std::filesystem::resize_file(file, bytes / 2);
    EXPECT_FALSE(readCase(store_.openCase("scan").value()));
    const CaseSummary damaged = of("scan");
    EXPECT_EQ(damaged.state, State::damaged);
    EXPECT_FALSE(damaged.reason.empty());
    EXPECT_EQ(damaged.reason.find(folder_.path().string()), std::string::npos) << damaged.reason;
    std::filesystem::remove(file);
    EXPECT_EQ(of("scan").state, State::damaged);
    // And is made anew.
    ASSERT_TRUE(made("scan").publishVolume("ct", key("another"), scan()));
    EXPECT_EQ(of("scan").state, State::ready);
    std::ofstream(store_.openCase("scan").value().folder() / "case.json") << "{\"products\": [";
    EXPECT_EQ(of("scan").state, State::damaged);
}

TEST_F(CaseList, WhatIsRepairedInPlaceIsReadyAgain) {
    makeScan("scan");
    const auto file = fileOf("scan", "ct");
    const std::string whole = tests::fileContent(file);
    std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    std::ofstream(file, std::ios::binary) << std::string(whole.size(), 'x');
    EXPECT_EQ(of("scan").state, State::damaged);
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_EQ(of("scan").state, State::ready);
}

TEST_F(CaseList, FollowsWhatIsPublishedAndBookmarked) {
    makeScan("a");
    makeScan("b");
    EXPECT_FALSE(of("a").cleansed);
    ASSERT_TRUE(made("a").publishVolume("cleansed", key("cleansed"), scan()));
    EXPECT_TRUE(of("a").cleansed);
    EXPECT_FALSE(of("b").cleansed);
    const std::string scanOfA = store_.openCase("a").value().scan().value()->key.hex;
    for (int n = 0; n < 3; ++n) {
        records::NewBookmark bookmark;
        bookmark.caseName = "a";
        bookmark.scan = scanOfA;
        bookmark.clientKey = "key" + std::to_string(n);
        ASSERT_TRUE(bookmarks_.add({bookmark}));
        EXPECT_EQ(of("a").bookmarks, std::size_t(n + 1));
        EXPECT_EQ(of("b").bookmarks, 0u);
    }
    std::filesystem::remove_all(store_.openCase("b").value().folder());
    EXPECT_EQ(reader_.read(bookmarks_)->size(), 1u);
}

TEST_F(CaseList, FiveHundredCasesTakeNoSeconds) {
    makeScan("first");
    const auto folder = store_.openCase("first").value().folder();
    for (int n = 1; n < 500; ++n)
        std::filesystem::copy(folder, folder.parent_path() / ("case-" + std::to_string(n)));
    const auto timed = [&] {
        const auto begin = Clock::now();
        EXPECT_EQ(reader_.read(bookmarks_)->size(), 500u);
        return std::chrono::duration<double>(Clock::now() - begin).count();
    };
    const double cold = timed(), warm = timed();
    RecordProperty("cold_ms", int(1e3 * cold));
    RecordProperty("warm_ms", int(1e3 * warm));
    std::printf("500 cases: %.0f ms, and %.0f ms when they are known\n", 1e3 * cold, 1e3 * warm);
    EXPECT_LT(cold, 2.0);
    EXPECT_LT(warm, 0.5);
}

TEST(OpenCounts, CountWhatLives) {
    OpenCounts counts;
    EXPECT_EQ(counts.of("a"), 0);
    auto one = counts.enter("a"), two = counts.enter("a"), other = counts.enter("b");
    EXPECT_EQ(counts.of("a"), 2);
    EXPECT_EQ(counts.of("b"), 1);
    one.reset();
    EXPECT_EQ(counts.of("a"), 1);
    two = counts.enter("b");
    EXPECT_EQ(counts.of("a"), 0);
    EXPECT_EQ(counts.of("b"), 2);
}

}  // namespace
}  // namespace haustra::session
