#include "handles/hole_fill.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_2_algorithms.h>
#include <CGAL/Polygon_mesh_processing/refine.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <Eigen/SparseCholesky>

namespace haustra::handles {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point2 = Kernel::Point_2;
using Point3 = Kernel::Point_3;

/// The mean plane of a polygon: origin, two axes in it and the normal by the right-hand rule.
struct Plane {
    glm::dvec3 origin, u, v;
    glm::dvec2 project(const glm::dvec3& p) const {
        return {glm::dot(p - origin, u), glm::dot(p - origin, v)};
    }
};

std::optional<Plane> meanPlane(const std::vector<glm::dvec3>& polygon) {
    glm::dvec3 center(0.0), area(0.0);
    for (const auto& p : polygon)
        center += p / double(polygon.size());
    double around = 0.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        area += 0.5 * glm::cross(a - center, b - center);
        around += glm::distance(a, b);
    }
    const double size = glm::length(area);
    if (!(size > 0.01 * around * around)) return std::nullopt;  // a circle's share is 0.08
    const glm::dvec3 normal = area / size;
    const glm::dvec3 other = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 u = glm::normalize(glm::cross(other, normal));
    return Plane{center, u, glm::cross(normal, u)};
}

double distanceToSegment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const glm::dvec2 ab = b - a;
    const double t = std::clamp(glm::dot(p - a, ab) / glm::dot(ab, ab), 0.0, 1.0);
    return glm::distance(p, a + t * ab);
}

/// Points of a hexagonal lattice that keep clear of the outline, inside or not.
std::vector<glm::dvec2> latticePoints(const std::vector<glm::dvec2>& outline, double spacing) {
    glm::dvec2 low = outline[0], high = outline[0];
    for (const auto& p : outline)
        low = glm::min(low, p), high = glm::max(high, p);
    const double cell = 2.0 * spacing;
    const auto cellOf = [&](const glm::dvec2& p) {
        return std::pair(int(std::floor((p.x - low.x) / cell)),
                         int(std::floor((p.y - low.y) / cell)));
    };
    std::map<std::pair<int, int>, std::vector<std::size_t>> near;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const auto a = cellOf(outline[i]), b = cellOf(outline[(i + 1) % outline.size()]);
        for (int x = std::min(a.first, b.first) - 1; x <= std::max(a.first, b.first) + 1; ++x) {
            for (int y = std::min(a.second, b.second) - 1; y <= std::max(a.second, b.second) + 1;
                 ++y)
                near[{x, y}].push_back(i);
        }
    }
    const double rise = spacing * std::sqrt(0.75);
    std::vector<glm::dvec2> points;
    for (int row = 0; low.y + row * rise < high.y; ++row) {
        for (double x = low.x + (row % 2) * 0.5 * spacing; x < high.x; x += spacing) {
            const glm::dvec2 p(x, low.y + row * rise);
            const auto found = near.find(cellOf(p));
            const bool clear =
                found == near.end() ||
                std::all_of(found->second.begin(), found->second.end(), [&](std::size_t i) {
                    return distanceToSegment(p, outline[i], outline[(i + 1) % outline.size()]) >=
                           0.65 * spacing;
                });
            if (clear) points.push_back(p);
        }
    }
    return points;
}

/// Splits every edge between two corners that is not the polygon's.
void splitChords(LoopDisc& disc, const std::vector<glm::dvec3>& corners) {
    const int n = disc.corners;
    const auto isChord = [n](int a, int b) {
        return a < n && b < n && (a + 1) % n != b && (b + 1) % n != a;
    };
    std::map<std::pair<int, int>, int> middles;
    for (std::size_t t = 0; t < disc.triangles.size();) {
        const glm::ivec3 triangle = disc.triangles[t];
        int corner = 0;
        while (corner < 3 && !isChord(triangle[corner], triangle[(corner + 1) % 3]))
            ++corner;
        if (corner == 3) {
            ++t;
            continue;
        }
        const int a = triangle[corner], b = triangle[(corner + 1) % 3],
                  c = triangle[(corner + 2) % 3];
        const auto [middle, isNew] =
            middles.try_emplace(std::minmax(a, b), n + int(disc.interior.size()));
        if (isNew) disc.interior.push_back(0.5 * (corners[a] + corners[b]));
        disc.triangles[t] = {a, middle->second, c};
        disc.triangles.push_back({middle->second, b, c});
    }
}

