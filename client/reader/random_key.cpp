#include "reader/random_key.h"

#include <cstdint>
#include <random>

namespace haustra::reader {

std::string randomKey() {
    std::random_device random;
    static constexpr char digits[] = "0123456789abcdef";
    std::string key;
    for (int word = 0; word < 4; ++word)
        for (std::uint32_t bits = random(), n = 0; n < 8; ++n, bits >>= 4)
            key += digits[bits & 15];
    return key;
}

}  // namespace haustra::reader
