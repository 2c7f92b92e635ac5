// The colon from outside: where things appear, and what stands before what.
#include "core/orbit.h"
#include "render_scene.h"

namespace haustra::tests {
namespace {

using namespace render;

/// A ball of triangles.
void addBall(TriMesh& mesh, glm::dvec3 center, double radius) {
    constexpr int rows = 48, sides = 64;
    const int first = int(mesh.vertices.size());
    for (int row = 0; row <= rows; ++row)
        for (int side = 0; side < sides; ++side) {
            const double polar = M_PI * row / rows, angle = 2.0 * M_PI * side / sides;
            mesh.vertices.push_back(center + radius * glm::dvec3(std::sin(polar) * std::cos(angle),
                                                                 std::sin(polar) * std::sin(angle),
                                                                 std::cos(polar)));
        }
    for (int row = 0; row < rows; ++row)
        for (int side = 0; side < sides; ++side) {
            const int a = first + row * sides + side, b = first + row * sides + (side + 1) % sides;
            mesh.triangles.push_back({a, a + sides, b});
            mesh.triangles.push_back({b, a + sides, b + sides});
        }
}

class Overview : public Drawing {
protected:
    const Grid grid = axisAlignedGrid({50, 50, 50}, glm::dvec3(2.0), glm::dvec3(-49.0));

