#include "handles/loop_search.h"

#include "core/parallel.h"
#include "handles/loop_front.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <mutex>

namespace haustra::handles {
namespace {

constexpr std::size_t batchSize = 16;  // fixed, so that the threads' number changes no bound
constexpr double slack = 1.25;  // how far past the best length a front looks, to rule out places
constexpr long mostSettled = 12'000'000;  // vertices, by all fronts: an end for very long loops

class Search {
public:
    Search(const mesh::HalfedgeMesh& mesh, const std::vector<std::uint64_t>& marks,
           const LoopSearchOptions& options)
        : mesh_(mesh),
          marks_(marks),
          options_(options),
          ruledOut_(std::size_t(mesh.vertexCount()), 0) {}

    /// Tries base vertices in order until `effort` vertices have been settled in all.
    void visit(const std::vector<int>& bases, long effort) {
        for (std::size_t next = 0; next < bases.size() && effort_ < effort;) {
            // One front alone while there is no bound: it may flood the whole mesh.
            const std::size_t most = best_.halfedges.empty() ? 1 : batchSize;
            std::vector<int> batch;
            for (; next < bases.size() && batch.size() < most; ++next) {
                if (!ruledOut_[bases[next]]) batch.push_back(bases[next]);
            }
            tryBatch(batch);
        }
    }

    /// Seeks through the loop's own vertices, which can only shorten it, until nothing does.
    void settle() {
        for (double before = std::numeric_limits<double>::infinity();
             best_.lengthMm < before && !best_.halfedges.empty();) {
            before = best_.lengthMm;
            const std::size_t count = best_.halfedges.size();
            std::vector<int> bases;
            for (std::size_t i = 0; i < 8; ++i)
                bases.push_back(mesh_.origin(best_.halfedges[i * count / 8]));
            for (const int base : bases)
                ruledOut_[base] = 0;
            visit(bases, std::numeric_limits<long>::max());
        }
    }

    const mesh::Loop& best() const { return best_; }

private:
    struct Front {
        explicit Front(const mesh::HalfedgeMesh& mesh)
            : front(mesh), sums(std::size_t(mesh.vertexCount())) {}
        LoopFront front;
        std::vector<std::uint64_t> sums;
    };
    struct Outcome {
        mesh::Loop loop;
        std::vector<int> ruledOut;
        long settled = 0;
    };

    bool counts(std::uint64_t sum) const {
        const auto& passed = options_.passOver;
        return sum != 0 && std::find(passed.begin(), passed.end(), sum) == passed.end();
    }

    Outcome through(int base, double boundMm, Front& work) const {
        LoopFront& front = work.front;
        auto& sums = work.sums;
        sums[base] = 0;
        const double lookMm = boundMm * slack;
        const int closing = front.run(
            base, lookMm, [&](int h) { sums[mesh_.target(h)] = sums[mesh_.origin(h)] ^ marks_[h]; },
            [&](int h) {
                return counts(sums[mesh_.origin(h)] ^ marks_[h] ^ sums[mesh_.target(h)]);
            });
        Outcome outcome;
        outcome.settled = long(front.order().size());
        // A loop through v is at most 2·d(base, v) shorter than the shortest through the base.
        const double lengthMm = closing >= 0 ? front.loopMm() : lookMm;
        const double beatenMm =
            closing >= 0 ? std::min(boundMm, front.loopOver(closing).lengthMm) : boundMm;
        for (const int v : front.order()) {
            if (!(lengthMm - 2.0 * front.distanceMm(v) >= beatenMm)) break;
            outcome.ruledOut.push_back(v);
        }
        if (closing >= 0) outcome.loop = front.loopOver(closing);
        return outcome;
    }

    std::unique_ptr<Front> takeFront() {
        const std::lock_guard lock(mutex_);
        if (idle_.empty()) return std::make_unique<Front>(mesh_);
        auto front = std::move(idle_.back());
        idle_.pop_back();
        return front;
    }

    void tryBatch(const std::vector<int>& batch) {
        const double boundMm =
            best_.halfedges.empty() ? std::numeric_limits<double>::infinity() : best_.lengthMm;
        std::vector<Outcome> outcomes(batch.size());
        parallelFor(batch.size(), 1, options_.threads, [&](std::size_t begin, std::size_t end) {
            auto front = takeFront();
            for (std::size_t i = begin; i < end; ++i)
                outcomes[i] = through(batch[i], boundMm, *front);
            const std::lock_guard lock(mutex_);
            idle_.push_back(std::move(front));
        });
        for (std::size_t i = 0; i < batch.size(); ++i) {
            effort_ += outcomes[i].settled;
            ruledOut_[batch[i]] = 1;
            for (const int v : outcomes[i].ruledOut)
                ruledOut_[v] = 1;
            if (!outcomes[i].loop.halfedges.empty() &&
                (best_.halfedges.empty() || outcomes[i].loop.lengthMm < best_.lengthMm))
                best_ = std::move(outcomes[i].loop);
        }
    }

    const mesh::HalfedgeMesh& mesh_;
    const std::vector<std::uint64_t>& marks_;
    const LoopSearchOptions& options_;
    std::vector<char> ruledOut_;
    std::vector<std::unique_ptr<Front>> idle_;
    std::mutex mutex_;
    mesh::Loop best_;
    long effort_ = 0;
};

/// The starts of marked edges, in an order that leaps about: neighbours are then often ruled out.
std::vector<int> crossings(const mesh::HalfedgeMesh& mesh,
                           const std::vector<std::uint64_t>& marks) {
    std::vector<char> marked(std::size_t(mesh.vertexCount()), 0);
    for (int h = 0; h < mesh.halfedgeCount(); ++h) {
        if (marks[h] && mesh.origin(h) < mesh.target(h)) marked[mesh.origin(h)] = 1;
    }
    std::vector<int> found, leaping;
    for (int v = 0; v < mesh.vertexCount(); ++v) {
        if (marked[v]) found.push_back(v);
    }
    constexpr std::size_t stride = 61;
    for (std::size_t first = 0; first < stride; ++first) {
        for (std::size_t i = first; i < found.size(); i += stride)
            leaping.push_back(found[i]);
    }
    return leaping;
}

}  // namespace

mesh::Loop shortestLoop(const mesh::HalfedgeMesh& mesh, const std::vector<std::uint64_t>& marks,
                        const std::vector<int>& near, const LoopSearchOptions& options) {
    Search search(mesh, marks, options);
    search.visit(near, mostSettled / 2);
    search.visit(crossings(mesh, marks), mostSettled);
    search.settle();
    return search.best();
}

}  // namespace haustra::handles
