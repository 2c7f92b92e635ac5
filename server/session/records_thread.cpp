#include "session/records_thread.h"

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
    CaseReader cases;
    std::vector<Add> additions;  // since the last commit

    void commit() {
        if (additions.empty()) return;
        auto waiting = std::exchange(additions, {});
        auto added = guarded([&] {
            std::vector<records::NewBookmark> batch;
            for (Add& add : waiting)
                batch.push_back(std::move(add.bookmark));
            return bookmarks.add(batch);
        });
        for (std::size_t n = 0; n < waiting.size(); ++n) {
            if (added)
                waiting[n].done(std::move((*added)[n]));
            else
                waiting[n].done(tl::make_unexpected(added.error()));
        }
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
};

RecordsThread::RecordsThread(records::BookmarkStore bookmarks, store::CaseStore cases) {
    worker_.start("records", maxSharedCommit,
                  [keeping = Keeping{std::move(bookmarks), CaseReader(std::move(cases)), {}}](
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

}  // namespace haustra::session
