// Segmented colour volumes of the Visible Korean's form: organs in slices' colours.
#include "reference_marcher.h"
#include "render/object_order/cell_grid.h"
#include "render/object_order/labelled_raycaster.h"
#include "render_scene.h"

#include <random>
#include <set>

namespace haustra::tests {
namespace {

using namespace render;

/// Three organs in a body, with the colours' noise of a photograph.
LabelledColorVolume organs() {
    const Grid grid = obliqueGrid({120, 111, 47}, {0.9, 0.9, 1.4});
    Volume<Rgba> color(grid);
    Volume<std::int16_t> labels(grid);
    std::mt19937 random(5);
    std::uniform_int_distribution<int> noise(-6, 6);
    struct Organ {
        glm::dvec3 middle, radius;
        Rgba color;
        std::int16_t label;
    };
    const Organ all[] = {{{55, 52, 22}, {50, 46, 20}, {201, 160, 120, 6}, 1},
                         {{40, 50, 20}, {14, 18, 9}, {180, 60, 50, 90}, 2},
                         {{85, 70, 30}, {9, 7, 8}, {230, 214, 150, 160}, 300}};
    for (std::size_t i = 0; i < grid.voxelCount(); ++i) {
        Rgba is{12, 16, 60, 0};
        std::int16_t label = 0;
        for (const Organ& organ : all) {
            const glm::dvec3 at = (glm::dvec3(grid.voxelAt(i)) - organ.middle) / organ.radius;
            if (glm::dot(at, at) <= 1.0) is = organ.color, label = organ.label;
        }
        const auto noisy = [&](int value) {
            return std::uint8_t(std::clamp(value + noise(random), 0, 255));
        };
        color.writable()[i] = {noisy(is.r), noisy(is.g), noisy(is.b), is.a};
        labels.writable()[i] = label;
    }
    return *makeLabelledColor(std::move(color), std::move(labels));
}

CameraView across(Lens lens) {
    CameraView view;
    view.camera = {{-70.0, 40.0, 60.0}, {0.7, -0.4, -0.6}, {0, 0, 1}, 70.0, lens, 150.0};
    view.optics.shading = false;
    return view;
}

/// Plainly, in double precision.
Image reference(const LabelledColorVolume& volume, const std::set<int>& labels,
                const CameraView& view, int width, int height) {
    const Grid& grid = volume.grid();
    const glm::dmat3 linear(grid.voxelFromPatient());
    const glm::dvec3 spacing = grid.spacingMm();
    const double stepMm = view.march.stepVoxels * std::min({spacing.x, spacing.y, spacing.z});
    const glm::dvec3 ahead = glm::normalize(view.camera.forward);
    const glm::dvec3 right = glm::normalize(glm::cross(ahead, view.camera.up));
    const glm::dvec3 down = glm::cross(ahead, right);
    const double slope = std::tan(glm::radians(view.camera.fovDegrees) / 2.0);
    const glm::dvec3 eye = grid.voxelFromPatientPoint(view.camera.positionMm);
    const auto texel = [&](glm::ivec3 v) {
        v = glm::clamp(v, glm::ivec3(0), grid.size - 1);
        const std::size_t i = grid.index(v);
        const Rgba is = volume.color[i];
        const bool shown = labels.empty() || labels.contains(volume.labels[i]);
        return glm::dvec4(is.r, is.g, is.b, shown ? is.a : 0) / 255.0;
    };
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 ray =
                glm::normalize(ahead + slope * (2.0 * (x + 0.5) - width) / height * right +
                               slope * (2.0 * (y + 0.5) - height) / height * down);
            const glm::dvec3 step = linear * ray * stepMm;
            glm::dvec3 color(0.0);
            double opacity = 0.0;
            for (double n = 0.0; n < 900.0 && opacity < terminationOpacity; n += 1.0) {
                const glm::dvec3 at = eye + n * step;
                if (glm::any(glm::lessThan(at, glm::dvec3(-0.5))) ||
                    glm::any(glm::greaterThan(at, glm::dvec3(grid.size) - 0.5)))
                    continue;
                const glm::dvec3 corner = glm::floor(at), f = at - corner;
                glm::dvec4 is(0.0);
                for (int c = 0; c < 8; ++c) {
                    const glm::ivec3 side(c & 1, (c >> 1) & 1, c >> 2);
                    const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(side));
                    is += w.x * w.y * w.z * texel(glm::ivec3(corner) + side);
                }
                const double a = 1.0 - std::pow(1.0 - is.a, stepMm);
                const glm::dvec3 light(linearOf(is.r), linearOf(is.g), linearOf(is.b));
                color += (1.0 - opacity) * a * light;
                opacity += (1.0 - opacity) * a;
            }
            if (opacity >= terminationOpacity) color /= opacity;
            for (int c = 0; c < 3; ++c)
                color[c] = displayedOf(std::clamp(color[c], 0.0, 1.0));
            append(image, color);
        }
    return image;
}

