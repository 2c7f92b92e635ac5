// A few things that are dear to make, kept while they are asked for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace haustra::render {

/// Keeps the `most` that were asked for last.
template <class T>
class LatelyUsed {
public:
    explicit LatelyUsed(std::size_t most) : most_(most) {}

    /// The first that `is(one)`, or null. Valid until the next call of find or keep.
    template <class Is>
    const T* find(const Is& is) {
        const auto found = std::find_if(kept_.begin(), kept_.end(), is);
        if (found == kept_.end()) return nullptr;
        std::rotate(found, found + 1, kept_.end());
        return &kept_.back();
    }
    /// In the place of the one that was not asked for the longest, where there are `most`.
    const T* keep(T one) {
        makeRoom();
        kept_.push_back(std::move(one));
        return &kept_.back();
    }
    /// Drops the one that keep() would: its memory is free before another is made.
    void makeRoom() {
        if (kept_.size() == most_) kept_.erase(kept_.begin());
    }
    void clear() { kept_.clear(); }
    const std::vector<T>& all() const { return kept_; }

private:
    std::size_t most_;
    std::vector<T> kept_;  // the latest used last
};

}  // namespace haustra::render
