// Polyp detection on a prepared colon (dissertation chapter 6, and past it).
#pragma once

#include "cad/model.h"
#include "cad/wall_evidence.h"
#include "core/findings.h"

#include <vector>

namespace haustra::cad {

/// Raised whenever detection makes something else of the same input and model: neither findings nor
/// kept candidates of another version are taken for this one's.
inline constexpr int detectionVersion = 30;

struct DetectOptions {
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

/// Everything that the generators found, each with its features; several may be of one place. By
/// texture where there is one (else its features are 0), and by shape at both scales. Left out is
/// what lies behind fluid without tagging by half, and what is nothing but tagged residue
/// (residue_film.h), which is added to `residue`. Then the same at other levels: of all that are
/// found by shape, or of those alone that `model` finds worth another look (places.h), which for
/// weighing is the same. The same for any number of threads.
std::vector<Candidate> findCandidates(const PreparedColon& colon, const WallEvidence& evidence,
                                      const TextureModel* texture, const DetectOptions& options,
                                      const CadModel* model = nullptr,
                                      std::vector<Candidate>* residue = nullptr);

/// Of those of one place keeps the most probable, with the place's probability (places.h); the most
/// probable place first.
void weigh(std::vector<Candidate>& candidates, const CadModel& model);
/// The same by the three thresholds of §6.2.6 alone: what passes has probability 1, the rest 0, and
/// other levels count nothing.
void weighByThresholds(std::vector<Candidate>& candidates, const ShapeThresholds& thresholds);

/// What is less probable is not told as a candidate, either.
inline constexpr double leastProbability = 0.02;
/// Of candidates as weigh() leaves them, those whose probability reaches the model's operating
/// point, from the rectum to the cecum; the others as candidates, down to `leastProbability`.
/// Warnings tell how much wall was not examined, and where `residue` looks like a polyp by itself.
/// The same for any number of threads.
Findings findingsOf(const PreparedColon& colon, const WallEvidence& evidence,
                    const std::vector<Candidate>& candidates, const CadModel& model,
                    const std::vector<Candidate>& residue = {}, int threads = 0);

/// All of it.
Findings detectPolyps(const PreparedColon& colon, const CadModel& model,
                      const DetectOptions& options = {});

}  // namespace haustra::cad
