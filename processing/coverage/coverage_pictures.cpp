#include "coverage/coverage_pictures.h"

#include "core/orbit.h"
#include "core/parallel.h"
#include "core/srgb.h"

#include <algorithm>
#include <cmath>

namespace haustra::coverage {
namespace {

// Linear light.
constexpr glm::vec3 seenColor(0.10f, 0.55f, 0.12f), unseenColor(0.80f, 0.38f, 0.30f),
    bridgeColor(0.35f), pathColor(0.02f, 0.05f, 0.35f);
constexpr int samplesAside = 2;  // per pixel, in each direction

std::uint8_t display(float linear) {
    return std::uint8_t(std::lround(255.0 * displayedLight(std::clamp(linear, 0.0f, 1.0f))));
}

/// Outward, by area, of each vertex.
std::vector<glm::vec3> normalsOf(const TriMesh& mesh) {
    std::vector<glm::vec3> normals(mesh.vertices.size(), glm::vec3(0.0f));
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)];
        const glm::vec3 outward(
            glm::cross(mesh.vertices[std::size_t(t.y)] - a, mesh.vertices[std::size_t(t.z)] - a));
        for (int n = 0; n < 3; ++n)
            normals[std::size_t(t[n])] += outward;
    }
    return normals;
}

/// What a ray that has met a triangle brings back.
class Paint {
public:
    Paint(const WallRays& rays, const CoverageWall& wall, const std::vector<Visibility>& seen)
        : rays_(rays), wall_(wall), seen_(seen), normals_(normalsOf(wall.mesh)) {}

    glm::vec3 color(const WallRays::Hit& hit, glm::vec3 from, glm::vec3 along) const {
        const auto n = std::size_t(hit.triangle);
        const glm::vec3 albedo = wall_.bridged[n]                 ? bridgeColor
                                 : seen_[n] != Visibility::unseen ? seenColor
                                                                  : unseenColor;
        const WallRays::Facet& f = rays_.facet(n);
        const glm::vec3 p = from + hit.distanceMm * along,
                        whole =
                            glm::cross(f.corners[1] - f.corners[0], f.corners[2] - f.corners[0]);
        glm::vec3 normal(0.0f);
        for (int corner = 0; corner < 3; ++corner) {
            const glm::vec3 b = f.corners[(corner + 1) % 3], c = f.corners[(corner + 2) % 3];
            const float weight = glm::dot(glm::cross(b - p, c - p), whole);
            normal += weight * normals_[std::size_t(wall_.mesh.triangles[n][corner])];
        }
        const float length = glm::length(normal);
        const float facing = length > 0.0f ? std::abs(glm::dot(normal, along)) / length : 0.0f;
        return albedo * (0.08f + 0.92f * facing);
    }

private:
    const WallRays& rays_;
    const CoverageWall& wall_;
    const std::vector<Visibility>& seen_;
    std::vector<glm::vec3> normals_;
};

void set(Image& image, int x, int y, glm::vec3 linear) {
    std::uint8_t* pixel =
        image.rgb.data() + 3 * (std::size_t(y) * std::size_t(image.width) + std::size_t(x));
    for (int n = 0; n < 3; ++n)
        pixel[n] = display(linear[n]);
}

}  // namespace

Image paintedView(const WallRays& rays, const CoverageWall& wall,
                  const std::vector<Visibility>& seen, const Eyepiece& eyepiece,
                  const CenterlineCamera& camera, int threads) {
    const Paint paint(rays, wall, seen);
    const Pose pose(camera, rays.originMm());
    Image image = blankImage(eyepiece.size());
    parallelFor(std::size_t(image.height), 8, threads, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y) {
            for (int x = 0; x < image.width; ++x) {
                const glm::vec3 direction =
                    eyepiece
                        .directions()[std::size_t(y) * std::size_t(image.width) + std::size_t(x)];
                if (direction == glm::vec3(0.0f)) continue;
                const glm::vec3 along = pose.toWorld(direction);
                const auto hit = rays.firstMet(pose.eye, along, 0.0f, INFINITY);
                if (hit.triangle < 0) continue;
                // The lamp's light falls off with depth, as in a colonoscope's picture.
                const float depth = hit.distanceMm / 60.0f;
                set(image, x, y, paint.color(hit, pose.eye, along) * 1.3f / (1.0f + depth * depth));
            }
        }
    });
    return image;
}

Image paintedOutside(const WallRays& rays, const CoverageWall& wall,
                     const std::vector<Visibility>& seen, const Centerline& path, glm::ivec2 size,
                     double azimuthDegrees, int threads) {
    const Paint paint(rays, wall, seen);
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::dvec3& vertex : wall.mesh.vertices)
        low = glm::min(low, vertex), high = glm::max(high, vertex);
    Orbit orbit = orbitAround(low, high, double(size.x) / size.y);
    orbit.azimuthDegrees = azimuthDegrees;
    const Camera camera = cameraOf(orbit);
    const glm::dvec3 right = glm::cross(camera.forward, camera.up);
    const double mmPerPixel = camera.heightMm / size.y;
    const auto placeOf = [&](double x, double y) {
        return glm::vec3(camera.positionMm + mmPerPixel * (x - 0.5 * size.x) * right -
                         mmPerPixel * (y - 0.5 * size.y) * camera.up - rays.originMm());
    };
    Image image = blankImage(size);
    const glm::vec3 along(camera.forward);
    parallelFor(std::size_t(size.y), 8, threads, [&](std::size_t begin, std::size_t end) {
        for (int y = int(begin); y < int(end); ++y) {
            for (int x = 0; x < size.x; ++x) {
                glm::vec3 sum(0.0f);
                for (int n = 0; n < samplesAside * samplesAside; ++n) {
                    const glm::vec3 from = placeOf(x + (n % samplesAside + 0.5) / samplesAside,
                                                   y + (n / samplesAside + 0.5) / samplesAside);
                    const auto hit = rays.firstMet(from, along, 0.0f, INFINITY);
                    sum += hit.triangle < 0 ? glm::vec3(1.0f) : paint.color(hit, from, along);
                }
                set(image, x, y, sum / float(samplesAside * samplesAside));
            }
        }
    });
    for (const CenterlinePoint& point : path.points) {
        const glm::dvec3 at = projected(camera, point.positionMm, glm::dvec2(size));
        for (int y = int(at.y) - 1; y <= int(at.y); ++y)
            for (int x = int(at.x) - 1; x <= int(at.x); ++x)
                if (x >= 0 && y >= 0 && x < size.x && y < size.y) set(image, x, y, pathColor);
    }
    return image;
}

}  // namespace haustra::coverage
