#include "bench/phantom_study.h"

#include "centerline/path.h"
#include "cleansing/digital_cleansing.h"
#include "cleansing/mixture.h"
#include "cleansing/tissue_mixture.h"
#include "contouring/dual_contouring.h"
#include "flatten/tube/end_holes.h"
#include "flatten/tube/flattening.h"
#include "handles/self_intersection.h"
#include "mesh/mesh_file.h"
#include "nifti/nifti_file.h"
#include "segmentation/find_colon.h"
#include "simplification/simplification.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>

namespace haustra::bench {
namespace {

class Stopwatch {
public:
    /// Seconds since the last lap, or since the beginning.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Writes what is made into a folder, for looking at; without one, nothing.
class Keeper {
public:
    explicit Keeper(std::filesystem::path folder) : folder_(std::move(folder)) {
        std::error_code ignored;  // the writers tell
        if (!folder_.empty()) std::filesystem::create_directories(folder_, ignored);
    }
    template <class T>
    Result<void> keep(const std::string& name, const Volume<T>& volume) const {
        return folder_.empty() ? Result<void>{}
                               : nifti::writeNifti(folder_ / (name + ".nii.gz"), volume);
    }
    Result<void> keep(const std::string& name, const Centerline& line) const {
        std::string text = "x_mm,y_mm,z_mm,arc_mm,radius_mm,gap\n";
        for (const CenterlinePoint& p : line.points) {
            char row[160];
            std::snprintf(row, sizeof row, "%.3f,%.3f,%.3f,%.3f,%.3f,%d\n", p.positionMm.x,
                          p.positionMm.y, p.positionMm.z, p.arcMm, p.radiusMm, int(p.gap));
            text += row;
        }
        return keepText(name + ".csv", text);
    }
    Result<void> keepText(const std::string& name, const std::string& text) const {
        if (folder_.empty() || std::ofstream(folder_ / name) << text) return {};
        return fail(ErrorKind::io, "the file cannot be written", (folder_ / name).string());
    }

private:
    std::filesystem::path folder_;
};

SmallestAngles smallestAngles(const TriMesh& mesh) {
    std::vector<double> degrees;
    for (const glm::ivec3 t : mesh.triangles) {
        double least = 180.0;
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 a = mesh.vertices[t[corner]];
            const glm::dvec3 u = mesh.vertices[t[(corner + 1) % 3]] - a,
                             v = mesh.vertices[t[(corner + 2) % 3]] - a;
            least = std::min(
                least, glm::degrees(std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v))));
        }
        degrees.push_back(least);
    }
    SmallestAngles angles;
    if (degrees.empty()) return angles;
    std::sort(degrees.begin(), degrees.end());
    angles.least = degrees.front();
    angles.p1 = degrees[degrees.size() / 100];
    angles.median = degrees[degrees.size() / 2];
    angles.shareBelow10 =
        double(std::lower_bound(degrees.begin(), degrees.end(), 10.0) - degrees.begin()) /
        double(degrees.size());
    return angles;
}

/// Contours, scores, simplifies to each bound and scores again.
Result<void> studySurfaces(const phantom::Phantom& truth, const Volume<std::int16_t>& cleansedHu,
                           const Volume<std::uint8_t>& lumen, const StudyOptions& options,
                           PhantomStudy& study) {
    const int threads = options.phantom.threads;
    options.log("true surface");
    const phantom::TrueSurface surface = phantom::trueLumenSurface(options.phantom, truth.lumen);
    Stopwatch watch;
    const auto add = [&](const std::string& what, const TriMesh& mesh,
                         double seconds) -> Result<void> {
        options.log("score of surface " + what);
        auto scored = TRY(studySurface(what, mesh, surface, threads));
        scored.seconds = seconds;
        study.surfaces.push_back(std::move(scored));
        if (options.out.empty()) return {};
        return mesh::writeMesh(options.out / ("surface " + what + ".ply"), mesh);
    };

    // What contouring alone does, on a scan that needed no cleansing, in a lumen that is the truth.
    topology::HandleCuttingOptions cutting;
    cutting.threads = threads;
    const auto trueBall = TRY(topology::cutHandles(truth.lumen, cutting));
    watch.lap();
    const auto ideal = TRY(
        contouring::contourLumen(truth.untaggedHu, trueBall.labels, study.airBelowHu, {threads}));
    if (auto added = add("truth", ideal, watch.lap()); !added) return added;

    watch.lap();
    const auto fine = TRY(contouring::contourLumen(cleansedHu, lumen, study.airBelowHu, {threads}));
    if (auto added = add("fine", fine, watch.lap()); !added) return added;
    for (const double errorMm : options.errorBoundsMm) {
        char what[32];
        std::snprintf(what, sizeof what, "%.2f mm", errorMm);
        options.log(std::string("simplification to ") + what);
        watch.lap();
        simplification::SimplificationOptions simplification;
        simplification.errorMm = errorMm, simplification.threads = threads;
        const auto simple = TRY(simplification::simplify(fine, simplification));
        if (auto added = add(what, simple, watch.lap()); !added) return added;
    }
    return {};
}

