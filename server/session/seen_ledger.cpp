#include "session/seen_ledger.h"

#include "core/missed_patches.h"
#include "protocol/limits.h"

#include <algorithm>
#include <utility>

#include <asio/post.hpp>
#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

constexpr int maxLooks = 64;  // of a ledger, that wait

// On the paint thread.
Result<ReaderSeen> readerOf(SeenWork& work, const records::Ledger& ledger, double leastMm2) {
    render::WallCoverage coverage(work.of().wall->painter->sharedSight(), ledger.key.limits);
    if (ledger.times.size() != coverage.times().size())
        return fail(ErrorKind::io, "the record of what a reader has seen is of another wall",
                    "records");
    coverage.add(ledger.times);
    return ReaderSeen{ledger.key, coverage.share(), ledger.changedUtc,
                      missedOf(work.of(), coverage.seenTriangles(), leastMm2,
                               protocol::maxReportedPatches, false)};
}

using Readers = std::vector<ReaderSeen>;

// What each reader has missed, one task of the paint thread after the other: others have their
// turns between. By way of the io thread, which ends before the paint thread does.
class ReaderByReader : public std::enable_shared_from_this<ReaderByReader> {
public:
    ReaderByReader(asio::any_io_executor io, PaintThread& painting, std::shared_ptr<SeenWork> work,
                   double leastMm2, std::weak_ptr<const void> asker,
                   std::function<void(Result<Readers>)> told)
        : io_(std::move(io)),
          painting_(painting),
          work_(std::move(work)),
          leastMm2_(leastMm2),
          asker_(std::move(asker)),
          told_(std::move(told)) {}

    bool wanted() const { return !asker_.expired(); }
    void fail(const Error& error) { told_(tl::make_unexpected(error)); }
    // After those who have no ledger that is kept.
    void start(Readers first, std::vector<records::Ledger> ledgers) {
        readers_ = std::move(first);
        ledgers_ = std::move(ledgers);
        next();
    }

private:
    void next() {
        if (!wanted()) return;
        if (at_ == ledgers_.size() || readers_.size() == std::size_t(protocol::maxReportedLedgers))
            return told_(std::move(readers_));
        painting_.push([self = shared_from_this(), &ledger = ledgers_[at_++]] {
            auto reader = guarded([&] { return readerOf(*self->work_, ledger, self->leastMm2_); });
            asio::post(self->io_, [self, reader = std::move(reader)]() mutable {
                self->found(std::move(reader));
            });
        });
    }
    void found(Result<ReaderSeen> reader) {
        if (!reader) return fail(reader.error());
        readers_.push_back(std::move(*reader));
        next();
    }

    asio::any_io_executor io_;
    PaintThread& painting_;
    std::shared_ptr<SeenWork> work_;
    double leastMm2_;
    std::weak_ptr<const void> asker_;
    std::function<void(Result<Readers>)> told_;
    Readers readers_;
    std::vector<records::Ledger> ledgers_;
    std::size_t at_ = 0;  // of ledgers_, the next
};

}  // namespace

Missed missedOf(const SeenWall& of, std::span<const std::uint8_t> seen, double leastMm2, int most,
                bool views) {
    const render::WallSight& sight = of.wall->painter->sight();
    Missed missed;
    for (const MissedPatch& patch : missedPatches(sight.map().surface, sight.neighbours(), seen,
                                                  sight.bridges(), of.centerline, leastMm2)) {
        ++missed.count;
        missed.areaMm2 += patch.areaMm2;
        if (int(missed.patches.size()) == most) continue;
        WallPlace place = of.wall->lookup.nearest(patch.centerMm);
        place.arcMm = patch.arcMm;
        std::optional<Camera> view;
        if (views) view = render::reviewCamera(sight, patch, of.centerline);
        missed.patches.push_back({patch.areaMm2, place, view});
    }
    return missed;
}

