// What detection learns: texture, trees, networks, calibration; and how it is judged.
#include "cad/candidate_table.h"
#include "cad/evaluate.h"
#include "cad/former_fluid.h"
#include "cad/model.h"
#include "cad/places.h"
#include "cad/train.h"

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

std::vector<cad::TextureVector> cloud(int count, float at, float spread, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<cad::TextureVector> vectors(static_cast<std::size_t>(count));
    for (cad::TextureVector& vector : vectors) {
        const float common = normal(random);
        for (float& v : vector)
            v = at + spread * (common + 0.1f * normal(random));
    }
    return vectors;
}

TEST(Texture, TheThresholdIsTheRootMeanSquareDistanceOfPolyps) {
    auto all = cloud(2000, 0.2f, 0.05f, 1);
    const auto polyps = cloud(300, 0.6f, 0.02f, 2);
    all.insert(all.end(), polyps.begin(), polyps.end());
    for (const bool reduce : {true, false}) {
        const cad::TextureModel model = cad::learnTexture(all, polyps, reduce);
        EXPECT_EQ(model.count() == cad::textureSize, !reduce);
        EXPECT_GE(model.varianceShare, reduce ? cad::textureVariance : 1.0 - 1e-5);
        double squares = 0.0;
        for (const auto& vector : polyps)
            squares += std::pow(cad::textureDistance(model, vector), 2.0);
        EXPECT_NEAR(squares / double(polyps.size()), 1.0, 1e-3);
        for (const auto& vector : cloud(50, 0.2f, 0.05f, 3))
            EXPECT_GT(cad::textureDistance(model, vector), 2.0);
    }
}

// Responses that a tree can tell: feature 1 over a half.
struct Taught {
    std::vector<float> rows, responses;
    explicit Taught(int count) {
        std::mt19937 random(7);
        std::uniform_real_distribution<float> share;
        for (int n = 0; n < count; ++n) {
            for (int f = 0; f < cad::featureCount; ++f)
                rows.push_back(share(random));
            responses.push_back(rows[rows.size() - std::size_t(cad::featureCount) + 1] > 0.5f);
        }
    }
};

cad::NetworkTraining quickTraining() {
    cad::NetworkTraining training;
    training.networks = 2, training.hidden = {16, 8}, training.epochs = 30, training.batch = 64;
    training.jitter = 0.1;
    return training;
}

cad::CadModel smallModel() {
    const Taught taught(400);
    cad::CadModel model;
    model.name = "test-1", model.trainedOn = "numbers that \"nobody\" measured";
    model.trainingSha256 = std::string(64, 'b');
    model.texture = cad::learnTexture(cloud(200, 0.2f, 0.05f, 1), cloud(50, 0.6f, 0.02f, 2));
    model.thresholds = {{0.8, 1.0}, {0.05, 0.4}, {0.1, 0.9}};
    model.boosted = cad::boostTrees(taught.rows, taught.responses, cad::featureCount, 30);
    model.networks =
        cad::trainNetworks(taught.rows, taught.responses, cad::featureCount, quickTraining());
    model.calibrationA = -0.25, model.calibrationB = 1.5, model.operatingPoint = 0.4;
    return model;
}

TEST(NormalScore, IsWhereAValueStandsAmongThose) {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<float> values;
    for (int n = 0; n < 20000; ++n)
        values.push_back(std::exp(normal(random)));  // skewed
    const cad::NormalScore score = cad::normalScoreOf(values);
    for (const float z : {-1.5f, -0.5f, 0.0f, 0.7f, 1.5f})
        EXPECT_NEAR(score.at(std::exp(z)), z, 0.1f);
    float before = -10.0f;
    for (float v = -1.0f; v < 60.0f; v += 0.01f) {
        EXPECT_GE(score.at(v), before);
        EXPECT_LE(score.at(v) - before, before < -5.0f ? 10.0f : 0.2f);
        before = score.at(v);
    }
    // Where 60 of 100 are equal, they stand in the middle of what they take.
    std::vector<float> tied(60, 0.0f);
    for (int n = 0; n < 40; ++n)
        tied.push_back(1.0f + float(n));
    EXPECT_NEAR(cad::normalScoreOf(tied).at(0.0f), -0.52f, 0.05f);  // Φ⁻¹(0.3)
    EXPECT_NEAR(cad::normalScoreOf({2.0f, 2.0f}).at(7.0f), 0.0f, 1e-6f);
}

TEST(NeuralNetworks, LearnWhatNoSingleFeatureTells) {
    // A polyp where features 0 and 1 are on different sides of a half.
    std::mt19937 random(11);
    std::uniform_real_distribution<float> share;
    std::vector<float> rows, responses;
    for (int n = 0; n < 6000; ++n) {
        for (int f = 0; f < 4; ++f)
            rows.push_back(share(random));
        const float* row = &rows[rows.size() - 4];
        responses.push_back((row[0] > 0.5f) != (row[1] > 0.5f));
    }
    cad::NetworkTraining training = quickTraining();
    training.threads = 1;
    const auto networks = cad::trainNetworks(rows, responses, 4, training);
    ASSERT_TRUE(cad::checkNetworks(networks, 4));
    for (const auto& [x, y] : {std::pair(0.2f, 0.8f), {0.8f, 0.2f}, {0.2f, 0.2f}, {0.8f, 0.8f}}) {
        const double odds = networks.at(std::vector<float>{x, y, 0.5f, 0.5f});
        EXPECT_GT((x > 0.5f) != (y > 0.5f) ? odds : -odds, 1.0) << x << ' ' << y;
    }
    // Known no better than the noise it was taught with, a step of a tenth of that moves it little.
    double largest = 0.0, before = 0.0;
    for (int n = 0; n <= 1000; ++n) {
        const double now =
            networks.at(std::vector<float>{0.2f + 0.6f * float(n) / 1000.0f, 0.2f, 0.5f, 0.5f});
        if (n > 0) largest = std::max(largest, std::abs(now - before));
        before = now;
    }
    EXPECT_LT(largest, 0.1);
    training.threads = 2;
    const auto again = cad::trainNetworks(rows, responses, 4, training);
    EXPECT_EQ(again.at(std::span(rows).first(4)), networks.at(std::span(rows).first(4)));
}

