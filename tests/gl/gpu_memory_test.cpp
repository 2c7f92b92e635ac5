// What a case says that it holds of the GPU's memory, against what the driver says.
#include "wall_scene.h"

#include <epoxy/gl.h>

namespace haustra::tests {
namespace {

using namespace render;

/// Bytes of all textures, depth buffers and arrays of the current context; without uniform blocks
/// and without memory that is the CPU's.
std::size_t deviceBytes() {
    std::size_t bytes = 0;
    for (GLuint id = 1; id < 4096; ++id) {
        if (glIsTexture(id)) {
            std::size_t texels = 1, bits = 0;
            GLint value = 0;
            for (const GLenum side : {GL_TEXTURE_WIDTH, GL_TEXTURE_HEIGHT, GL_TEXTURE_DEPTH}) {
                glGetTextureLevelParameteriv(id, 0, side, &value);
                texels *= std::size_t(value);
            }
            for (const GLenum channel : {GL_TEXTURE_RED_SIZE, GL_TEXTURE_GREEN_SIZE,
                                         GL_TEXTURE_BLUE_SIZE, GL_TEXTURE_ALPHA_SIZE}) {
                glGetTextureLevelParameteriv(id, 0, channel, &value);
                bits += std::size_t(value);
            }
            bytes += texels * bits / 8;
        }
        if (glIsBuffer(id)) {
            GLint64 size = 0;
            GLint flags = 0;
            glGetNamedBufferParameteri64v(id, GL_BUFFER_SIZE, &size);
            glGetNamedBufferParameteriv(id, GL_BUFFER_STORAGE_FLAGS, &flags);
            if (!(flags & (GL_DYNAMIC_STORAGE_BIT | GL_CLIENT_STORAGE_BIT)))
                bytes += std::size_t(size);
        }
        if (glIsRenderbuffer(id)) {
            std::size_t product = 1;
            GLint value = 0;
            for (const GLenum side :
                 {GL_RENDERBUFFER_WIDTH, GL_RENDERBUFFER_HEIGHT, GL_RENDERBUFFER_DEPTH_SIZE}) {
                glGetNamedRenderbufferParameteriv(id, side, &value);
                product *= std::size_t(value);
            }
            bytes += product / 8;
        }
    }
    return bytes;
}

class GpuMemory : public Drawing, public testing::WithParamInterface<RaycasterEntry> {};

TEST_P(GpuMemory, IsAllCounted) {
    const Grid grid = obliqueGrid({96, 90, 110}, {0.4, 0.4, 0.4});
    auto prepared = prepareCase(sampled(grid, tubeWithResidue), sampled(grid, closedTube));
    ASSERT_TRUE(prepared);
    Tube tube = makeTube(96);
    prepared->wall = std::make_shared<const TriMesh>(std::move(tube.wall));
    prepared->flatMap = std::make_shared<const FlatMap>(std::move(tube.map));

    const CaseGpuBytes wanted = CaseRenderer::gpuBytesFor(*prepared);
    EXPECT_EQ(wanted.volumes, 2u * 2u * grid.voxelCount()) << "before and after cleansing";
    ASSERT_EQ(deviceBytes(), 0u);
    auto renderer =
        CaseRenderer::upload(*context, std::move(*prepared), {.raycaster = GetParam().kind});
    ASSERT_TRUE(renderer);
    const auto expectCounted = [&](const char* when) {
        EXPECT_EQ((*renderer)->gpuBytes(), deviceBytes()) << when;
    };
    expectCounted("made");
    if (GetParam().needsWholeVolume()) {
        EXPECT_GE(deviceBytes(), wanted.volumes);
    } else if (GetParam().volume == VolumeOnGpu::none) {
        EXPECT_EQ(deviceBytes(), 0u);
    }
    const auto drawAll = [&](const char* preset) {
        CameraView camera;
        camera.optics = *opticsPreset(preset);
        draw(**renderer, camera, 61, 47);
        expectCounted("from within");
        camera.camera.lens = Lens::fisheye;
        draw(**renderer, camera, 47, 61);
        ASSERT_TRUE((*renderer)->wallSeen(camera.camera, Band::whole(47, 61)));
        expectCounted("wall");
        draw(**renderer, SliceView{View::axial, glm::dvec3(0.0), 1.0, {}}, 50, 40);
        FlatView flat;
        flat.window.pixelsPerUnit = 40.0;
        flat.optics = camera.optics;
        draw(**renderer, flat, 40, 50);
        expectCounted("flattened");
        OverviewView overview;
        overview.camera.positionMm = {0.0, -150.0, 0.0};
        overview.camera.forward = {0.0, 1.0, 0.0};
        overview.camera.up = {0.0, 0.0, 1.0};
        overview.optics = *opticsPreset("body");
        draw(**renderer, overview, 50, 40);
        expectCounted("from outside");
    };
    for (const char* preset : {"mucosa", "translucent", "mip", "surface", "biopsy", "bone"})
        drawAll(preset);

    // And what was only tried is let go of.
    const std::size_t before = deviceBytes();
    ASSERT_TRUE((*renderer)->use(GetParam().kind == RaycasterKind::native
                                     ? RaycasterKind::singlePass
                                     : RaycasterKind::native));
    expectCounted("two raycasters");
    EXPECT_GE(deviceBytes(), before);
    (*renderer)->keepOnlyUsed();
    expectCounted("one again");
    (*renderer).reset();
    EXPECT_EQ(deviceBytes(), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, GpuMemory,
                         testing::ValuesIn(raycasters().begin(), raycasters().end()),
                         nameOfRaycaster);

}  // namespace
}  // namespace haustra::tests
