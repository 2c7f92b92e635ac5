// Slices and flattened views in bands: the same pixels, whoever draws them.
#include "flat_tube.h"
#include "render_scene.h"

namespace haustra::tests {
namespace {

using namespace render;

class PictureBands : public Drawing,
                     public testing::WithParamInterface<std::tuple<RaycasterKind, const char*>> {
protected:
    /// Draws every picture whole and in bands of different heights; a band touches its rows alone.
    template <class View>
    void expectSamePixels(CaseRenderer& renderer, const View& view, glm::ivec2 size) {
        const Image whole = draw(renderer, view, size.x, size.y);
        const std::size_t row = 3 * std::size_t(size.x);
        for (const int bandRows : {1, 7, 16, 50}) {
            Image picture = blankImage(size);
            for (int first = size.y; first > 0;) {
                const int end = std::exchange(first, std::max(first - bandRows, 0));
                std::fill(picture.rgb.begin() + std::ptrdiff_t(row) * first,
                          picture.rgb.begin() + std::ptrdiff_t(row) * end, std::uint8_t(123));
                const Image before = picture;
                const auto drawn = renderer.render(view, {size, first, end - first}, picture);
                ASSERT_TRUE(drawn) << describe(drawn.error());
                ASSERT_TRUE(std::equal(picture.rgb.begin() + std::ptrdiff_t(row) * end,
                                       picture.rgb.end(),
                                       before.rgb.begin() + std::ptrdiff_t(row) * end));
                ASSERT_TRUE(std::equal(picture.rgb.begin(),
                                       picture.rgb.begin() + std::ptrdiff_t(row) * first,
                                       before.rgb.begin()));
            }
            ASSERT_EQ(picture.rgb, whole.rgb) << bandRows << " rows a band";
        }
        Image other = blankImage(size);
        EXPECT_FALSE(renderer.render(view, {size, size.y - 3, 4}, other));
        EXPECT_FALSE(renderer.render(view, {size + 1, 0, 4}, other));
    }
};

TEST_P(PictureBands, ChangeNoPixel) {
    const auto [kind, preset] = GetParam();
    FlatTubeShape shape;
    shape.lengthMm = 45.0;
    shape.leanMm = 8.0;
    const FlatTube tube(shape);
    const Volume<std::int16_t> scan = tube.scan();
    auto prepared = prepareCase(scan, {});
    ASSERT_TRUE(prepared);
    prepared->flatMap = std::make_shared<const FlatMap>(tube.map({48, 80}));
    auto renderer = CaseRenderer::upload(*context, std::move(*prepared), {.raycaster = kind});
    ASSERT_TRUE(renderer);

    const glm::ivec2 size(71, 83);
    FlatView flat;
    flat.optics = *opticsPreset(preset);
    for (const FlatWindow& window :
         {FlatWindow{{0.5, 0.4}, 90.0}, FlatWindow{{0.013, 0.02}, 61.7},
          FlatWindow{{0.9, 0.55}, 1500.0}, FlatWindow{{0.4, 0.5}, 12.0}}) {
        flat.window = window;
        expectSamePixels(**renderer, flat, size);
    }
    expectSamePixels(**renderer, FlatOverview{flat.optics, {}}, size);
    expectSamePixels(**renderer, FlatOverview{flat.optics, {}}, {160, 40});

    const glm::dvec3 middle =
        scan.grid().patientFromVoxelPoint(0.5 * glm::dvec3(scan.grid().size) + 0.3);
    for (const View plane : {View::axial, View::coronal})
        expectSamePixels(**renderer, SliceView{plane, middle, 1.7, {}}, size);
    ObliqueView oblique;
    oblique.positionMm = middle;
    oblique.forward = {0.3, 0.2, 1.0};
    expectSamePixels(**renderer, oblique, size);
}

INSTANTIATE_TEST_SUITE_P(All, PictureBands,
                         testing::Combine(testing::Values(RaycasterKind::native,
                                                          RaycasterKind::singlePass),
                                          testing::Values("mucosa", "translucent")));

}  // namespace
}  // namespace haustra::tests
