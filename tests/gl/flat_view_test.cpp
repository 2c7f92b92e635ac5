// The flattened wall against a tube whose map is known, and against a plain ray caster on the CPU.
#include "flat_reference.h"
#include "flat_tube.h"
#include "render/gl/flat_painter.h"
#include "render_scene.h"

#include <limits>
#include <set>

namespace haustra::tests {
namespace {

using namespace render;

class Flattened : public Drawing {
protected:
    static constexpr glm::ivec2 cells{48, 80};

    std::unique_ptr<CaseRenderer> upload(const Volume<std::int16_t>& ct, const FlatMap& map) {
        auto prepared = prepareCase(ct, {});
        EXPECT_TRUE(prepared);
        prepared->flatMap = std::make_shared<const FlatMap>(map);
        auto made = CaseRenderer::upload(*context, std::move(*prepared));
        if (!made) ADD_FAILURE() << describe(made.error());
        return made ? std::move(*made) : nullptr;
    }
    static FlatView view(glm::dvec2 center, double pixelsPerUnit,
                         const Optics& optics = *opticsPreset("mucosa")) {
        FlatView view;
        view.window = {center, pixelsPerUnit};
        view.optics = optics;
        return view;
    }
    /// The part of a picture that begins at `corner`.
    static std::vector<std::uint8_t> part(const Image& image, glm::ivec2 corner, glm::ivec2 size) {
        std::vector<std::uint8_t> pixels;
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                for (int c = 0; c < 3; ++c)
                    pixels.push_back(std::uint8_t(pixel(image, corner.x + x, corner.y + y, c)));
        return pixels;
    }
    static int largestDifference(const Image& a, const Image& b) {
        int largest = 0;
        for (std::size_t i = 0; i < a.rgb.size(); ++i)
            largest = std::max(largest, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
        return largest;
    }
};

/// Folds that hide places behind them from the axis.
FlatTube overhanging() {
    FlatTubeShape shape;
    shape.lengthMm = 45.0;
    shape.leanMm = 8.0;
    return FlatTube(shape);
}

FlatTube upright() {
    FlatTubeShape shape;
    shape.lengthMm = 45.0;
    return FlatTube(shape);
}

TEST_F(Flattened, EachPixelShowsItsPlace) {
    // The scan rises along one axis, and more steeply towards the tube's axis: no sample on the way
    // back is darker, and rays start at their places. Colours that run to and fro tell the HU there
    // to a fraction, and so the place to some hundredths of a millimetre.
    const FlatTube tube = upright();
    const FlatMap map = tube.map(cells);
    const FlatLookup lookup(std::make_shared<const FlatMap>(map));
    TransferFunction vernier;
    for (int n = 0; n <= 80; ++n)
        vernier.points.push_back({-2000.0 + 50.0 * n, {(n % 2), n / 80.0, 0.0}, 1.0});
    for (int axis = 0; axis < 3; ++axis) {
        const Volume<std::int16_t> ramp = sampled(tube.scan(1.0).grid(), [&](glm::dvec3 p) {
            return 20.0 * (p[axis] - (axis == 2 ? 22.0 : 0.0)) - 50.0 * std::hypot(p.x, p.y) +
                   400.0;
        });
        const auto renderer = upload(ramp, map);
        FlatView window = view({0.4, 0.5 * tube.height()}, 150.0, {vernier});
        window.optics.shading = false;
        const glm::ivec2 size(150, 120);
        const Image image = draw(*renderer, window, size.x, size.y);
        double worst = 0.0;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const auto place =
                    lookup.at(window.window.flatFromPixel(glm::dvec2(x, y) + 0.5, size));
                ASSERT_TRUE(place);
                const double hu =
                    trilinear(ramp, ramp.grid().voxelFromPatientPoint(place->positionMm));
                const double part = std::abs(std::fmod(hu + 2000.0, 100.0) - 50.0);
                const double red = 255.0 * (1.0 - part / 50.0);
                worst = std::max(worst, std::abs(pixel(image, x, y) - red));
                EXPECT_NEAR(pixel(image, x, y, 1), 255.0 * (hu + 2000.0) / 4000.0, 1.0);
            }
        }
        // 5 levels are 1 HU; rounding to 8 bits, the table's steps, and light adding up linearly
        // take the rest.
        EXPECT_LE(worst, 8.0) << "axis " << axis;
    }
}

TEST_F(Flattened, AgreesWithAPlainOneOnTheCpu) {
    for (const FlatTube& tube : {upright(), overhanging()}) {
        const Volume<std::int16_t> scan = tube.scan();
        const FlatMap map = tube.map(cells);
        const ReferenceWall reference(map);
        const auto renderer = upload(scan, map);
        for (const char* preset : {"mucosa", "translucent"}) {
            for (const auto& [center, pixels] : {std::pair(glm::dvec2(0.5, 0.4), 90.0),
                                                 {glm::dvec2(0.02, 0.0), 150.0},
                                                 {glm::dvec2(0.3, 0.55), 1500.0}}) {
                const FlatView window = view(center, pixels, *opticsPreset(preset));
                const Image image = draw(*renderer, window, 96, 64);
                const Image plain = referenceFlat(reference, scan, window, {96, 64});
                EXPECT_GE(psnr(image, plain), 45.0)
                    << preset << ", " << pixels << " pixels a circumference, lean "
                    << tube.shape().leanMm;
            }
        }
    }
}

TEST_F(Flattened, NoFoldHidesAPlace) {
    const FlatTube tube = overhanging();
    const Volume<std::int16_t> scan = tube.scan();
    const ReferenceWall reference(tube.map(cells));
    const auto huAt = [&](glm::dvec3 p) {
        return trilinear(scan, scan.grid().voxelFromPatientPoint(p));
    };
    const double stepMm = 0.1;
    int hidden = 0, behind = 0, places = 0;
    for (double y = 0.01; y < tube.height() - 0.01; y += 0.004) {
        const auto place = referencePlace(reference, scan, stepMm, {0.31, y});
        ASSERT_TRUE(place);
        ++places;
        const glm::dvec3 sight = place->positionMm - place->cameraMm;
        const double distance = glm::length(sight);
        bool blocked = false;
        for (double mm = 0.0; mm < distance - 2.0; mm += stepMm)
            blocked = blocked || huAt(place->cameraMm + mm / distance * sight) > -200.0;
        hidden += blocked;
        behind += glm::dot(sight, place->intoLumen) > 0.0;
        // The ray comes from the lumen, through air, and is at the wall within half a millimetre.
        EXPECT_LT(glm::dot(place->direction, place->intoLumen), -std::cos(0.81));
        double wall = place->stepsBack;
        for (double n = 0.0; n < place->stepsBack && wall == place->stepsBack; n += 1.0) {
            const glm::dvec3 at =
                place->positionMm - (place->stepsBack - n) * stepMm * place->direction;
            if (huAt(at) > -480.0) wall = n;
        }
        EXPECT_LT((place->stepsBack - wall) * stepMm, 0.5) << "at y " << y;
    }
    // The scene has what it is about: places that the camera cannot see, or sees from behind.
    EXPECT_GT(hidden, places / 20);
    EXPECT_GT(behind, places / 20);
}

TEST_F(Flattened, GoesOnAcrossTheSeam) {
    const FlatTube tube = upright();
    const Volume<std::int16_t> scan = tube.scan();
    // The same tube, cut open on the other side.
    const FlatMap map = tube.map(cells);
    FlatMap elsewhere = map;
    for (std::size_t i = 0; i < map.flat.size(); ++i)
        elsewhere.surface.vertices[i] =
            tube.positionMm({map.flat[i].x == 1.0 ? 0.5 : map.flat[i].x + 0.5, map.flat[i].y});
    const auto one = upload(scan, map), other = upload(scan, elsewhere);
    for (const double pixels : {100.0, 777.7}) {
        const double y = 0.5 * tube.height();
        const Image across = draw(*one, view({0.0, y}, pixels), 120, 90);
        EXPECT_LE(largestDifference(across, draw(*other, view({0.5, y}, pixels), 120, 90)), 2);
        EXPECT_EQ(across.rgb, draw(*one, view({1.0, y}, pixels), 120, 90).rgb);
        EXPECT_EQ(across.rgb, draw(*one, view({-3.0, y}, pixels), 120, 90).rgb);
    }
}

TEST_F(Flattened, APlaceIsTheSameInEveryPicture) {
    const FlatTube tube = overhanging();
    const auto renderer = upload(tube.scan(), tube.map(cells));
    for (const char* preset : {"mucosa", "translucent"}) {
        for (const double pixels : {83.0, 400.0, 5000.0 / 3.0}) {
            const FlatView whole = view({0.11, 0.4}, pixels, *opticsPreset(preset));
            const glm::ivec2 size(211, 160);
            const Image image = draw(*renderer, whole, size.x, size.y);
            for (const glm::ivec2 corner : {glm::ivec2(0, 0), {37, 51}, {100, 3}}) {
                const glm::ivec2 tile(101, 90);
                FlatView cut = whole;
                cut.window.center =
                    whole.window.flatFromPixel(glm::dvec2(corner) + 0.5 * glm::dvec2(tile), size);
                EXPECT_EQ(draw(*renderer, cut, tile.x, tile.y).rgb, part(image, corner, tile))
                    << preset << ", " << pixels << " pixels, at " << corner.x;
            }
        }
    }
}

TEST_F(Flattened, LeapingAndThreadsAndWhatWasDrawnBeforeChangeNoPixel) {
    const FlatTube tube = overhanging();
    const Volume<std::int16_t> scan = tube.scan();
    const auto one = upload(scan, tube.map(cells)), other = upload(scan, tube.map(cells));
    for (const char* preset : {"mucosa", "translucent"}) {
        FlatView window = view({0.9, 0.5}, 170.0, *opticsPreset(preset));
        const Image image = draw(*one, window, 131, 90);
        draw(*other, view({0.2, 0.2}, 900.0), 64, 33);
        EXPECT_EQ(image.rgb, draw(*other, window, 131, 90).rgb);
        window.march.emptySpaceLeaping = false;
        EXPECT_EQ(image.rgb, draw(*other, window, 131, 90).rgb);
    }
}

TEST_F(Flattened, IsBlackBeyondTheEnds) {
    const FlatTube tube = upright();
    const auto renderer = upload(tube.scan(), tube.map(cells));
    for (const double end : {0.0, tube.height()}) {
        const Image image = draw(*renderer, view({0.5, end}, 200.0), 60, 80);
        for (int y = 0; y < 80; ++y) {
            const bool onStrip = end == 0.0 ? y < 40 : y >= 40;
            for (int x = 0; x < 60; ++x)
                EXPECT_EQ(pixel(image, x, y) > 0, onStrip) << x << ", " << y;
        }
    }
    // Far away there is nothing, and nothing breaks.
    const Image far = draw(*renderer, view({1e9, 4096.0}, double(1 << 18)), 20, 20);
    EXPECT_EQ(std::count(far.rgb.begin(), far.rgb.end(), 0), 3 * 20 * 20);
}

TEST_F(Flattened, AZoomedWindowIsDrawnAfresh) {
    const FlatTube tube = overhanging();
    const Volume<std::int16_t> scan = tube.scan();
    const FlatMap map = tube.map(cells);
    const ReferenceWall reference(map);
    const auto renderer = upload(scan, map);
    // The crest of a fold, between light and shade.
    double crest = 0.2;
    for (double y = crest; y < 0.6; y += 0.001) {
        const auto radius = [&](double at) { return tube.positionMm({0.0, at}).x; };
        if (radius(y) < radius(crest)) crest = y;
    }
    const FlatView near = view({0.3, crest}, 1600.0), distant = view({0.3, crest}, 100.0);
    const Image drawn = draw(*renderer, near, 160, 160);
    const Image small = draw(*renderer, distant, 10, 10);
    Image stretched = drawn;
    for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 160; ++x)
            for (int c = 0; c < 3; ++c)
                stretched.rgb[3u * (160u * unsigned(y) + unsigned(x)) + unsigned(c)] =
                    std::uint8_t(pixel(small, x / 16, y / 16, c));
    const Image plain = referenceFlat(reference, scan, near, {160, 160});
    EXPECT_GE(psnr(drawn, plain), 45.0);
    EXPECT_LE(psnr(stretched, plain), 36.0);
}

