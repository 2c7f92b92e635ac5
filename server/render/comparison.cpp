#include "render/comparison.h"

#include "core/slice_placement.h"

#include <algorithm>
#include <cmath>

namespace haustra::render {
namespace {

// The most that counts as none, 255ths: 5 %.
constexpr int leastShare = 255 * 5 / 100;

void append(std::vector<std::uint8_t>& rgb, glm::u8vec3 color) {
    rgb.insert(rgb.end(), {color.r, color.g, color.b});
}

}  // namespace

glm::u8vec3 tissueColor(TissueFractions fractions) {
    const auto counted = [](int share) { return share > leastShare ? share : 0; };
    const int air = counted(fractions.air), tagged = counted(fractions.tagged),
              soft = counted(fractions.soft());
    const bool meet = air > 0 && tagged > 0;
    const glm::ivec3 sum = air * glm::ivec3(meet ? interfaceColor : airColor) +
                           tagged * glm::ivec3(meet ? interfaceColor : taggedColor) +
                           soft * glm::ivec3(softColor);
    const int total = air + tagged + soft;
    return glm::u8vec3((sum + total / 2) / total);
}

Result<Image> tissuePicture(const Volume<TissueFractions>& mixture, const SliceView& view,
                            int width, int height) {
    const Grid& grid = mixture.grid();
    const auto placement = TRY(placeSlice(view, grid, width, height));
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    const glm::dvec3 origin(voxelFromPatient * glm::dvec4(placement.topLeftMm, 1.0)),
        right(voxelFromPatient * glm::dvec4(placement.rightMm, 0.0)),
        down(voxelFromPatient * glm::dvec4(placement.downMm, 0.0));
    Image image{width, height, {}};
    image.rgb.reserve(3 * std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const glm::dvec3 nearest =
                glm::floor(origin + double(x) * right + double(y) * down + 0.5);
            // Compared before the conversion: the point may lie anywhere.
            const bool inside = glm::all(glm::greaterThanEqual(nearest, glm::dvec3(0.0))) &&
                                glm::all(glm::lessThan(nearest, glm::dvec3(grid.size)));
            append(image.rgb,
                   inside ? tissueColor(mixture.at(glm::ivec3(nearest))) : glm::u8vec3(0));
        }
    }
    return image;
}

}  // namespace haustra::render
