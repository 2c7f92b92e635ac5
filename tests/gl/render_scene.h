// Small volumes, a context and renderers for the tests that draw.
#pragma once

#include "render/case_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace haustra::tests {

/// What a test of each raycaster is called by.
inline std::string nameOfRaycaster(const testing::TestParamInfo<RaycasterEntry>& entry) {
    std::string name(entry.param.name);
    std::erase(name, '-');
    return name;
}

/// A volume of value(patient point in mm), rounded to whole HU.
inline Volume<std::int16_t> sampled(const Grid& grid,
                                    const std::function<double(glm::dvec3)>& value) {
    Volume<std::int16_t> volume(grid);
    for (std::size_t i = 0; i < grid.voxelCount(); ++i)
        volume.writable()[i] = std::int16_t(
            std::lround(value(grid.patientFromVoxelPoint(glm::dvec3(grid.voxelAt(i))))));
    return volume;
}

/// A grid whose axes are turned in the patient, with the given spacing, centred on the origin.
inline Grid obliqueGrid(glm::ivec3 size, glm::dvec3 spacingMm) {
    Grid grid{size, glm::dmat4(1.0)};
    const glm::dmat4 turned =
        glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1.0, 2.0, -0.5)));
    grid.patientFromVoxel =
        glm::translate(glm::scale(turned, spacingMm), -0.5 * glm::dvec3(size - 1));
    return grid;
}

/// A tube along z with ring folds: air in it, soft tissue around, blurred as by a scanner.
inline double foldedTube(glm::dvec3 p) {
    const double radius =
        12.0 + 3.0 * std::sin(0.6 * p.z) + 1.5 * std::sin(3.0 * std::atan2(p.y, p.x));
    const double outside = std::hypot(p.x, p.y) - radius;
    return -480.0 + 520.0 * std::tanh(outside / 1.2);
}

/// White, unlit, with `opacity` for each mm at every value.
inline render::TransferFunction everywhere(double opacity) {
    return {{{-2000.0, glm::dvec3(1.0), opacity}, {2000.0, glm::dvec3(1.0), opacity}}};
}

/// Opaque white above `hu`, nothing below.
inline render::TransferFunction surfaceAt(double hu) {
    return {{{hu - 1.0, glm::dvec3(1.0), 0.0},
             {hu, glm::dvec3(1.0), 1.0},
             {hu + 1000.0, glm::dvec3(1.0), 1.0}}};
}

/// sRGB's curve and its inverse; values 0…1.
inline double displayedOf(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}
inline double linearOf(double displayed) {
    return displayed <= 0.04045 ? displayed / 12.92 : std::pow((displayed + 0.055) / 1.055, 2.4);
}

inline int pixel(const Image& image, int x, int y, int channel = 0) {
    return image.rgb[3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x)) +
                     std::size_t(channel)];
}

/// A test with a context; fails where anything that it drew made OpenGL complain.
class Drawing : public testing::Test {
protected:
    void SetUp() override {
        auto made = gpu::Context::create();
        ASSERT_TRUE(made) << describe(made.error());
        context = std::move(*made);
    }
    void TearDown() override {
        if (context) {
            EXPECT_EQ(context->errorCount(), 0);
        }
    }
    /// The picture, in bands of so many rows.
    static Image drawn(render::Raycaster& raycaster, const render::CameraView& view,
                       glm::ivec2 size, int bandRows = 1 << 20) {
        Image picture{size.x, size.y, std::vector<std::uint8_t>(3u * unsigned(size.x * size.y))};
        for (int row = 0; row < size.y; row += bandRows) {
            const auto done =
                raycaster.render(view, {size, row, std::min(bandRows, size.y - row)}, picture);
            if (!done) ADD_FAILURE() << describe(done.error());
        }
        return picture;
    }
    std::unique_ptr<render::CaseRenderer> renderer(const Volume<std::int16_t>& ct,
                                                   const Volume<std::int16_t>& cleansed = {},
                                                   int threads = 0) {
        auto made = render::CaseRenderer::create(*context, ct, cleansed, {.threads = threads});
        if (!made) {
            ADD_FAILURE() << describe(made.error());
            return nullptr;
        }
        return std::move(*made);
    }
    template <class View>
    static Image draw(render::CaseRenderer& renderer, const View& view, int width, int height) {
        auto made = renderer.render(view, width, height);
        if (!made) ADD_FAILURE() << describe(made.error());
        return made ? std::move(*made)
                    : Image{width, height, std::vector<std::uint8_t>(3u * width * height)};
    }

    /// Graphics hardware weighs texels by fractions of eight bits or so (Vulkan's
    /// subTexelPrecisionBits); software filters exactly. `software` is how near a value comes
    /// there.
    double near(double software, double hardware) const {
        return context->software() ? software : hardware;
    }
    /// Whether two pictures are the same though their samples lay elsewhere in a texture: to the
    /// bit where the filter is exact. Else its fractions round otherwise there: values are a level
    /// off, and at most one of a thousand more, where a sample just meets a surface or misses it.
    testing::AssertionResult samePicture(const Image& a, const Image& b) const {
        if (a.rgb.size() != b.rgb.size()) return testing::AssertionFailure() << "other sizes";
        std::size_t off = 0, far = 0;
        int worst = 0;
        for (std::size_t n = 0; n < a.rgb.size(); ++n) {
            const int by = std::abs(int(a.rgb[n]) - int(b.rgb[n]));
            worst = std::max(worst, by), off += by > 0, far += by > 1;
        }
        if (off == 0 || (!context->software() && far * 1000 <= a.rgb.size() && worst <= 16))
            return testing::AssertionSuccess();
        return testing::AssertionFailure()
               << off << " of " << a.rgb.size() << " values differ, " << far
               << " by more than a level, by " << worst << " at most";
    }

    std::unique_ptr<gpu::Context> context;
};

}  // namespace haustra::tests