TEST(NeuralNetworks, ThatDoNotFitAreRefused) {
    const cad::NeuralNetworks sound = smallModel().networks;
    ASSERT_TRUE(cad::checkNetworks(sound, cad::featureCount));
    EXPECT_FALSE(cad::checkNetworks(sound, cad::featureCount + 1));
    EXPECT_FALSE(cad::checkNetworks({}, cad::featureCount));
    cad::NeuralNetworks other = sound;
    other.networks[0][0].weights.pop_back();
    EXPECT_FALSE(cad::checkNetworks(other, cad::featureCount));
    other = sound;
    other.networks[0].pop_back();  // many numbers, not one
    EXPECT_FALSE(cad::checkNetworks(other, cad::featureCount));
    other = sound;
    other.networks[0][1].biases[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(cad::checkNetworks(other, cad::featureCount));
    other = sound;
    other.networks[0][0].weights[0] = 1e30f;  // two of them would overflow
    EXPECT_FALSE(cad::checkNetworks(other, cad::featureCount));
    other = sound;
    other.networks[0].insert(other.networks[0].end(), 9, {1, {1.0f}, {0.0f}});  // fits, but deep
    EXPECT_FALSE(cad::checkNetworks(other, cad::featureCount));
    other = sound;
    std::swap(other.scores[0].values.front(), other.scores[0].values.back());
    EXPECT_FALSE(cad::checkNetworks(other, cad::featureCount));
}

TEST(BoostedTrees, LearnsWhatTellsTheTwoApart) {
    const cad::CadModel model = smallModel();
    cad::FeatureVector features;
    features.fill(0.5f);
    features[1] = 0.95f;
    EXPECT_GT(model.boosted.at(features), 1.0);
    features[1] = 0.05f;
    EXPECT_LT(model.boosted.at(features), -1.0);
    const Taught taught(400);
    const cad::BoostedTrees again =
        cad::boostTrees(taught.rows, taught.responses, cad::featureCount, 30);
    EXPECT_EQ(again.at(features), model.boosted.at(features));
}

TEST(BoostedTrees, AnswerIsTheMeanOverWhatFeaturesMayBe) {
    // Where one tree asks for each feature once, that is the mean over errors of the features.
    cad::BoostedTrees one;
    one.trees = {
        {{0, 0.5f, 1, 4}, {1, 0.2f, 2, 3}, {-1, 1.0f, 0, 0}, {-1, -2.0f, 0, 0}, {-1, 5.0f, 0, 0}}};
    one.widths = {0.3f, 0.4f};
    ASSERT_TRUE(cad::checkTrees(one, 2));
    cad::BoostedTrees hard = one;
    hard.widths = {0.0f, 0.0f};
    for (const auto& [x, y] : {std::pair(0.45f, 0.25f), {0.6f, 0.2f}, {0.2f, 0.1f}, {0.9f, 0.3f}}) {
        constexpr int steps = 400;
        double sum = 0.0;
        for (int i = 0; i < steps; ++i)
            for (int j = 0; j < steps; ++j)
                sum += hard.at(std::vector<float>{
                    x + one.widths[0] * (float(i) + 0.5f - 0.5f * steps) / steps,
                    y + one.widths[1] * (float(j) + 0.5f - 0.5f * steps) / steps});
        EXPECT_NEAR(one.at(std::vector<float>{x, y}), sum / (steps * steps), 0.02);
    }
    // It is continuous: a small change of a feature is a small change of the answer.
    const cad::CadModel model = smallModel();
    cad::FeatureVector features;
    features.fill(0.5f);
    double largest = 0.0, before = 0.0;
    for (int n = 0; n <= 4000; ++n) {
        features[1] = float(n) / 4000.0f;
        const double now = model.boosted.at(features);
        if (n > 0) largest = std::max(largest, std::abs(now - before));
        before = now;
    }
    EXPECT_LT(largest, 0.4);  // a single one of the 30 trees may leap by 2
    // What would be walked for ever, or too deep, is refused.
    cad::BoostedTrees shared = one;
    shared.trees = {{{0, 0.5f, 1, 1}, {-1, 1.0f, 0, 0}}};
    EXPECT_FALSE(cad::checkTrees(shared, 2));
    cad::BoostedTrees chain = one;
    chain.trees.assign(1, {});
    for (int n = 0; n < 200; n += 2) {
        chain.trees[0].push_back({0, 0.5f, n + 1, n + 2});
        chain.trees[0].push_back({-1, 1.0f, 0, 0});
    }
    chain.trees[0].push_back({-1, 2.0f, 0, 0});
    EXPECT_FALSE(cad::checkTrees(chain, 2));
    one.widths.pop_back();
    EXPECT_FALSE(cad::checkTrees(one, 2));
}

TEST(Model, ReadsBackAsItWas) {
    const cad::CadModel model = smallModel();
    const std::string text = cad::modelText(model);
    const auto read = cad::modelOfText(text);
    ASSERT_TRUE(read) << describe(read.error());
    EXPECT_EQ(cad::modelText(*read), text);
    std::mt19937 random(3);
    std::uniform_real_distribution<float> share;
    for (int n = 0; n < 200; ++n) {
        cad::FeatureVector features;
        for (float& f : features)
            f = share(random);
        EXPECT_NEAR(read->probability(features), model.probability(features), 1e-4);
    }
}

TEST(Model, WhatIsNoneIsRefused) {
    const std::string sound = cad::modelText(smallModel());
    const auto with = [&](const std::string& from, const std::string& to) {
        std::string text = sound;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos) << from;
        return text.replace(at, from.size(), to);
    };
    ASSERT_TRUE(cad::modelOfText(sound));
    const auto withTree = [&](const std::string& tree) {
        return with("\"trees\": [\n", "\"trees\": [\n" + tree + ",\n");
    };
    ASSERT_TRUE(cad::modelOfText(withTree("[[0,0.5,2],1.0,-1.0]"), "m.json"));
    const std::string mean = "\"mean\":[",
                      inputs = "\"inputs\":" + std::to_string(cad::featureCount);
    const std::size_t firstMean = sound.find(mean) + mean.size();
    const std::string meanOf = sound.substr(firstMean, sound.find(',', firstMean) - firstMean);
    ASSERT_TRUE(cad::modelOfText(with(mean + meanOf, mean + "0.25"), "m.json"));
    cad::TextureModel none = smallModel().texture;
    ASSERT_TRUE(cad::textureOfText(cad::textureText(none), "t.json"));
    none.polyp.clear(), none.components.clear();
    EXPECT_FALSE(cad::textureOfText(cad::textureText(none), "t.json"));
    for (const std::string& text : {std::string(),
                                    std::string("[]"),
                                    sound.substr(0, sound.size() - 40),
                                    with("\"haustra_cad_model\": ", "\"haustra_cad_model\": 9"),
                                    with("diameter_mm", "weight_kg"),
                                    withTree("[[99,0.5,2],1.0,-1.0]"),
                                    withTree("[[0.9,0.5,2],1.0,-1.0]"),
                                    withTree("[[0,0.5,1],1.0,-1.0]"),
                                    withTree("[[0,0.5,0],1.0,-1.0]"),
                                    with("\"polyp\":[", "\"polyp\":[0,"),
                                    with("\"operating_point\": ", "\"operating_point\": 2"),
                                    with("\"networks\": [", "\"networks\": [[],"),
                                    with("\"threshold\":", "\"threshold\":-1,\"x\":"),
                                    with(mean + meanOf, mean + "1e30"),
                                    with(inputs, inputs + ".5"),
                                    with("\"name\": \"", "\"name\": \"a\\nwarning: b"),
                                    with("\"name\": \"", "\"name\": \"a\u009b31m"),
                                    with("\"name\": \"", "\"name\": \"a\u2028b"),
                                    with("\"name\": \"", "\"name\": \"" + std::string(300, 'a')),
                                    with("\"scores\": [", "\"scores\": [[[1.0],[1.0]],"),
                                    with("\"training_scans\": ", "\"training_scans\": 7, \"x\": ")})
        EXPECT_FALSE(cad::modelOfText(text, "m.json")) << text.substr(0, 60);
    // Higher scores are more probable, and greater values have higher scores.
    for (const auto& spoil : std::vector<std::function<void(cad::CadModel&)>>{
             [](cad::CadModel& model) { model.calibrationB = -1.5; },
             [](cad::CadModel& model) { model.placeB = -1.0; },
             [](cad::CadModel& model) {
                 model.networks.scores.front() = {{0.0f, 1.0f}, {1.0f, 0.0f}};
             }}) {
        cad::CadModel falling = smallModel();
        spoil(falling);
        EXPECT_FALSE(cad::modelOfText(cad::modelText(falling), "m.json"));
    }
    // A version that no program has is no other program's.
    for (const char* version : {"1e99", "1.5", "\"1\"", "null"}) {
        const auto refused =
            cad::modelOfText(with("\"haustra_cad_model\": ",
                                  std::string("\"haustra_cad_model\": ") + version + ", \"x\": "),
                             "m.json");
        ASSERT_FALSE(refused) << version;
        EXPECT_NE(refused.error().message.find("no whole number"), std::string::npos)
            << refused.error().message;
    }
}

