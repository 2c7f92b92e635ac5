// Four numbers that are worked on at once.
#pragma once

namespace haustra::cad {

/// Three coordinates and a fourth number that is not used, or what else comes in fours. GCC and
/// clang add, multiply and compare all four by one instruction, on x86-64 and on arm64 (their
/// vector extensions; __builtin_shufflevector from GCC 12 on). A comparison gives FourInts, −1
/// where it holds and 0 where not, and `a < b ? x : y` chooses one by one.
using FourFloats = float __attribute__((vector_size(16)));
using FourInts = int __attribute__((vector_size(16)));

}  // namespace haustra::cad
