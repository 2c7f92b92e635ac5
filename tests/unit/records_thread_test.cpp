// Whoever adds a bookmark does not wait for what others list.
#include "session/records_thread.h"

#include "core/volume.h"
#include "store/products.h"
#include "temporary_folder.h"

#include <future>

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

class RecordsOrder : public testing::Test {
protected:
    /// What is asked for by `requests` waits together; then what was answered, in order.
    std::vector<std::string> answersTo(const std::function<void(RecordsThread&)>& requests) {
        const auto file = folder_.path() / "records.sqlite3";
        {
            RecordsThread records(records::BookmarkStore::open(file).value(),
                                  records::SeenStore::open(file).value(), store_);
            std::promise<void> busy, all;
            records.findSeen({}, [&](const auto&) {
                busy.set_value();
                all.get_future().wait();
            });
            busy.get_future().wait();
            requests(records);
            all.set_value();
        }
        return std::exchange(answers_, {});
    }
    void add(RecordsThread& records, std::uint64_t by, const std::string& name) {
        records::NewBookmark bookmark;
        bookmark.caseName = "a case";
        bookmark.scan = "a scan";
        bookmark.clientKey = name;
        records.add(by, bookmark, [this, name](const auto& added) {
            EXPECT_TRUE(added);
            answers_.push_back(name);
        });
    }
    void list(RecordsThread& records, std::uint64_t by, const std::string& name) {
        records.list(by, "a case", "a scan", [this, name](const auto& bookmarks) {
            answers_.push_back(name + " of " + std::to_string(bookmarks->size()));
        });
    }
    /// And makes a case more, so that the next reading has another count.
    void listCases(RecordsThread& records, std::uint64_t by, const std::string& name) {
        records.listCases(by, [this, name](const auto& cases) {
            answers_.push_back(name + " of " + std::to_string(cases->size()));
            EXPECT_TRUE(store_.createCase("case-" + std::to_string(++made_))
                            ->publishText("quality", store::makeKey(name, 1, "", {}), "{}"));
        });
    }
    using Answers = std::vector<std::string>;

    tests::TemporaryFolder folder_;
    store::CaseStore store_ = store::CaseStore::open(folder_.path(), true).value();
    std::vector<std::string> answers_;
    int made_ = 0;
};

TEST_F(RecordsOrder, AdditionsGoBeforeTheListsOfOthersAndNoSessionsAnswersChangePlaces) {
    const auto answers = answersTo([&](RecordsThread& records) {
        list(records, 1, "list");
        listCases(records, 2, "cases");
        add(records, 3, "early");
        add(records, 2, "after cases");
        list(records, 2, "list after it");
        add(records, 3, "early, too");
    });
    EXPECT_EQ(answers, (Answers{"early", "early, too", "list of 2", "cases of 0", "after cases",
                                "list after it of 3"}));
}

TEST_F(RecordsOrder, ListsOfCasesThatWaitTogetherAreOneReading) {
    const auto answers = answersTo([&](RecordsThread& records) {
        for (std::uint64_t by = 1; by <= 3; ++by)
            listCases(records, by, "cases");
        add(records, 3, "mine");
        listCases(records, 3, "cases with mine");
    });
    EXPECT_EQ(answers,
              (Answers{"cases of 0", "cases of 0", "cases of 0", "mine", "cases with mine of 3"}));
    EXPECT_EQ(answersTo([&](RecordsThread& records) { listCases(records, 1, "cases"); }),
              Answers{"cases of 4"})
        << "the next reads anew";
}

}  // namespace
}  // namespace haustra::session
