#include "cad/detect.h"

#include "cad/annular_wall.h"
#include "cad/examined_colon.h"
#include "cad/masses.h"
#include "cad/places.h"
#include "cad/residue_film.h"
#include "cad/standing_height.h"
#include "cad/wall_frames.h"
#include "core/parallel.h"
#include "core/printed_text.h"
#include "core/segments_along.h"
#include "core/version.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <thread>

namespace haustra::cad {
namespace {

// What has a stalk is nearly as high as wide; Paris 0-II is at most 2.5 mm high (the closed cups of
// a forceps), to which the scan adds its blur.
constexpr double stalkHeightRatio = 0.75, flatHeightMm = 3.0, flatRatio = 0.4;

// Less of the wall than a polyp of 5 mm takes is no gap in an examination.
constexpr double leastUnseenMm2 = 20.0;
// Of the smoothed scan; the noisiest training phantoms have 15.
constexpr double noisyHu = 25.0;

const char* kindOf(const Lesion& lesion, double heightMm) {
    const double ratio = heightMm / std::max(0.1, lesion.diameter.mm);
    if (standsOnStalk(lesion) && ratio > stalkHeightRatio) return "pedunculated";
    return heightMm < flatHeightMm && ratio < flatRatio ? "flat" : "sessile";
}

Finding findingOf(const PreparedColon& colon, const std::vector<SegmentStart>& segments,
                  const WallEvidence& evidence, const Candidate& candidate,
                  SampleNumbers& numbers) {
    const Lesion& lesion = candidate.lesion;
    Finding finding;
    finding.positionMm = lesion.centerMm;
    finding.diameterMm = lesion.diameter.mm;
    finding.score = candidate.probability;
    finding.wallMm = lesion.topMm;
    finding.diameterEndsMm = {evidence.samples.mesh.vertices[lesion.diameter.from],
                              evidence.samples.mesh.vertices[lesion.diameter.to]};
    finding.heightMm = standingHeightMm(evidence, lesion, numbers);
    finding.kind = kindOf(lesion, finding.heightMm);
    const WallPlace along = evidence.alongColon->at(lesion.topMm);
    finding.arcMm = along.arcMm;
    finding.segment = segmentAt(segments, along.arcMm);
    for (std::size_t n = 0; n < featureNames.size(); ++n)
        finding.features.emplace_back(std::string(featureNames[n]), candidate.features[n]);
    finding.voxels = segmentationOf(colon, evidence, lesion);
    return finding;
}

// Each as a finding, in their order.
std::vector<Finding> describe(const PreparedColon& colon, const WallEvidence& evidence,
                              std::span<const Candidate* const> candidates, int threads) {
    const auto segments = segmentsAlong(colon.centerline, colon.pieces);
    std::vector<Finding> findings(candidates.size());
    parallelForEach(
        candidates.size(), threads,
        [&] { return SampleNumbers(evidence.samples.mesh.vertices.size()); },
        [&](std::size_t n, SampleNumbers& numbers) {
            findings[n] = findingOf(colon, segments, evidence, *candidates[n], numbers);
        });
    return findings;
}

// A maximal independent set of the samples, ascending; `memberOf`: of each sample itself if it is
// in the set, else its lowest-numbered neighbour that is.
std::vector<std::uint32_t> independentSamples(const WallSamples& wall,
                                              std::vector<std::uint32_t>& memberOf) {
    std::vector<std::uint32_t> independent;
    memberOf.resize(wall.mesh.vertices.size());
    for (std::uint32_t v = 0; v < memberOf.size(); ++v) {
        memberOf[v] = v;
        for (const std::uint32_t next : wall.around(v)) {
            if (next > v) break;
            if (memberOf[next] != next) continue;
            memberOf[v] = next;
            break;
        }
        if (memberOf[v] == v) independent.push_back(v);
    }
    return independent;
}

// Of every sample, in T. Samples lie denser than the stencil's steps, so texture is measured at a
// maximal independent set of them, and each of the others has the distance of one beside it.
std::vector<float> textureDistances(const PreparedColon& colon, const WallEvidence& evidence,
                                    const TextureModel& texture, int threads) {
    std::vector<std::uint32_t> measuredAt, measured;
    std::vector<glm::vec3> along, colors;
    std::optional<const TextureStencil> stencil;
    parallelInvoke(
        threads, [&] { measured = independentSamples(evidence.samples, measuredAt); },
        [&] {
            along = stripDirections(evidence.samples, colon.flat, threads);
            stencil.emplace(evidence.samples, along);
            colors.reserve(evidence.rays.size());
            for (const BiopsyRay& ray : evidence.rays)
                colors.push_back(ray.color);
        });
    std::vector<float> distances(measuredAt.size());
    parallelFor(measured.size(), 4096, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t m = begin; m < end; ++m) {
            const std::uint32_t v = measured[m];
            const auto neighbours = stencil->around(v, evidence.shapes[v].intoWall);
            distances[v] = float(textureDistance(texture, textureVector(v, neighbours, colors)));
        }
    });
    // Those of the set are only read here.
    parallelFor(distances.size(), 65536, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end; ++v)
            if (measuredAt[v] != v) distances[v] = distances[measuredAt[v]];
    });
    return distances;
}

