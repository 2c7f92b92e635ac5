// The thread that waits for the disk, so that no picture has to.
#pragma once

#include "records/bookmarks.h"
#include "records/seen_walls.h"
#include "session/case_list.h"
#include "session/worker.h"
#include "store/case_store.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace haustra::session {

/// Owns the records. Requests are served in order, but that bookmarks which wait to be added go
/// before the lists of other sessions. Bookmarks that wait together share one commit, and so do
/// ledgers to be kept; lists of cases that wait together are read once. Its functions may be called
/// from any thread and never block; callbacks come on the records thread.
class RecordsThread {
public:
    RecordsThread(records::BookmarkStore bookmarks, records::SeenStore seen,
                  store::CaseStore cases);

    /// `done` is called after the commit.
    using Added = std::function<void(Result<records::Bookmark>)>;
    /// `by`: the session that asks, whose answers keep their order.
    void add(std::uint64_t by, records::NewBookmark bookmark, Added done);
    using Listed = std::function<void(Result<std::vector<records::Bookmark>>)>;
    /// `scan` is what the case of that name is of.
    void list(std::uint64_t by, std::string caseName, std::string scan, Listed done);
    using Cases = std::function<void(Result<std::vector<CaseSummary>>)>;
    void listCases(std::uint64_t by, Cases done);

    /// What readers have seen, as records::SeenStore; `done` of what is kept or forgotten is called
    /// after the commit.
    using Done = std::function<void(Result<void>)>;
    void keepSeen(records::Ledger ledger, Done done);
    void forgetSeen(records::LedgerKey key, Done done);
    using Found = std::function<void(Result<std::optional<records::Ledger>>)>;
    void findSeen(records::LedgerKey key, Found done);
    using Ledgers = std::function<void(Result<std::vector<records::Ledger>>)>;
    void listSeen(std::string wall, Ledgers done);

private:
    struct Add {
        std::uint64_t by;
        records::NewBookmark bookmark;
        Added done;
    };
    struct List {
        std::uint64_t by;
        std::string caseName, scan;
        Listed done;
    };
    struct ListCases {
        std::uint64_t by;
        Cases done;
    };
    struct KeepSeen {
        records::Ledger ledger;
        Done done;
    };
    struct ForgetSeen {
        records::LedgerKey key;
        Done done;
    };
    struct FindSeen {
        records::LedgerKey key;
        Found done;
    };
    struct ListSeen {
        std::string wall;
        Ledgers done;
    };
    using Request = std::variant<Add, List, ListCases, KeepSeen, ForgetSeen, FindSeen, ListSeen>;
    struct Keeping;

    Worker<Request> worker_;
};

}  // namespace haustra::session