    std::unique_ptr<CaseRenderer> renderer(const TriMesh& wall, const Centerline& path = {}) {
        const Volume<std::int16_t> ct(grid, 0);
        auto prepared = prepareCase(ct, {});
        EXPECT_TRUE(prepared);
        prepared->wall = std::make_shared<const TriMesh>(wall);
        prepared->path = std::make_shared<const Centerline>(path);
        auto made = CaseRenderer::upload(*context, std::move(*prepared));
        if (!made) ADD_FAILURE() << describe(made.error());
        return made ? std::move(*made) : nullptr;
    }
    static Orbit orbit(double azimuth = 0.0, double elevation = 0.0) {
        return {glm::dvec3(0.0), 300.0, azimuth, elevation, 100.0};
    }
    static OverviewView seenFrom(const Orbit& orbit) {
        OverviewView view;
        view.camera = cameraOf(orbit);
        view.body = false;
        view.optics.transferFunction = everywhere(0.0);
        return view;
    }
    static bool isBackground(const Image& image, int x, int y) {
        for (int channel = 0; channel < 3; ++channel)
            if (pixel(image, x, y, channel) != pixel(image, 0, 0, channel)) return false;
        return true;
    }
    /// Middle and area of what is not background.
    static std::pair<glm::dvec2, double> shape(const Image& image) {
        glm::dvec2 sum(0.0);
        double count = 0.0;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                if (!isBackground(image, x, y)) {
                    sum += glm::dvec2(x, y) + 0.5;
                    count += 1.0;
                }
        return {sum / std::max(count, 1.0), count};
    }
};

TEST_F(Overview, TheWallIsWhereAnOrbitProjectsIt) {
    const glm::dvec3 place(18.0, -6.0, 11.0);
    TriMesh wall;
    addBall(wall, place, 12.0);
    const auto scan = renderer(wall);
    for (const auto& [azimuth, elevation] :
         {std::pair(0.0, 0.0), {90.0, 0.0}, {180.0, 0.0}, {-37.0, 25.0}, {10.0, -90.0}}) {
        const Orbit from = orbit(azimuth, elevation);
        const auto [middle, area] = shape(draw(*scan, seenFrom(from), 200, 160));
        const glm::dvec3 expected = projected(from, place, {200.0, 160.0});
        EXPECT_NEAR(glm::distance(middle, glm::dvec2(expected)), 0.0, 0.3) << azimuth;
        // 1.6 pixels a millimetre; a pixel counts when the ball touches a part of it.
        const double radius = std::sqrt(area / M_PI);
        EXPECT_NEAR(radius, 12.0 * 1.6, 0.7) << azimuth;
    }
}

TEST_F(Overview, APerspectiveCameraSeesWhatItsRaysMeet) {
    const glm::dvec3 place(10.0, 5.0, -8.0);
    TriMesh wall;
    addBall(wall, place, 10.0);
    const auto scan = renderer(wall);
    OverviewView view = seenFrom(orbit());
    view.camera = {{0.0, -200.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, 30.0};
    const auto [middle, area] = shape(draw(*scan, view, 150, 150));
    const double scale = 75.0 / std::tan(glm::radians(15.0)) / 205.0;
    EXPECT_NEAR(middle.x, 75.0 + 10.0 * scale, 0.5);
    EXPECT_NEAR(middle.y, 75.0 + 8.0 * scale, 0.5);
    EXPECT_NEAR(std::sqrt(area / M_PI), 10.0 * scale, 1.0);
}

TEST_F(Overview, SeenFromTheFrontThePatientsLeftIsRightAndTheHeadUp) {
    for (const auto& [place, side] : {std::pair(glm::dvec3(25, 0, 0), glm::dvec2(1, 0)),
                                      {glm::dvec3(0, 0, 25), glm::dvec2(0, -1)}}) {
        TriMesh wall;
        addBall(wall, place, 10.0);
        const auto [middle, area] = shape(draw(*renderer(wall), seenFrom(orbit()), 100, 100));
        EXPECT_NEAR(glm::distance(middle - 50.0, 25.0 * side), 0.0, 0.5);
    }
}

TEST_F(Overview, TheBodyEndsAtTheWall) {
    // An unlit body of one colour before a wall lets through (1 − opacity)^way of it.
    TriMesh wall;
    addBall(wall, glm::dvec3(0.0), 20.0);
    const auto scan = renderer(wall);
    OverviewView view = seenFrom(orbit());
    const Image bare = draw(*scan, view, 100, 100);
    view.body = true;
    const double opacity = 0.01;
    view.optics.transferFunction = everywhere(opacity);
    view.optics.shading = false;
    view.march.stepVoxels = 0.25;
    const Image image = draw(*scan, view, 100, 100);
    for (const glm::dvec2 aside : {glm::dvec2(0, 0), {9, 3}, {-5, -14}, {30, 10}, {-40, 40}}) {
        const glm::ivec2 at(50.0 + aside);
        const glm::dvec2 mm = glm::dvec2(at) + 0.5 - 50.0;
        const double square = 400.0 - glm::dot(mm, mm);
        const double way = square > 0.0 ? 50.0 - std::sqrt(square) : 100.0;
        const double through = std::pow(1.0 - opacity, way);
        const double behind = linearOf(pixel(bare, at.x, at.y) / 255.0);
        const double expected = displayedOf(1.0 - through + through * behind);
        EXPECT_NEAR(pixel(image, at.x, at.y) / 255.0, expected, 0.01) << aside.x << " " << aside.y;
    }
}

TEST_F(Overview, MarksShowThroughTheWallWhereTheyAreAndNowhereElse) {
    TriMesh wall;
    addBall(wall, glm::dvec3(0.0), 35.0);
    Centerline path;
    for (int i = -20; i <= 20; ++i)
        path.points.push_back({{1.0 * i, 0.0, -10.0}, i + 20.0, 30.0, i > 5 && i < 12});
    const auto scan = renderer(wall, path);
    OverviewView view = seenFrom(orbit());
    view.path = false;
    const Image bare = draw(*scan, view, 200, 200);
    const auto changed = [&](const Image& image, glm::dvec3 place) {
        const glm::ivec2 at(projected(orbit(), place, {200.0, 200.0}));
        for (int channel = 0; channel < 3; ++channel)
            if (pixel(image, at.x, at.y, channel) != pixel(bare, at.x, at.y, channel)) return true;
        return false;
    };
    view.path = true;
    const Image withPath = draw(*scan, view, 200, 200);
    EXPECT_TRUE(changed(withPath, {-15.0, 0.0, -10.0}));
    EXPECT_TRUE(changed(withPath, {15.0, 0.0, -10.0}));
    EXPECT_FALSE(changed(withPath, {8.5, 0.0, -10.0})) << "in the gap";
    EXPECT_FALSE(changed(withPath, {0.0, 0.0, 5.0}));

    view.path = false;
    view.bookmarksMm = {{12.0, 10.0, 14.0}};
    view.reader = Camera{{-10.0, 0.0, 10.0}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}};
    const Image marked = draw(*scan, view, 200, 200);
    EXPECT_TRUE(changed(marked, view.bookmarksMm[0]));
    EXPECT_TRUE(changed(marked, {-10.0, 0.0, 14.0})) << "ahead of the reader";
    EXPECT_FALSE(changed(marked, {-10.0, 0.0, 6.0})) << "behind";
    EXPECT_FALSE(changed(marked, {-10.0, 0.0, -10.0}));

    // What has been drawn before changes nothing.
    EXPECT_EQ(draw(*renderer(wall, path), view, 200, 200).rgb, marked.rgb);
    view.bookmarksMm.clear();
    view.reader.reset();
    EXPECT_EQ(draw(*scan, view, 200, 200).rgb, bare.rgb);
}

TEST_F(Overview, BandsMakeTheSamePictureAlsoWhereTwoReadersTakeTurns) {
    TriMesh wall;
    addBall(wall, {18.0, -6.0, 11.0}, 12.0);
    std::vector<OverviewView> views{seenFrom(orbit()), seenFrom(orbit(60.0, 20.0))};
    for (OverviewView& view : views) {
        view.body = true;
        view.optics.transferFunction = everywhere(0.01);
        view.bookmarksMm = {{18.0, -6.0, 11.0}};
    }
    const int width = 90, height = 70;
    std::vector<Image> whole;
    for (const OverviewView& view : views)
        whole.push_back(draw(*renderer(wall), view, width, height));
    ASSERT_NE(whole[0].rgb, whole[1].rgb);
    // Each view's rows are drawn where the other's were last; the first again at the end, as kept.
    const auto scan = renderer(wall);
    std::vector<Image> drawn(2,
                             Image{width, height, std::vector<std::uint8_t>(3 * width * height)});
    for (const auto& [firstRow, rows] : {std::pair(0, 24), {24, 16}, {40, 30}})
        for (std::size_t i = 0; i < views.size(); ++i)
            ASSERT_TRUE(scan->render(views[i], Band{{width, height}, firstRow, rows}, drawn[i]));
    EXPECT_EQ(drawn[0].rgb, whole[0].rgb);
    EXPECT_EQ(drawn[1].rgb, whole[1].rgb);
    EXPECT_EQ(draw(*scan, views[0], width, height).rgb, whole[0].rgb);
    EXPECT_EQ(draw(*scan, views[0], width, height).rgb, whole[0].rgb);
}

TEST_F(Overview, WithoutAWallTheBodyStillShows) {
    const Volume<std::int16_t> ct(grid, 0);
    auto prepared = prepareCase(ct, {});
    ASSERT_TRUE(prepared);
    const auto scan = CaseRenderer::upload(*context, std::move(*prepared));
    ASSERT_TRUE(scan);
    OverviewView view = seenFrom(orbit());
    view.body = true;
    view.optics.transferFunction = everywhere(0.02);
    view.optics.shading = false;
    EXPECT_GT(pixel(draw(**scan, view, 50, 50), 25, 25), 200);
}

TEST_F(Overview, SaysWhatIsWrong) {
    TriMesh wall;
    addBall(wall, glm::dvec3(0.0), 20.0);
    const auto scan = renderer(wall);
    OverviewView view = seenFrom(orbit());
    EXPECT_FALSE(scan->render(view, 0, 10));
    EXPECT_FALSE(scan->render(view, 4096, 10));
    view.camera.lens = Lens::fisheye;
    const auto bent = scan->render(view, 10, 10);
    ASSERT_FALSE(bent);
    EXPECT_EQ(bent.error().kind, ErrorKind::badInput);
    view = seenFrom(orbit());
    view.camera.heightMm = -1.0;
    EXPECT_FALSE(scan->render(view, 10, 10));
}

}  // namespace
}  // namespace haustra::tests