// Whether more than half of a patch's area has fluid without tagging before it, so that the shape
// that made it a candidate is not the wall's.
bool liesBehindUntagged(const WallEvidence& evidence, const Patch& patch) {
    double untagged = 0.0, all = 0.0;
    for (const std::uint32_t v : patch.samples) {
        all += evidence.samples.areaMm2[v];
        if (evidence.untagged[v]) untagged += evidence.samples.areaMm2[v];
    }
    return untagged > 0.5 * all;
}

// Whether nothing would rise without the tagged residue on it.
bool isResidue(const Lesion& lesion, const FeatureVector& features, double residueMm) {
    if (residueMm <= 0.0) return false;
    const double mean = std::max<double>(features[featureNumber("lift_mean")],
                                         lesion.volumeMm3 / std::max(0.1, lesion.baseMm2));
    const double top =
        std::max(features[featureNumber("height_mm")], features[featureNumber("lift_top")]);
    return heightWithoutResidue(top, mean, residueMm) < leastHeightMm;
}

// What patches are measured by.
struct Measures {
    const PreparedColon& colon;
    const WallEvidence& evidence;
    const ResidueFilms& films;
    std::span<const float> textureDistances;
    int threads;
    Progress progress;
};

// Adds those of the patches that are bodies, residue apart; `levelOf` of each, or of none.
void measure(const Measures& with, std::vector<Patch> patches,
             std::span<const std::int32_t> levelOf, std::vector<Candidate>& candidates,
             std::vector<Candidate>* residue) {
    std::vector<std::optional<Candidate>> measured(patches.size());
    std::vector<std::uint8_t> nothingElse(patches.size(), 0);
    const std::thread::id caller = std::this_thread::get_id();
    // Patches differ in size by a thousand times.
    parallelForEach(
        patches.size(), with.threads,
        [&] { return SampleNumbers(with.evidence.samples.mesh.vertices.size()); },
        [&](std::size_t n, SampleNumbers& numbers) {
            if (with.progress && std::this_thread::get_id() == caller)
                with.progress(double(n) / double(patches.size()));
            if (liesBehindUntagged(with.evidence, patches[n])) return;
            auto lesion =
                standUp(with.evidence, std::move(patches[n]), with.colon.cleansed.grid(), numbers);
            if (!lesion) return;
            const FeatureVector features =
                featuresOf(with.colon, with.evidence, with.textureDistances, *lesion, numbers);
            const double residueMm = with.films.liftMm(with.colon, with.evidence, lesion->patch);
            nothingElse[n] = isResidue(*lesion, features, residueMm);
            measured[n] = Candidate{*std::move(lesion), features};
            if (!levelOf.empty()) measured[n]->levelOf = levelOf[n];
        });
    for (std::size_t n = 0; n < measured.size(); ++n) {
        std::vector<Candidate>* to = nothingElse[n] ? residue : &candidates;
        if (measured[n] && to) to->push_back(*std::move(measured[n]));
    }
}

// Adds other levels of the candidates that are worth it; without a model, of all.
void measureOtherLevels(const Measures& with, const CadModel* model,
                        std::vector<Candidate>& candidates) {
    std::vector<const Patch*> patches;
    std::vector<std::int32_t> numbers;
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        const Candidate& candidate = candidates[n];
        if (candidate.lesion.patch.by == Generator::texture) continue;
        if (model && model->probability(candidate.features) < worthAnotherLook) continue;
        patches.push_back(&candidate.lesion.patch);
        numbers.push_back(std::int32_t(n));
    }
    std::vector<Patch> levels;
    std::vector<std::int32_t> levelOf;
    auto others = otherLevels(with.evidence, patches, with.threads);
    for (std::size_t n = 0; n < others.size(); ++n) {
        std::ranges::move(others[n], std::back_inserter(levels));
        levelOf.resize(levels.size(), numbers[n]);
    }
    measure(with, std::move(levels), levelOf, candidates, nullptr);
}

