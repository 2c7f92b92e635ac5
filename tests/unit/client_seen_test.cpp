// What a client counts as on screen, and the name under which the reader's record is kept.
#include "protocol/limits.h"
#include "reader/reader_name.h"
#include "reader/screen_time.h"
#include "temporary_folder.h"

#include <map>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

using std::chrono::microseconds, std::chrono::milliseconds;

class Screen : public ::testing::Test {
protected:
    /// What has come since, by picture.
    std::map<std::uint32_t, int> taken(std::size_t most = 256) {
        std::map<std::uint32_t, int> times;
        for (const ShownTime& time : screen_.take(now_, most)) {
            EXPECT_GT(time.ms, 0);
            EXPECT_TRUE(times.emplace(time.picture, time.ms).second);
        }
        return times;
    }
    using Times = std::map<std::uint32_t, int>;
    ScreenTime screen_;
    link::Clock::time_point now_{std::chrono::hours(1)};
};

TEST_F(Screen, APictureIsOnItUntilAnotherOfItsViewportIs) {
    screen_.show(0, 1, now_);
    screen_.show(5, 2, now_);
    now_ += milliseconds(40);
    screen_.show(0, 3, now_);
    now_ += milliseconds(60);
    EXPECT_EQ(taken(), (Times{{1, 40}, {2, 100}, {3, 60}}));
    screen_.show(0, 3, now_);  // painted again
    now_ += milliseconds(10);
    screen_.hide(5, now_);
    now_ += milliseconds(10);
    EXPECT_EQ(taken(), (Times{{2, 10}, {3, 20}}));
    screen_.reset();
    now_ += milliseconds(10);
    EXPECT_EQ(taken(), Times{});
}

TEST_F(Screen, NoTimeIsLostOrToldTwice) {
    screen_.show(0, 1, now_);
    int told = 0;
    for (int n = 0; n < 1000; ++n) {
        now_ += microseconds(700);
        for (const auto& [picture, ms] : taken())
            told += ms;
    }
    EXPECT_EQ(told, 700);
    // More than one message holds, in a minute's portions.
    for (std::uint32_t picture = 2; picture < 12; ++picture) {
        now_ += milliseconds(5);
        screen_.show(0, picture, now_);
    }
    now_ += std::chrono::minutes(2);
    Times all;
    for (Times part = taken(4); !part.empty(); part = taken(4)) {
        EXPECT_LE(part.size(), 4u);
        for (const auto& [picture, ms] : part) {
            EXPECT_LE(ms, protocol::mostSeenMs);
            all[picture] += ms;
        }
    }
    EXPECT_EQ(all.size(), 11u);
    EXPECT_EQ(all[5], 5);
    EXPECT_EQ(all[11], 120'000);
}

TEST(ReaderName, IsMadeOnceAndKept) {
    const tests::TemporaryFolder folder;
    const auto file = folder.path() / "haustra" / "reader";
    const auto made = readerNameIn(file);
    ASSERT_TRUE(made) << describe(made.error());
    EXPECT_EQ(made->size(), 32u);
    EXPECT_EQ(*readerNameIn(file), *made);
    EXPECT_NE(*readerNameIn(folder.path() / "another"), *made);
    using std::filesystem::perms;
    EXPECT_EQ(std::filesystem::status(file).permissions() & (perms::group_all | perms::others_all),
              perms::none);
    std::ofstream(file) << "dr.lin\n";
    EXPECT_EQ(*readerNameIn(file), "dr.lin");
    for (const char* bad : {"two words\n", "\n"}) {
        std::ofstream(file) << bad;
        EXPECT_FALSE(readerNameIn(file)) << bad;
    }
    std::ofstream(file, std::ios::trunc).close();  // as a full disk leaves it
    const auto again = readerNameIn(file);
    ASSERT_TRUE(again) << describe(again.error());
    EXPECT_EQ(again->size(), 32u);
    EXPECT_FALSE(checkReaderName(std::string(65, 'a')));
    EXPECT_TRUE(checkReaderName(std::string(64, 'a')));
}

}  // namespace
}  // namespace haustra::reader