std::optional<LoopDisc> spanInPlane(const std::vector<glm::dvec3>& polygon) {
    const auto plane = meanPlane(polygon);
    if (!plane) return std::nullopt;
    const std::size_t n = polygon.size();
    std::vector<glm::dvec2> outline;
    std::vector<Point2> points;
    double around = 0.0;
    for (const auto& p : polygon) {
        outline.push_back(plane->project(p));
        points.emplace_back(outline.back().x, outline.back().y);
    }
    for (std::size_t i = 0; i < n; ++i) {
        const double length = glm::distance(polygon[i], polygon[(i + 1) % n]);
        if (glm::distance(outline[i], outline[(i + 1) % n]) < 0.3 * length) return std::nullopt;
        around += length;
    }
    if (!CGAL::is_simple_2(points.begin(), points.end(), Kernel())) return std::nullopt;

    using VertexBase = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
    using FaceBase = CGAL::Triangulation_face_base_with_info_2<
        int, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
    using Delaunay = CGAL::Constrained_Delaunay_triangulation_2<
        Kernel, CGAL::Triangulation_data_structure_2<VertexBase, FaceBase>>;
    Delaunay delaunay;
    std::vector<Delaunay::Vertex_handle> handles;
    for (std::size_t i = 0; i < n; ++i) {
        handles.push_back(delaunay.insert(points[i]));
        handles.back()->info() = int(i);
    }
    if (delaunay.number_of_vertices() != n) return std::nullopt;
    for (std::size_t i = 0; i < n; ++i)
        delaunay.insert_constraint(handles[i], handles[(i + 1) % n]);
    const auto inside = [&](const Point2& p) {
        return CGAL::bounded_side_2(points.begin(), points.end(), p, Kernel()) ==
               CGAL::ON_BOUNDED_SIDE;
    };
    LoopDisc disc;
    disc.corners = int(n);
    for (const glm::dvec2& p : latticePoints(outline, around / double(n))) {
        if (!inside({p.x, p.y})) continue;
        delaunay.insert(Point2(p.x, p.y))->info() = int(n + disc.interior.size());
        disc.interior.push_back(plane->origin + p.x * plane->u + p.y * plane->v);
    }
    // Inside is what an odd number of outline edges parts from infinity.
    std::vector<Delaunay::Face_handle> stack{delaunay.infinite_face()};
    for (auto face : delaunay.all_face_handles())
        face->info() = -1;
    delaunay.infinite_face()->info() = 0;
    while (!stack.empty()) {
        const auto face = stack.back();
        stack.pop_back();
        for (int i = 0; i < 3; ++i) {
            const auto next = face->neighbor(i);
            if (next->info() >= 0) continue;
            next->info() = face->info() ^ int(face->is_constrained(i));
            stack.push_back(next);
        }
    }
    for (auto face : delaunay.finite_face_handles()) {
        if (face->info() != 1) continue;
        disc.triangles.push_back(
            {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
    }
    splitChords(disc, polygon);

    std::vector<glm::dvec3> offsets(n);
    const glm::dvec3 normal = glm::cross(plane->u, plane->v);
    for (std::size_t i = 0; i < n; ++i)
        offsets[i] = glm::dot(polygon[i] - plane->origin, normal) * normal;
    const auto heights = extendInside(disc, offsets);
    for (std::size_t i = 0; i < heights.size(); ++i) {
        glm::dvec3& p = disc.interior[i];
        p += heights[i] - glm::dot(p - plane->origin, normal) * normal;
    }
    return disc;
}

LoopDisc spanInSpace(const std::vector<glm::dvec3>& polygon) {
    const std::size_t n = polygon.size();
    std::vector<Point3> points;
    for (const auto& p : polygon)
        points.emplace_back(p.x, p.y, p.z);
    std::vector<CGAL::Triple<int, int, int>> triples;
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(points, std::back_inserter(triples));
    LoopDisc disc;
    disc.corners = int(n);
    if (triples.size() + 2 != n) {  // a fan round the centre always closes it
        glm::dvec3 center(0.0);
        for (const auto& p : polygon)
            center += p / double(n);
        disc.interior.push_back(center);
        for (std::size_t i = 0; i < n; ++i)
            disc.triangles.push_back({int(i), int((i + 1) % n), int(n)});
        return disc;
    }

    CGAL::Surface_mesh<Point3> patch;
    std::vector<CGAL::SM_Vertex_index> vertices;
    for (const Point3& p : points)
        vertices.push_back(patch.add_vertex(p));
    // CGAL's triangles may run against the polygon; the first edge tells.
    bool along = false;
    for (const auto& t : triples) {
        const int corners[3] = {t.first, t.second, t.third};
        for (int c = 0; c < 3; ++c)
            along |= corners[c] == 0 && corners[(c + 1) % 3] == 1;
    }
    for (const auto& t : triples) {
        const int b = along ? t.second : t.third, c = along ? t.third : t.second;
        patch.add_face(vertices[t.first], vertices[b], vertices[c]);
    }
    std::vector<CGAL::SM_Face_index> newFaces;
    std::vector<CGAL::SM_Vertex_index> newVertices;
    const std::vector<CGAL::SM_Face_index> faces(patch.faces_begin(), patch.faces_end());
    CGAL::Polygon_mesh_processing::refine(patch, faces, std::back_inserter(newFaces),
                                          std::back_inserter(newVertices));
    for (std::size_t v = n; v < patch.number_of_vertices(); ++v) {
        const Point3& p = patch.point(CGAL::SM_Vertex_index(CGAL::SM_Vertex_index::size_type(v)));
        disc.interior.push_back({p.x(), p.y(), p.z()});
    }
    for (const auto face : patch.faces()) {
        glm::ivec3 triangle;
        int corner = 0;
        for (const auto v : patch.vertices_around_face(patch.halfedge(face)))
            triangle[corner++] = int(v.idx());
        disc.triangles.push_back(triangle);
    }
    splitChords(disc, polygon);
    disc.interior = extendInside(disc, polygon);
    return disc;
}

}  // namespace

std::vector<glm::dvec3> extendInside(const LoopDisc& disc, const std::vector<glm::dvec3>& corners) {
    const int n = disc.corners, inner = int(disc.interior.size());
    if (inner == 0) return {};
    std::set<std::pair<int, int>> edges;
    for (const glm::ivec3& t : disc.triangles) {
        for (int corner = 0; corner < 3; ++corner)
            edges.insert(std::minmax(t[corner], t[(corner + 1) % 3]));
    }
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(inner, 3);
    std::vector<double> degree(std::size_t(inner), 0.0);
    std::vector<Eigen::Triplet<double>> entries;
    const auto couple = [&](int from, int to) {
        if (from < n) return;
        degree[from - n] += 1.0;
        if (to >= n) {
            entries.emplace_back(from - n, to - n, -1.0);
        } else {
            for (int axis = 0; axis < 3; ++axis)
                right(from - n, axis) += corners[to][axis];
        }
    };
    for (const auto& [a, b] : edges) {
        couple(a, b);
        couple(b, a);
    }
    for (int i = 0; i < inner; ++i)
        entries.emplace_back(i, i, degree[i]);
    Eigen::SparseMatrix<double> laplacian(inner, inner);
    laplacian.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(laplacian);
    const Eigen::MatrixXd solved = solver.solve(right);
    std::vector<glm::dvec3> values(std::size_t(inner), glm::dvec3(0.0));
    for (int i = 0; i < inner; ++i)
        values[i] = {solved(i, 0), solved(i, 1), solved(i, 2)};
    return values;
}

LoopDisc spanLoop(const std::vector<glm::dvec3>& polygon) {
    if (polygon.size() == 3) return {3, {}, {{0, 1, 2}}};
    if (auto disc = spanInPlane(polygon)) return *disc;
    return spanInSpace(polygon);
}

}  // namespace haustra::handles
