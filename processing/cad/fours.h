// Four numbers that are worked on at once.
#pragma once

#include <array>

namespace haustra::cad {

/// Three coordinates and a fourth number that is not used, or what else comes in fours. GCC and
/// clang add, multiply and compare all four by one instruction, on x86-64 and on arm64 (their
/// vector extensions; __builtin_shufflevector from GCC 12 on). A comparison gives FourInts, −1
/// where it holds and 0 where not, and `a < b ? x : y` chooses one by one.
using FourFloats = float __attribute__((vector_size(16)));
using FourInts = int __attribute__((vector_size(16)));

/// The first of each, the second of each, and so on.
inline std::array<FourFloats, 4> transposed(const std::array<FourFloats, 4>& rows) {
    const FourFloats a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 1, 5),
                     b = __builtin_shufflevector(rows[2], rows[3], 0, 4, 1, 5),
                     c = __builtin_shufflevector(rows[0], rows[1], 2, 6, 3, 7),
                     d = __builtin_shufflevector(rows[2], rows[3], 2, 6, 3, 7);
    return {__builtin_shufflevector(a, b, 0, 1, 4, 5), __builtin_shufflevector(a, b, 2, 3, 6, 7),
            __builtin_shufflevector(c, d, 0, 1, 4, 5), __builtin_shufflevector(c, d, 2, 3, 6, 7)};
}

}  // namespace haustra::cad
