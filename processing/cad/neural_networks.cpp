#include "cad/neural_networks.h"

#include "core/parallel.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

#include <Eigen/Core>

namespace haustra::cad {
namespace {

constexpr double farthestScore = 3.0;

// Φ⁻¹ by bisection of Φ: some dozens of calls a feature.
double normalQuantile(double share) {
    double lo = -farthestScore, hi = farthestScore;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (lo + hi);
        (0.5 * std::erfc(-middle / std::numbers::sqrt2) < share ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
}

// The same numbers on every machine, which std::normal_distribution does not promise.
class Random {
public:
    explicit Random(std::uint64_t seed) : bits_(seed) {}
    double uniform() { return (double(bits_() >> 11) + 0.5) * 0x1p-53; }
    /// Standard normal (Box and Muller 1958).
    float normal() {
        if (std::exchange(spare_, !spare_)) return second_;
        const double radius = std::sqrt(-2.0 * std::log(uniform())),
                     angle = 2.0 * std::numbers::pi * uniform();
        second_ = float(radius * std::sin(angle));
        return float(radius * std::cos(angle));
    }
    void shuffle(std::vector<std::uint32_t>& order) {
        for (std::size_t n = order.size(); n > 1; --n)
            std::swap(order[n - 1], order[std::size_t(uniform() * double(n))]);
    }

private:
    std::mt19937_64 bits_;
    bool spare_ = false;
    float second_ = 0.0f;
};

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Row = Eigen::RowVectorXf;

// Parameters of one kind and how Adam moves them.
template <class Values>
struct Moving {
    Values value, mean, square;

    explicit Moving(Values start)
        : value(std::move(start)),
          mean(Values::Zero(value.rows(), value.cols())),
          square(Values::Zero(value.rows(), value.cols())) {}

    void step(const Values& gradient, double rate, int step) {
        constexpr double decay = 0.9, squareDecay = 0.999;
        mean = float(decay) * mean + float(1.0 - decay) * gradient;
        square = float(squareDecay) * square +
                 float(1.0 - squareDecay) * gradient.cwiseProduct(gradient);
        const double unbiased =
            rate * std::sqrt(1.0 - std::pow(squareDecay, step)) / (1.0 - std::pow(decay, step));
        value.array() -= float(unbiased) * mean.array() / (square.array().sqrt() + 1e-8f);
    }
};

struct Layer {
    Moving<Matrix> weights;  // outputs × inputs
    Moving<Row> biases;

    // Glorot and Bengio 2010: signals keep their size from layer to layer.
    static Layer random(int inputs, int outputs, Random& random) {
        const double bound = std::sqrt(6.0 / double(inputs + outputs));
        const auto fill = [&](auto values) {
            for (float& value : values.reshaped())
                value = float(bound * (2.0 * random.uniform() - 1.0));
            return values;
        };
        return {Moving<Matrix>(fill(Matrix(outputs, inputs))), Moving<Row>(fill(Row(outputs)))};
    }
};

class Training {
public:
    Training(const Matrix& scores, std::span<const float> responses,
             const NetworkTraining& training, std::uint64_t seed)
        : scores_(scores), responses_(responses), training_(training), random_(seed) {
        int inputs = int(scores.cols());
        for (const int outputs : training.hidden) {
            layers_.push_back(Layer::random(inputs, outputs, random_));
            inputs = outputs;
        }
        layers_.push_back(Layer::random(inputs, 1, random_));
    }

    NeuralNetwork run() {
        std::vector<std::uint32_t> order(responses_.size());
        std::iota(order.begin(), order.end(), 0u);
        for (int epoch = 0; epoch < training_.epochs; ++epoch) {
            const double rate =
                training_.learningRate * (3 * epoch < 2 * training_.epochs ? 1.0 : 0.25);
            random_.shuffle(order);
            for (std::size_t first = 0; first < order.size(); first += std::size_t(training_.batch))
                learn(std::span(order).subspan(
                          first, std::min(order.size() - first, std::size_t(training_.batch))),
                      rate);
        }
        NeuralNetwork network;
        for (const Layer& layer : layers_) {
            const Matrix& w = layer.weights.value;
            const Row& b = layer.biases.value;
            network.push_back(
                {int(w.cols()), {w.data(), w.data() + w.size()}, {b.data(), b.data() + b.size()}});
        }
        return network;
    }

private:
    void learn(std::span<const std::uint32_t> rows, double rate) {
        const auto count = Eigen::Index(rows.size());
        std::vector<Matrix> active;  // what each layer gets
        active.emplace_back(count, scores_.cols());
        for (Eigen::Index n = 0; n < count; ++n) {
            for (Eigen::Index f = 0; f < scores_.cols(); ++f)
                active[0](n, f) =
                    scores_(rows[std::size_t(n)], f) + float(training_.jitter) * random_.normal();
        }
        for (std::size_t l = 0; l < layers_.size(); ++l) {
            Matrix out = active[l] * layers_[l].weights.value.transpose();
            out.rowwise() += layers_[l].biases.value;
            active.push_back(l + 1 < layers_.size() ? Matrix(out.cwiseMax(0.0f)) : out);
        }
        // Of −log likelihood by the last layer's output: p − truth.
        Matrix slope(count, 1);
        for (Eigen::Index n = 0; n < count; ++n)
            slope(n, 0) = (1.0f / (1.0f + std::exp(-active.back()(n, 0))) -
                           responses_[rows[std::size_t(n)]]) /
                          float(count);
        ++step_;
        for (std::size_t l = layers_.size(); l-- > 0;) {
            Layer& layer = layers_[l];
            const Matrix weights = slope.transpose() * active[l];
            const Row biases = slope.colwise().sum();
            if (l > 0) {
                const Matrix below = slope * layer.weights.value;
                slope = (active[l].array() > 0.0f).select(below, 0.0f);
            }
            layer.weights.step(weights, rate, step_);
            layer.biases.step(biases, rate, step_);
        }
    }

    const Matrix& scores_;
    std::span<const float> responses_;
    const NetworkTraining& training_;
    Random random_;
    std::vector<Layer> layers_;
    int step_ = 0;
};

// Of a file's networks, so that no answer leaves the range of a float: greatest · (width ·
// greatest)^layers.
constexpr std::size_t widest = 1000, mostLayers = 5;
constexpr float greatest = 1e3f;

bool finite(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

bool bounded(const std::vector<float>& values) {
    return std::ranges::all_of(values, [](float v) { return std::abs(v) <= greatest; });
}

}  // namespace

float NormalScore::at(float value) const {
    const auto above = std::ranges::upper_bound(values, value);
    if (above == values.begin()) return scores.front();
    if (above == values.end()) return scores.back();
    const auto n = std::size_t(above - values.begin());
    return std::lerp(scores[n - 1], scores[n],
                     (value - values[n - 1]) / (values[n] - values[n - 1]));
}

NormalScore normalScoreOf(std::vector<float> values) {
    constexpr int knots = 33;
    std::sort(values.begin(), values.end());
    NormalScore score;
    // Of each distinct quantile the first and the last share that it stands for.
    std::vector<std::pair<double, double>> shares;
    for (int k = 0; k < knots; ++k) {
        const double share = double(k) / double(knots - 1);
        const float value = values[std::size_t(std::lround(share * double(values.size() - 1)))];
        if (score.values.empty() || value > score.values.back()) {
            score.values.push_back(value);
            shares.emplace_back(share, share);
        } else {
            shares.back().second = share;
        }
    }
    for (const auto& [first, last] : shares)
        score.scores.push_back(float(normalQuantile(0.5 * (first + last))));
    return score;
}

double NeuralNetworks::at(std::span<const float> features) const {
    std::vector<float> input;
    for (std::size_t f = 0; f < scores.size(); ++f)
        input.push_back(scores[f].at(features[f]));
    double sum = 0.0;
    for (const NeuralNetwork& network : networks) {
        std::vector<float> values = input, next;
        for (std::size_t l = 0; l < network.size(); ++l) {
            const DenseLayer& layer = network[l];
            next = layer.biases;
            for (std::size_t o = 0; o < next.size(); ++o) {
                next[o] = std::inner_product(
                    values.begin(), values.end(),
                    layer.weights.begin() + std::ptrdiff_t(o * values.size()), next[o]);
                if (l + 1 < network.size()) next[o] = std::max(next[o], 0.0f);
            }
            values.swap(next);
        }
        sum += values.front();
    }
    return sum / double(networks.size());
}

Result<void> checkNetworks(const NeuralNetworks& networks, int features) {
    const auto refuse = [](const char* what) { return fail(ErrorKind::badInput, what, "model"); };
    if (networks.networks.empty()) return refuse("there is no network");
    if (int(networks.scores.size()) != features) return refuse("features have no scores");
    for (const NormalScore& score : networks.scores) {
        if (score.values.empty() || score.values.size() != score.scores.size() ||
            !finite(score.values) || !bounded(score.scores) ||
            std::ranges::adjacent_find(score.values, std::greater_equal()) != score.values.end() ||
            !std::ranges::is_sorted(score.scores))
            return refuse("a feature's scores do not ascend");
    }
    for (const NeuralNetwork& network : networks.networks) {
        std::size_t width = std::size_t(features);
        for (const DenseLayer& layer : network) {
            if (std::size_t(layer.inputs) != width || layer.biases.empty() ||
                layer.weights.size() != width * layer.biases.size())
                return refuse("a network's layers do not fit each other");
            if (!bounded(layer.weights) || !bounded(layer.biases))
                return refuse("a network's number is not finite, or too great");
            width = layer.biases.size();
            if (width > widest) return refuse("a network's layer is too wide");
        }
        if (network.empty() || width != 1) return refuse("a network gives not one number");
        if (network.size() > mostLayers) return refuse("a network has too many layers");
    }
    return {};
}

NeuralNetworks trainNetworks(std::span<const float> rows, std::span<const float> responses,
                             int features, const NetworkTraining& training) {
    NeuralNetworks result;
    const auto width = std::size_t(features);
    Matrix scores(Eigen::Index(responses.size()), features);
    for (std::size_t f = 0; f < width; ++f) {
        std::vector<float> values;
        for (std::size_t n = 0; n < responses.size(); ++n)
            values.push_back(rows[n * width + f]);
        result.scores.push_back(normalScoreOf(values));
        for (std::size_t n = 0; n < responses.size(); ++n)
            scores(Eigen::Index(n), Eigen::Index(f)) = result.scores.back().at(values[n]);
    }
    result.networks.resize(std::size_t(training.networks));
    parallelFor(result.networks.size(), 1, training.threads,
                [&](std::size_t begin, std::size_t end) {
                    for (std::size_t n = begin; n < end; ++n)
                        result.networks[n] = Training(scores, responses, training, n + 1).run();
                });
    return result;
}

}  // namespace haustra::cad
