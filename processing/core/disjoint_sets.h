// Disjoint sets of numbers, kept as a forest (union–find).
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace haustra {

/// The number that stands for the set of `n`: the root of its tree. parentOf(n) is a reference to
/// the next number towards it, a root's own number. Halves the path that it walks. O(log n)
/// amortised.
template <class Number, class ParentOf>
Number rootOf(const ParentOf& parentOf, Number n) {
    while (parentOf(n) != n)
        n = parentOf(n) = parentOf(parentOf(n));
    return n;
}

/// The same with the parents in a vector; at first, parent[n] = n.
template <class Number>
Number rootOf(std::vector<Number>& parent, Number n) {
    return rootOf([&](Number m) -> Number& { return parent[std::size_t(m)]; }, n);
}

/// Makes one set of two; the lower of both roots stands for it.
template <class Number>
void unite(std::vector<Number>& parent, Number a, Number b) {
    a = rootOf(parent, a), b = rootOf(parent, b);
    parent[std::size_t(std::max(a, b))] = std::min(a, b);
}

}  // namespace haustra
