#include "cad/model.h"

#include "cad/built_in_models.h"
#include "cad/places.h"
#include "core/control_characters.h"
#include "core/printed_text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace haustra::cad {
namespace {

using ModelJson = nlohmann::ordered_json;

// To seven significant digits: a model is what is written, and a fifth shorter than with nine.
double shortened(float value, int digits = 7) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*g", digits, double(value));
    return std::strtod(text, nullptr);
}

ModelJson numbers(const std::vector<float>& values, int digits = 7) {
    ModelJson list = ModelJson::array();
    for (const float v : values)
        list.push_back(shortened(v, digits));
    return list;
}

constexpr int weightDigits = 5;  // thousands of weights: none matters so much
// Colours are 0 to 1, components unit vectors: what is greater comes from no training.
constexpr float greatestTexture = 1e6f;
constexpr int exactDigits = 9;  // neighbours stay apart, which a score's values must

ModelJson jsonOf(const DenseLayer& layer) {
    return {{"inputs", layer.inputs},
            {"weights", numbers(layer.weights, weightDigits)},
            {"biases", numbers(layer.biases, weightDigits)}};
}

// A whole number, written as one.
std::int64_t countIn(const ModelJson& json) {
    if (!json.is_number_integer()) throw std::invalid_argument("a count is no whole number");
    const auto count = json.get<std::int64_t>();
    if (count < std::numeric_limits<std::int32_t>::min() ||
        count > std::numeric_limits<std::int32_t>::max())
        throw std::invalid_argument("a count is out of range");
    return count;
}

std::string lineIn(const ModelJson& json, std::size_t longest) {
    const auto line = json.get<std::string>();
    if (!isModelLine(line, longest))
        throw std::invalid_argument("a text is too long, or has control characters");
    return line;
}

NeuralNetwork networkIn(const ModelJson& json) {
    NeuralNetwork network;
    for (const ModelJson& layer : json)
        network.push_back({std::int32_t(countIn(layer.at("inputs"))),
                           layer.at("weights").get<std::vector<float>>(),
                           layer.at("biases").get<std::vector<float>>()});
    return network;
}

std::vector<float> numbersIn(const ModelJson& json, std::size_t count) {
    if (json.size() != count) throw std::invalid_argument("a list has another length");
    std::vector<float> values;
    for (const ModelJson& v : json)
        values.push_back(v.get<float>());
    return values;
}

std::pair<double, double> rangeIn(const ModelJson& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>()};
}

ModelJson jsonOf(const TextureModel& texture) {
    return {{"threshold", texture.threshold},
            {"variance_share", texture.varianceShare},
            {"polyp", numbers(texture.polyp)},
            {"mean", numbers(texture.mean)},
            {"components", numbers(texture.components)}};
}

TextureModel textureIn(const ModelJson& json) {
    const std::size_t count = json.at("polyp").size();
    TextureModel texture;
    texture.threshold = json.at("threshold");
    texture.varianceShare = json.at("variance_share");
    texture.polyp = numbersIn(json.at("polyp"), count);
    texture.mean = numbersIn(json.at("mean"), textureSize);
    texture.components = numbersIn(json.at("components"), count * textureSize);
    // No distance would tell a polyp's colours from the wall's.
    if (count == 0) throw std::invalid_argument("the texture has no component");
    if (!(texture.threshold > 0.0 && texture.threshold < greatestTexture))
        throw std::invalid_argument("the texture's threshold is no distance");
    for (const auto* list : {&texture.polyp, &texture.mean, &texture.components})
        if (!std::ranges::all_of(*list, [](float v) { return std::abs(v) < greatestTexture; }))
            throw std::invalid_argument("a number of the texture is not finite, or too great");
    return texture;
}

}  // namespace

bool isModelLine(std::string_view text, std::size_t longest) {
    if (text.size() > longest) return false;
    try {
        ModelJson(std::string(text)).dump();
    } catch (const ModelJson::type_error&) {
        return false;  // no UTF-8
    }
    for (std::size_t at = 0; at < text.size();) {
        const auto [code, length] = characterAt(text, at);
        if (isControlCharacter(code)) return false;
        at += length;
    }
    return true;
}

std::string textureText(const TextureModel& texture) {
    return jsonOf(texture).dump() + "\n";
}

Result<TextureModel> textureOfText(std::string_view text, const std::string& place) {
    try {
        return textureIn(ModelJson::parse(text));
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this is no texture: " + reasonOf(error), place);
    }
}