SeenLedger::SeenLedger(asio::any_io_executor io, PaintThread& painting, RecordsThread& records,
                       const OpenCase& of, records::LedgerKey key)
    : io_(std::move(io)),
      painting_(painting),
      records_(records),
      caseName_(of.name),
      scan_(of.scan),
      key_(std::move(key)),
      work_(std::make_shared<SeenWork>(SeenWall{of.wall, of.centerline}, key_.limits)),
      recorded_(!key_.reader.empty()),
      later_(io_) {}

SeenLedger::~SeenLedger() {
    for (const auto& waiting : std::exchange(whenLoaded_, {}))
        waiting(false);
    flush();
}

// By way of the paint thread, as what is written: whoever had this ledger before has written it.
void SeenLedger::load(std::function<void()> done) {
    loadDone_ = std::move(done);
    if (!recorded_) return loaded({});
    painting_.push([weak = weak_from_this(), io = io_, &records = records_, key = key_] {
        records.findSeen(key, [weak, io](Result<std::optional<records::Ledger>> found) {
            postTo(io, weak, [found = std::move(found)](SeenLedger& self) mutable {
                self.found(std::move(found));
            });
        });
    });
}

void SeenLedger::found(Result<std::optional<records::Ledger>> kept) {
    if (!kept) return loaded(tl::make_unexpected(kept.error()));
    if (!*kept) return loaded({});
    painting_.push([weak = weak_from_this(), io = io_, work = work_,
                    times = std::move((*kept)->times)] {
        auto read = guarded([&]() -> Result<void> {
            render::WallCoverage& coverage = work->coverage();
            if (times.size() != coverage.times().size())
                return fail(ErrorKind::io,
                            "the record of what a reader has seen is of another wall", "records");
            coverage.add(times);
            return {};
        });
        postTo(io, weak, [read = std::move(read)](SeenLedger& self) mutable {
            self.loaded(std::move(read));
        });
    });
}

// What cannot be read is not written over.
void SeenLedger::loaded(Result<void> read) {
    loaded_ = true;
    if (!read) {
        spdlog::error("what a reader has seen is not kept: {}", read.error().message);
        recorded_ = false;
        news_.tell({0.0, 0, false, read.error()});
    }
    for (const auto& waiting : std::exchange(whenLoaded_, {}))
        waiting(true);
    writeSoon();
    std::exchange(loadDone_, {})();
}

void SeenLedger::broken(const std::string& what) {
    spdlog::error("a reader's ledger fails: {}", what);
}

// ---- taking in ----------------------------------------------------------------------------------

std::uint64_t SeenLedger::take(std::vector<ShownPicture> pictures) {
    ++asked_;
    for (ShownPicture& picture : pictures) {
        if (looks_ < maxLooks) {
            look(std::move(picture));
        } else if (!picture.moving) {
            if (still_ && still_->shown == picture.shown && still_->size == picture.size)
                picture.microseconds += still_->microseconds;
            still_ = std::move(picture);
        }
    }
    // An empty one: that all before it has been looked at.
    if (looks_ == 0) took(asked_, 0);
    return asked_;
}

void SeenLedger::look(ShownPicture picture) {
    ++looks_;
    painting_.push([weak = weak_from_this(), io = io_, work = work_, step = asked_,
                    picture = std::move(picture)] {
        const auto added = guarded([&]() -> Result<int> {
            return work->coverage().show(picture.shown, picture.size, picture.microseconds);
        });
        postTo(io, weak, [step, added](SeenLedger& self) {
            --self.looks_;
            self.took(step, added);
        });
    });
}

void SeenLedger::took(std::uint64_t step, Result<int> added) {
    if (auto still = std::exchange(still_, std::nullopt)) look(std::move(*still));
    if (!added) spdlog::error("a wall cannot be looked at: {}", added.error().message);
    // Of a step's pictures the last one tells that all have been looked at.
    taken_ = looks_ == 0 ? asked_ : std::max(taken_, step - 1);
    changed_ |= added && *added > 0;
    writeSoon();
}