/// Surface and flat map as prepare makes them; the flat map's folded triangles.
Result<std::size_t> flattenLumen(const Volume<std::int16_t>& cleansedHu,
                                 const Volume<std::uint8_t>& lumen, const Centerline& path,
                                 const StudyOptions& options, PhantomStudy& study) {
    constexpr double endWindowMm = 6.0;
    const int threads = options.phantom.threads;
    Stopwatch watch;
    const auto fine = TRY(contouring::contourLumen(cleansedHu, lumen, study.airBelowHu, {threads}));
    simplification::SimplificationOptions simplification;
    simplification.errorMm = options.prepareErrorMm, simplification.threads = threads;
    const auto simple = TRY(simplification::simplify(fine, simplification));
    study.colon.surfaceSeconds = watch.lap();
    const CenterlinePose first = poseAtArc(path, 0.0, endWindowMm),
                         last = poseAtArc(path, path.lengthMm(), endWindowMm);
    const glm::dvec3 ends[2] = {first.point.positionMm, last.point.positionMm},
                     outwards[2] = {-first.tangent, last.tangent};
    const auto punched = TRY(flatten::punchEnds(simple, ends, outwards));
    flatten::FlatteningOptions flattening;
    flattening.threads = threads;
    const auto flat = flatten::flattenTube(punched.tube, punched.firstLoop, flattening);
    study.colon.flatteningSeconds = watch.lap();
    if (!flat) return tl::make_unexpected(flat.error());
    return flatten::foldedTriangles(flat->map).size();
}

}  // namespace

Result<SurfaceStudy> studySurface(std::string what, const TriMesh& mesh,
                                  const phantom::TrueSurface& truth, int threads) {
    SurfaceStudy study;
    study.what = std::move(what);
    study.triangles = mesh.triangles.size();
    study.topology = meshTopology(mesh);
    study.selfIntersections = handles::selfIntersections(mesh).size();
    study.angles = smallestAngles(mesh);
    phantom::SurfaceScoreOptions scoring;
    scoring.threads = threads;
    return phantom::scoreSurface(mesh, truth, scoring).map([&](const phantom::SurfaceScore& score) {
        study.score = score;
        return study;
    });
}