bool ShapeThresholds::pass(const FeatureVector& features) const {
    const auto within = [&](FeatureName name, std::pair<double, double> range) {
        const double value = features[name.number];
        return value >= range.first && value <= range.second;
    };
    return within("shape_index_mean", shapeIndex) && within("curvedness_mean", curvedness) &&
           within("gradient_concentration", gradientConcentration);
}

double candidateProbability(const BoostedTrees& trees, const NeuralNetworks& networks, double a,
                            double b, const FeatureVector& features) {
    const FeatureVector weighed = asDenseAsTheWall(features);
    return logistic(0.5 * (a + b * trees.at(weighed) + networks.at(weighed)));
}

double CadModel::probability(const FeatureVector& features) const {
    return rises(features)
               ? candidateProbability(boosted, networks, calibrationA, calibrationB, features)
               : 0.0;
}

double CadModel::placeProbability(double score) const {
    return logistic(placeA + placeB * logit(score));
}

std::pair<double, double> fitLogistic(std::span<const double> x, std::span<const int> truths) {
    constexpr double pull = 1.0;
    // Negative log-likelihood and the pull's share.
    const auto loss = [&](double a, double b) {
        double sum = 0.5 * pull * (a * a + (b - 1.0) * (b - 1.0));
        for (std::size_t n = 0; n < x.size(); ++n) {
            // ln(1 + exp(-t)), t > 0 where the truth is likely.
            const double t = (truths[n] ? 1.0 : -1.0) * (a + b * x[n]);
            sum += t > 0.0 ? std::log1p(std::exp(-t)) : std::log1p(std::exp(t)) - t;
        }
        return sum;
    };
    double a = 0.0, b = 1.0, least = loss(a, b);
    for (int step = 0; step < 100; ++step) {
        double ga = pull * a, gb = pull * (b - 1.0), haa = pull, hab = 0.0, hbb = pull;
        for (std::size_t n = 0; n < x.size(); ++n) {
            const double p = 1.0 / (1.0 + std::exp(-(a + b * x[n]))), off = p - truths[n],
                         w = p * (1.0 - p);
            ga += off, gb += off * x[n];
            haa += w, hab += w * x[n], hbb += w * x[n] * x[n];
        }
        const double det = haa * hbb - hab * hab;
        double da = (hbb * ga - hab * gb) / det, db = (haa * gb - hab * ga) / det;
        double next = loss(a - da, b - db);
        for (int half = 0; half < 50 && !(next <= least); ++half)
            da *= 0.5, db *= 0.5, next = loss(a - da, b - db);
        if (!(next <= least)) break;
        a -= da, b -= db, least = next;
        if (std::abs(da) + std::abs(db) < 1e-10) break;
    }
    return {a, b};
}

std::string modelText(const CadModel& model) {
    ModelJson trees = ModelJson::array();
    for (const auto& tree : model.boosted.trees) {
        ModelJson nodes = ModelJson::array();
        for (const TreeNode& node : tree) {
            // A leaf is its value; a branch's left child is the next node.
            if (node.feature < 0)
                nodes.push_back(shortened(node.threshold));
            else
                nodes.push_back({node.feature, shortened(node.threshold), node.right});
        }
        trees.push_back(std::move(nodes));
    }
    const auto range = [](std::pair<double, double> r) { return ModelJson{r.first, r.second}; };
    const ModelJson thresholds{
        {"shape_index", range(model.thresholds.shapeIndex)},
        {"curvedness", range(model.thresholds.curvedness)},
        {"gradient_concentration", range(model.thresholds.gradientConcentration)}};
    std::string text = "{";
    const auto add = [&](const char* name, const ModelJson& value) {
        text += '"' + std::string(name) +
                "\": " + value.dump(-1, ' ', false, ModelJson::error_handler_t::replace) + ",\n";
    };
    add("haustra_cad_model", modelVersion);
    add("name", model.name);
    add("trained_on", model.trainedOn);
    add("training_sha256", model.trainingSha256);
    add("training_scans", model.trainingScans);
    if (!model.textureFrom.empty()) add("texture_from", model.textureFrom);
    add("operating_point", model.operatingPoint);
    add("calibration", {model.calibrationA, model.calibrationB});
    add("place_calibration", {model.placeA, model.placeB});
    ModelJson names = ModelJson::array();
    for (const std::string_view name : featureNames)
        names.push_back(std::string(name));
    add("features", names);
    ModelJson widths = ModelJson::array();
    for (const float width : model.boosted.widths)
        widths.push_back(shortened(width));
    add("widths", widths);
    add("thresholds", thresholds);
    add("texture", jsonOf(model.texture));
    ModelJson scores = ModelJson::array(), networks = ModelJson::array();
    for (const NormalScore& score : model.networks.scores)
        scores.push_back({numbers(score.values, exactDigits), numbers(score.scores, weightDigits)});
    add("scores", scores);
    for (const NeuralNetwork& network : model.networks.networks) {
        ModelJson layers = ModelJson::array();
        for (const DenseLayer& layer : network)
            layers.push_back(jsonOf(layer));
        networks.push_back(std::move(layers));
    }
    add("networks", networks);
    text += "\"trees\": [";
    for (std::size_t n = 0; n < trees.size(); ++n)
        text += (n ? ",\n" : "\n") + trees[n].dump();
    return text + "]}\n";
}

