// What detection has learnt, as a small file.
#pragma once

#include "cad/boosted_trees.h"
#include "cad/lesion_features.h"
#include "cad/neural_networks.h"
#include "cad/texture.h"
#include "core/result.h"

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace haustra::cad {

/// Raised whenever features or candidates change so that older models no longer fit them.
inline constexpr int modelVersion = 9;

/// The reduction of false positives of the source (§6.2.6): each of its features within what
/// training polyps had.
struct ShapeThresholds {
    std::pair<double, double> shapeIndex{0.0, 1.0}, curvedness{0.0, 1e9},
        gradientConcentration{-1.0, 1.0};
    bool pass(const FeatureVector& features) const;
};

/// What is shown of a model to people: one line of UTF-8 without control characters, of at most so
/// many bytes; a description as long as the protocol carries it (protocol/limits.h).
inline constexpr std::size_t longestModelName = 200, longestModelDescription = 2000;
bool isModelLine(std::string_view text, std::size_t longest);

/// How probable it is that a candidate, which rises, is a polyp by itself: the logarithm of its
/// odds is the mean of the networks' and of a + b·s, s being the trees' sum (Platt 1999).
double candidateProbability(const BoostedTrees& trees, const NeuralNetworks& networks, double a,
                            double b, const FeatureVector& features);

struct CadModel {
    std::string name;       ///< "phantoms-1"; a model's line
    std::string trainedOn;  ///< for a reader: of what, and what that means; a model's line
    /// Of the training cases' scans, in order; once calibrated, of that and of these cases' scans.
    std::string trainingSha256;
    /// What the model must not be judged by: beginnings of the keys of the scans of the cases that
    /// it has learnt from or been calibrated on, and of digests of their studies' UIDs; and those
    /// of the model that texture is from.
    std::vector<std::string> trainingScans;
    std::string textureFrom;  ///< the model whose texture this is; empty: learnt from these cases
    TextureModel texture;
    ShapeThresholds thresholds;
    BoostedTrees boosted;
    NeuralNetworks networks;
    /// The trees' sum s is the logarithm of the odds a + b·s (Platt 1999).
    double calibrationA = 0.0, calibrationB = 1.0;
    /// A place's score s (places.h) becomes the probability 1/(1 + exp(−(a + b·logit s))).
    double placeA = 0.0, placeB = 1.0;
    double operatingPoint = 0.5;  ///< probability from which on a candidate is a finding

    /// candidateProbability; 0 where it does not rise.
    double probability(const FeatureVector& features) const;
    /// Of a place with this score: what a finding tells.
    double placeProbability(double score) const;
};

/// JSON that modelOfText reads back; single-precision numbers with seven significant digits, so
/// that they come back as neighbours, the values of normal scores with nine, the networks' weights
/// and scores with five. Ends with a new line.
std::string modelText(const CadModel& model);
/// Fails (badInput) where the text is no model; (unsupported) where it is of another version or of
/// other features than this program has.
Result<CadModel> modelOfText(std::string_view text, const std::string& place = "model");

/// The texture's part alone, as in a model, and back.
std::string textureText(const TextureModel& texture);
Result<TextureModel> textureOfText(std::string_view text, const std::string& place);

/// The one that the program carries: trained on phantoms alone.
std::string_view builtInModelText();

/// The pair (a, b) for which 1/(1 + exp(−(a + b·x))) fits `truths` (0 or 1) best: maximum
/// likelihood by Newton's method, a step halved until it is one downhill, with a weak pull towards
/// a = 0 and b = 1.
std::pair<double, double> fitLogistic(std::span<const double> x, std::span<const int> truths);

}  // namespace haustra::cad
