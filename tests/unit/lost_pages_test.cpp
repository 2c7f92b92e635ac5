// Products that are cut short while they are mapped.
#include "store/lost_pages.h"

#include "end_to_end/run_program.h"
#include "store/case_store.h"

#include <csignal>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::store {
namespace {

using tests::TemporaryFolder;

ProductKey key(const char* stage) {
    return makeKey(stage, 1, "", {});
}

/// A case with a volume of sevens, larger than a few pages.
class LostPages : public ::testing::Test {
protected:
    LostPages() {
        surviveLostPages();
        const Grid grid = axisAlignedGrid({64, 64, 16}, {1.0, 1.0, 1.0});
        volume_ = Volume<std::int16_t>(grid, 7);
        EXPECT_TRUE(writing().publishVolume("ct", key("ct"), volume_));
    }
    Case writing() { return cases().createCase("c").value(); }
    Case reading() { return cases().openCase("c").value(); }
    CaseStore cases() { return CaseStore::open(folder_.path(), true).value(); }
    std::filesystem::path file(const std::string& product) {
        const Case opened = reading();
        return opened.folder() / opened.find(product).value().file;
    }

    TemporaryFolder folder_;
    Volume<std::int16_t> volume_;
};

TEST_F(LostPages, OtherBusErrorsEndTheProgram) {
    EXPECT_EXIT(std::raise(SIGBUS), ::testing::KilledBySignal(SIGBUS), "");
}

// What has been lost once is not forgotten, so this is the last test.
TEST_F(LostPages, ReadAsZerosAndAreTold) {
    const auto before = reading().readVolume<std::int16_t>("ct").value();
    const auto other = reading().readVolume<std::int16_t>("ct").value();
    const void* const address = before.voxels().data();
    EXPECT_EQ(before[0], 7);
    EXPECT_FALSE(firstLostFile());
    const auto whole = std::filesystem::file_size(file("ct"));
    ASSERT_EQ(::truncate(file("ct").c_str(), off_t(whole / 2)), 0);
    EXPECT_TRUE(isWhole(address)) << "no page that is gone has been read yet";
    EXPECT_EQ(before.voxels().back(), 0);
    EXPECT_EQ(before[0], 7);
    EXPECT_FALSE(isWhole(address));
    EXPECT_FALSE(isWhole(&before.voxels().back()));
    EXPECT_TRUE(isWhole(other.voxels().data()));
    EXPECT_TRUE(isWhole(volume_.voxels().data())) << "memory that no file is mapped to";
    EXPECT_EQ(firstLostFile(), file("ct"));

    // Nothing is published that may come from them.
    const auto made = writing().publishVolume("cleansed", key("cleansed"), before);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().kind, ErrorKind::io);
    EXPECT_EQ(made.error().place, file("ct"));
    EXPECT_FALSE(reading().find("cleansed"));
}

}  // namespace
}  // namespace haustra::store
