// What is said twice, in GLSL and in C++, is the same: lenses, light, the display's curve, and the
// way from a place of the flattened wall to its ray. Shaders compute it for random inputs.
#include "core/srgb.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "render/flat/flat_coverage.h"
#include "render/gl/flat_surface.h"
#include "render/native/native_scene.h"
#include "render/scene/lens.h"
#include "render/scene/ray_setup.h"
#include "shaders/shader_source.h"
#include "shaders/uniforms.h"
#include "wall_scene.h"

#include <random>
#include <string>
#include <vector>

// The packets' functions, compiled for the vectors that every machine of this kind has.
// clang-format off
#include <hwy/highway.h>
#include "render/native/lens-inl.h"
#include "render/native/flat_wall-inl.h"
#include "render/native/optics-inl.h"
// clang-format on

namespace haustra::tests {
namespace {

using namespace render;
namespace packets = render::HWY_NAMESPACE;
namespace hn = hwy::HWY_NAMESPACE;

/// Where results lie and inputs come from.
constexpr const char* interface = R"(
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f, binding = 0) uniform writeonly image2D results;
layout(std430, binding = 3) readonly buffer Inputs { vec4 inputs[]; };
)";
constexpr unsigned inputBinding = 3;

using Floats = std::vector<glm::vec4>;

/// Runs a shader of one row of threads, one for each column of the results: `rows` of them for
/// each.
std::vector<Floats> computed(std::initializer_list<std::string_view> pieces, const Floats& inputs,
                             int columns, int rows) {
    const auto program = gpu::ComputeProgram::create("agreement", pieces);
    const auto buffer = gpu::StorageBuffer::create(std::span(inputs), "inputs");
    const auto results = gpu::Texture::create(2, {columns, rows, 1}, gpu::TexelFormat::rgba32f,
                                              gpu::Filter::nearest, "results");
    if (!program || !buffer || !results) {
        ADD_FAILURE() << (program ? "no room" : describe(program.error()));
        return std::vector<Floats>(std::size_t(rows), Floats(std::size_t(columns)));
    }
    buffer->bind(inputBinding);
    results->bindImage(shaders::pictureImage);
    program->dispatch({columns, 1});
    Floats all(std::size_t(columns) * std::size_t(rows));
    results->read(all.data(), results->bytes());
    std::vector<Floats> byRow;
    for (int row = 0; row < rows; ++row)
        byRow.emplace_back(all.begin() + row * columns, all.begin() + (row + 1) * columns);
    return byRow;
}

void expectNear(glm::dvec3 a, glm::dvec3 b, double most, const std::string& what) {
    EXPECT_LE(glm::length(a - b), most) << what << ": " << a.x << " " << a.y << " " << a.z
                                        << " and " << b.x << " " << b.y << " " << b.z;
}

packets::V3 same(glm::vec3 v) {
    return {packets::set(v.x), packets::set(v.y), packets::set(v.z)};
}
glm::dvec3 first(packets::V3 v) {
    return {hn::GetLane(v.x), hn::GetLane(v.y), hn::GetLane(v.z)};
}

class ShadingAgreement : public Drawing {
protected:
    std::mt19937 random{11};

    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    }
    glm::dvec3 direction() {
        for (;;) {
            const glm::dvec3 v(between(-1, 1), between(-1, 1), between(-1, 1));
            if (const double length = glm::length(v); length > 0.1 && length < 1.0)
                return v / length;
        }
    }
    static constexpr int count = 2048;
};

/// A small volume, as packets and shaders read it.
struct Small {
    std::shared_ptr<const Scene> scene;
    std::unique_ptr<NativeScene> native;