TEST(Model, TheBuiltInOneIsSoundAndSaysWhatItIs) {
    const auto model = cad::modelOfText(cad::builtInModelText(), "built-in model");
    ASSERT_TRUE(model) << describe(model.error());
    EXPECT_NE(model->trainedOn.find("phantoms"), std::string::npos);
    EXPECT_EQ(model->trainingSha256.size(), 64u);
    EXPECT_GT(model->operatingPoint, cad::leastProbability);
    EXPECT_GE(model->texture.varianceShare, cad::textureVariance);
}

TEST(Model, WhatDoesNotRiseIsNothing) {
    cad::CadModel model;
    model.boosted.trees = {{{-1, 5.0f}}};
    const auto count = std::size_t(cad::featureCount);
    model.boosted.widths.assign(count, 0.0f);
    model.networks.scores.assign(count, {{0.0f}, {0.0f}});
    model.networks.networks = {{{cad::featureCount, std::vector<float>(count, 0.0f), {5.0f}}}};
    ASSERT_TRUE(cad::checkNetworks(model.networks, cad::featureCount));
    cad::FeatureVector features{};
    // Above a soap film, or above the wall around continued: either will do.
    for (const std::size_t number :
         {cad::featureNumber("height_mm"), cad::featureNumber("lift_top")}) {
        float& height = features[number];
        for (const float mm : {-2.0f, 0.0f, 0.49f}) {
            height = mm;
            EXPECT_EQ(model.probability(features), 0.0);
        }
        height = cad::leastHeightMm;
        EXPECT_GT(model.probability(features), 0.9);
        height = 0.0f;
    }
}

// Its probability by a tree and a network that look at density alone.
cad::CadModel densityModel() {
    const auto count = std::size_t(cad::featureCount), peak = cad::featureNumber("peak_median");
    cad::CadModel model;
    model.boosted.trees = {
        {{std::int32_t(peak), -0.12f, 1, 2}, {-1, -2.0f, 0, 0}, {-1, 2.0f, 0, 0}}};
    model.boosted.widths.assign(count, 0.0f);
    model.networks.scores.assign(count, {{-3.0f, 3.0f}, {-3.0f, 3.0f}});
    std::vector<float> weights(count, 0.0f);
    weights[cad::featureNumber("density_core")] = 1.0f;
    model.networks.networks = {{{cad::featureCount, weights, {0.0f}}}};
    return model;
}