class LabelledColor : public Drawing {
protected:
    void SetUp() override {
        Drawing::SetUp();
        volume = std::make_shared<const LabelledColorVolume>(organs());
        cells = cellsOf({.cellSide = 16});
    }
    std::unique_ptr<LabelledRaycaster> cellsOf(ObjectOrderOptions options) {
        auto made = LabelledRaycaster::create(*context, volume, options);
        EXPECT_TRUE(made) << describe(made.error());
        return std::move(*made);
    }
    /// Cells with a voxel of these labels, border included.
    int cellsHolding(const std::set<int>& labels) const {
        const CellGrid grid{volume->grid().size, 16};
        int count = 0;
        for (int index = 0; index < grid.cells(); ++index) {
            const glm::ivec3 from = grid.cellAt(index) * 16;
            const glm::ivec3 to = glm::min(from + 16, grid.voxels - 1);
            bool holds = false;
            for (int z = from.z; z <= to.z; ++z)
                for (int y = from.y; y <= to.y; ++y)
                    for (int x = from.x; x <= to.x; ++x)
                        holds = holds || labels.contains(volume->labels.at(x, y, z));
            count += holds;
        }
        return count;
    }
    std::shared_ptr<const LabelledColorVolume> volume;
    std::unique_ptr<LabelledRaycaster> cells;
};

TEST_F(LabelledColor, ShowsColoursAsAPlainMarcherDoes) {
    const CameraView view = across(Lens::perspective);
    for (const std::set<int>& labels : {std::set<int>{}, {300}, {2, 300}}) {
        ASSERT_TRUE(cells->choose({labels.begin(), labels.end()}));
        EXPECT_GE(psnr(drawn(*cells, view, {60, 50}), reference(*volume, labels, view, 60, 50)),
                  45.0);
    }
}

TEST_F(LabelledColor, AChosenLabelLoadsItsCellsAlone) {
    // All of the volume is in this picture, and label 1 lets all rays through.
    const CameraView view = across(Lens::orthographic);
    for (const std::set<int>& labels : {std::set<int>{1}, {2}, {300}, {2, 300}}) {
        ASSERT_TRUE(cells->choose({labels.begin(), labels.end()}));
        drawn(*cells, view, {80, 80});
        const ResidencyStats& stats = cells->residency();
        const int holding = cellsHolding(labels);
        EXPECT_EQ(stats.nonEmpty, holding);
        EXPECT_LE(stats.uploaded, holding);
        if (labels.contains(1)) {
            EXPECT_EQ(stats.uploaded, holding);
        }
        EXPECT_GT(stats.uploaded, 0);
        EXPECT_EQ(stats.bytesMoved, std::size_t(stats.uploaded) * 21 * 21 * 21 * 4);
        EXPECT_LT(holding, stats.cells);
    }
    EXPECT_LT(cellsHolding({300}), cellsHolding({1}) / 4);
    const auto none = cells->choose({7});
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::noResult);
}

TEST_F(LabelledColor, NoPixelDependsOnTheBudget) {
    const auto tight = cellsOf({.cellSide = 16, .budgetBytes = 64 * 64 * 32 * 4});
    CameraView view = across(Lens::fisheye);
    view.optics.shading = true;
    EXPECT_TRUE(samePicture(drawn(*cells, view, {61, 47}), drawn(*tight, view, {61, 47})));
    EXPECT_GT(tight->residency().uploaded, tight->residency().resident);
}

TEST(ColorOpacity, FollowsTheEyesColourDifferences) {
    EXPECT_NEAR(glm::distance(luvOf({255, 255, 255}), {100.0, 0.0, 0.0}), 0.0, 0.05);
    EXPECT_NEAR(glm::distance(luvOf({255, 0, 0}), {53.24, 175.01, 37.75}), 0.0, 0.1);
    EXPECT_EQ(luvOf({0, 0, 0}), glm::dvec3(0.0));

    const Grid grid = axisAlignedGrid({12, 6, 5}, glm::dvec3(1.0));
    Volume<Rgba> color(grid);
    for (std::size_t i = 0; i < grid.voxelCount(); ++i)
        color.writable()[i] = grid.voxelAt(i).x < 6 ? Rgba{90, 60, 50} : Rgba{140, 60, 50};
    Volume<std::int16_t> labels(grid, 0);
    labels.writable()[grid.index(1, 1, 1)] = 4;
    const double apart = glm::distance(luvOf({90, 60, 50}), luvOf({140, 60, 50}));
    const ColorOpacity rule{.least = 0.2, .gain = 0.8, .atDifference = 60.0, .exponent = 1.5};
    const Volume<Rgba> made = withColorOpacity(color, labels, rule, 2);
    const int expected = int(std::lround(255.0 * std::min(0.8 * std::pow(apart / 60.0, 1.5), 1.0)));
    ASSERT_GT(expected, 10);
    for (std::size_t i = 0; i < grid.voxelCount(); ++i) {
        const int x = grid.voxelAt(i).x;
        const int labelled = labels[i] ? 51 : 0;
        EXPECT_EQ(made[i].a, x == 5 || x == 6 ? expected : labelled);
        EXPECT_EQ(made[i].r, color[i].r);
    }
    const double lightness = luvOf({90, 60, 50}).x;
    ASSERT_LT(lightness, 40.0);
    ASSERT_GT(luvOf({140, 60, 50}).x, lightness + 1.0);
    ColorOpacity blind = rule;
    blind.dark = lightness + 0.5;
    const Volume<Rgba> bright = withColorOpacity(color, labels, blind, 2);
    EXPECT_EQ(bright[grid.index(5, 2, 2)].a, 0);
    EXPECT_EQ(bright[grid.index(6, 2, 2)].a, expected);
    const Volume<Rgba> again = withColorOpacity(color, labels, rule, 1);
    EXPECT_TRUE(std::equal(made.voxels().begin(), made.voxels().end(), again.voxels().begin()));
}

}  // namespace
}  // namespace haustra::tests
