#include "core/flat_lookup.h"

#include "core/polygon_bands.h"
#include "core/triangle_tree.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

namespace haustra {
namespace {

/// x modulo 1, in [0, 1).
double wrapped(double x) {
    const double inside = x - std::floor(x);
    return inside < 1.0 ? inside : 0.0;  // just below a whole number it can round up to 1
}

std::vector<glm::dvec3> inPlane(const std::vector<glm::dvec2>& flat) {
    std::vector<glm::dvec3> vertices;
    vertices.reserve(flat.size());
    for (const glm::dvec2& v : flat)
        vertices.push_back({v, 0.0});
    return vertices;
}

bool finite(glm::dvec2 p) {
    return std::isfinite(p.x) && std::isfinite(p.y);
}

struct FlatTriangle {
    std::array<glm::dvec2, 3> corners;
    double doubleArea;

    glm::dvec3 barycentric(glm::dvec2 p) const {
        const auto& [a, b, c] = corners;
        return glm::dvec3(cross(b - p, c - p), cross(c - p, a - p), cross(a - p, b - p)) /
               doubleArea;
    }
};

/// What part of a line, by its parameter, lies in one triangle.
struct Stretch {
    double begin, end;
    int triangle;
    double shift;  ///< whole turns from the line's x to the triangle's
};

/// The part of from…to in a triangle of positive area, widened by rounding: a line along an edge is
/// in both triangles rather than in neither.
bool clip(const FlatTriangle& triangle, glm::dvec2 from, glm::dvec2 to, Stretch& part) {
    part.begin = 0.0, part.end = 1.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec2 corner = triangle.corners[c];
        const glm::dvec2 edge = triangle.corners[(c + 1) % 3] - corner;
        const double slack = 1e-13 * triangle.doubleArea;
        const double atBegin = cross(edge, from - corner) + slack;
        const double atEnd = cross(edge, to - corner) + slack;
        if (atBegin < 0.0 && atEnd < 0.0) return false;
        if (atBegin < 0.0) part.begin = std::max(part.begin, atBegin / (atBegin - atEnd));
        if (atEnd < 0.0) part.end = std::min(part.end, atBegin / (atBegin - atEnd));
    }
    return part.begin < part.end;
}

/// Flat area of the part of a convex piece in a triangle (Sutherland and Hodgman 1974).
double sharedArea(const FlatTriangle& triangle, const Trapezoid& piece) {
    // A cut adds one corner to a convex polygon; half as many again to one that rounding bent.
    std::array<glm::dvec2, 16> polygon, cut;
    std::size_t count = piece.size();
    std::copy(piece.begin(), piece.end(), polygon.begin());
    for (std::size_t c = 0; c < 3; ++c) {
        const glm::dvec2 corner = triangle.corners[c];
        const glm::dvec2 edge = triangle.corners[(c + 1) % 3] - corner;
        std::size_t kept = 0;
        for (std::size_t n = 0; n < count; ++n) {
            const glm::dvec2 a = polygon[n], b = polygon[(n + 1) % count];
            const double sideA = cross(edge, a - corner), sideB = cross(edge, b - corner);
            if (sideA >= 0.0) cut[kept++] = a;
            if ((sideA < 0.0) != (sideB < 0.0)) cut[kept++] = a + sideA / (sideA - sideB) * (b - a);
        }
        polygon = cut;
        count = kept;
        if (count < 3) return 0.0;
    }
    double doubled = 0.0;
    for (std::size_t n = 1; n + 1 < count; ++n)
        doubled += cross(polygon[n] - polygon[0], polygon[n + 1] - polygon[0]);
    return 0.5 * std::max(doubled, 0.0);
}

}  // namespace

WallPlace placeByCenterline(const Centerline& centerline, glm::dvec3 wallMm) {
    WallPlace place;
    place.positionMm = place.cameraMm = wallMm;
    if (centerline.points.empty()) return place;
    place.arcMm = nearestArc(centerline, wallMm);
    place.cameraMm = poseAtArc(centerline, place.arcMm).point.positionMm;
    return place;
}

struct FlatLookup::Index {
    explicit Index(std::shared_ptr<const FlatMap> of)
        : map(std::move(of)),
          flat(inPlane(map->flat)),
          inFlat(flat, map->surface.triangles),
          inSpace(map->surface.vertices, map->surface.triangles) {}