TEST(Model, ALittleLessDenseThanTheWallTellsNothing) {
    const cad::CadModel model = densityModel();
    ASSERT_TRUE(cad::checkTrees(model.boosted, cad::featureCount));
    ASSERT_TRUE(cad::checkNetworks(model.networks, cad::featureCount));
    // A polyp's features, all of it `darker` than the wall.
    const auto probability = [&](float darker) {
        cad::FeatureVector features{};
        features[cad::featureNumber("height_mm")] = 4.0f;
        features[cad::featureNumber("peak_median")] = -darker;
        features[cad::featureNumber("density_core")] = 0.1f - darker;
        return model.probability(features);
    };
    const double asDense = probability(0.0f);
    for (const float darker : {0.05f, 0.1f, 0.149f})
        EXPECT_NEAR(probability(darker), asDense, 1e-6) << darker;
    // Fat is a wall's density less than 1; denser ones stay as they are.
    EXPECT_LT(probability(0.7f), asDense - 0.2);
    EXPECT_GT(probability(-0.3f), asDense);
    cad::FeatureVector features{};
    features.fill(-0.1f);
    const cad::FeatureVector weighed = cad::asDenseAsTheWall(features);
    using Names = std::initializer_list<cad::FeatureName>;
    for (const auto [n] : Names{"density_median", "density_p90", "density_core", "peak_median",
                                "peak_p90", "peak_over_ring"})
        EXPECT_NEAR(weighed[n] - features[n], 0.1f, 1e-6f) << cad::featureNames[n];
    for (const auto [n] : Names{"height_mm", "density_spread", "peak_spread", "dip_mean"})
        EXPECT_EQ(weighed[n], features[n]) << cad::featureNames[n];
}

TEST(Calibration, FindsTheLogisticThatDrewTheTruths) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share;
    std::vector<double> x;
    std::vector<int> truths;
    for (int n = 0; n < 20000; ++n) {
        x.push_back(8.0 * share(random) - 4.0);
        truths.push_back(share(random) < 1.0 / (1.0 + std::exp(-(-1.0 + 0.7 * x.back()))));
    }
    const auto [a, b] = cad::fitLogistic(x, truths);
    EXPECT_NEAR(a, -1.0, 0.1);
    EXPECT_NEAR(b, 0.7, 0.05);
}

cad::TrueLesion polypAt(glm::dvec3 place, double diameterMm, const char* kind = "sessile") {
    cad::TrueLesion lesion;
    lesion.positionMm = lesion.wallMm = place;
    lesion.diameterMm = diameterMm, lesion.kind = kind;
    lesion.neoplastic = std::string(kind) != "hyperplastic" && std::string(kind) != "lump";
    return lesion;
}

TEST(Truth, AFindingMeansTheNearestPolypThatItReaches) {
    const std::vector<cad::TrueLesion> truth{polypAt({0, 0, 0}, 10.0), polypAt({12, 0, 0}, 6.0),
                                             polypAt({0, 30, 0}, 4.0, "hyperplastic")};
    EXPECT_EQ(cad::matched({{1, 0, 0}, {7.9, 0, 0}, {8.1, 0, 0}, {0, 26, 0}, {0, 0, 20}}, truth),
              (std::vector<int>{0, 1, 1, 2, -1}));
}

// One case with two polyps; what is told of it has these scores.
cad::EvaluatedCase judged(std::vector<cad::ToldPlace> places) {
    cad::EvaluatedCase each;
    each.truth = {polypAt({0, 0, 0}, 8.0), polypAt({50, 0, 0}, 12.0),
                  polypAt({0, 50, 0}, 3.0, "hyperplastic"), polypAt({0, 0, 50}, 7.0, "lump")};
    each.places = std::move(places);
    return each;
}

TEST(Examples, AreLearntFromWhereTheyShowAPolypWhole) {
    std::vector<cad::TrueLesion> truth(2);
    truth[0].diameterMm = 10.0;
    truth[1].diameterMm = 6.0, truth[1].positionMm = {50, 0, 0};
    truth[1].neoplastic = false, truth[1].kind = "hyperplastic";
    const auto candidate = [](double x, double diameterMm) {
        cad::Candidate made;
        made.lesion.centerMm = {x, 0, 0};
        made.lesion.diameter.mm = diameterMm, made.lesion.areaMm2 = diameterMm * diameterMm;
        return made;
    };
    const auto examples = cad::examplesOf(
        {candidate(1, 9), candidate(2, 4), candidate(51, 6), candidate(100, 6)}, truth);
    const auto told = [&](auto member) {
        std::vector<bool> all;
        for (const cad::Example& example : examples)
            all.push_back(example.*member);
        return all;
    };
    // Whole; a fragment; benign; nothing at all.
    EXPECT_EQ(told(&cad::Example::polyp), (std::vector<bool>{true, false, false, false}));
    EXPECT_EQ(told(&cad::Example::weighed), (std::vector<bool>{true, false, false, true}));
}

TEST(Examples, OfOtherLevelsAreNotLearntFrom) {
    std::vector<cad::TrueLesion> truth(1);
    truth[0].diameterMm = 12.0;
    const auto candidate = [](double x, double diameterMm, int levelOf) {
        cad::Candidate made;
        made.lesion.centerMm = {x, 0, 0}, made.levelOf = levelOf;
        made.lesion.diameter.mm = diameterMm, made.lesion.areaMm2 = diameterMm * diameterMm;
        return made;
    };
    // Of the two at the polyp neither is half as wide, so the larger stands for it, whatever its
    // wide level is.
    const auto examples =
        cad::examplesOf({candidate(1, 4, -1), candidate(2, 5, -1), candidate(90, 6, -1),
                         candidate(1, 11, 0), candidate(90, 7, 2)},
                        truth);
    ASSERT_EQ(examples.size(), 5u);
    for (std::size_t n = 0; n < 5; ++n) {
        EXPECT_EQ(examples[n].polyp, n == 1) << n;
        EXPECT_EQ(examples[n].weighed, n == 1 || n == 2) << n;
    }
    EXPECT_EQ(examples[3].lesion, 0) << "but tells what its place is";
    EXPECT_EQ(examples[3].levelOf, 0);
    EXPECT_EQ(examples[4].lesion, -1);
}

