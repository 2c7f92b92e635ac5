// Learning a model from cases whose truth is known.
#pragma once

#include "cad/detect.h"
#include "cad/evaluate.h"
#include "cad/truth.h"

#include <string>
#include <vector>

namespace haustra::cad {

/// Vectors of one case's biopsy colours: of its whole wall, thinned, and of its polyps.
struct TextureExamples {
    std::vector<TextureVector> all, polyps;
};
TextureExamples textureExamples(const WallEvidence& evidence, const FlatMap& flat,
                                const std::vector<TrueLesion>& truth);

/// What one candidate is in truth.
struct Example {
    FeatureVector features{};
    glm::dvec3 placeMm{0.0};
    double diameterMm = 0.0, areaMm2 = 0.0;
    int lesion = -1;            ///< of the case's truth; −1: nothing
    bool polyp = false;         ///< stands for that neoplastic lesion
    bool weighed = true;        ///< else neither: a fragment of a polyp, or a benign growth
    std::int32_t levelOf = -1;  ///< as Candidate has it; of another level: a witness alone
};
/// One case's candidates. A polyp is stood for by those that it is reached from and that are at
/// least half as wide, and by the one of the largest area; by none of another level.
std::vector<Example> examplesOf(const std::vector<Candidate>& candidates,
                                const std::vector<TrueLesion>& truth);

struct TrainingCase {
    std::string name;
    std::vector<TrueLesion> truth;
    std::vector<Example> examples;
    std::string study = {};  ///< cases of one study are of one patient; empty: of its own
};

/// In so many parts the training cases are left out in turns.
inline constexpr int trainingFolds = 5;

struct TrainOptions {
    std::string name, trainedOn, trainingSha256;
    std::vector<std::string> trainingScans = {};  ///< as CadModel has them, like the next
    std::string textureFrom = {};
    /// Findings a scan that are no lesion, in cross-validation, at the operating point.
    double falsePositives = 2.0;
    int threads = 0;
};

struct TrainedModel {
    CadModel model;
    /// Each case as it was told by what had not seen it; scores are probabilities.
    std::vector<EvaluatedCase> crossValidated;
};

/// Trees, networks, thresholds, calibration and operating point. Trees and networks have learnt
/// from all cases; calibration and operating point are those of others that had not seen the case
/// nor another one of its study (folds by study), but for texture, which is learnt from all cases
/// before. Fails (badInput) where there are fewer studies
/// than trainingFolds, no polyp was a candidate, or polyps that the trees or networks had not seen
/// score no higher than what is none.
Result<TrainedModel> trainModel(const TextureModel& texture, const std::vector<TrainingCase>& cases,
                                const TrainOptions& options);

/// Fits how probable a place is, and the operating point at so many false positives a scan, to
/// cases that the model has not learnt from; trees, networks and thresholds stay. Each case as it
/// is then told, scores being probabilities. Fails (badInput), and the model is then of no use,
/// where the cases hold no polyp that rises above the wall, or nothing else, or where polyps score
/// no higher than what is none.
Result<std::vector<EvaluatedCase>> calibrate(CadModel& model,
                                             const std::vector<TrainingCase>& cases,
                                             double falsePositives);

}  // namespace haustra::cad