    FlatTriangle flatTriangle(int triangle) const {
        const glm::ivec3 t = map->surface.triangles[std::size_t(triangle)];
        FlatTriangle result;
        for (int c = 0; c < 3; ++c)
            result.corners[std::size_t(c)] = map->flat[std::size_t(t[c])];
        const auto& [a, b, c] = result.corners;
        result.doubleArea = cross(b - a, c - a);
        return result;
    }

    glm::dvec3 position(int triangle, glm::dvec3 barycentric) const {
        const glm::ivec3 t = map->surface.triangles[std::size_t(triangle)];
        glm::dvec3 p(0.0);
        for (int c = 0; c < 3; ++c)
            p += barycentric[c] * map->surface.vertices[std::size_t(t[c])];
        return p;
    }

    WallPlace place(int triangle, glm::dvec3 barycentric) const {
        const glm::ivec3 t = map->surface.triangles[std::size_t(triangle)];
        WallPlace place;
        place.flatTriangle = triangle;
        place.sourceTriangle = map->sourceTriangle[std::size_t(triangle)];
        place.barycentric = barycentric;
        place.positionMm = position(triangle, barycentric);
        double camera = 0.0;
        for (int c = 0; c < 3; ++c) {
            place.flat += barycentric[c] * map->flat[std::size_t(t[c])];
            camera += barycentric[c] * map->camera[std::size_t(t[c])];
        }
        place.flat = {wrapped(place.flat.x), std::clamp(place.flat.y, 0.0, map->height)};
        const double last = double(map->cameras.size() - 1);
        camera = std::clamp(camera, 0.0, last);
        const FlatCamera& before = map->cameras[std::size_t(camera)];
        const FlatCamera& after = map->cameras[std::size_t(std::ceil(camera))];
        const double share = camera - std::floor(camera);
        place.arcMm = glm::mix(before.arcMm, after.arcMm, share);
        place.cameraMm = glm::mix(before.positionMm, after.positionMm, share);
        return place;
    }

    /// Calls visit(shift) for each whole number of turns by which [low, high] meets the flat map.
    template <class Visit>
    void forEachTurn(double low, double high, const Visit& visit) const {
        const double first = std::ceil(inFlat.bounds().low.x - high);
        const double last = std::floor(inFlat.bounds().high.x - low);
        for (double shift = first; shift <= last; shift += 1.0)
            visit(shift);
    }

    std::shared_ptr<const FlatMap> map;
    std::vector<glm::dvec3> flat;  ///< FlatMap::flat, z = 0
    TriangleTree inFlat, inSpace;
};

FlatLookup::FlatLookup(std::shared_ptr<const FlatMap> map)
    : index_(std::make_unique<const Index>(std::move(map))) {}
FlatLookup::~FlatLookup() = default;
FlatLookup::FlatLookup(FlatLookup&&) noexcept = default;
FlatLookup& FlatLookup::operator=(FlatLookup&&) noexcept = default;

const FlatMap& FlatLookup::map() const {
    return *index_->map;
}

std::optional<WallPlace> FlatLookup::at(glm::dvec2 flat) const {
    if (!std::isfinite(flat.x) || !(flat.y >= 0.0 && flat.y <= map().height)) return std::nullopt;
    flat.x = wrapped(flat.x);
    TriangleTree::Nearest best;
    // A hair beyond either side is nearest to the other's triangles, perhaps.
    index_->forEachTurn(flat.x - 0.5, flat.x + 0.5, [&](double shift) {
        index_->inFlat.nearest({flat.x + shift, flat.y, 0.0}, best);
    });
    WallPlace place = index_->place(best.triangle, best.barycentric);
    place.flat = flat;
    return place;
}

WallPlace FlatLookup::nearest(glm::dvec3 positionMm) const {
    TriangleTree::Nearest best;
    index_->inSpace.nearest(positionMm, best);
    return index_->place(best.triangle, best.barycentric);
}

