// Memory that is zero until it is written to.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>

namespace haustra {

/// `size` numbers, all 0. Of one that is made of fresh memory only the pages that are touched are
/// ever held, so that where little of it is used it costs little: a vector of zeros writes all.
/// Indices are not checked: it is for what is asked in innermost loops.
template <class T>
class ZeroedArray {
    static_assert(std::is_arithmetic_v<T>);

public:
    explicit ZeroedArray(std::size_t size)
        : values_(static_cast<T*>(std::calloc(size > 0 ? size : 1, sizeof(T)))) {
        if (!values_) throw std::bad_alloc();
    }
    T& operator[](std::size_t n) { return values_.get()[n]; }
    const T& operator[](std::size_t n) const { return values_.get()[n]; }

private:
    struct Free {
        void operator()(T* values) const { std::free(values); }
    };
    std::unique_ptr<T[], Free> values_;
};

}  // namespace haustra