TEST_F(Flattened, EveryTriangleIsInThePictureWhereItIsLargeEnough) {
    const FlatTube tube = overhanging();
    const FlatMap map = tube.map(cells);
    auto painter = FlatPainter::create(map, tube.scan(2.0).grid());
    ASSERT_TRUE(painter);
    // Pixels a circumference such that every triangle's inscribed circle holds a pixel's centre.
    const double pixels = 160.0 * cells.x / 48;
    std::set<int> seen;
    const glm::ivec2 size(160, 100);
    for (double row = 0.0; row < map.height * pixels; row += size.y) {
        FlatWindow window;
        window.pixelsPerUnit = pixels;
        window.center = {0.5, (row + 0.5 * size.y) / pixels};
        ASSERT_TRUE(painter->findTriangles(window, Band::whole(size.x, size.y)));
        const std::vector<int> found = painter->triangleOfPixel();
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double y = window.flatFromPixel({0.5, double(i / 160) + 0.5}, size).y;
            EXPECT_EQ(found[i] >= 0, y <= map.height) << "pixel " << i;
            if (found[i] >= 0) seen.insert(found[i]);
        }
    }
    EXPECT_EQ(seen.size(), map.surface.triangles.size());
}

TEST_F(Flattened, TheOverviewShowsItsColumns) {
    FlatTubeShape shape;
    shape.lengthMm = 120.0;
    shape.radiusMm = 6.0;
    shape.foldMm = 1.5;
    const FlatTube tube(shape);
    const auto renderer = upload(tube.scan(), tube.map(cells));
    const FlatOverview overview{*opticsPreset("mucosa"), {}};
    const glm::ivec2 size(330, 150);
    const Image image = draw(*renderer, overview, size.x, size.y);
    const StripLayout layout = layOutStrip(tube.height(), size);
    ASSERT_GE(layout.columns.size(), 2u);
    std::vector<bool> drawn(std::size_t(size.x), false);
    for (const StripColumn& column : layout.columns) {
        FlatView window{column.window, overview.optics, {}};
        EXPECT_EQ(part(image, {column.left, 0}, column.size),
                  draw(*renderer, window, column.size.x, column.size.y).rgb);
        std::fill_n(drawn.begin() + column.left, column.size.x, true);
    }
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y && !drawn[std::size_t(x)]; ++y)
            EXPECT_EQ(pixel(image, x, y), 0);
}