WallPath FlatLookup::path(glm::dvec2 from, glm::dvec2 to) const {
    if (!finite(from) || !finite(to) || std::abs(to.x - from.x) > mostTurns) return {};
    const double turns = std::floor(from.x);
    from.x -= turns, to.x -= turns;
    from.y = std::clamp(from.y, 0.0, map().height);
    to.y = std::clamp(to.y, 0.0, map().height);

    std::vector<Stretch> parts;
    const auto [left, right] = std::minmax(from.x, to.x);
    index_->forEachTurn(left, right, [&](double shift) {
        const glm::dvec2 a(from.x + shift, from.y), b(to.x + shift, to.y);
        const glm::dvec2 half = 0.5 * glm::abs(b - a), middle = 0.5 * (a + b);
        const glm::dvec2 normal(a.y - b.y, b.x - a.x);
        const auto meets = [&](const TriangleTree::Box& box) {
            const glm::dvec2 size = 0.5 * glm::dvec2(box.high - box.low);
            const glm::dvec2 away = middle - 0.5 * glm::dvec2(box.high + box.low);
            return std::abs(away.x) <= half.x + size.x + 1e-12 &&
                   std::abs(away.y) <= half.y + size.y + 1e-12 &&
                   std::abs(glm::dot(away, normal)) <= glm::dot(size + 1e-12, glm::abs(normal));
        };
        index_->inFlat.forEach(meets, [&](int triangle) {
            const FlatTriangle flat = index_->flatTriangle(triangle);
            Stretch part{0.0, 1.0, triangle, shift};
            if (flat.doubleArea > 0.0 && clip(flat, a, b, part)) parts.push_back(part);
        });
    });
    std::sort(parts.begin(), parts.end(), [](const Stretch& a, const Stretch& b) {
        return std::tie(a.begin, a.end, a.triangle) < std::tie(b.begin, b.end, b.triangle);
    });

    WallPath path;
    const auto add = [&](glm::dvec3 point) {
        if (!path.pointsMm.empty()) path.lengthMm += glm::distance(path.pointsMm.back(), point);
        path.pointsMm.push_back(point);
    };
    const auto pointOf = [&](const Stretch& part, double t) {
        const glm::dvec2 p = glm::mix(from, to, t) + glm::dvec2(part.shift, 0.0);
        return index_->position(part.triangle, index_->flatTriangle(part.triangle).barycentric(p));
    };
    const auto end = [&](glm::dvec2 flat) { return at(flat)->positionMm; };
    add(end(from));
    double reached = 0.0;
    for (const Stretch& part : parts) {
        // Stretches that end where the line is already are what rounding widened.
        if (part.end <= reached + 1e-12 || part.end > 1.0 - 1e-12) continue;
        reached = part.end;
        add(pointOf(part, part.end));
    }
    add(end(to));
    path.straightMm = glm::distance(path.pointsMm.front(), path.pointsMm.back());
    return path;
}

double FlatLookup::areaMm2(const std::vector<glm::dvec2>& polygon) const {
    const auto byX = [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; };
    if (polygon.empty() || !std::all_of(polygon.begin(), polygon.end(), finite)) return 0.0;
    const auto [leftmost, rightmost] = std::minmax_element(polygon.begin(), polygon.end(), byX);
    if (rightmost->x - leftmost->x > mostTurns) return 0.0;
    const double turns = std::floor(leftmost->x);
    std::vector<glm::dvec2> near = polygon;
    for (glm::dvec2& corner : near)
        corner.x -= turns;
    double sum = 0.0;
    for (const Trapezoid& piece : evenOddTrapezoids(near)) {
        const auto ends = std::minmax({piece[0].x, piece[1].x, piece[2].x, piece[3].x});
        const double left = ends.first, right = ends.second;
        index_->forEachTurn(left, right, [&](double shift) {
            Trapezoid moved = piece;
            for (glm::dvec2& corner : moved)
                corner.x += shift;
            const auto meets = [&](const TriangleTree::Box& box) {
                return box.high.x >= left + shift && box.low.x <= right + shift &&
                       box.high.y >= piece[0].y && box.low.y <= piece[2].y;
            };
            index_->inFlat.forEach(meets, [&](int triangle) {
                const FlatTriangle flat = index_->flatTriangle(triangle);
                if (flat.doubleArea <= 0.0) return;
                const double flatArea = sharedArea(flat, moved);
                if (flatArea == 0.0) return;
                const glm::ivec3 t = map().surface.triangles[std::size_t(triangle)];
                const auto& v = map().surface.vertices;
                const double doubleAreaMm2 =
                    glm::length(glm::cross(v[std::size_t(t.y)] - v[std::size_t(t.x)],
                                           v[std::size_t(t.z)] - v[std::size_t(t.x)]));
                sum += flatArea * doubleAreaMm2 / flat.doubleArea;
            });
        });
    }
    return sum;
}

}  // namespace haustra