// Where a candidate that was taken for residue looks like a polyp by itself, and no finding is:
// each place once, along the colon, mm from the rectum.
std::vector<double> residueLikePolyps(const std::vector<Candidate>& residue,
                                      std::span<const Finding> findings, const CadModel& model,
                                      const AlongColon& alongColon) {
    std::vector<PlaceWitness> witnesses;
    for (const Candidate& each : residue)
        witnesses.push_back({each.lesion.centerMm, each.lesion.diameter.mm, each.lesion.areaMm2,
                             model.probability(each.features)});
    std::vector<double> arcs;
    for (const WitnessedPlace& place : placesOf(witnesses)) {
        const PlaceWitness& best = witnesses[place.best];
        const bool found = std::ranges::any_of(findings, [&](const Finding& finding) {
            return finding.kind != annularKind &&
                   isSamePlace(finding.positionMm, finding.diameterMm, best.centerMm,
                               best.diameterMm);
        });
        if (best.probability >= model.operatingPoint && !found)
            arcs.push_back(alongColon.at(residue[place.best].lesion.topMm).arcMm);
    }
    std::sort(arcs.begin(), arcs.end());
    return arcs;
}

void warnOfUnexaminedWall(const WallEvidence& evidence, Findings& findings) {
    double inventedMm2 = 0.0, untaggedMm2 = 0.0;
    for (std::size_t v = 0; v < evidence.unseen.size(); ++v)
        if (evidence.unseen[v] || evidence.untagged[v])
            (evidence.unseen[v] ? inventedMm2 : untaggedMm2) += evidence.samples.areaMm2[v];
    for (const double mm2 : {inventedMm2, untaggedMm2})
        if (mm2 >= leastUnseenMm2) findings.unexaminedMm2 += mm2;
    if (inventedMm2 >= leastUnseenMm2)
        findings.warnings.push_back(printed(
            "%.0f mm2 of the wall were not examined: they enclose a bridge over a collapse, or "
            "were rebuilt after a leak",
            inventedMm2));
    if (untaggedMm2 >= leastUnseenMm2)
        findings.warnings.push_back(printed(
            "%.0f mm2 of the wall were not examined: they lie behind fluid without tagging or "
            "beside what stands in the lumen, where the wall's place is known to millimetres only",
            untaggedMm2));
}

// Those that may be a tumour are added to the findings, longer ones told by a warning alone, all in
// which there is fluid by one, and all beside other loops by one.
void tellAnnularWalls(const PreparedColon& colon, const WallEvidence& evidence, int threads,
                      Findings& findings, std::vector<Finding>& made) {
    const auto segments = segmentsAlong(colon.centerline, colon.pieces);
    double fluidMm = 0.0, fluidFromMm = 0.0, fluidHu = 0.0;
    std::string besideLoops;
    for (const AnnularWall& wall : annularWalls(colon, evidence, threads)) {
        if (isFluid(wall, evidence.statistics)) {
            if (fluidMm == 0.0) fluidFromMm = wall.fromMm;
            fluidMm += wall.lengthMm(), fluidHu = std::max(fluidHu, wall.middleHu);
            continue;
        }
        if (wall.isBesideLoops) {
            besideLoops +=
                printed(besideLoops.empty() ? "%.0f-%.0f" : ", %.0f-%.0f", wall.fromMm, wall.toMm);
            continue;
        }
        if (wall.channelMm > widestChannelMm) {
            findings.warnings.push_back(printed(
                "the wall is %.0f mm thick all around from %.0f to %.0f mm, but the lumen is %.0f "
                "mm wide: other bowel may lie around it, or it is inflamed",
                wall.thicknessMm, wall.fromMm, wall.toMm, wall.channelMm));
            continue;
        }
        const bool tumour = wall.lengthMm() <= longestTumourMm;
        findings.warnings.push_back(printed(
            "the wall is %.0f mm thick all around from %.0f to %.0f mm: %s", wall.thicknessMm,
            wall.fromMm, wall.toMm,
            tumour ? "it may be a cancer that leaves a channel, or a segment that is contracted"
                   : "it may be a segment that is inflamed or contracted, or a long tumour"));
        if (!tumour) continue;
        made.push_back(findingOf(wall, colon, evidence, segments));
        // Whatever point a model operates at: it has not weighed this.
        made.back().score = std::max(annularScore, findings.operatingPoint);
    }
    if (!besideLoops.empty())
        findings.warnings.push_back(
            printed("the wall, or what lies between it and other loops, is thick all around at "
                    "%s mm: other bowel may lie on it without fat between, or a cancer narrow it",
                    besideLoops.c_str()));
    if (fluidMm > 0.0)
        findings.warnings.push_back(printed(
            "on %.0f mm of the colon, from %.0f mm on, nothing is told of how thick the wall is: "
            "%.0f HU at most behind it are fluid's, around the colon or in a wall that is swollen",
            fluidMm, fluidFromMm, fluidHu));
}