    Small() {
        const Volume<std::int16_t> volume =
            sampled(obliqueGrid({20, 24, 28}, {0.7, 0.8, 1.1}), foldedTube);
        scene = std::make_shared<const Scene>(
            Scene{volume.share(), blockRanges(volume, blockSide, 1), nullptr, nullptr, nullptr});
        native = std::make_unique<NativeScene>(scene, 1);
    }
    PacketScene packetScene(const CameraView& view, glm::ivec2 size) {
        const auto classified = native->classification(view.optics, view.march);
        if (!classified) throw std::runtime_error(describe(classified.error()));
        return native->packetScene(
            marchUniforms(view, scene->grid(), (*classified)->table, scene->ranges.size, size),
            **classified);
    }
};

TEST_F(ShadingAgreement, OfLenses) {
    using shaders::shaderSource;
    Small small;
    const glm::ivec2 size(120, 90);
    for (const Lens lens : {Lens::perspective, Lens::fisheye, Lens::orthographic}) {
        CameraView view;
        view.optics = *opticsPreset("mucosa");
        view.camera.lens = lens;
        view.camera.fovDegrees = lens == Lens::fisheye ? 330.0 : 110.0;
        view.camera.heightMm = 25.0;
        view.camera.positionMm = {1.5, -2.0, 3.0};
        view.camera.forward = direction();
        view.camera.up = direction();
        Floats pixels;
        for (int n = 0; n < count; ++n)
            pixels.push_back({between(0, size.x), between(0, size.y), 0, 0});
        const PacketScene scene = small.packetScene(view, size);
        auto block = gpu::UniformBuffer::create(sizeof scene.u);
        ASSERT_TRUE(block);
        block->write(scene.u);
        block->bind(shaders::uniformBinding);
        const auto rays = computed(
            {shaderSource("uniforms.h"), shaderSource("srgb.glsl"), shaderSource("lens.glsl"),
             shaderSource("optics.glsl"), shaderSource("rays.glsl"), interface,
             "void main() {\n"
             "    int n = int(gl_GlobalInvocationID.x);\n"
             "    if (gl_GlobalInvocationID.y > 0u || n >= inputs.length()) return;\n"
             "    Ray ray = rayThrough(inputs[n].xy);\n"
             "    imageStore(results, ivec2(n, 0), vec4(ray.directionMm, "
             "isInPicture(inputs[n].xy)));\n"
             "    imageStore(results, ivec2(n, 1), vec4(ray.origin, 0.0));\n"
             "    imageStore(results, ivec2(n, 2), vec4(ray.step, 0.0));\n"
             "}\n"},
            pixels, count, 3);
        const LensFrame frame = lensFrame(view.camera, double(size.x) / size.y);
        const Grid& grid = small.scene->grid();
        const glm::dvec3 voxels(grid.size);
        const double step = stepMm(view.march, grid);
        int shown = 0;
        for (std::size_t n = 0; n < pixels.size(); ++n) {
            const std::string what =
                "lens " + std::to_string(int(lens)) + ", ray " + std::to_string(n);
            const glm::dvec2 pixel(pixels[n]);
            const auto ray = lensRay(frame, 2.0 * pixel / glm::dvec2(size) - 1.0);
            const auto aside =
                packets::asideMm(scene, packets::set(pixels[n].x), packets::set(pixels[n].y));
            const bool inPicture = rays[0][n].w == 1.0f;
            // A hair from the rim of what a fisheye shows, rounding decides.
            const double angle = glm::length(first(aside));
            if (lens != Lens::fisheye || std::abs(angle - M_PI) > 1e-4) {
                EXPECT_EQ(inPicture, ray.has_value()) << what;
                EXPECT_EQ(inPicture, packets::any(packets::isInPicture(scene, aside))) << what;
            }
            if (!ray || !inPicture) continue;
            ++shown;
            const packets::Rays packet = packets::raysAlong(scene, aside);
            expectNear(glm::dvec3(rays[0][n]), ray->direction, 2e-6, what);
            expectNear(first(packet.directionMm), ray->direction, 2e-6, what);
            const glm::dvec3 origin =
                grid.voxelFromPatientPoint(view.camera.positionMm + ray->fromEye);
            expectNear(glm::dvec3(rays[1][n]) * voxels - 0.5, origin, 1e-4, what);
            expectNear(first(packet.origin), origin, 1e-4, what);
            const glm::dvec3 onward =
                step * glm::dvec3(grid.voxelFromPatient() * glm::dvec4(ray->direction, 0.0));
            expectNear(glm::dvec3(rays[2][n]) * voxels, onward, 1e-5, what);
            expectNear(first(packet.step), onward, 1e-5, what);
        }
        EXPECT_GT(shown, count / 2);
    }
}

