#include "phantom/streaks.h"

#include "core/parallel.h"
#include "phantom/random.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace haustra::phantom {
namespace {

constexpr int angleCount = 240;
constexpr double pixelMm = 1.5, mostLog = 3.0, hardeningShare = 0.4;

/// One slice's rays and pictures, on square pixels of `mm`, `n` a side.
class Fan {
public:
    Fan(const Grid& grid, int firstOfAll, const Streaks& streaks)
        : fine_(grid.size), spacing_(grid.spacingMm()), streaks_(streaks), firstOfAll_(firstOfAll) {
        const double sideMm = std::max(fine_.x * spacing_.x, fine_.y * spacing_.y);
        mm_ = std::max({pixelMm, spacing_.x, spacing_.y});
        n_ = int(std::ceil(sideMm / mm_));
        bins_ = 2 * (int(std::ceil(0.5 * std::numbers::sqrt2 * n_)) + 2) + 1;
        for (int a = 0; a < angleCount; ++a) {
            const double angle = std::numbers::pi * (a + 0.5) / angleCount;
            across_.push_back({std::cos(angle), std::sin(angle)});
        }
        key_ = mixBits(streaks.seed ^ 0x73747265616Bull);
        // Noise of variance 1 in all rays gives a pixel the variance π²/angles · c · Σ h²: h is the
        // filter, Σ h² = 1/12, and c = 0.464 what interpolation between two bins leaves on average.
        noiseGain_ = streaks.noiseHu /
                     std::sqrt(std::numbers::pi * std::numbers::pi / angleCount * 0.464 / 12.0);
    }

    /// Adds nothing and is false where there is nothing to add.
    bool streaks(const float* hu, int slice, float* out) {
        water_.assign(std::size_t(n_) * n_, 0.0f);
        metal_.assign(water_.size(), 0.0f);
        const bool metal = shrink(hu);
        if (streaks_.noiseHu <= 0.0 && !metal) return false;
        picture_.assign(water_.size(), 0.0f);
        for (int a = 0; a < angleCount; ++a) {
            project(water_, a, waterRay_);
            ray_.assign(std::size_t(bins_), 0.0);
            if (streaks_.noiseHu > 0.0) addNoise(slice, a);
            if (metal) {
                project(metal_, a, metalRay_);
                // −ln cosh (0.4 m), the hardening, in the unit of the rays' noise: HU.
                for (int b = 0; b < bins_; ++b)
                    ray_[std::size_t(b)] -=
                        std::log(std::cosh(hardeningShare * metalRay_[std::size_t(b)])) * 1e3 /
                        (waterPerMm * mm_);
            }
            filter();
            backproject(a);
        }
        enlarge(out);
        return true;
    }

private:
    double offset(int pixel) const { return pixel - 0.5 * (n_ - 1); }

    /// Means of the slice on the pixels, as attenuation per pixel; whether there is metal.
    bool shrink(const float* hu) {
        bool metal = false;
        const float perPixel = float(waterPerMm * mm_),
                    part = float(spacing_.x * spacing_.y / (mm_ * mm_)) * perPixel;
        for (int j = 0; j < fine_.y; ++j) {
            const int y =
                std::clamp(int((j - 0.5 * (fine_.y - 1)) * spacing_.y / mm_ + 0.5 * n_), 0, n_ - 1);
            for (int i = 0; i < fine_.x; ++i) {
                const int x = std::clamp(
                    int((i - 0.5 * (fine_.x - 1)) * spacing_.x / mm_ + 0.5 * n_), 0, n_ - 1);
                const float value = hu[std::size_t(j) * fine_.x + i];
                const std::size_t at = std::size_t(y) * n_ + x;
                const float share = part * std::max(0.0f, 1.0f + value * 1e-3f);
                water_[at] += share;
                if (streaks_.hardening && value > metalHu) metal_[at] += share, metal = true;
            }
        }
        return metal;
    }

    void project(const std::vector<float>& picture, int angle, std::vector<double>& ray) const {
        ray.assign(std::size_t(bins_), 0.0);
        const glm::dvec2 across = across_[std::size_t(angle)];
        for (int y = 0; y < n_; ++y) {
            double s = offset(0) * across.x + offset(y) * across.y + 0.5 * (bins_ - 1);
            for (int x = 0; x < n_; ++x, s += across.x) {
                const float value = picture[std::size_t(y) * n_ + x];
                if (value == 0.0f) continue;
                const int b = int(s);
                const double f = s - b;
                ray[std::size_t(b)] += (1.0 - f) * value, ray[std::size_t(b) + 1] += f * value;
            }
        }
    }

