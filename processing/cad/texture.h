// Texture of the electronic biopsy image, and which of it looks like a polyp's (dissertation
// §6.2.5).
#pragma once

#include "cad/wall_samples.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

/// Red, green and blue of a place and its twelve neighbours: those within two steps along the
/// strip's axes. Steps are of 0.5 mm on the wall, where the source has pixels of its image.
inline constexpr int textureNeighbours = 12, textureSize = 3 * (1 + textureNeighbours);
inline constexpr double textureStepMm = 0.5;
using TextureVector = std::array<float, textureSize>;

/// Which samples are the twelve neighbours of each: the nearest on the wall to where each should
/// be. What it is made of outlives it.
class TextureStencil {
public:
    /// `along`: stripDirections.
    TextureStencil(const WallSamples& samples, std::span<const glm::vec3> along);
    using Neighbours = std::array<std::uint32_t, textureNeighbours>;
    /// `intoWall`: the sample's, as its shape has it.
    Neighbours around(std::uint32_t sample, glm::vec3 intoWall) const;

private:
    const WallSamples& samples_;
    std::span<const glm::vec3> along_;
    // Half as many bytes to go through; a body's places to within 1e-5 mm.
    std::vector<glm::vec3> places_;
};

/// `colors`: of every sample that the vector is made of, by the sample's number.
TextureVector textureVector(std::uint32_t sample, const TextureStencil::Neighbours& neighbours,
                            std::span<const glm::vec3> colors);

/// What training polyps look like: the Karhunen–Loève transformation, the representative vector V
/// and the threshold T of the source, in the transformed domain.
struct TextureModel {
    std::vector<float> mean;        ///< textureSize
    std::vector<float> components;  ///< rows of textureSize, as many as there are components
    std::vector<float> polyp;       ///< V: one number a component
    double threshold = 0.0;         ///< T
    double varianceShare = 0.0;     ///< that the components hold
    int count() const { return int(polyp.size()); }
};

/// Share of the variance that the components must hold (§6.2.5: seven held 96.5 %).
inline constexpr double textureVariance = 0.965;

/// `all`: vectors of whole walls; `polyps`: those of polyps alone. Neither empty. The components
/// are those of all (cv::PCA); V is the polyps' mean and T the root of their mean squared distance
/// from it. With `reduce` false, all components are kept.
TextureModel learnTexture(std::span<const TextureVector> all, std::span<const TextureVector> polyps,
                          bool reduce = true);

/// Distance of a vector from V in the transformed domain, in T: below 1 it counts as a polyp's.
double textureDistance(const TextureModel& model, const TextureVector& vector);

}  // namespace haustra::cad
