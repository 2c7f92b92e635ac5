#include "coverage/wall_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

namespace haustra::coverage {

struct WallRays::Tree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    ~Tree() {
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }
};

WallRays::WallRays() : tree_(std::make_unique<Tree>()) {}
WallRays::~WallRays() = default;

Result<std::shared_ptr<const WallRays>> WallRays::of(const TriMesh& wall,
                                                     std::vector<std::uint8_t> bridged) {
    if (wall.triangles.empty()) return fail(ErrorKind::badInput, "the wall has no triangle");
    if (!bridged.empty() && bridged.size() != wall.triangles.size())
        return fail(ErrorKind::badInput, "the bridges are of another wall");
    std::shared_ptr<WallRays> made(new WallRays);
    glm::dvec3 low(std::numeric_limits<double>::max()), high = -low;
    for (const glm::dvec3& vertex : wall.vertices)
        low = glm::min(low, vertex), high = glm::max(high, vertex);
    made->originMm_ = 0.5 * (low + high);

    // One thread, so that the tree is the same each time; no wider vectors than most machines have.
    Tree& tree = *made->tree_;
    tree.device = rtcNewDevice("threads=1,set_affinity=0,max_isa=avx2");
    if (!tree.device) return fail(ErrorKind::device, "there is not enough memory for rays");
    tree.scene = rtcNewScene(tree.device);
    // No ray slips through between two triangles.
    rtcSetSceneFlags(tree.scene, RTC_SCENE_FLAG_ROBUST);
    const RTCGeometry geometry = rtcNewGeometry(tree.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), wall.vertices.size()));
    auto* corners = static_cast<glm::uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(glm::uvec3), wall.triangles.size()));
    if (vertices && corners) {
        for (const glm::dvec3& vertex : wall.vertices)
            *vertices++ = glm::vec3(vertex - made->originMm_);
        for (const glm::ivec3& t : wall.triangles)
            *corners++ = glm::uvec3(t);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree.scene, geometry);
        rtcCommitScene(tree.scene);
    }
    rtcReleaseGeometry(geometry);
    if (rtcGetDeviceError(tree.device) != RTC_ERROR_NONE)
        return fail(ErrorKind::device, "there is not enough memory for rays");

    made->facets_.reserve(wall.triangles.size());
    for (std::size_t n = 0; n < wall.triangles.size(); ++n) {
        Facet facet;
        for (int corner = 0; corner < 3; ++corner)
            facet.corners[corner] =
                glm::vec3(wall.vertices[std::size_t(wall.triangles[n][corner])] - made->originMm_);
        facet.inward = !bridged.empty() && bridged[n]
                           ? glm::vec3(0.0f)
                           : glm::cross(facet.corners[2] - facet.corners[0],
                                        facet.corners[1] - facet.corners[0]);
        made->facets_.push_back(facet);
    }
    return std::shared_ptr<const WallRays>(std::move(made));
}

WallRays::Hit WallRays::firstMet(glm::vec3 from, glm::vec3 along, float nearestMm,
                                 float farthestMm) const {
    RTCRayHit found;
    found.ray = {from.x,  from.y, from.z,     nearestMm, along.x, along.y,
                 along.z, 0.0f,   farthestMm, ~0u,       0,       0};
    found.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(tree_->scene, &context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    return {int(found.hit.primID), found.ray.tfar};
}

void WallRays::firstMet16(glm::vec3 from, const glm::vec3* along, int count, float nearestMm,
                          float farthestMm, Hit* hits) const {
    alignas(64) RTCRayHit16 found;
    alignas(64) int valid[16];
    for (int n = 0; n < 16; ++n) {
        valid[n] = n < count ? -1 : 0;
        const glm::vec3 direction = n < count ? along[n] : glm::vec3(0.0f, 0.0f, 1.0f);
        found.ray.org_x[n] = from.x, found.ray.org_y[n] = from.y, found.ray.org_z[n] = from.z;
        found.ray.dir_x[n] = direction.x, found.ray.dir_y[n] = direction.y,
        found.ray.dir_z[n] = direction.z;
        found.ray.tnear[n] = nearestMm, found.ray.tfar[n] = farthestMm;
        found.ray.time[n] = 0.0f, found.ray.mask[n] = ~0u, found.ray.id[n] = 0,
        found.ray.flags[n] = 0;
        found.hit.geomID[n] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, tree_->scene, &context, &found);
    for (int n = 0; n < count; ++n)
        hits[n] = found.hit.geomID[n] == RTC_INVALID_GEOMETRY_ID
                      ? Hit{}
                      : Hit{int(found.hit.primID[n]), found.ray.tfar[n]};
}

}  // namespace haustra::coverage