// ---- keeping ------------------------------------------------------------------------------------

void SeenLedger::writeSoon() {
    if (!loaded_ || writing_ || taken_ == told_) return;
    if (nextWrite_ <= std::chrono::steady_clock::now()) return write();
    later_.expires_at(nextWrite_);
    later_.async_wait([weak = weak_from_this()](const asio::error_code& error) {
        const auto self = weak.lock();
        if (error || !self || self->writing_ || self->taken_ == self->told_) return;
        self->write();
    });
}

void SeenLedger::write() {
    later_.cancel();
    writing_ = true;
    nextWrite_ = std::chrono::steady_clock::now() + ledgerEvery;
    const bool keeps = std::exchange(changed_, false) && recorded_;
    painting_.push([weak = weak_from_this(), io = io_, &records = records_, work = work_,
                    step = taken_, keeps, ledger = record()]() mutable {
        const auto told = [weak, io, step](Result<double> share) {
            postTo(io, weak, [step, share = std::move(share)](SeenLedger& self) mutable {
                self.wrote(step, std::move(share));
            });
        };
        auto share = guarded([&]() -> Result<double> {
            if (keeps) ledger.times = work->coverage().times();
            return work->coverage().share();
        });
        if (!share || !keeps) return told(std::move(share));
        records.keepSeen(std::move(ledger), [told, share = *share](Result<void> kept) {
            told(kept.map([&] { return share; }));
        });
    });
}

void SeenLedger::wrote(std::uint64_t step, Result<double> share) {
    writing_ = false;
    if (share) {
        told_ = std::max(told_, step);
        news_.tell({*share, told_, recorded_, std::nullopt});
    } else {
        spdlog::error("what a reader has seen cannot be kept: {}", share.error().message);
        changed_ = true;
        nextWrite_ = std::chrono::steady_clock::now() + ledgerAgainAfter;
        if (share.error().kind != ErrorKind::io) recorded_ = false;  // to try again is of no use
        news_.tell({0.0, 0, recorded_, share.error()});
    }
    writeSoon();
}

records::Ledger SeenLedger::record() const {
    return {key_, caseName_, scan_, {}};
}

void SeenLedger::flush() {
    if (!recorded_ || (looks_ == 0 && !changed_ && !writing_)) return;
    painting_.push([&records = records_, work = work_, ledger = record()]() mutable {
        const auto made = guarded([&]() -> Result<void> {
            ledger.times = work->coverage().times();
            return {};
        });
        if (!made)
            spdlog::error("what a reader has seen last is lost: {}", made.error().message);
        else
            records.keepSeen(std::move(ledger), [](Result<void> kept) {
                if (!kept)
                    spdlog::error("what a reader has seen last is lost: {}", kept.error().message);
            });
    });
}

// ---- questions ----------------------------------------------------------------------------------

template <class T>
void SeenLedger::onPaintThread(std::function<Result<T>(SeenWork&)> what,
                               std::function<void(Result<T>)> told) {
    if (!loaded_) {
        whenLoaded_.push_back([this, what = std::move(what), told = std::move(told)](bool loaded) {
            if (loaded) return onPaintThread(what, told);
            told(fail(ErrorKind::wrongState, "the case has been left", "seen"));
        });
        return;
    }
    painting_.push([io = io_, work = work_, what = std::move(what), told = std::move(told)] {
        auto answer = guarded([&] { return what(*work); });
        asio::post(io, [told, answer = std::move(answer)]() mutable { told(std::move(answer)); });
    });
}

void SeenLedger::ask(std::function<void(Result<double>)> told) {
    onPaintThread<double>([](SeenWork& work) -> Result<double> { return work.coverage().share(); },
                          std::move(told));
}

