// Random numbers that are the same on every machine, and noise that depends on a place alone.
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

namespace haustra::phantom {

/// The SplitMix64 finaliser: a good 64-bit hash of a counter.
inline std::uint64_t mixBits(std::uint64_t x) {
    x += 0x9E3779B97F4A7C15ull;
    x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9ull;
    x = (x ^ (x >> 27)) * 0x94D049BB133111EBull;
    return x ^ (x >> 31);
}

/// A number for each place, roughly normal, of mean 0 and variance 1: the sum of four uniform
/// numbers from one hash.
inline float whiteNoise(std::uint64_t key, std::size_t place) {
    const std::uint64_t h = mixBits(key + place);
    const int sum = int(h & 0xFFFF) + int(h >> 16 & 0xFFFF) + int(h >> 32 & 0xFFFF) + int(h >> 48);
    constexpr float scale = 1.7320508f / 65536.0f;
    return (float(sum) - 131070.0f) * scale;
}

/// A stream of numbers for one purpose. Streams with different names are independent, so that
/// adding a polyp does not move the spine.
class Random {
public:
    Random(std::uint64_t seed, std::uint64_t stream) : key_(mixBits(seed) ^ mixBits(~stream)) {}

    std::uint64_t bits() { return mixBits(key_ + 0xD1B54A32D192ED03ull * ++counter_); }
    double uniform() { return double(bits() >> 11) * 0x1p-53; }
    double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
    /// 0 … count − 1.
    int index(int count) { return int(uniform() * count); }
    bool chance(double probability) { return uniform() < probability; }
    /// Mean 0, standard deviation 1, never beyond ±3.5: the sum of twelve uniform numbers.
    double normal() {
        double sum = -6.0;
        for (int n = 0; n < 12; ++n)
            sum += uniform();
        return std::fmin(std::fmax(sum, -3.5), 3.5);
    }
    glm::dvec3 normal3() {
        const double x = normal(), y = normal(), z = normal();
        return {x, y, z};
    }

private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

/// Smooth noise in [−1, 1] with features of `featureMm`: random values on a cubic lattice,
/// blended with smoothstep weights.
inline double valueNoise(std::uint64_t seed, glm::dvec3 p, double featureMm) {
    const glm::dvec3 q = p / featureMm;
    const glm::dvec3 cell = glm::floor(q);
    const glm::dvec3 f = q - cell;
    const glm::dvec3 w = f * f * (3.0 - 2.0 * f);
    const std::uint64_t x = std::uint64_t(std::int64_t(cell.x)),
                        y = std::uint64_t(std::int64_t(cell.y)),
                        z = std::uint64_t(std::int64_t(cell.z));
    auto at = [&](int i, int j, int k) {
        const std::uint64_t h =
            mixBits(seed ^ ((x + i) * 0x8DA6B343u + (y + j) * 0xD8163841u * 0x10001u +
                            (z + k) * 0xCB1AB31Full * 0x100000001ull));
        return double(h >> 11) * 0x1p-52 - 1.0;
    };
    auto alongX = [&](int j, int k) { return at(0, j, k) * (1.0 - w.x) + at(1, j, k) * w.x; };
    auto alongY = [&](int k) { return alongX(0, k) * (1.0 - w.y) + alongX(1, k) * w.y; };
    return alongY(0) * (1.0 - w.z) + alongY(1) * w.z;
}

}  // namespace haustra::phantom