TEST(Places, AreScoredByTheirThreeMostProbableWitnesses) {
    // Two of one place, one of another, one so far that only its own width joins it to the first.
    const std::vector<cad::PlaceWitness> witnesses{{{0, 0, 0}, 6.0, 20.0, 0.8},
                                                   {{2.9, 0, 0}, 4.0, 10.0, 0.6},
                                                   {{3.1, 0, 0}, 4.0, 10.0, 0.4},
                                                   {{0, 9.0, 0}, 20.0, 200.0, 0.7}};
    const auto places = cad::placesOf(witnesses);
    ASSERT_EQ(places.size(), 2u);
    EXPECT_EQ(places[0].best, 0u);
    // The wide one is the first that seconds it; the third is no part of it, and alone.
    EXPECT_DOUBLE_EQ(places[0].score, (0.8 + 0.7 + 0.6) / 3.0);
    EXPECT_EQ(places[1].best, 2u);
    EXPECT_DOUBLE_EQ(places[1].score, 0.4 / 3.0);
    // Of equal ones the larger; the order in which they come is nothing.
    std::vector<cad::PlaceWitness> equal{{{0, 0, 0}, 6.0, 10.0, 0.5}, {{1, 0, 0}, 6.0, 30.0, 0.5}};
    EXPECT_EQ(cad::placesOf(equal)[0].best, 1u);
    std::swap(equal[0], equal[1]);
    EXPECT_EQ(cad::placesOf(equal)[0].best, 0u);
    EXPECT_NEAR(cad::logistic(cad::logit(0.3)), 0.3, 1e-12);
}

TEST(Places, HearAnotherLevelOnlyOfWhatIsWorthTheLook) {
    std::vector<cad::PlaceWitness> witnesses{{{0, 0, 0}, 6.0, 20.0, 0.3},
                                             {{9, 0, 0}, 6.0, 20.0, 0.5 * cad::worthAnotherLook},
                                             {{0, 0, 0}, 5.0, 15.0, 0.6, 0},
                                             {{9, 0, 0}, 7.0, 25.0, 0.9, 1}};
    const auto places = cad::placesOf(witnesses);
    ASSERT_EQ(places.size(), 2u);
    EXPECT_EQ(places[0].best, 2u) << "the other level may be the most probable";
    EXPECT_DOUBLE_EQ(places[0].score, (0.6 + 0.3) / 3.0);
    EXPECT_EQ(places[1].best, 1u);
    EXPECT_DOUBLE_EQ(places[1].score, 0.5 * cad::worthAnotherLook / 3.0);
}

TEST(Calibration, AModelIsCalibratedOnOtherCases) {
    // Trees that ask for one feature; of what scores high three in four are polyps, of what scores
    // low one in ten.
    cad::CadModel model = smallModel();
    model.networks = {};
    model.networks.scores.assign(std::size_t(cad::featureCount), {{0.0f}, {0.0f}});
    model.networks.networks = {
        {{cad::featureCount, std::vector<float>(std::size_t(cad::featureCount), 0.0f), {0.0f}}}};
    model.boosted.trees = {{{0, 0.5f, 1, 2}, {-1, -4.0f, 0, 0}, {-1, 4.0f, 0, 0}}};
    model.boosted.widths.assign(std::size_t(cad::featureCount), 0.0f);
    model.calibrationA = 0.0, model.calibrationB = 1.0;
    std::mt19937 random(9);
    std::uniform_real_distribution<double> share;
    std::vector<cad::TrainingCase> cases(20);
    double polyps = 0.0, others = 0.0;
    for (std::size_t n = 0; n < cases.size(); ++n) {
        cases[n].name = "case " + std::to_string(n);
        for (int p = 0; p < 40; ++p) {
            const bool high = p % 2 == 0, polyp = share(random) < (high ? 0.75 : 0.1);
            cad::Example example;
            example.features[0] = high ? 1.0f : 0.0f;
            example.features[cad::featureNumber("height_mm")] = 2.0f;
            example.placeMm = {20.0 * p, 0, 0}, example.diameterMm = 8.0;
            example.lesion = polyp ? int(cases[n].truth.size()) : -1, example.polyp = polyp;
            if (polyp) cases[n].truth.push_back(polypAt(example.placeMm, 8.0));
            (polyp ? polyps : others) += 1.0;
            cases[n].examples.push_back(example);
        }
    }
    const auto before = model.probability(cases[0].examples[0].features);
    const double allowed = 10.0;  // of some 5 high ones and 18 low ones
    const auto told = cad::calibrate(model, cases, allowed);
    ASSERT_TRUE(told) << describe(told.error());
    EXPECT_EQ(model.probability(cases[0].examples[0].features), before) << "places' alone";
    // As probable as there are polyps, in the mean and of either kind.
    double sum = 0.0, wrong = 0.0;
    for (const cad::EvaluatedCase& each : *told) {
        for (const cad::ToldPlace& place : each.places) {
            EXPECT_NEAR(place.score, place.score > 0.4 ? 0.75 : 0.1, 0.05);
            sum += place.score;
            wrong += place.lesion < 0 && place.score >= model.operatingPoint;
        }
    }
    EXPECT_NEAR(sum, polyps, 0.01 * (polyps + others));
    EXPECT_LE(wrong, allowed * double(cases.size()));
    EXPECT_GT(wrong, 0.0);
    for (cad::TrainingCase& each : cases)
        each.truth.clear();
    for (cad::TrainingCase& each : cases)
        for (cad::Example& example : each.examples)
            example.lesion = -1;
    EXPECT_FALSE(cad::calibrate(model, cases, allowed)) << "nothing to calibrate by";
}