Result<PhantomStudy> studyPhantom(const StudyOptions& options) {
    const int threads = options.phantom.threads;
    PhantomStudy study;
    Stopwatch watch;
    options.log("phantom");
    const auto truth = TRY(phantom::makePhantom(options.phantom));
    study.phantomSeconds = watch.lap();
    const Keeper keeper(options.out);
    if (auto kept = keeper.keep("ct", truth.scan.hu)
                        .and_then([&] { return keeper.keep("truth", truth.lumen); })
                        .and_then([&] { return keeper.keep("sites", truth.sites); })
                        .and_then([&] { return keeper.keep("true line", truth.centerline); });
        !kept)
        return tl::make_unexpected(kept.error());
    study.noiseSdHu = truth.noiseSdHu;
    study.lengthMm = truth.centerline.lengthMm();
    const auto voxels = truth.lumen.voxels();
    study.lumenMl =
        double(voxels.size() - std::size_t(std::count(voxels.begin(), voxels.end(), 0))) *
        truth.lumen.grid().voxelVolumeMm3() * 1e-3;

    options.log("segmentation");
    watch.lap();
    const auto tissue = TRY(cleansing::fitTissueModel(truth.scan, threads));
    study.airBelowHu = tissue.airBelowHu;
    segmentation::ColonOptions finding;
    finding.threads = threads;
    const auto segmentation = TRY(segmentation::findColon(truth.scan, tissue, finding));
    study.segmentationSeconds = watch.lap();
    if (auto kept = keeper.keep("segmentation", segmentation.labels).and_then([&] {
            return keeper.keepText("quality.json", qualityJson(segmentation.record));
        });
        !kept)
        return tl::make_unexpected(kept.error());

    Result<cleansing::Cleansed> cleansed =
        cleansing::Cleansed{truth.scan.hu.share(), segmentation.labels.share()};
    if (!options.onlySegmentation) {
        options.log("mixture");
        watch.lap();
        const auto mixture = cleansing::estimateMixture(truth.scan, tissue, segmentation.labels,
                                                        segmentation.gravity, {threads, {}});
        if (!mixture) return tl::make_unexpected(mixture.error());
        study.mixtureSeconds = watch.lap();
        options.log("cleansing");
        cleansed = cleansing::cleanse(truth.scan, tissue, *mixture, segmentation.labels, threads);
        if (!cleansed) return tl::make_unexpected(cleansed.error());
        study.cleansingSeconds = watch.lap();
    }
    options.log("denoising");
    topology::HandleCuttingOptions cutting;
    cutting.threads = threads;
    auto cut = TRY(topology::cutHandles(cleansed->lumen, cutting));
    study.denoisingSeconds = watch.lap();
    const Volume<std::uint8_t> lumen = std::move(cut.labels);
    study.cut = std::move(cut);
    options.log("centerline");
    centerline::CenterlineOptions tracing;
    tracing.threads = threads;
    const auto traced =
        centerline::traceCenterline(lumen, topology::distanceToBoundaryMm(lumen, threads), tracing);
    study.centerlineSeconds = watch.lap();

    // A lumen without a centerline still has a score of its own.
    const Centerline found = traced ? traced->centerline : Centerline{};
    if (auto kept = keeper.keep("cleansed", cleansed->hu)
                        .and_then([&] { return keeper.keep("lumen", lumen); })
                        .and_then([&] { return keeper.keep("line", found); });
        !kept)
        return tl::make_unexpected(kept.error());

    options.log("scores");
    study.before = topology::digitalTopology(cleansed->lumen, threads);
    study.after = topology::digitalTopology(lumen, threads);
    const auto rough =
        TRY(phantom::scoreLumen(truth.lumen, truth.centerline, segmentation.labels, found));
    study.segmentation = rough;
    const auto fine = TRY(phantom::scoreLumen(truth.lumen, truth.centerline, lumen, found));
    study.lumen = fine;
    if (options.cleansing) {
        auto clean = TRY(phantom::scoreCleansing(truth, cleansed->hu));
        study.cleansing = std::move(clean);
    }
    if (options.colon) {
        const ColonRecord& record = segmentation.record;
        std::vector<std::string> warnings = record.warnings;
        for (std::string& line : piecesPassedBy(found, record.pieces))
            warnings.push_back(std::move(line));
        study.colon.score = phantom::scoreColon(truth, lumen, found, record, warnings);
        study.colon.confidence = record.confidence;
        study.colon.warnings = warnings.size();
        for (const std::string& line : warnings)
            options.log("warned: " + line);
        if (!traced) {
            study.colon.failed = "centerline: " + describe(traced.error());
        } else if (!options.onlySegmentation) {
            study.colon.failed = "flattening not done";
            if (options.beforeFlattening) options.beforeFlattening(study);
            study.colon.failed.clear();
            options.log("flattening");
            const auto flips = flattenLumen(cleansed->hu, lumen, found, options, study);
            if (flips) study.colon.flips = *flips;
            if (!flips) study.colon.failed = "flattening: " + describe(flips.error());
        }
    }

    if (options.surface) {
        if (auto done = studySurfaces(truth, cleansed->hu, lumen, options, study); !done)
            return tl::make_unexpected(done.error());
    }
    return study;
}

}  // namespace haustra::bench
