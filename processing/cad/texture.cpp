#include "cad/texture.h"

#include "cad/fours.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <opencv2/core.hpp>

namespace haustra::cad {
namespace {

// In steps along and across the strip: a diamond.
constexpr std::array<glm::ivec2, textureNeighbours> stencil{{{1, 0},
                                                             {-1, 0},
                                                             {0, 1},
                                                             {0, -1},
                                                             {1, 1},
                                                             {1, -1},
                                                             {-1, 1},
                                                             {-1, -1},
                                                             {2, 0},
                                                             {-2, 0},
                                                             {0, 2},
                                                             {0, -2}}};

// Of each the one before it that lies between it and the middle; −1: the middle itself.
constexpr std::array<int, textureNeighbours> onTheWay{-1, -1, -1, -1, 0, 0, 1, 1, 0, 1, 2, 3};

}  // namespace

TextureStencil::TextureStencil(const WallSamples& samples, std::span<const glm::vec3> along)
    : samples_(samples),
      along_(along),
      places_(samples.mesh.vertices.begin(), samples.mesh.vertices.end()) {}

TextureStencil::Neighbours TextureStencil::around(std::uint32_t sample, glm::vec3 intoWall) const {
    const glm::vec3 at = places_[sample], n = intoWall;
    glm::vec3 up = along_[sample] - glm::dot(along_[sample], n) * n;
    const float length = glm::length(up);
    up = length > 1e-3f ? up / length
                        : glm::normalize(glm::cross(
                              n, std::abs(n.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
    const glm::vec3 aside = glm::cross(up, n);
    const glm::vec3* const places = places_.data();  // looked at too often to check the index
    Neighbours neighbours;
    for (std::size_t s = 0; s < stencil.size(); ++s) {
        // Downhill along the mesh to where the neighbour should be, from a nearer one.
        const glm::vec3 wanted =
            at + float(textureStepMm) * (float(stencil[s].x) * aside + float(stencil[s].y) * up);
        std::uint32_t best = onTheWay[s] < 0 ? sample : neighbours[std::size_t(onTheWay[s])];
        const auto squaredTo = [&](std::uint32_t other) {
            const glm::vec3 off = places[other] - wanted;
            return glm::dot(off, off);
        };
        float least = squaredTo(best);
        for (std::uint32_t from = ~0u; best != from;) {
            from = best;
            for (const std::uint32_t next : samples_.around(from)) {
                // Chosen without a branch: which is the nearest cannot be predicted.
                const float squared = squaredTo(next);
                best = squared < least ? next : best;
                least = std::min(least, squared);
            }
        }
        neighbours[s] = best;
    }
    return neighbours;
}

TextureVector textureVector(std::uint32_t sample, const TextureStencil::Neighbours& neighbours,
                            std::span<const glm::vec3> colors) {
    TextureVector vector;
    const auto put = [&](std::size_t place, const glm::vec3& color) {
        for (int c = 0; c < 3; ++c)
            vector[3 * place + std::size_t(c)] = color[c];
    };
    put(0, colors[sample]);
    for (std::size_t place = 0; place < neighbours.size(); ++place)
        put(1 + place, colors[neighbours[place]]);
    return vector;
}

TextureModel learnTexture(std::span<const TextureVector> all, std::span<const TextureVector> polyps,
                          bool reduce) {
    const cv::Mat data(int(all.size()), textureSize, CV_32F,
                       const_cast<float*>(all.front().data()));
    const cv::PCA pca(data, cv::noArray(), cv::PCA::DATA_AS_ROW);
    double sum = 0.0, held = 0.0;
    for (int n = 0; n < pca.eigenvalues.rows; ++n)
        sum += std::max(0.0f, pca.eigenvalues.at<float>(n));
    int count = 0;
    while (count < pca.eigenvalues.rows && (!reduce || held < textureVariance * sum || count == 0))
        held += std::max(0.0f, pca.eigenvalues.at<float>(count++));
    TextureModel model;
    model.varianceShare = sum > 0.0 ? held / sum : 1.0;
    model.mean.assign(pca.mean.ptr<float>(), pca.mean.ptr<float>() + textureSize);
    for (int n = 0; n < count; ++n) {
        const float* row = pca.eigenvectors.ptr<float>(n);
        model.components.insert(model.components.end(), row, row + textureSize);
    }
    // Distances from zero are coordinates: V first, then what lies around it.
    model.polyp.assign(std::size_t(count), 0.0f);
    std::vector<double> mean(std::size_t(count), 0.0);
    double squares = 0.0;
    for (const TextureVector& vector : polyps) {
        for (int n = 0; n < count; ++n) {
            double coordinate = 0.0;
            for (std::size_t c = 0; c < textureSize; ++c)
                coordinate += double(model.components[std::size_t(n) * textureSize + c]) *
                              double(vector[c] - model.mean[c]);
            mean[std::size_t(n)] += coordinate;
            squares += coordinate * coordinate;
        }
    }
    const double size = double(polyps.size());
    for (int n = 0; n < count; ++n) {
        mean[std::size_t(n)] /= size;
        squares -= size * mean[std::size_t(n)] * mean[std::size_t(n)];
        model.polyp[std::size_t(n)] = float(mean[std::size_t(n)]);
    }
    model.threshold = std::sqrt(std::max(0.0, squares / size));
    return model;
}

double textureDistance(const TextureModel& model, const TextureVector& vector) {
    TextureVector off;
    for (std::size_t c = 0; c < textureSize; ++c)
        off[c] = vector[c] - model.mean[c];
    float squared = 0.0f;
    for (int n = 0; n < model.count(); ++n) {
        const float* row = &model.components[std::size_t(n) * textureSize];
        FourFloats sums{};
        std::size_t c = 0;
        for (; c + 4 <= textureSize; c += 4) {
            FourFloats weights, values;
            std::memcpy(&weights, row + c, sizeof weights);
            std::memcpy(&values, off.data() + c, sizeof values);
            sums += weights * values;
        }
        float away = sums[0] + sums[1] + sums[2] + sums[3] - model.polyp[std::size_t(n)];
        for (; c < textureSize; ++c)
            away += row[c] * off[c];
        squared += away * away;
    }
    return model.threshold > 0.0 ? std::sqrt(double(squared)) / model.threshold : 1e9;
}

}  // namespace haustra::cad
