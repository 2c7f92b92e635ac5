// A shortest-path front that closes loops.
#pragma once

#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

namespace haustra::handles {

/// Dijkstra over a mesh's edges from one base vertex after another. Keeps a reference to the mesh;
/// one object to a thread.
class LoopFront {
public:
    explicit LoopFront(const mesh::HalfedgeMesh& mesh)
        : mesh_(mesh),
          distanceMm_(std::size_t(mesh.vertexCount())),
          into_(std::size_t(mesh.vertexCount())),
          stamp_(std::size_t(mesh.vertexCount()), 0),
          settled_(std::size_t(mesh.vertexCount())) {}

    /// Grows from `base` until no loop shorter than `boundMm` can be closed any more, and returns
    /// the half-edge over which the shortest one closes, or −1. By the three-path condition the
    /// shortest non-separating loop through `base` is two of its shortest paths and an edge;
    /// `closes(h)` says whether the loop over edge h between two settled vertices counts.
    /// `reach(h)` is called as the target of h is settled, after its origin.
    template <class Reach, class Closes>
    int run(int base, double boundMm, const Reach& reach, const Closes& closes);

    double distanceMm(int v) const { return distanceMm_[v]; }
    /// Length of the loop that run() returned, with the tail from the base to where its paths part.
    double loopMm() const { return loopMm_; }
    /// The settled vertices, nearest first.
    const std::vector<int>& order() const { return order_; }
    /// The loop over `closing`, less that tail: it visits no vertex twice.
    mesh::Loop loopOver(int closing) const;

private:
    using Entry = std::pair<double, int>;

    void reset() {
        ++now_;
        order_.clear();
        heap_.clear();
        loopMm_ = 0.0;
    }
    void offer(int v, double distance, int into) {
        if (stamp_[v] == now_ && (settled_[v] || distance >= distanceMm_[v])) return;
        stamp_[v] = now_;
        settled_[v] = 0;
        distanceMm_[v] = distance;
        into_[v] = into;
        heap_.push_back({distance, v});
        std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    }
    std::vector<int> pathTo(int v) const {
        std::vector<int> path;
        for (; into_[v] >= 0; v = mesh_.origin(into_[v]))
            path.push_back(into_[v]);
        std::reverse(path.begin(), path.end());
        return path;
    }

    const mesh::HalfedgeMesh& mesh_;
    std::vector<double> distanceMm_;
    std::vector<int> into_, stamp_, order_;
    std::vector<char> settled_;
    std::vector<Entry> heap_;
    double loopMm_ = 0.0;
    int now_ = 0;
};

template <class Reach, class Closes>
int LoopFront::run(int base, double boundMm, const Reach& reach, const Closes& closes) {
    reset();
    offer(base, 0.0, -1);
    int best = -1;
    double bestMm = boundMm;
    while (!heap_.empty()) {
        const auto [distance, v] = heap_.front();
        std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
        heap_.pop_back();
        if (settled_[v] || distance > distanceMm_[v]) continue;
        if (2.0 * distance >= bestMm) break;
        settled_[v] = 1;
        order_.push_back(v);
        if (into_[v] >= 0) reach(into_[v]);
        int h = mesh_.outgoing(v);
        do {
            const int w = mesh_.target(h);
            const double there = distance + mesh_.lengthMm(h);
            if (stamp_[w] == now_ && settled_[w]) {
                if (there + distanceMm_[w] < bestMm && closes(h)) {
                    bestMm = there + distanceMm_[w];
                    best = h;
                }
            } else if (2.0 * there < bestMm) {
                offer(w, there, h);
            }
            h = mesh_.turnLeft(h);
        } while (h != mesh_.outgoing(v));
    }
    loopMm_ = best >= 0 ? bestMm : 0.0;
    return best;
}

inline mesh::Loop LoopFront::loopOver(int closing) const {
    const std::vector<int> out = pathTo(mesh_.origin(closing)),
                           back = pathTo(mesh_.target(closing));
    std::size_t tail = 0;
    while (tail < out.size() && tail < back.size() && out[tail] == back[tail])
        ++tail;
    mesh::Loop loop;
    loop.halfedges.assign(out.begin() + std::ptrdiff_t(tail), out.end());
    loop.halfedges.push_back(closing);
    for (std::size_t i = back.size(); i-- > tail;)
        loop.halfedges.push_back(mesh_.opposite(back[i]));
    for (const int h : loop.halfedges)
        loop.lengthMm += mesh_.lengthMm(h);
    return loop;
}

}  // namespace haustra::handles
