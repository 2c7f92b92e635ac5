#include "mesh/polygon_soup.h"

#include <bit>
#include <cmath>
#include <unordered_map>

namespace haustra::mesh {
namespace {

constexpr std::size_t maxCorners = 10000;
constexpr std::size_t maxCount = std::size_t(1) << 30;

struct PlaceHash {
    std::size_t operator()(const glm::dvec3& p) const {
        std::uint64_t hash = 0;
        for (int axis = 0; axis < 3; ++axis) {
            hash = (hash ^ std::bit_cast<std::uint64_t>(p[axis])) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 29;
        }
        return hash;
    }
};

glm::dvec3 newellNormal(const std::vector<int>& polygon, const std::vector<glm::dvec3>& points) {
    glm::dvec3 normal(0.0);
    const glm::dvec3 origin = points[polygon[0]];
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        normal += glm::cross(points[polygon[i]] - origin,
                             points[polygon[(i + 1) % polygon.size()]] - origin);
    }
    return normal;
}

/// Twice the signed area of abc seen against `normal`.
double turn(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
            const glm::dvec3& normal) {
    return glm::dot(glm::cross(b - a, c - a), normal);
}

bool isEar(const std::vector<int>& polygon, std::size_t tip, const std::vector<glm::dvec3>& points,
           const glm::dvec3& normal) {
    const std::size_t n = polygon.size();
    const std::size_t before = (tip + n - 1) % n, after = (tip + 1) % n;
    const glm::dvec3 &a = points[polygon[before]], &b = points[polygon[tip]],
                     &c = points[polygon[after]];
    if (turn(a, b, c, normal) <= 0.0) return false;
    for (std::size_t i = 0; i < n; ++i) {
        if (i == before || i == tip || i == after) continue;
        const glm::dvec3& p = points[polygon[i]];
        if (turn(a, b, p, normal) >= 0.0 && turn(b, c, p, normal) >= 0.0 &&
            turn(c, a, p, normal) >= 0.0) {
            return false;
        }
    }
    return true;
}

/// Where to start: the tip whose removal leaves the shorter diagonal of a quadrilateral.
std::size_t firstTip(const std::vector<int>& polygon, const std::vector<glm::dvec3>& points) {
    if (polygon.size() != 4) return 1;
    const glm::dvec3 across = points[polygon[2]] - points[polygon[0]];
    const glm::dvec3 other = points[polygon[3]] - points[polygon[1]];
    return glm::dot(other, other) < glm::dot(across, across) ? 0 : 1;
}

void clipEars(std::vector<int> polygon, const std::vector<glm::dvec3>& points,
              std::vector<glm::ivec3>& triangles) {
    const glm::dvec3 normal = newellNormal(polygon, points);
    std::size_t tip = firstTip(polygon, points);
    while (polygon.size() > 3) {
        const std::size_t n = polygon.size();
        std::size_t tried = 0;
        while (tried < n && !isEar(polygon, (tip + tried) % n, points, normal))
            ++tried;
        // A polygon that crosses itself may have no ear; any tip then keeps its connectivity.
        const std::size_t ear = (tip + (tried < n ? tried : 0)) % n;
        triangles.push_back({polygon[(ear + n - 1) % n], polygon[ear], polygon[(ear + 1) % n]});
        polygon.erase(polygon.begin() + std::ptrdiff_t(ear));
        tip = ear % (n - 1);
    }
    triangles.push_back({polygon[0], polygon[1], polygon[2]});
}

}  // namespace

void weldPoints(PolygonSoup& soup) {
    std::unordered_map<glm::dvec3, std::int64_t, PlaceHash> indexOf;
    indexOf.reserve(soup.points.size() / 4);
    std::vector<std::int64_t> welded(soup.points.size());
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < soup.points.size(); ++i) {
        const glm::dvec3 place = soup.points[i] + 0.0;  // −0 becomes 0
        const auto [entry, isNew] = indexOf.try_emplace(place, std::int64_t(points.size()));
        if (isNew) points.push_back(place);
        welded[i] = entry->second;
    }
    for (std::int64_t& corner : soup.corners)
        corner = welded[std::size_t(corner)];
    soup.points = std::move(points);
}

Result<TriMesh> triangulated(const PolygonSoup& soup, const std::string& place) {
    if (soup.points.size() > maxCount || soup.corners.size() > maxCount)
        return fail(ErrorKind::badInput, "the mesh is too large", place);
    for (const glm::dvec3& p : soup.points) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return fail(ErrorKind::badInput, "the mesh has a coordinate that is not finite", place);
    }
    TriMesh mesh;
    mesh.vertices = soup.points;
    std::vector<int> polygon;
    for (std::size_t p = 0; p < soup.polygonCount(); ++p) {
        polygon.clear();
        for (std::size_t i = soup.firstCorner[p]; i < soup.firstCorner[p + 1]; ++i) {
            const std::int64_t corner = soup.corners[i];
            if (corner < 0 || corner >= std::int64_t(soup.points.size()))
                return fail(ErrorKind::badInput, "a polygon of the mesh names no vertex", place);
            if (polygon.empty() || polygon.back() != corner) polygon.push_back(int(corner));
        }
        while (polygon.size() > 1 && polygon.back() == polygon.front())
            polygon.pop_back();
        if (polygon.size() < 3) continue;
        if (polygon.size() > maxCorners)
            return fail(ErrorKind::badInput, "the mesh has a polygon of too many corners", place);
        if (polygon.size() == 3)
            mesh.triangles.push_back({polygon[0], polygon[1], polygon[2]});
        else
            clipEars(polygon, mesh.vertices, mesh.triangles);
    }
    if (mesh.triangles.empty()) return fail(ErrorKind::badInput, "the mesh has no triangle", place);
    return mesh;
}

}  // namespace haustra::mesh
