#include "render/wall/strip_painter.h"

#include "render/flat/flat_coverage.h"
#include "render/flat/flat_geometry.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace haustra::render {

namespace {

constexpr glm::u8vec3 unseenColor(64, 132, 255), markColor(255, 224, 0);
constexpr int unseenCover = 150, rimCover = 235, insideCover = 95;
// A hatch's stripes are as wide as the gaps between them; both divide any paint's circumference.
constexpr glm::u8vec3 hatchColors[2] = {{255, 255, 255}, {96, 96, 96}};
constexpr int hatchPixels = 8, hatchCover = 255;
constexpr double rimShare = 0.2, leastRimMm = 0.6;

/// One colour over another, in display values.
glm::u8vec4 over(glm::u8vec3 upper, int cover, glm::u8vec4 lower) {
    const float a = float(cover) / 255.0f, b = float(lower.a) / 255.0f * (1.0f - a);
    if (!(a + b > 0.0f)) return glm::u8vec4(0);
    const glm::vec3 color = (a * glm::vec3(upper) + b * glm::vec3(lower)) / (a + b);
    return glm::u8vec4(glm::round(glm::vec4(color, 255.0f * (a + b))));
}

}  // namespace

StripPainter::StripPainter(std::shared_ptr<const WallSight> sight) : sight_(std::move(sight)) {}

Result<std::shared_ptr<const StripPainter>> StripPainter::of(
    std::shared_ptr<const WallSight> sight) {
    const FlatMap& map = sight->map();
    const auto geometry = TRY(FlatGeometry::of(map, sight->originMm()));
    std::shared_ptr<StripPainter> made(new StripPainter(std::move(sight)));
    int around = pixelsAround;
    while (std::ceil(map.height * around) > maxPaintSide)
        around /= 2;
    const glm::ivec2 size(around, std::max(1, int(std::ceil(map.height * around))));
    made->size_ = size;
    const FlatWindow window{{0.5, 0.5 * size.y / around}, double(around)};
    std::vector<FlatPixel> pixels(std::size_t(size.x) * std::size_t(size.y));
    coverRows(*geometry, geometry->lattice(window, Band::whole(size.x, size.y)), 0, size.y, pixels);
    for (const FlatPixel& pixel : pixels)
        made->triangle_.push_back(pixel.triangle < 0 ? -1 : geometry->mapTriangle(pixel.triangle));
    return std::shared_ptr<const StripPainter>(std::move(made));
}

glm::dvec2 StripPainter::flatOf(glm::ivec2 pixel) const {
    return (glm::dvec2(size_) - glm::dvec2(pixel) - 0.5) / double(size_.x);
}

// Of a pixel that has a triangle.
glm::dvec3 StripPainter::placeOf(glm::ivec2 pixel) const {
    const FlatMap& map = sight_->map();
    const glm::ivec3 t = map.surface.triangles[std::size_t(triangle_[at(pixel)])];
    const auto flat = [&](int corner) { return map.flat[std::size_t(t[corner])]; };
    const auto place = [&](int corner) { return map.surface.vertices[std::size_t(t[corner])]; };
    const glm::dvec2 a = flat(0), ab = flat(1) - a, ac = flat(2) - a;
    glm::dvec2 fromA = flatOf(pixel) - a;
    fromA.x -= std::round(fromA.x);  // the copy of the strip that the triangle is in
    const double doubled = ab.x * ac.y - ab.y * ac.x;
    if (doubled == 0.0) return place(0);
    const double v = (fromA.x * ac.y - fromA.y * ac.x) / doubled,
                 w = (ab.x * fromA.y - ab.y * fromA.x) / doubled;
    return place(0) + v * (place(1) - place(0)) + w * (place(2) - place(0));
}

std::optional<WallSight::Place> StripPainter::placeAt(std::int32_t pixel) const {
    const int triangle = triangle_[std::size_t(pixel)];
    if (triangle < 0) return std::nullopt;
    const glm::ivec2 at(pixel % size_.x, pixel / size_.x);
    return WallSight::Place{triangle, flatOf(at), placeOf(at)};
}