TEST_F(ShadingAgreement, OfLight) {
    using shaders::shaderSource;
    Small small;
    for (const double shininess : {1.0, 12.0, 7.5, 60.0}) {
        CameraView view;
        view.optics = *opticsPreset("mucosa");
        view.optics.light = {35.0, 0.15, 0.7, 0.4, shininess};
        const PacketScene scene = small.packetScene(view, {8, 8});
        Floats inputs;  // of each: colour and step, normal in HU, light
        for (int n = 0; n < count; ++n) {
            inputs.push_back({between(0, 1), between(0, 1), between(0, 1), between(0, 200)});
            const glm::dvec3 normal = direction() * std::exp(between(-4.0, 7.0));
            inputs.push_back(n % 64 == 0 ? glm::vec4(0.0f) : glm::vec4(normal, 0.0));
            inputs.push_back(glm::vec4(direction(), 0.0));
        }
        auto block = gpu::UniformBuffer::create(sizeof scene.u);
        ASSERT_TRUE(block);
        block->write(scene.u);
        block->bind(shaders::uniformBinding);
        const auto lit =
            computed({shaderSource("uniforms.h"), shaderSource("srgb.glsl"),
                      shaderSource("optics.glsl"), interface,
                      "void main() {\n"
                      "    int n = int(gl_GlobalInvocationID.x);\n"
                      "    if (gl_GlobalInvocationID.y > 0u || 3 * n >= inputs.length()) return;\n"
                      "    vec4 color = inputs[3 * n];\n"
                      "    vec3 lit = shade(color.rgb, inputs[3 * n + 1].xyz / 65535.0, inputs[3 * "
                      "n + 2].xyz,\n"
                      "                     color.w);\n"
                      "    imageStore(results, ivec2(n, 0), vec4(lit, 0.0));\n"
                      "    imageStore(results, ivec2(n, 1), vec4(displayed(color.rgb), 0.0));\n"
                      "    imageStore(results, ivec2(n, 2), vec4(linearOf(color.rgb), 0.0));\n"
                      "}\n"},
                     inputs, count, 3);
        for (std::size_t n = 0; n < std::size_t(count); ++n) {
            const std::string what =
                "shininess " + std::to_string(shininess) + ", sample " + std::to_string(n);
            const glm::vec4 color = inputs[3 * n];
            const packets::V3 c = same(glm::vec3(color));
            const packets::Color packet = packets::shaded(
                scene, {c.x, c.y, c.z, packets::set(1.0f)}, same(glm::vec3(inputs[3 * n + 1])),
                same(glm::vec3(inputs[3 * n + 2])), packets::set(color.w));
            expectNear(glm::dvec3(lit[0][n]), first({packet.r, packet.g, packet.b}), 2e-4, what);
            for (int channel = 0; channel < 3; ++channel) {
                const double shown = 255.0 * lit[1][n][channel];
                EXPECT_NEAR(shown, hn::GetLane(packets::displayed(packets::set(color[channel]))),
                            0.51);
                EXPECT_NEAR(lit[2][n][channel], linearLight(color[channel]), 2e-6);
            }
        }
    }
}

