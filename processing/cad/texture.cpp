#include "cad/texture.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>

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

TextureStencil::TextureStencil(const WallSamples& samples, std::span<const std::uint32_t> of,
                               std::span<const WallShape> shapes, std::span<const glm::vec3> along,
                               int threads)
    : of_(of.begin(), of.end()), neighbours_(of.size()) {
    // Half as many bytes to go through; a body's places to within 1e-5 mm.
    const std::vector<glm::vec3> places(samples.mesh.vertices.begin(), samples.mesh.vertices.end());
    parallelFor(neighbours_.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const std::uint32_t v = of_[m];
            const glm::vec3 at = places[v];
            const glm::vec3 n = shapes[v].intoWall;
            glm::vec3 up = along[v] - glm::dot(along[v], n) * n;
            const float length = glm::length(up);
            up = length > 1e-3f
                     ? up / length
                     : glm::normalize(glm::cross(
                           n, std::abs(n.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0)));
            const glm::vec3 aside = glm::cross(up, n);
            for (std::size_t s = 0; s < stencil.size(); ++s) {
                // Downhill along the mesh to where the neighbour should be, from a nearer one.
                const glm::vec3 wanted = at + float(textureStepMm) * (float(stencil[s].x) * aside +
                                                                      float(stencil[s].y) * up);
                std::uint32_t best =
                    onTheWay[s] < 0 ? std::uint32_t(v) : neighbours_[m][std::size_t(onTheWay[s])];
                const auto squaredTo = [&](std::uint32_t sample) {
                    const glm::vec3 off = places[sample] - wanted;
                    return glm::dot(off, off);
                };
                float least = squaredTo(best);
                for (bool nearer = true; nearer;) {
                    nearer = false;
                    const std::uint32_t from = best;
                    for (std::uint32_t e = samples.begin[from]; e < samples.begin[from + 1]; ++e) {
                        const float squared = squaredTo(samples.neighbours[e]);
                        if (squared < least)
                            least = squared, best = samples.neighbours[e], nearer = true;
                    }
                }
                neighbours_[m][s] = best;
            }
        }
    });
}

TextureVector TextureStencil::at(std::size_t n, std::span<const glm::vec3> colors) const {
    TextureVector vector;
    const auto put = [&](int place, const glm::vec3& color) {
        for (int c = 0; c < 3; ++c)
            vector[std::size_t(3 * place + c)] = color[c];
    };
    put(0, colors[of_[n]]);
    for (int place = 0; place < textureNeighbours; ++place)
        put(1 + place, colors[neighbours_[n][std::size_t(place)]]);
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
    float squared = 0.0f;
    for (int n = 0; n < model.count(); ++n) {
        const float* row = &model.components[std::size_t(n) * textureSize];
        float coordinate = 0.0f;
        for (std::size_t c = 0; c < textureSize; ++c)
            coordinate += row[c] * (vector[c] - model.mean[c]);
        const float away = coordinate - model.polyp[std::size_t(n)];
        squared += away * away;
    }
    return model.threshold > 0.0 ? std::sqrt(double(squared)) / model.threshold : 1e9;
}

}  // namespace haustra::cad