void warnOfMasses(Findings& findings) {
    for (const MassOfFindings& mass : massesOf(findings.findings)) {
        const Finding& first = findings.findings[mass.findings.front()];
        std::string numbers;
        for (std::size_t n = 0; n < mass.findings.size(); ++n)
            numbers += (n == 0                          ? ""
                        : n + 1 == mass.findings.size() ? " and "
                                                        : ", ") +
                       std::to_string(mass.findings[n] + 1);
        findings.warnings.push_back(printed(
            "findings %s, from %.0f mm on, lie rim to rim, %.0f mm wide in all: they may be "
            "lobes of one mass",
            numbers.c_str(), first.arcMm, mass.widthMm));
    }
}

void warnOfResidue(const std::vector<Candidate>& residue, const CadModel& model,
                   const AlongColon& alongColon, Findings& findings) {
    const auto arcs = residueLikePolyps(residue, findings.findings, model, alongColon);
    if (arcs.empty()) return;
    std::string places;
    for (const double arcMm : arcs)
        places += printed(places.empty() ? "%.0f" : ", %.0f", arcMm);
    findings.warnings.push_back(printed(
        arcs.size() == 1 ? "%zu place that looks like a polyp was taken for tagged residue on the "
                           "wall: %s mm from the rectum"
                         : "%zu places that look like polyps were taken for tagged residue on the "
                           "wall: %s mm from the rectum",
        arcs.size(), places.c_str()));
}

}  // namespace

std::vector<Candidate> findCandidates(const PreparedColon& colon, const WallEvidence& evidence,
                                      const TextureModel* texture, const DetectOptions& options,
                                      const CadModel* model, std::vector<Candidate>* residue) {
    std::vector<float> distances;
    if (texture) distances = textureDistances(colon, evidence, *texture, options.threads);
    // Each takes mostly one thread, so they go side by side.
    const int some = std::max(1, threadCount(options.threads) / 2);
    std::array<std::vector<Patch>, 3> made;
    std::optional<const ResidueFilms> films;
    parallelInvoke(
        options.threads,
        [&] {
            if (texture) made[0] = patchesByTexture(evidence, distances, some);
        },
        [&] { made[1] = patchesByShape(evidence, Generator::shape, some); },
        [&] { made[2] = patchesByShape(evidence, Generator::broadShape, some); },
        [&] { films.emplace(colon, evidence); });
    // Other levels take about as long as the candidates.
    const auto measures = [&](double from) {
        Progress half;
        if (options.progress)
            half = [&options, from](double share) { options.progress(from + 0.5 * share); };
        return Measures{colon, evidence, *films, distances, options.threads, half};
    };
    std::vector<Patch> patches;
    for (auto& each : made)
        std::ranges::move(each, std::back_inserter(patches));
    std::vector<Candidate> candidates;
    measure(measures(0.0), std::move(patches), {}, candidates, residue);
    measureOtherLevels(measures(0.5), model, candidates);
    return candidates;
}

namespace {

// Of each place the best witness, which has what `ofPlace` makes of the place's score and its own.
template <class OfCandidate, class OfPlace>
void keepPlaces(std::vector<Candidate>& candidates, const OfCandidate& ofCandidate,
                const OfPlace& ofPlace) {
    std::vector<PlaceWitness> witnesses;
    for (const Candidate& candidate : candidates)
        witnesses.push_back({candidate.lesion.centerMm, candidate.lesion.diameter.mm,
                             candidate.lesion.areaMm2, ofCandidate(candidate.features),
                             candidate.levelOf});
    std::vector<Candidate> kept;
    for (const WitnessedPlace& place : placesOf(witnesses)) {
        kept.push_back(std::move(candidates[place.best]));
        kept.back().levelOf = -1;  // what it is another level of need not be kept
        kept.back().probability = ofPlace(place.score, witnesses[place.best].probability);
    }
    std::stable_sort(kept.begin(), kept.end(), [](const Candidate& a, const Candidate& b) {
        return a.probability > b.probability;
    });
    candidates = std::move(kept);
}

}  // namespace