TEST(Truth, APhantomsValveAndTubeAreNoLesions) {
    const auto mimics = cad::mimicsOfJson(
        R"({"valve":{"position_mm":[1,2,3]},
            "rectal_tube":{"axis_mm":[[50,0,0],[50,0,4]],"shaft_radius_mm":4.5,
                           "balloon_mm":[50,0,40],"balloon_radius_mm":15}})",
        "structure.json");
    ASSERT_TRUE(mimics && mimics->size() == 4);
    for (const cad::TrueLesion& mimic : *mimics) {
        EXPECT_FALSE(mimic.neoplastic);
        EXPECT_FALSE(mimic.hyperplastic());
        EXPECT_EQ(mimic.kind, &mimic == &mimics->front() ? "valve" : "tube");
    }
    // A polyp on it is a polyp.
    const std::vector<cad::TrueLesion> truth{mimics->at(0), polypAt({1, 2, 8}, 8.0), mimics->at(3)};
    EXPECT_EQ(cad::matched({{1, 2, 4}, {1, -8, 3}, {30, 0, 0}, {50, 17, 40}}, truth),
              (std::vector<int>{1, 0, -1, 2}));
    const auto none = cad::mimicsOfJson(R"({"valve":null})", "structure.json");
    EXPECT_TRUE(none && none->empty());
    EXPECT_FALSE(cad::mimicsOfJson("{\"valve\":{}}", "structure.json"));
    for (const char* other : {"{}", "[]", "3", "null", R"({"growths":[]})"})
        EXPECT_FALSE(cad::mimicsOfJson(other, "structure.json")) << other;
    EXPECT_FALSE(cad::mimicsOfJson(R"({"rectal_tube":{"axis_mm":[]}})", "structure.json"));
}

TEST(Truth, AHyperplasticGrowthIsNoPolypUnlessSomebodySaysTwoThings) {
    const auto lesion = [](const std::string& more) {
        return cad::truthOfJson(
            R"({"findings":[{"position_mm":[0,0,0],"diameter_mm":8)" + more + "}]}", "truth.json");
    };
    const auto benign = lesion(R"(,"kind":"hyperplastic")"), polyp = lesion(R"(,"kind":"flat")");
    ASSERT_TRUE(benign && polyp);
    EXPECT_FALSE(benign->front().neoplastic);
    EXPECT_EQ(benign->front().isPolyp(), std::nullopt);
    EXPECT_EQ(polyp->front().isPolyp(), true);
    EXPECT_FALSE(lesion(R"(,"kind":"hyperplastic","neoplastic":true)"));
}

TEST(Truth, WhatIsPrintedOrCountedIsSound) {
    const auto takes = [](const std::string& more) {
        return cad::truthOfJson(
                   R"({"findings":[{"position_mm":[0,0,0],"diameter_mm":8,)" + more + "}]}",
                   "truth.json")
            .has_value();
    };
    EXPECT_TRUE(takes(R"("kind":"flat","untagged_share":1.0,"submerged_share":0,"height_mm":2.5)"));
    for (const char* bad : {R"("kind":"flat\n\u001b[31mall  99/99")", R"("untagged_share":40)",
                            R"("submerged_share":-0.1)", R"("height_mm":-3)",
                            R"("height_mm":1e300)", R"("film_mm":301)"})
        EXPECT_FALSE(takes(bad)) << bad;
}

TEST(FormerFluid, IsAsFarAsItsNearestPlace) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> within(-40.0, 40.0);
    std::vector<glm::dvec3> places;
    std::vector<std::uint8_t> wet;
    for (int n = 0; n < 400; ++n) {
        places.emplace_back(within(random), within(random), within(random));
        wet.push_back(n % 3 == 0);
    }
    const cad::FormerFluid fluid(places, wet);
    for (int n = 0; n < 300; ++n) {
        const glm::dvec3 at(1.8 * within(random), within(random), within(random));
        double least = cad::FormerFluid::farthestMm;
        for (std::size_t p = 0; p < places.size(); ++p)
            if (wet[p]) least = std::min(least, glm::distance(places[p], at));
        EXPECT_DOUBLE_EQ(fluid.distanceMm(at), least);
    }
    EXPECT_EQ(cad::FormerFluid().distanceMm({}), cad::FormerFluid::farthestMm);
}

TEST(Evaluation, CountsWhatItSays) {
    const cad::EvaluatedCase a = judged({{0.9, 8.5, 0, ""},
                                         {0.8, 6.0, -1, "fold"},
                                         {0.7, 3.0, 2, ""},
                                         {0.6, 7.0, 3, ""},
                                         {0.3, 11.0, 1, ""}});
    const cad::Evaluation sum = cad::evaluate({&a}, 0.5);
    EXPECT_EQ(sum.from6Mm.of, 2);
    EXPECT_EQ(sum.from6Mm.hit, 1);
    EXPECT_EQ(sum.from10Mm.hit, 0);
    EXPECT_DOUBLE_EQ(sum.falsePositives, 2.0) << "a fold and a lump; a benign growth is none";
    EXPECT_DOUBLE_EQ(sum.falseBefore, 2.0) << "whatever their score";
    EXPECT_DOUBLE_EQ(cad::evaluate({&a}, 0.75).falsePositives, 1.0);
    EXPECT_DOUBLE_EQ(cad::evaluate({&a}, 0.75).falseBefore, 2.0);
    EXPECT_EQ(sum.hyperplastic, 1);
    EXPECT_EQ(sum.falseKinds.at("fold"), 1);
    EXPECT_EQ(sum.falseKinds.at("lump"), 1);
    EXPECT_DOUBLE_EQ(sum.diameterMean.value(), 0.5);
    EXPECT_DOUBLE_EQ(sum.diameter95.value(), 0.5);
    const cad::Evaluation both = cad::evaluate({&a}, 0.2);
    EXPECT_GE(both.diameter95.value(), both.diameterMean.value());
    EXPECT_EQ(cad::evaluate({&a}, 0.2).from6Mm.hit, 2);
    // Of what was not found no error is told.
    const cad::Evaluation nothing = cad::evaluate({&a}, 0.95);
    for (const auto& error : {nothing.diameterMean, nothing.diameter95, nothing.diameterBias})
        EXPECT_FALSE(error);
}

