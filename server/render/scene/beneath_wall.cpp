#include "render/scene/beneath_wall.h"

#include "core/parallel.h"

namespace haustra::render {
namespace {

constexpr double sampleMm = 0.5;
constexpr float noEnd = 1e30f;

}  // namespace

std::shared_ptr<const Backdrop> endsBeneathWall(const Scene& scene, const Camera& camera,
                                                const Band& band, std::span<const float> wallMm,
                                                double deepMm, int threads) {
    auto ends = std::make_shared<Backdrop>();
    const glm::ivec2 size = band.pictureSize;
    ends->size = size;
    ends->pixels.assign(std::size_t(size.x) * std::size_t(size.y), {0.0f, 0.0f, 0.0f, noEnd});
    const glm::dmat4 voxelFromPatient = scene.grid().voxelFromPatient();
    const glm::dvec3 ahead = glm::normalize(camera.forward),
                     right = glm::normalize(glm::cross(ahead, camera.up)),
                     down = glm::cross(ahead, right);
    const auto endOf = [&](int x, int y, double wall) -> double {
        const glm::dvec2 place = (glm::dvec2(x, y) + 0.5 - 0.5 * glm::dvec2(size)) / double(size.y);
        const bool parallel = camera.lens == Lens::orthographic;
        const auto along = parallel ? ahead : rayThrough(camera, place);
        if (!along) return noEnd;
        glm::dvec3 from = camera.positionMm;
        if (parallel) from += camera.heightMm * (place.x * right + place.y * down);
        const glm::dvec3 perMm(voxelFromPatient * glm::dvec4(*along, 0.0));
        const glm::dvec3 start(voxelFromPatient * glm::dvec4(from, 1.0));
        bool inTissue = false;
        for (double beneath = 0.0; beneath < deepMm; beneath += sampleMm) {
            const bool gas = trilinear(scene.volume, start + (wall + beneath) * perMm) < gasBelowHu;
            if (inTissue && gas) return wall + beneath;
            inTissue |= !gas;
        }
        return wall + deepMm;
    };
    parallelFor(std::size_t(band.rows), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t row = begin; row < end; ++row)
            for (int x = 0; x < size.x; ++x) {
                const float wall = wallMm[row * std::size_t(size.x) + std::size_t(x)];
                const std::size_t y = row + std::size_t(band.firstRow);
                if (wall >= 0.0f)
                    ends->pixels[y * std::size_t(size.x) + std::size_t(x)].w =
                        float(endOf(x, int(y), double(wall)));
            }
    });
    return ends;
}

}  // namespace haustra::render
