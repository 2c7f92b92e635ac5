// How well detection does on cases whose truth is known.
#pragma once

#include "cad/detect.h"
#include "cad/truth.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace haustra::cad {

/// One place that detection told of.
struct ToldPlace {
    double score = 0.0;
    double diameterMm = 0.0;
    int lesion = -1;        ///< of the case's truth; −1: none
    std::string looksLike;  ///< where it is no lesion: "fold", "wall", "under fluid"
    glm::dvec3 centerMm{0.0};
};

struct EvaluatedCase {
    std::string name, group;
    std::vector<TrueLesion> truth;
    std::vector<ToldPlace> places;  ///< whatever its score
};

/// What detection made of a case, whose candidates are `weighed` (detect.h).
EvaluatedCase evaluateCase(std::string name, std::string group,
                           const std::vector<Candidate>& weighed,
                           const std::vector<TrueLesion>& truth);

struct Share {
    int hit = 0, of = 0;
};

struct Evaluation {
    int cases = 0;
    Share from6Mm, from5To6Mm, from10Mm;  ///< neoplastic, by diameter
    Share plain, dense;                   ///< of those from 6 mm: no denser than the wall, denser
    Share submerged, coated;              ///< likewise: under fluid; dry, under a film of residue
    Share hidden;                         ///< likewise: under fluid without tagging
    std::map<std::string, Share> byKind;  ///< likewise
    double falsePositives = 0.0;          ///< a scan; hyperplastic growths are none
    double falseBefore = 0.0;             ///< a scan: the same with no candidate rejected
    std::map<std::string, int> falseKinds;
    int hyperplastic = 0;  ///< findings that are small benign growths: neither right nor false
    /// Absolute error of diameters of what was found, mm: mean, 95 %, and the mean error. Empty
    /// where nothing was.
    std::optional<double> diameterMean, diameter95, diameterBias;
    std::optional<double> submergedDiameterMean, pedunculatedDiameterMean;
};
Evaluation evaluate(const std::vector<const EvaluatedCase*>& cases, double operatingPoint);

/// What is not right at an operating point, to be looked at; by case, and of each the most probable
/// first.
struct JudgedPlace {
    std::string caseName;
    glm::dvec3 positionMm{0.0};
    double diameterMm = 0.0;
    std::string kind;    ///< of the lesion; of a false finding as in Evaluation::falseKinds
    double score = 0.0;  ///< the best that means the lesion; 0 too where no candidate does
};
/// Neoplastic lesions from 5 mm that are not told.
std::vector<JudgedPlace> missedLesions(const std::vector<const EvaluatedCase*>& cases,
                                       double operatingPoint);
/// What is told and counts as false.
std::vector<JudgedPlace> falseFindings(const std::vector<const EvaluatedCase*>& cases,
                                       double operatingPoint);
/// What is told and is hyperplastic, which counts as neither.
std::vector<JudgedPlace> hyperplasticFindings(const std::vector<const EvaluatedCase*>& cases,
                                              double operatingPoint);

/// Whether the free-response ROC curve asks for it: neoplastic, from 6 mm.
bool countsInCurve(const TrueLesion& lesion);

/// One point of the free-response ROC curve, with the 2.5 and 97.5 % of `resamples` bootstrap
/// samples of the cases; of samples without such a lesion nothing can be said, and they are left
/// out. Where fewer than two cases have one, all samples are alike and tell nothing of other cases:
/// 0 and 1.
struct FrocPoint {
    double falsePositives = 0.0;                      ///< a scan
    double sensitivity = 0.0, low = 0.0, high = 0.0;  ///< of neoplastic lesions from 6 mm
    double threshold = 0.0;                           ///< what scores more is told; −1: all is
};
/// At 1/8, 1/4 … 16 false positives a scan and every half between. Empty where no case has a
/// neoplastic lesion from 6 mm. The same for equal input.
std::vector<FrocPoint> frocCurve(const std::vector<const EvaluatedCase*>& cases,
                                 int resamples = 1000);

}  // namespace haustra::cad