TEST(Evaluation, SaysWhereItsMistakesLie) {
    const cad::EvaluatedCase a = judged({{0.6, 7.0, 3, "", {4, 0, 0}},
                                         {0.9, 8.5, 0, "", {1, 0, 0}},
                                         {0.8, 6.0, -1, "fold", {2, 0, 0}},
                                         {0.7, 3.0, 2, "", {3, 0, 0}},
                                         {0.3, 11.0, 1, "", {5, 0, 0}}}),
                             b{"b", "", a.truth, {}};
    for (const double point : {0.2, 0.5, 0.65, 0.95}) {
        const cad::Evaluation sum = cad::evaluate({&a, &b}, point);
        const auto missed = cad::missedLesions({&a, &b}, point),
                   wrong = cad::falseFindings({&a, &b}, point);
        EXPECT_EQ(int(missed.size()), sum.from6Mm.of - sum.from6Mm.hit) << "none is smaller";
        EXPECT_DOUBLE_EQ(double(wrong.size()) / 2.0, sum.falsePositives);
    }
    const auto missed = cad::missedLesions({&a, &b}, 0.5);
    ASSERT_EQ(missed.size(), 3u);
    EXPECT_EQ(missed[0].caseName, a.name);
    EXPECT_EQ(missed[0].positionMm, a.truth[1].positionMm);
    EXPECT_DOUBLE_EQ(missed[0].score, 0.3) << "told, but not probable enough";
    EXPECT_EQ(missed[1].caseName, "b");
    EXPECT_DOUBLE_EQ(missed[1].score, 0.0) << "nothing means it";
    const auto wrong = cad::falseFindings({&a, &b}, 0.5);
    ASSERT_EQ(wrong.size(), 2u);
    EXPECT_EQ(wrong[0].kind, "fold") << "the most probable first";
    EXPECT_EQ(wrong[0].positionMm, glm::dvec3(2, 0, 0));
    EXPECT_EQ(wrong[1].kind, "lump");
    const auto benign = cad::hyperplasticFindings({&a, &b}, 0.5);
    ASSERT_EQ(benign.size(), 1u);
    EXPECT_EQ(benign[0].positionMm, glm::dvec3(3, 0, 0));
    EXPECT_TRUE(cad::hyperplasticFindings({&a, &b}, 0.75).empty()) << "it is not told there";
}

TEST(Evaluation, CountsWhatResidueCoatsApartFromWhatIsUnderFluid) {
    cad::TrueLesion dry, under, hidden, bare;
    for (cad::TrueLesion* each : {&dry, &under, &hidden, &bare})
        each->diameterMm = 9.0, each->filmMm = 1.5;
    bare.filmMm = 0.0;
    under.submergedShare = hidden.submergedShare = hidden.untaggedShare = 1.0;
    const cad::EvaluatedCase a{
        "a", "", {dry, dry, under, hidden, hidden, bare}, {{0.9, 9.0, 1, ""}, {0.8, 9.0, 3, ""}}};
    const cad::Evaluation sum = cad::evaluate({&a}, 0.5);
    EXPECT_EQ(sum.coated.of, 2);
    EXPECT_EQ(sum.coated.hit, 1);
    EXPECT_EQ(sum.submerged.of, 1);
    EXPECT_EQ(sum.submerged.hit, 0);
    EXPECT_EQ(sum.hidden.of, 2) << "under water, which shows nothing, and apart";
    EXPECT_EQ(sum.hidden.hit, 1);
}

TEST(Evaluation, CountsADensityOnlyWhereTheTruthTellsIt) {
    cad::TrueLesion plain, dense, unknown;
    for (cad::TrueLesion* each : {&plain, &dense, &unknown})
        each->diameterMm = 8.0;
    plain.coreHu = 0.0, dense.coreHu = 22.0;
    const cad::EvaluatedCase a{"a", "", {plain, dense, unknown}, {}};
    const cad::Evaluation sum = cad::evaluate({&a}, 0.5);
    EXPECT_EQ(sum.from6Mm.of, 3);
    EXPECT_EQ(sum.plain.of, 1);
    EXPECT_EQ(sum.dense.of, 1);
}

TEST(Evaluation, TheFrocCurveRisesAndItsBandsHoldIt) {
    std::vector<cad::EvaluatedCase> cases;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> share;
    for (int n = 0; n < 30; ++n) {
        std::vector<cad::ToldPlace> places{{0.3 + 0.7 * share(random), 8.0, 0, ""},
                                           {0.3 + 0.7 * share(random), 12.0, 1, ""}};
        for (int f = 0; f < 12; ++f)
            places.push_back({share(random) * share(random), 5.0, -1, "wall"});
        cases.push_back(judged(std::move(places)));
    }
    std::vector<const cad::EvaluatedCase*> all;
    for (const auto& each : cases)
        all.push_back(&each);
    const auto curve = cad::frocCurve(all, 200);
    ASSERT_GT(curve.size(), 5u);
    for (std::size_t p = 0; p < curve.size(); ++p) {
        EXPECT_LE(curve[p].low, curve[p].sensitivity + 1e-9);
        EXPECT_GE(curve[p].high, curve[p].sensitivity - 1e-9);
        if (p == 0) continue;
        EXPECT_GE(curve[p].sensitivity, curve[p - 1].sensitivity);
        // At its threshold there are no more false positives than it says.
        int wrong = 0;
        for (const auto& each : cases)
            for (const auto& place : each.places)
                wrong += place.lesion < 0 && place.score > curve[p].threshold;
        EXPECT_LE(wrong, curve[p].falsePositives * 30.0);
    }
    EXPECT_EQ(curve.back().sensitivity, 1.0);
}

