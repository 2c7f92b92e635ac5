// The report of what all readers have seen, and that nobody's question waits for all of it.
#include "flat_tube.h"
#include "protocol/limits.h"
#include "session/seen_ledger.h"
#include "temporary_folder.h"

#include <future>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>

namespace haustra::session {
namespace {

class SeenReport : public testing::Test {
protected:
    static constexpr int readers = 12;

    static std::shared_ptr<const OpenCase> openTube() {
        const tests::FlatTube tube;
        OpenCase of;
        of.name = "tube";
        of.scan = "a scan";
        of.grid = tube.scan().grid();
        of.centerline = tube.centerline();
        of.wall = makeWall(std::make_shared<const FlatMap>(tube.map())).value();
        return std::make_shared<const OpenCase>(std::move(of));
    }
    void SetUp() override {
        std::vector<records::Ledger> all;
        for (std::uint32_t n = 0; n < readers; ++n)
            all.push_back({{"reader " + std::to_string(n), of_->wall->content, {}},
                           of_->name,
                           of_->scan,
                           std::vector<std::uint32_t>(of_->wall->map->surface.triangles.size(),
                                                      n % 2 == 0 ? 300'000u : 0u)});
        const auto kept = records::SeenStore::open(file_)->keep(all);
        ASSERT_TRUE(kept && std::all_of(kept->begin(), kept->end(),
                                        [](const auto& one) { return one.has_value(); }));
        ledger_ = ledgers_.of("", *of_, {});
    }
    /// What waits on the other threads is done, then one thing of the io thread's, where there is
    /// one.
    void step() {
        std::promise<void> painted, read;
        painting_.push([&] { painted.set_value(); });
        painted.get_future().wait();
        records_.findSeen({}, [&](const auto&) { read.set_value(); });
        read.get_future().wait();
        io_.restart();
        io_.run_one_for(std::chrono::milliseconds(1));
    }

    tests::TemporaryFolder folder_;
    const std::filesystem::path file_ = folder_.path() / "records.sqlite3";
    std::shared_ptr<const OpenCase> of_ = openTube();
    asio::io_context io_;
    RecordsThread records_{records::BookmarkStore::open(file_).value(),
                           records::SeenStore::open(file_).value(),
                           store::CaseStore::open(folder_.path(), true).value()};
    PaintThread painting_;
    SeenLedgers ledgers_{io_.get_executor(), painting_, records_};
    std::shared_ptr<SeenLedger> ledger_;
};

TEST_F(SeenReport, OthersHaveATurnBetweenReaders) {
    const auto asker = std::make_shared<int>();
    std::optional<Result<std::vector<ReaderSeen>>> report;
    // The share is asked for again and again, by whoever waits for it before it asks anew.
    int answered = 0;
    std::function<void()> ask = [&] {
        ledger_->ask([&](const auto& share) {
            EXPECT_TRUE(share);
            if (report) return;
            ++answered;
            ask();
        });
    };
    ledger_->report(leastMissedMm2, asker, [&](auto told) { report = std::move(told); });
    ask();
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!report && std::chrono::steady_clock::now() < end)
        step();
    ASSERT_TRUE(report && *report);
    EXPECT_GE(answered, readers);
    ASSERT_EQ((*report)->size(), std::size_t(readers) + 1);
    EXPECT_EQ((*report)->front().key.reader, "") << "who asks, and is not kept";
    for (const ReaderSeen& one : std::span(**report).subspan(1)) {
        const bool all = (one.key.reader.back() - '0') % 2 == 0;
        EXPECT_EQ(one.share, all ? 1.0 : 0.0) << one.key.reader;
        EXPECT_EQ(one.missed.count, all ? 0u : 1u) << one.key.reader;
    }
}

TEST_F(SeenReport, IsNotFinishedForWhoHasGone) {
    auto asker = std::make_shared<int>();
    ledger_->report(leastMissedMm2, asker, [](const auto&) { ADD_FAILURE() << "nobody asks"; });
    for (int n = 0; n < 8; ++n)
        step();
    asker.reset();
    for (int n = 0; n < 8 * readers; ++n)
        step();
}

}  // namespace
}  // namespace haustra::session
