// What a hostile server says: sound messages made unsound, a field or a few at a time.
#pragma once

#include "protocol/haustra.pb.h"

#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

namespace haustra::bench {

using Random = std::mt19937_64;

/// From 0 to `most`.
std::uint64_t pick(Random& random, std::uint64_t most);
bool chance(Random& random, double share);
/// No number, infinite, huge, tiny, negative or nothing special.
double wildNumber(Random& random);
/// Empty, huge, with lines, markup, controls, or written from the right.
std::string wildText(Random& random, std::size_t mostBytes = 1'000'000);

/// A way to lie: `tell` changes a sound message of that sort, or makes one of nothing.
struct Lie {
    std::string name;
    protocol::ServerMessage::BodyCase of;
    std::function<void(Random&, protocol::ServerMessage&)> tell;
};
const std::vector<Lie>& lies();

/// Changes bytes of the encoded message, so that it may still be one.
void mutateBytes(Random& random, std::vector<std::uint8_t>& bytes, std::size_t from);

}  // namespace haustra::bench