    void addNoise(int slice, int angle) {
        for (int b = 0; b < bins_; ++b) {
            const double more =
                std::min(waterRay_[std::size_t(b)] - waterPerMm * streakWaterMm, mostLog);
            const std::size_t place =
                (std::size_t(slice + firstOfAll_) * angleCount + std::size_t(angle)) * 4096 +
                std::size_t(b);
            ray_[std::size_t(b)] += noiseGain_ * std::exp(0.5 * more) * whiteNoise(key_, place);
        }
    }

    /// Ram-Lak: 1/4, and −1/(π n)² at odd distances.
    void filter() {
        filtered_.assign(std::size_t(bins_), 0.0);
        constexpr double far = -1.0 / (std::numbers::pi * std::numbers::pi);
        for (int b = 0; b < bins_; ++b) {
            const double value = ray_[std::size_t(b)];
            if (value == 0.0) continue;
            filtered_[std::size_t(b)] += 0.25 * value;
            for (int c = (b + 1) % 2; c < bins_; c += 2)
                filtered_[std::size_t(c)] += far / (double(c - b) * (c - b)) * value;
        }
    }

    void backproject(int angle) {
        const glm::dvec2 across = across_[std::size_t(angle)];
        constexpr double share = std::numbers::pi / angleCount;
        for (int y = 0; y < n_; ++y) {
            double s = offset(0) * across.x + offset(y) * across.y + 0.5 * (bins_ - 1);
            for (int x = 0; x < n_; ++x, s += across.x) {
                const int b = int(s);
                const double f = s - b;
                picture_[std::size_t(y) * n_ + x] +=
                    float(share * ((1.0 - f) * filtered_[std::size_t(b)] +
                                   f * filtered_[std::size_t(b) + 1]));
            }
        }
    }

    void enlarge(float* out) const {
        const auto at = [&](int x, int y) { return picture_[std::size_t(y) * n_ + x]; };
        for (int j = 0; j < fine_.y; ++j) {
            const double v =
                std::clamp((j - 0.5 * (fine_.y - 1)) * spacing_.y / mm_ - offset(0), 0.0, n_ - 1.0);
            const int y = std::min(int(v), n_ - 2);
            for (int i = 0; i < fine_.x; ++i) {
                const double u = std::clamp(
                    (i - 0.5 * (fine_.x - 1)) * spacing_.x / mm_ - offset(0), 0.0, n_ - 1.0);
                const int x = std::min(int(u), n_ - 2);
                const double f = u - x, g = v - y;
                out[std::size_t(j) * fine_.x + i] =
                    float((1.0 - g) * ((1.0 - f) * at(x, y) + f * at(x + 1, y)) +
                          g * ((1.0 - f) * at(x, y + 1) + f * at(x + 1, y + 1)));
            }
        }
    }

    glm::ivec3 fine_;
    glm::dvec3 spacing_;
    Streaks streaks_;
    int firstOfAll_;
    int n_ = 0, bins_ = 0;
    double mm_ = 1.0, noiseGain_ = 0.0;
    std::uint64_t key_ = 0;
    std::vector<glm::dvec2> across_;
    std::vector<float> water_, metal_, picture_;
    std::vector<double> waterRay_, metalRay_, ray_, filtered_;
};

}  // namespace

Volume<float> streaksOf(const Volume<float>& slab, int first, int count, int firstOfAll,
                        const Streaks& streaks, int threads) {
    Grid grid = slab.grid();
    grid.size.z = count;
    grid.patientFromVoxel[3] += double(first) * grid.patientFromVoxel[2];
    Volume<float> all(grid, 0.0f);
    const std::size_t slice = std::size_t(grid.size.x) * grid.size.y;
    const auto out = all.writable();
    parallelFor(std::size_t(count), 1, threads, [&](std::size_t begin, std::size_t end) {
        Fan fan(grid, firstOfAll, streaks);
        for (std::size_t k = begin; k < end; ++k)
            fan.streaks(slab.voxels().data() + (k + std::size_t(first)) * slice, int(k),
                        out.data() + k * slice);
    });
    return all;
}

}  // namespace haustra::phantom
