#include "render/wall/wall_sight.h"

#include "core/missed_patches.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include <embree3/rtcore.h>

namespace haustra::render {

struct WallSight::Tree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    ~Tree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

namespace {

tl::unexpected<Error> noRoom() {
    return fail(ErrorKind::device, "there is not enough memory for the wall's lines of sight",
                "wall");
}

RTCRay rayFrom(glm::vec3 from, glm::vec3 along) {
    RTCRay ray{};
    ray.org_x = from.x, ray.org_y = from.y, ray.org_z = from.z;
    ray.dir_x = along.x, ray.dir_y = along.y, ray.dir_z = along.z;
    ray.mask = ~0u;
    return ray;
}

/// The lesser singular value of the map from the triangle's plane to the strip, which the
/// triangle's sides define: that of the 2×2 matrix M from one to the other, from |M|² and det M.
float leastStretch(glm::dvec3 ab, glm::dvec3 ac, glm::dvec2 flatAb, glm::dvec2 flatAc) {
    const double length = glm::length(ab), doubled = glm::length(glm::cross(ab, ac));
    if (!(doubled > 0.0)) return 0.0f;
    // The sides in axes along ab and across it: (length, 0) and `c`.
    const glm::dvec2 c(glm::dot(ab, ac) / length, doubled / length);
    const glm::dvec2 along = flatAb / length, across = (flatAc - c.x * along) / c.y;
    const double squares = glm::dot(along, along) + glm::dot(across, across);
    const double det = along.x * across.y - along.y * across.x;
    const double apart = std::sqrt(std::max(squares * squares - 4.0 * det * det, 0.0));
    return float(std::sqrt(std::max(0.5 * (squares - apart), 0.0)));
}

}  // namespace

WallSight::WallSight(std::shared_ptr<const FlatMap> map)
    : map_(std::move(map)), tree_(std::make_unique<Tree>()) {}
WallSight::~WallSight() = default;

Result<std::shared_ptr<const WallSight>> WallSight::of(std::shared_ptr<const FlatMap> map,
                                                       std::vector<std::uint8_t> bridged) {
    std::shared_ptr<WallSight> made(new WallSight(std::move(map)));
    if (!bridged.empty() && bridged.size() != made->map_->surface.triangles.size())
        return fail(ErrorKind::badInput, "the bridges are of another flat map", "wall");
    if (std::any_of(bridged.begin(), bridged.end(), [](std::uint8_t is) { return is != 0; }))
        made->bridged_ = std::move(bridged);
    const TriMesh& mesh = made->map_->surface;
    glm::dvec3 low(std::numeric_limits<double>::max()), high = -low;
    for (const glm::dvec3& vertex : mesh.vertices)
        low = glm::min(low, vertex), high = glm::max(high, vertex);
    made->originMm_ = 0.5 * (low + high);
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[std::size_t(t.x)], b = mesh.vertices[std::size_t(t.y)],
                         c = mesh.vertices[std::size_t(t.z)];
        const glm::dvec3 outward = glm::cross(b - a, c - a);
        const double doubled = glm::length(outward);
        const auto flat = [&](int corner) { return made->map_->flat[std::size_t(t[corner])]; };
        made->facets_.push_back({glm::vec3((a + b + c) / 3.0 - made->originMm_),
                                 doubled > 0.0 ? glm::vec3(-outward / doubled) : glm::vec3(0.0f),
                                 float(0.5 * doubled),
                                 glm::vec2((flat(0) + flat(1) + flat(2)) / 3.0),
                                 leastStretch(b - a, c - a, flat(1) - flat(0), flat(2) - flat(0))});
        if (!made->isBridge(int(made->facets_.size()) - 1)) made->areaMm2_ += 0.5 * doubled;
    }
    made->neighbours_ = neighboursOf(mesh);

    // One thread, so that the tree is the same each time and no case starts threads of its own.
    Tree& tree = *made->tree_;
    tree.device = rtcNewDevice("threads=1,set_affinity=0");
    if (!tree.device) return noRoom();
    tree.scene = rtcNewScene(tree.device);
    // No ray slips through between two triangles.
    rtcSetSceneFlags(tree.scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(tree.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), mesh.vertices.size()));
    auto* corners = static_cast<glm::uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(glm::uvec3), mesh.triangles.size()));
    if (vertices && corners) {
        for (const glm::dvec3& vertex : mesh.vertices)
            *vertices++ = glm::vec3(vertex - made->originMm_);
        for (const glm::ivec3& t : mesh.triangles)
            *corners++ = glm::uvec3(t);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree.scene, geometry);
        rtcCommitScene(tree.scene);
    }
    rtcReleaseGeometry(geometry);
    if (rtcGetDeviceError(tree.device) != RTC_ERROR_NONE) return noRoom();
    return std::shared_ptr<const WallSight>(std::move(made));
}

std::optional<WallSight::Place> WallSight::firstMet(glm::dvec3 fromMm, glm::dvec3 direction) const {
    const glm::dvec3 along = glm::normalize(direction);
    RTCRayHit found{};
    found.ray = rayFrom(fromMm - originMm_, along);
    found.ray.tfar = std::numeric_limits<float>::infinity();
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(tree_->scene, &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    const glm::ivec3 t = map_->surface.triangles[found.hit.primID];
    const glm::dvec3 weights(1.0 - double(found.hit.u) - double(found.hit.v), found.hit.u,
                             found.hit.v);
    Place place;
    place.triangle = int(found.hit.primID);
    for (int corner = 0; corner < 3; ++corner) {
        place.flat += weights[corner] * map_->flat[std::size_t(t[corner])];
        place.positionMm += weights[corner] * map_->surface.vertices[std::size_t(t[corner])];
    }
    place.flat.x -= std::floor(place.flat.x);
    place.distanceMm = double(found.ray.tfar);
    return place;
}

bool WallSight::hides(glm::dvec3 eyeMm, int triangle) const {
    const Facet& facet = facets_[std::size_t(triangle)];
    const glm::vec3 eye(eyeMm - originMm_), toPlace = facet.middleMm - eye;
    const float distance = glm::length(toPlace);
    if (!(distance > standOffMm)) return false;
    RTCRay ray = rayFrom(eye, toPlace / distance);
    ray.tfar = distance - standOffMm;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(tree_->scene, &context, &ray);
    return ray.tfar < 0.0f;
}

}  // namespace haustra::render