TEST_F(ShadingAgreement, OfTheFlattenedWall) {
    using shaders::shaderSource;
    const Tube tube = makeTube(96);
    const auto geometry = FlatGeometry::of(tube.map, glm::dvec3(0.0));
    ASSERT_TRUE(geometry) << describe(geometry.error());
    const auto surface = FlatSurface::upload(*geometry);
    ASSERT_TRUE(surface);
    FlatWindow window;
    window.center = {0.9, 0.5 * (*geometry)->height()};  // across the seam
    window.pixelsPerUnit = 60.0;
    const Band band = Band::whole(64, 48);
    const FlatLattice lattice = (*geometry)->lattice(window, band);
    std::vector<FlatPixel> pixels;
    coverRows(**geometry, lattice, 0, band.rows, pixels);
    Floats inputs;
    for (int n = 0; n < int(pixels.size()); ++n)
        inputs.push_back(
            {n % 64, n / 64, pixels[std::size_t(n)].triangle, pixels[std::size_t(n)].copy});
    auto block = gpu::UniformBuffer::create(sizeof lattice.uniforms);
    ASSERT_TRUE(block);
    block->write(lattice.uniforms);
    block->bind(shaders::flatUniformBinding);
    surface->bind();
    surface->triangles().bind(shaders::flatTriangleBinding);
    const auto rays = computed(
        {shaderSource("uniforms.h"), shaderSource("flat_map.glsl"), shaderSource("flat_wall.glsl"),
         interface,
         "void main() {\n"
         "    int n = int(gl_GlobalInvocationID.x);\n"
         "    if (gl_GlobalInvocationID.y > 0u || n >= inputs.length()) return;\n"
         "    WallPlace wall = placeAt(ivec2(inputs[n].xy), ivec2(inputs[n].zw));\n"
         "    Sight sight = sightOf(wall);\n"
         "    imageStore(results, ivec2(n, 0), vec4(wall.placeMm, wall.camera));\n"
         "    imageStore(results, ivec2(n, 1), vec4(wall.intoLumen, 0.0));\n"
         "    imageStore(results, ivec2(n, 2),\n"
         "               vec4(turned(sight.ray, wall.intoLumen, flatWindow.mostRayAngle), 0.0));\n"
         "    imageStore(results, ivec2(n, 3),\n"
         "               vec4(turned(sight.light, wall.intoLumen, flatWindow.mostLightAngle), "
         "0.0));\n"
         "}\n"},
        inputs, int(inputs.size()), 4);
    const PacketWall wall{(*geometry)->vertices().data(), (*geometry)->triangles().data(),
                          (*geometry)->cameras().data(), lattice.uniforms};
    int covered = 0;
    for (std::size_t n = 0; n < pixels.size(); ++n) {
        if (pixels[n].triangle < 0) continue;
        ++covered;
        const std::string what = "pixel " + std::to_string(n);
        const glm::ivec2 place =
            packets::flatPlaceOf(wall.u, {int(n) % 64, int(n) / 64}, pixels[n].copy);
        const auto places =
            packets::placesAt(wall, hn::Set(packets::i, pixels[n].triangle),
                              hn::Set(packets::i, place.x), hn::Set(packets::i, place.y));
        const auto sight = packets::sightOf(wall, places);
        expectNear(glm::dvec3(rays[0][n]), first(places.placeMm), 1e-4, what);
        EXPECT_NEAR(rays[0][n].w, hn::GetLane(places.camera), 1e-4) << what;
        expectNear(glm::dvec3(rays[1][n]), first(places.intoLumen), 1e-5, what);
        expectNear(glm::dvec3(rays[2][n]),
                   first(packets::turned(sight.ray, places.intoLumen, wall.u.mostRayAngle)), 1e-4,
                   what);
        expectNear(glm::dvec3(rays[3][n]),
                   first(packets::turned(sight.light, places.intoLumen, wall.u.mostLightAngle)),
                   1e-4, what);
    }
    EXPECT_GT(covered, 1000);
}

}  // namespace
}  // namespace haustra::tests