TEST_F(Flattened, SaysWhatIsWrong) {
    const FlatTube tube = upright();
    const Volume<std::int16_t> scan = tube.scan(2.0);
    const auto refused = [](const auto& made, const char* words) {
        ASSERT_FALSE(made) << words;
        EXPECT_EQ(made.error().kind, ErrorKind::badInput);
        EXPECT_NE(describe(made.error()).find(words), std::string::npos) << describe(made.error());
    };
    const FlatView good = view({0.5, 0.3}, 100.0);
    const auto without = renderer(scan);
    refused(without->render(good, 10, 10), "no flat map");
    refused(without->render(FlatOverview{good.optics, {}}, 10, 10), "no flat map");

    const auto drawing = upload(scan, tube.map({8, 8}));
    constexpr double notANumber = std::numeric_limits<double>::quiet_NaN();
    refused(drawing->render(good, 0, 10), "0x10");
    refused(drawing->render(view({notANumber, 0.3}, 100.0), 10, 10), "centre");
    refused(drawing->render(view({0.5, notANumber}, 100.0), 10, 10), "centre");
    refused(drawing->render(view({0.5, 1e9}, 100.0), 10, 10), "centre");
    refused(drawing->render(view({0.5, 0.3}, notANumber), 10, 10), "circumference");
    refused(drawing->render(view({0.5, 0.3}, 0.1), 10, 10), "circumference");
    refused(drawing->render(view({0.5, 0.3}, 1e7), 10, 10), "circumference");
    FlatView coarse = good;
    coarse.march.stepVoxels = 9.0;
    refused(drawing->render(coarse, 10, 10), "sampling");

    const auto refusedMap = [&](auto&& spoil, const char* words) {
        auto prepared = prepareCase(scan, {});
        FlatMap map = tube.map({8, 8});
        spoil(map);
        prepared->flatMap = std::make_shared<const FlatMap>(std::move(map));
        refused(CaseRenderer::upload(*context, std::move(*prepared)), words);
    };
    refusedMap([](FlatMap& map) { map.flat.pop_back(); }, "for each vertex");
    refusedMap([](FlatMap& map) { map.camera.pop_back(); }, "for each vertex");
    refusedMap([](FlatMap& map) { map.camera[3] = 100000; }, "cameras");
    refusedMap([](FlatMap& map) { map.surface.triangles[5].y = -1; }, "triangles");
    refusedMap([](FlatMap& map) { map.surface.triangles.clear(); }, "no triangles");
    refusedMap([](FlatMap& map) { map.cameras.clear(); }, "no cameras");
    refusedMap([](FlatMap& map) { map.flat[7].y = notANumber; }, "beyond the strip");
    refusedMap([](FlatMap& map) { map.surface.vertices[7].x = notANumber; }, "finite");
    refusedMap([](FlatMap& map) { map.height = 1e6; }, "too long");
}

TEST_F(Flattened, CountsItsGpuMemory) {
    const FlatTube tube = upright();
    const Volume<std::int16_t> scan = tube.scan(2.0);
    const FlatMap map = tube.map(cells);
    EXPECT_EQ(upload(scan, map)->gpuBytes() - renderer(scan)->gpuBytes(),
              48 * map.flat.size() + 12 * map.surface.triangles.size() + 32 * map.cameras.size());
}

}  // namespace
}  // namespace haustra::tests