void weigh(std::vector<Candidate>& candidates, const CadModel& model) {
    keepPlaces(
        candidates, [&](const FeatureVector& features) { return model.probability(features); },
        [&](double score, double) { return model.placeProbability(score); });
}

void weighByThresholds(std::vector<Candidate>& candidates, const ShapeThresholds& thresholds) {
    std::erase_if(candidates, [](const Candidate& each) { return each.levelOf >= 0; });
    keepPlaces(
        candidates,
        [&](const FeatureVector& features) { return thresholds.pass(features) ? 1.0 : 0.0; },
        [](double, double ofBest) { return ofBest; });
}

Findings findingsOf(const PreparedColon& colon, const WallEvidence& evidence,
                    const std::vector<Candidate>& candidates, const CadModel& model,
                    const std::vector<Candidate>& residue, int threads) {
    Findings findings;
    findings.operatingPoint = model.operatingPoint;
    findings.model.software = std::string("haustra ") + softwareVersion;
    findings.model.name = model.name;
    findings.model.trainedOn = model.trainedOn;
    findings.grid = colon.ct.grid();
    const WallStatistics& statistics = evidence.statistics;
    findings.biopsy = {statistics.wallHu, statistics.fatHu, statistics.noiseHu,
                       evidence.transferFunction};
    warnOfUnexaminedWall(evidence, findings);
    if (statistics.noiseHu > noisyHu)
        findings.warnings.push_back(
            printed("the tissue behind the wall is less even than where detection has learnt, %.0f "
                    "HU or more after smoothing to 1 mm: by noise, by contrast in its vessels, or "
                    "by residue of weak tagging",
                    statistics.noiseHu));
    std::vector<Finding> made;
    tellAnnularWalls(colon, evidence, threads, findings, made);
    std::vector<const Candidate*> told;
    for (const Candidate& candidate : candidates)
        if (candidate.probability >= std::min(leastProbability, model.operatingPoint))
            told.push_back(&candidate);
    if (const std::size_t room = std::size_t(maxFindings) - made.size(); told.size() > room) {
        told.resize(room);
        findings.warnings.push_back(printed(
            "more than %d places may be polyps; the least probable are left out", maxFindings));
    }
    std::ranges::move(describe(colon, evidence, told, threads), std::back_inserter(made));
    for (Finding& finding : made)
        (finding.score >= model.operatingPoint ? findings.findings : findings.candidates)
            .push_back(std::move(finding));
    for (auto* list : {&findings.findings, &findings.candidates})
        std::stable_sort(list->begin(), list->end(),
                         [](const Finding& a, const Finding& b) { return a.arcMm < b.arcMm; });
    // Few colons have as many polyps, and none that detection has learnt from.
    constexpr std::size_t crowd = 25;
    if (findings.findings.size() >= crowd)
        findings.warnings.push_back(
            printed("%.0f places are told, more than a colon commonly has polyps: lumps of residue "
                    "without tagging look alike, and most may be such",
                    double(findings.findings.size())));
    warnOfMasses(findings);
    warnOfResidue(residue, model, *evidence.alongColon, findings);
    return findings;
}

Findings detectPolyps(const PreparedColon& colon, const CadModel& model,
                      const DetectOptions& options) {
    // Half of the time each, roughly.
    constexpr double evidenceShare = 0.5;
    EvidenceOptions gathering;
    gathering.threads = options.threads;
    if (options.progress)
        gathering.progress = [&](double share) { options.progress(evidenceShare * share); };
    const ExaminedColon examined(colon, gathering);
    const WallEvidence& evidence = examined.evidence();
    std::vector<Candidate> residue;
    DetectOptions finding{options.threads};
    if (options.progress)
        finding.progress = [&](double share) {
            options.progress(evidenceShare + (1.0 - evidenceShare) * share);
        };
    auto candidates =
        findCandidates(examined.colon(), evidence, &model.texture, finding, &model, &residue);
    weigh(candidates, model);
    if (options.progress) options.progress(1.0);
    Findings findings =
        findingsOf(examined.colon(), evidence, candidates, model, residue, options.threads);
    if (examined.edgeWarning()) findings.warnings.push_back(*examined.edgeWarning());
    return findings;
}

}  // namespace haustra::cad