// The record goes in the same step of the paint thread: what is looked at after it is kept.
void SeenLedger::forget(std::function<void(Result<double>)> told) {
    if (!loaded_) {
        whenLoaded_.push_back([this, told = std::move(told)](bool loaded) {
            if (loaded) return forget(told);
            told(fail(ErrorKind::wrongState, "the case has been left", "seen"));
        });
        return;
    }
    still_.reset();
    const auto gone = [io = io_, told](Result<void> forgotten) {
        asio::post(io, [told, forgotten = std::move(forgotten)] {
            told(forgotten.map([] { return 0.0; }));
        });
    };
    onPaintThread<bool>(
        [&records = records_, key = key_, recorded = recorded_,
         gone](SeenWork& work) -> Result<bool> {
            work.coverage().forget();
            if (recorded) records.forgetSeen(key, gone);
            return recorded;
        },
        [told](Result<bool> recorded) {
            if (!recorded) return told(tl::make_unexpected(recorded.error()));
            if (!*recorded) told(0.0);
        });
}

void SeenLedger::missed(double leastMm2, std::function<void(Result<Missed>)> told) {
    onPaintThread<Missed>(
        [leastMm2](SeenWork& work) -> Result<Missed> {
            const auto seen = work.coverage().seenTriangles();
            Missed missed = missedOf(work.of(), seen, leastMm2, protocol::maxMissedPatches, true);
            missed.share = work.coverage().share();
            return missed;
        },
        std::move(told));
}

void SeenLedger::flags(std::function<void(Result<SeenFlags>)> told) {
    onPaintThread<SeenFlags>(
        [](SeenWork& work) -> Result<SeenFlags> {
            const render::WallCoverage& coverage = work.coverage();
            return SeenFlags{coverage.shownTriangles(), coverage.seenTriangles(), coverage.share()};
        },
        std::move(told));
}

void SeenLedger::report(double leastMm2, std::weak_ptr<const void> asker,
                        std::function<void(Result<Readers>)> told) {
    flush();
    const auto report = std::make_shared<ReaderByReader>(io_, painting_, work_, leastMm2,
                                                         std::move(asker), std::move(told));
    onPaintThread<Readers>(
        [leastMm2, recorded = recorded_, key = key_](SeenWork& work) -> Result<Readers> {
            Readers readers;
            if (!recorded)
                readers.push_back({key,
                                   work.coverage().share(),
                                   {},
                                   missedOf(work.of(), work.coverage().seenTriangles(), leastMm2,
                                            protocol::maxReportedPatches, false)});
            return readers;
        },
        [&records = records_, io = io_, wall = key_.wall, report](Result<Readers> own) {
            if (!own) return report->fail(own.error());
            if (!report->wanted()) return;
            records.listSeen(wall, [io, report, own = std::move(*own)](
                                       Result<std::vector<records::Ledger>> kept) mutable {
                asio::post(io, [report, own = std::move(own), kept = std::move(kept)]() mutable {
                    if (!kept) return report->fail(kept.error());
                    report->start(std::move(own), std::move(*kept));
                });
            });
        });
}

std::shared_ptr<SeenLedger> SeenLedgers::of(const std::string& reader, const OpenCase& of,
                                            const SeenLimits& limits) {
    records::LedgerKey key{reader, of.wall->content, limits};
    std::erase_if(ledgers_, [](const auto& known) { return known.expired(); });
    for (const auto& known : ledgers_)
        if (auto ledger = known.lock(); ledger && !reader.empty() && ledger->key() == key)
            return ledger;
    auto ledger = std::make_shared<SeenLedger>(io_, painting_, records_, of, std::move(key));
    ledgers_.push_back(ledger);
    loading_.push_back(ledger);
    ledger->load([this, loaded = ledger.get()] {
        std::erase_if(loading_, [&](const auto& one) { return one.get() == loaded; });
    });
    return ledger;
}

}  // namespace haustra::session