TEST(Evaluation, WithoutAPolypThereIsNoCurve) {
    cad::EvaluatedCase none{"a", "g", {}, {{0.9, 8.0, -1, "wall"}}};
    EXPECT_TRUE(cad::frocCurve({&none}, 20).empty());
    EXPECT_DOUBLE_EQ(cad::evaluate({&none}, 0.5).falsePositives, 1.0);
    // Beside one that has some, those without lower no sensitivity in any sample of the cases.
    cad::EvaluatedCase found = none;
    found.truth.resize(1);
    found.truth[0].diameterMm = 8.0;
    found.places.push_back({0.95, 8.0, 0, ""});
    const auto curve = cad::frocCurve({&none, &found, &found}, 50);
    ASSERT_FALSE(curve.empty());
    for (const cad::FrocPoint& point : cad::frocCurve({&none, &found}, 50)) {
        EXPECT_DOUBLE_EQ(point.sensitivity, 1.0);
        EXPECT_DOUBLE_EQ(point.low, 0.0) << "of one case nothing is known of others";
        EXPECT_DOUBLE_EQ(point.high, 1.0);
    }
    for (const cad::FrocPoint& point : curve) {
        EXPECT_DOUBLE_EQ(point.sensitivity, 1.0);
        EXPECT_DOUBLE_EQ(point.low, 1.0);
    }
}

TEST(CandidateTable, ReadsBackWhatLearningAndJudgingUse) {
    std::vector<cad::Candidate> candidates(3);
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        cad::Candidate& candidate = candidates[n];
        candidate.lesion.centerMm = {-12.5 - double(n), 3.25, -640.0};
        candidate.lesion.diameter.mm = 6.125 + double(n);
        candidate.lesion.areaMm2 = 33.5;
        candidate.lesion.patch.by = n == 0 ? cad::Generator::texture : cad::Generator::broadShape;
        candidate.levelOf = n == 2 ? 1 : -1;
        for (std::size_t f = 0; f < candidate.features.size(); ++f)
            candidate.features[f] = 0.1f * float(f) - float(n);
    }
    const std::string text = cad::candidateTable(candidates);
    const auto read = cad::candidatesOfTable(text, "table");
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ(read->size(), candidates.size());
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const cad::Lesion &was = candidates[n].lesion, &is = (*read)[n].lesion;
        EXPECT_EQ(is.centerMm, was.centerMm);
        EXPECT_EQ(is.diameter.mm, was.diameter.mm);
        EXPECT_EQ(is.areaMm2, was.areaMm2);
        EXPECT_EQ(is.patch.by, was.patch.by);
        EXPECT_EQ((*read)[n].levelOf, candidates[n].levelOf);
        for (std::size_t f = 0; f < candidates[n].features.size(); ++f)
            EXPECT_EQ((*read)[n].features[f], candidates[n].features[f]);
    }
    EXPECT_EQ(cad::candidateTable(*read), text);
}

TEST(CandidateTable, RefusesWhatIsNone) {
    const std::string text = cad::candidateTable({cad::Candidate()});
    const auto refused = [](const std::string& bad) {
        const auto read = cad::candidatesOfTable(bad, "table");
        return !read && read.error().place == "table";
    };
    EXPECT_TRUE(refused(""));
    EXPECT_TRUE(refused(text.substr(0, text.size() / 2)));
    std::string other = text;
    other.replace(other.find("diameter_mm"), 11, "weight_kg__");
    EXPECT_TRUE(refused(other));
    // Of a version that no program has; no list; a size below none.
    const auto changed = [&](const std::string& from, const std::string& to) {
        std::string bad = text;
        return bad.replace(bad.find(from), from.size(), to);
    };
    const std::string version = "candidates\": " + std::to_string(cad::modelVersion);
    for (const char* more : {".9", "e300"})
        EXPECT_TRUE(refused(changed(version, version + more)));
    EXPECT_TRUE(refused(text.substr(0, text.rfind("[\n[")) + "null}"));
    cad::Candidate negative;
    negative.lesion.diameter.mm = -1.0;
    EXPECT_TRUE(refused(cad::candidateTable({negative})));
    std::string shorter = text;
    shorter.replace(shorter.rfind(",0]"), 3, "]");
    EXPECT_TRUE(refused(shorter));
    // Another level of itself, or of another level.
    const auto with = [](std::array<std::pair<cad::Generator, int>, 3> rows) {
        std::vector<cad::Candidate> several(3);
        for (std::size_t n = 0; n < 3; ++n)
            several[n].lesion.patch.by = rows[n].first, several[n].levelOf = rows[n].second;
        return cad::candidateTable(several);
    };
    constexpr auto shape = cad::Generator::shape, broad = cad::Generator::broadShape,
                   texture = cad::Generator::texture;
    EXPECT_FALSE(refused(with({{{shape, -1}, {broad, -1}, {broad, 1}}})));
    EXPECT_FALSE(refused(with({{{shape, -1}, {shape, 0}, {shape, 0}}})));
    EXPECT_TRUE(refused(with({{{shape, -1}, {shape, 1}, {shape, 0}}}))) << "of itself";
    EXPECT_TRUE(refused(with({{{shape, -1}, {shape, 2}, {shape, 0}}}))) << "of a later one";
    EXPECT_TRUE(refused(with({{{shape, -1}, {shape, 0}, {shape, 1}}}))) << "of another level";
    EXPECT_TRUE(refused(with({{{shape, -1}, {shape, 0}, {shape, -1}}}))) << "not behind all";
    EXPECT_TRUE(refused(with({{{shape, -1}, {broad, -1}, {broad, 0}}}))) << "of another scale";
    EXPECT_TRUE(refused(with({{{texture, -1}, {texture, 0}, {texture, 0}}}))) << "of a texture";
    EXPECT_TRUE(refused(with({{{shape, -1}, {shape, -2}, {shape, 0}}})));
    EXPECT_TRUE(refused(with({{{cad::Generator(3), -1}, {shape, -1}, {shape, 1}}})));
}

}  // namespace
