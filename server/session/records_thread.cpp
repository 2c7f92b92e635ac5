#include "session/records_thread.h"

#include "protocol/limits.h"
#include "session/worker.h"

#include <deque>
#include <set>
#include <utility>

namespace haustra::session {
namespace {

// Bounds how long the first of a burst waits for its acknowledgement.
constexpr std::size_t maxSharedCommit = 256;

}  // namespace

// What lives on the records thread.
struct RecordsThread::Keeping {
    records::BookmarkStore bookmarks;
    records::SeenStore seen;
    CaseReader cases;
    std::vector<Add> additions;                              // since the last commit
    std::vector<KeepSeen> kept;                              // likewise
    std::optional<Result<std::vector<CaseSummary>>> listed;  // of this batch

    // Nobody's acknowledgement waits for what others read.
    void serve(std::deque<Request>& batch) {
        listed.reset();
        std::set<std::uint64_t> readers;
        std::vector<Request*> inOrder;
        for (Request& request : batch) {
            Add* const add = std::get_if<Add>(&request);
            if (add && !readers.contains(add->by)) {
                serve(*add);
                continue;
            }
            inOrder.push_back(&request);
            std::visit(
                [&](const auto& body) {
                    if constexpr (requires { body.by; }) readers.insert(body.by);
                },
                request);
        }
        for (Request* const request : inOrder)
            std::visit([&](auto& body) { serve(body); }, *request);
        commit();
    }

    /// Gives each that waits its part of what `store` makes of all.
    template <class Waiting, class Store>
    static void commit(std::vector<Waiting>& waiting, const Store& store) {
        if (waiting.empty()) return;
        auto all = std::exchange(waiting, {});
        auto done = guarded([&] { return store(all); });
        for (std::size_t n = 0; n < all.size(); ++n) {
            if (done)
                all[n].done(std::move((*done)[n]));
            else
                all[n].done(tl::make_unexpected(done.error()));
        }
    }
    void commit() {
        if (!additions.empty()) listed.reset();  // cases have more bookmarks now
        commit(additions, [&](std::vector<Add>& waiting) {
            std::vector<records::NewBookmark> batch;
            for (Add& add : waiting)
                batch.push_back(std::move(add.bookmark));
            return bookmarks.add(batch);
        });
        commit(kept, [&](std::vector<KeepSeen>& waiting) {
            std::vector<records::Ledger> batch;
            for (KeepSeen& keep : waiting)
                batch.push_back(std::move(keep.ledger));
            return seen.keep(batch);
        });
    }

    void serve(Add& add) { additions.push_back(std::move(add)); }
    void serve(List& list) {
        commit();
        list.done(guarded([&] {
            return bookmarks.adopt(list.caseName, list.scan).and_then([&] {
                return bookmarks.list(list.scan);
            });
        }));
    }
    void serve(ListCases& list) {
        commit();
        if (!listed) listed = guarded([&] { return cases.read(bookmarks); });
        list.done(*listed);
    }
    void serve(KeepSeen& keep) { kept.push_back(std::move(keep)); }
    void serve(ForgetSeen& forget) {
        commit();
        forget.done(guarded([&] { return seen.forget(forget.key); }));
    }
    void serve(FindSeen& find) {
        commit();
        find.done(guarded([&] { return seen.find(find.key); }));
    }
    void serve(ListSeen& list) {
        commit();
        list.done(guarded([&] { return seen.ofWall(list.wall, protocol::maxReportedLedgers); }));
    }
};

RecordsThread::RecordsThread(records::BookmarkStore bookmarks, records::SeenStore seen,
                             store::CaseStore cases) {
    worker_.start(
        "records", maxSharedCommit,
        [keeping =
             Keeping{
                 std::move(bookmarks), std::move(seen), CaseReader(std::move(cases)), {}, {}, {}}](
            auto& taken) mutable { keeping.serve(taken); });
}

void RecordsThread::add(std::uint64_t by, records::NewBookmark bookmark, Added done) {
    worker_.push(Add{by, std::move(bookmark), std::move(done)});
}
void RecordsThread::list(std::uint64_t by, std::string caseName, std::string scan, Listed done) {
    worker_.push(List{by, std::move(caseName), std::move(scan), std::move(done)});
}
void RecordsThread::listCases(std::uint64_t by, Cases done) {
    worker_.push(ListCases{by, std::move(done)});
}
void RecordsThread::keepSeen(records::Ledger ledger, Done done) {
    worker_.push(KeepSeen{std::move(ledger), std::move(done)});
}
void RecordsThread::forgetSeen(records::LedgerKey key, Done done) {
    worker_.push(ForgetSeen{std::move(key), std::move(done)});
}
void RecordsThread::findSeen(records::LedgerKey key, Found done) {
    worker_.push(FindSeen{std::move(key), std::move(done)});
}
void RecordsThread::listSeen(std::string wall, Ledgers done) {
    worker_.push(ListSeen{std::move(wall), std::move(done)});
}

}  // namespace haustra::session
