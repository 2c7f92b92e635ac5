// A cache of a few things that are dear to make.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace haustra::render {

/// Holds at most `most` things; the least recently used one makes room for another.
template <class T>
class LruCache {
public:
    explicit LruCache(std::size_t most) : most_(most) {}

    /// The first that `is(one)`, or null. Valid until the next call of find or keep.
    template <class Is>
    const T* find(const Is& is) {
        const auto found = std::find_if(kept_.begin(), kept_.end(), is);
        if (found == kept_.end()) return nullptr;
        std::rotate(found, found + 1, kept_.end());
        return &kept_.back();
    }
    /// Evicts the least recently used one where there are `most`.
    const T* keep(T one) {
        makeRoom();
        kept_.push_back(std::move(one));
        return &kept_.back();
    }
    /// Evicts what keep() would: its memory is free before another is made.
    void makeRoom() {
        if (kept_.size() == most_) kept_.erase(kept_.begin());
    }
    void clear() { kept_.clear(); }
    const std::vector<T>& all() const { return kept_; }

private:
    std::size_t most_;
    std::vector<T> kept_;  // the most recently used last
};

}  // namespace haustra::render