std::vector<MarkedPixel> StripPainter::discs(std::span<const WallMark> marks,
                                             double radiusMm) const {
    const double rimMm = std::min(radiusMm, std::max(leastRimMm, rimShare * radiusMm));
    std::unordered_map<std::int32_t, std::uint8_t> covers;
    for (const WallMark& mark : marks) {
        const glm::dvec2 from = glm::dvec2(size_) - mark.flat * double(size_.x);
        glm::ivec2 start(glm::floor(from));
        start.x = ((start.x % size_.x) + size_.x) % size_.x;
        start.y = std::clamp(start.y, 0, size_.y - 1);
        std::vector<glm::ivec2> front{start};
        std::unordered_map<std::int32_t, bool> met{{std::int32_t(at(start)), true}};
        while (!front.empty()) {
            const glm::ivec2 pixel = front.back();
            front.pop_back();
            if (triangle_[at(pixel)] < 0) continue;
            const double distance = glm::distance(placeOf(pixel), mark.positionMm);
            // The pixel that the mark lies in belongs to its disc, however small.
            if (distance > radiusMm && pixel != start) continue;
            std::uint8_t& cover = covers[std::int32_t(at(pixel))];
            const bool rim = distance > radiusMm - rimMm;
            cover = std::max(cover, std::uint8_t(rim ? rimCover : insideCover));
            for (const glm::ivec2 step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
                const glm::ivec2 next((pixel.x + step.x + size_.x) % size_.x, pixel.y + step.y);
                if (next.y < 0 || next.y >= size_.y) continue;
                if (met.emplace(std::int32_t(at(next)), true).second) front.push_back(next);
            }
        }
    }
    std::vector<MarkedPixel> pixels;
    for (const auto& [pixel, cover] : covers)
        pixels.push_back({pixel, cover});
    std::sort(pixels.begin(), pixels.end(),
              [](const MarkedPixel& a, const MarkedPixel& b) { return a.pixel < b.pixel; });
    return pixels;
}

void StripPainter::hatch(WallPaint& paint) const {
    if (!sight_->hasBridges()) return;
    for (int y = 0; y < size_.y; ++y) {
        for (int x = 0; x < size_.x; ++x) {
            const std::int32_t triangle = triangle_[at({x, y})];
            if (triangle >= 0 && sight_->isBridge(triangle))
                paint.pixels[at({x, y})] =
                    glm::u8vec4(hatchColors[(x + y) / hatchPixels % 2], hatchCover);
        }
    }
}

std::shared_ptr<const WallPaint> StripPainter::bridgesOver(const WallPaint& paint) const {
    auto both = std::make_shared<WallPaint>();
    both->size = size_;
    both->height = double(size_.y) / size_.x;
    both->smooth = true;
    both->pixels.resize(triangle_.size());
    for (int y = 0; y < size_.y; ++y)
        for (int x = 0; x < size_.x; ++x)
            both->pixels[at({x, y})] = paint.at(flatOf({x, y}));
    hatch(*both);
    return both;
}

std::shared_ptr<const WallPaint> StripPainter::paint(std::span<const MarkedPixel> marks,
                                                     std::span<const std::uint8_t> seenTriangles,
                                                     std::span<const TintedPixel> findings) const {
    auto paint = std::make_shared<WallPaint>();
    paint->size = size_;
    paint->height = double(size_.y) / size_.x;
    paint->smooth = true;
    paint->pixels.assign(triangle_.size(), glm::u8vec4(0));
    if (!seenTriangles.empty())
        for (std::size_t n = 0; n < triangle_.size(); ++n)
            if (triangle_[n] >= 0 && !seenTriangles[std::size_t(triangle_[n])])
                paint->pixels[n] = glm::u8vec4(unseenColor, unseenCover);
    for (const TintedPixel& tinted : findings) {
        glm::u8vec4& pixel = paint->pixels[std::size_t(tinted.pixel)];
        pixel = over(glm::u8vec3(tinted.color), tinted.color.a, pixel);
    }
    hatch(*paint);
    for (const MarkedPixel& marked : marks) {
        glm::u8vec4& pixel = paint->pixels[std::size_t(marked.pixel)];
        pixel = over(markColor, marked.cover, pixel);
    }
    return paint;
}

}  // namespace haustra::render
