// Small neural networks, whose mean changes smoothly with the features.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace haustra::cad {

/// A feature's place among those of training, as a number that is normally distributed there:
/// features of any scale and skew become alike. Piecewise linear, constant beyond its ends.
struct NormalScore {
    std::vector<float> values;  ///< strictly ascending, one or more
    std::vector<float> scores;  ///< of each value, ascending

    float at(float value) const;
};

/// From 33 quantiles of the values, evenly spread; a value that several quantiles share has the
/// middle one's score. Scores are within ±3. `values` must not be empty.
NormalScore normalScoreOf(std::vector<float> values);

/// y = W x + b, W by rows.
struct DenseLayer {
    int inputs = 0;
    std::vector<float> weights, biases;
};

/// Layers one after the other, what is below 0 set to 0 between them. The last has one output: the
/// logarithm of the odds for a polyp.
using NeuralNetwork = std::vector<DenseLayer>;

/// Immutable once it is made; any number of threads.
struct NeuralNetworks {
    std::vector<NormalScore> scores;  ///< of each feature
    std::vector<NeuralNetwork> networks;

    /// The mean of what the networks say. They must have passed checkNetworks.
    double at(std::span<const float> features) const;
};

/// Fails (badInput) where there is no network or one does not take `features` numbers and give one,
/// a number is not finite, a score's values do not ascend, or a network is so deep, wide or has
/// such great numbers that its answer could be none.
Result<void> checkNetworks(const NeuralNetworks& networks, int features);

struct NetworkTraining {
    int networks = 3;
    std::vector<int> hidden{64, 32};  ///< sizes of the layers between
    int epochs = 15;
    int batch = 512;
    double learningRate = 2e-3;  ///< a quarter of it in the last third of the epochs
    /// A feature is known no better than this, standard deviation, in scores: fresh noise is added
    /// at each look, so that nothing is learnt from less (Bishop, Neural Computation 1995; 7: 108).
    double jitter = 0.3;
    int threads = 0;
};

/// `rows`: `features` numbers each, as many rows as responses (0 or 1, both kinds). Each network
/// from other weights, in another order (Adam: Kingma and Ba, ICLR 2015; the loss is the negative
/// log-likelihood). The same for equal input and any number of threads.
NeuralNetworks trainNetworks(std::span<const float> rows, std::span<const float> responses,
                             int features, const NetworkTraining& training = {});

}  // namespace haustra::cad
