// The thread that waits for the disk, so that no picture has to.
#pragma once

#include "records/bookmarks.h"
#include "session/case_list.h"
#include "session/worker.h"
#include "store/case_store.h"

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace haustra::session {

/// Owns the bookmarks. Requests are served in order; additions that wait together share one
/// commit. Its functions may be called from any thread and never block; callbacks come on the
/// records thread.
class RecordsThread {
public:
    RecordsThread(records::BookmarkStore bookmarks, store::CaseStore cases);

    /// `done` is called after the commit.
    using Added = std::function<void(Result<records::Bookmark>)>;
    void add(records::NewBookmark bookmark, Added done);
    using Listed = std::function<void(Result<std::vector<records::Bookmark>>)>;
    /// `scan` is what the case of that name is of.
    void list(std::string caseName, std::string scan, Listed done);
    using Cases = std::function<void(Result<std::vector<CaseSummary>>)>;
    void listCases(Cases done);

private:
    struct Add {
        records::NewBookmark bookmark;
        Added done;
    };
    struct List {
        std::string caseName, scan;
        Listed done;
    };
    struct ListCases {
        Cases done;
    };
    using Request = std::variant<Add, List, ListCases>;
    struct Keeping;

    Worker<Request> worker_;
};

}  // namespace haustra::session
