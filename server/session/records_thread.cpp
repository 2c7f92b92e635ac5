#include "session/records_thread.h"

#include "protocol/limits.h"
#include "session/worker.h"

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
    std::vector<Add> additions;  // since the last commit
    std::vector<KeepSeen> kept;  // likewise

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
        list.done(guarded([&] { return cases.read(bookmarks); }));
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
             Keeping{std::move(bookmarks), std::move(seen), CaseReader(std::move(cases)), {}, {}}](
            auto& taken) mutable {
            for (Request& request : taken)
                std::visit([&](auto& body) { keeping.serve(body); }, request);
            keeping.commit();
        });
}

void RecordsThread::add(records::NewBookmark bookmark, Added done) {
    worker_.push(Add{std::move(bookmark), std::move(done)});
}
void RecordsThread::list(std::string caseName, std::string scan, Listed done) {
    worker_.push(List{std::move(caseName), std::move(scan), std::move(done)});
}
void RecordsThread::listCases(Cases done) {
    worker_.push(ListCases{std::move(done)});
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