Result<CadModel> modelOfText(std::string_view text, const std::string& place) {
    try {
        const ModelJson json = ModelJson::parse(text);
        if (!json.contains("haustra_cad_model"))
            throw std::invalid_argument("it has no haustra_cad_model, a model's version");
        const ModelJson& version = json.at("haustra_cad_model");
        if (!version.is_number_integer())
            throw std::invalid_argument("haustra_cad_model, its version, is no whole number");
        if (version != modelVersion)
            return fail(ErrorKind::unsupported,
                        printed("the model is of version %s, and this program reads %d: it must be "
                                "trained anew",
                                version.dump().c_str(), modelVersion),
                        place);
        const ModelJson& names = json.at("features");
        bool same = names.size() == featureNames.size();
        for (std::size_t n = 0; same && n < featureNames.size(); ++n)
            same = names.at(n).get<std::string>() == featureNames[n];
        if (!same)
            return fail(ErrorKind::unsupported, "the model weighs other features than this program",
                        place);
        CadModel model;
        model.name = lineIn(json.at("name"), longestModelName);
        model.trainedOn = lineIn(json.at("trained_on"), longestModelDescription);
        model.trainingSha256 = json.at("training_sha256");
        model.trainingScans = json.at("training_scans").get<std::vector<std::string>>();
        if (json.contains("texture_from"))
            model.textureFrom = lineIn(json.at("texture_from"), longestModelName);
        model.operatingPoint = json.at("operating_point");
        model.calibrationA = json.at("calibration").at(0).get<double>();
        model.calibrationB = json.at("calibration").at(1).get<double>();
        model.placeA = json.at("place_calibration").at(0).get<double>();
        model.placeB = json.at("place_calibration").at(1).get<double>();
        const ModelJson& thresholds = json.at("thresholds");
        model.thresholds = {rangeIn(thresholds.at("shape_index")),
                            rangeIn(thresholds.at("curvedness")),
                            rangeIn(thresholds.at("gradient_concentration"))};
        model.texture = textureIn(json.at("texture"));
        for (const ModelJson& score : json.at("scores"))
            model.networks.scores.push_back(
                {score.at(0).get<std::vector<float>>(), score.at(1).get<std::vector<float>>()});
        for (const ModelJson& layers : json.at("networks"))
            model.networks.networks.push_back(networkIn(layers));
        model.boosted.widths = json.at("widths").get<std::vector<float>>();
        for (const ModelJson& nodes : json.at("trees")) {
            std::vector<TreeNode> tree;
            for (const ModelJson& node : nodes) {
                const auto next = std::int32_t(tree.size()) + 1;
                if (node.is_number())
                    tree.push_back({-1, node.get<float>(), 0, 0});
                else
                    tree.push_back({std::int32_t(countIn(node.at(0))), node.at(1).get<float>(),
                                    next, std::int32_t(countIn(node.at(2)))});
                if (!node.is_number() && tree.back().feature < 0)
                    throw std::invalid_argument("a branch has no feature");
            }
            model.boosted.trees.push_back(std::move(tree));
        }
        if (!(model.operatingPoint >= 0.0 && model.operatingPoint <= 1.0))
            throw std::invalid_argument("the operating point is no probability");
        const auto isRising = [](double a, double b) {
            return std::abs(a) < 1e6 && b > 0.0 && b < 1e6;
        };
        if (!isRising(model.calibrationA, model.calibrationB) ||
            !isRising(model.placeA, model.placeB))
            throw std::invalid_argument("the calibration does not rise with the score");
        if (const auto sound = checkTrees(model.boosted, featureCount); !sound)
            throw std::invalid_argument(sound.error().message);
        if (const auto sound = checkNetworks(model.networks, featureCount); !sound)
            throw std::invalid_argument(sound.error().message);
        return model;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this is no model: " + reasonOf(error), place);
    }
}

std::string_view builtInModelText() {
    return builtInModels().at("phantoms");
}

}  // namespace haustra::cad
