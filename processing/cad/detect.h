// Polyp detection on a prepared colon (dissertation chapter 6, and past it).
#pragma once

#include "cad/model.h"
#include "cad/wall_evidence.h"
#include "core/findings.h"

#include <optional>
#include <vector>

namespace haustra::cad {

/// Raised whenever detection makes something else of the same input and model: neither findings nor
/// kept candidates of another version are taken for this one's.
inline constexpr int detectionVersion = 25;

/// What of the whole is used; all by default. For comparisons, which leave out one after the other.
struct Method {
    bool automaticTransfer = true;  ///< else the fixed transfer function
    bool texture = true;            ///< candidates by texture
    bool shape = true;              ///< candidates by shape
    /// The classifier; else the thresholds of §6.2.6 decide, and all that pass are as probable.
    bool classifier = true;
};

struct DetectOptions {
    Method method;
    int threads = 0;
    Progress progress = {};
};

/// One place that was weighed.
struct Candidate {
    Lesion lesion;
    FeatureVector features{};
    double probability = 0.0;
    /// Of a patch at another level (otherLevels): the number of the candidate whose patch that is,
    /// one earlier in the list, which has all that generators found first; −1: one of these.
    std::int32_t levelOf = -1;
};

/// Everything that the generators found, each with its features; several may be of one place. Left
/// out is what lies behind fluid without tagging by half, and what is nothing but tagged residue
/// (residue_film.h), which is added to `residue`. Then the same at other levels: of all that are
/// found by shape, or of those alone that `model` finds worth another look (places.h), which for
/// weighing is the same; none without the classifier. The same for any number of threads.
std::vector<Candidate> findCandidates(const PreparedColon& colon, const WallEvidence& evidence,
                                      const TextureModel* texture, const DetectOptions& options,
                                      const CadModel* model = nullptr,
                                      std::vector<Candidate>* residue = nullptr);

/// Of those of one place keeps the most probable, with the place's probability (places.h). Without
/// the classifier other levels count nothing.
void weigh(std::vector<Candidate>& candidates, const CadModel& model, const Method& method);

/// Those whose probability reaches the model's operating point, from the rectum to the cecum; the
/// others as candidates, down to `leastProbability`. Warnings tell how much wall was not examined,
/// and where `residue` looks like a polyp by itself. The same for any number of threads.
inline constexpr double leastProbability = 0.02;
Findings findingsOf(const PreparedColon& colon, const WallEvidence& evidence,
                    const std::vector<Candidate>& candidates, const CadModel& model,
                    const std::vector<Candidate>& residue = {}, int threads = 0);

/// All of it.
Findings detectPolyps(const PreparedColon& colon, const CadModel& model,
                      const DetectOptions& options = {});

}  // namespace haustra::cad
