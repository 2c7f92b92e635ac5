// What polyp detection costs on a prepared case, stage by stage, beside the dissertation's shape
// features over the whole mucosa (its §6.3 compares the two), and the biopsy image. Where the truth
// is given, how far off the heights of what was found are, and how many samples and pixels of the
// strip a polyp has. usage: cad_table STORE CASE [TRUTH.json | - [CLUSTERS.png]]
#include "cad/biopsy_image.h"
#include "cad/detect.h"
#include "cad/examined_colon.h"
#include "cad/lesion_features.h"
#include "cad/strip_raster.h"
#include "cad/truth.h"
#include "core/large_pages.h"
#include "core/parallel.h"
#include "pictures/picture_file.h"
#include "pipeline/colon_inputs.h"
#include "stopwatch.h"
#include "store/case_store.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>

namespace {

using namespace haustra;
using bench::cpuMilliseconds, bench::milliseconds;

template <class Work>
auto timed(const char* what, const Work& work) {
    const double start = milliseconds(), cpuStart = cpuMilliseconds();
    auto result = work();
    std::printf("%-44s %8.2f s, processor time %8.2f s\n", what, (milliseconds() - start) / 1e3,
                (cpuMilliseconds() - cpuStart) / 1e3);
    return result;
}

/// At every sample; the gradient concentration, of a lesion of 6 mm, at every `stride`-th.
void timeWholeMucosa(const cad::WallEvidence& evidence) {
    timed("shape index and curvedness everywhere",
          [&] { return cad::shapesOf(evidence.samples, *evidence.smooth, 0); });
    constexpr std::size_t stride = 200;
    const auto& places = evidence.samples.mesh.vertices;
    const double start = milliseconds();
    std::vector<double> concentration(places.size() / stride + 1);
    parallelFor(concentration.size(), 64, 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end && n * stride < places.size(); ++n)
            concentration[n] =
                cad::gradientConcentration(*evidence.smooth, places[n * stride], 4.6);
    });
    std::printf("%-44s %8.0f s (one in %zu took %.2f s)\n", "gradient concentration everywhere",
                (milliseconds() - start) / 1e3 * double(stride), stride,
                (milliseconds() - start) / 1e3);
}

/// Of two programs that find and measure the same it is the same (FNV-1a over the bytes of patches,
/// voxels and features).
std::uint64_t fingerprintOf(const std::vector<cad::Candidate>& candidates) {
    std::uint64_t hash = 14695981039346656037u;
    const auto add = [&](std::uint32_t bits) {
        for (int byte = 0; byte < 4; ++byte)
            hash = (hash ^ (bits >> (8 * byte) & 0xffu)) * 1099511628211u;
    };
    for (const cad::Candidate& candidate : candidates) {
        add(std::uint32_t(candidate.levelOf));
        for (const std::uint32_t sample : candidate.lesion.patch.samples)
            add(sample);
        for (const VoxelRun& run : candidate.lesion.voxels) {
            for (int axis = 0; axis < 3; ++axis)
                add(std::uint32_t(run.first[axis]));
            add(std::uint32_t(run.count));
        }
        for (const float feature : candidate.features)
            add(std::bit_cast<std::uint32_t>(feature));
    }
    return hash;
}

/// Colours the pixels that lie on a candidate's patch.
void tint(Image& image, const cad::StripRaster& raster, const FlatMap& flat,
          const cad::WallEvidence& evidence, const cad::Candidate& candidate, glm::u8vec3 color) {
    constexpr double cellMm = 0.35;  // and the cells around it: samples are at most 0.5 mm apart
    std::set<std::array<int, 3>> cells;
    const auto cellOf = [&](glm::dvec3 p) {
        const glm::ivec3 c(glm::floor(p / cellMm));
        return std::array{c.x, c.y, c.z};
    };
    glm::dvec3 low(1e30), high(-1e30);
    for (const std::uint32_t v : candidate.lesion.patch.samples) {
        const glm::dvec3 p = evidence.samples.mesh.vertices[v];
        low = glm::min(low, p), high = glm::max(high, p);
        for (int n = 0; n < 27; ++n)
            cells.insert(cellOf(p + cellMm * glm::dvec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
    }
    for (std::size_t n = 0; n < raster.pixels.size(); ++n) {
        if (raster.pixels[n].triangle < 0) continue;
        const glm::dvec3 p = raster.placeOf(raster.pixels[n], flat);
        if (glm::any(glm::lessThan(p, low)) || glm::any(glm::greaterThan(p, high)) ||
            !cells.contains(cellOf(p)))
            continue;
        for (std::size_t c = 0; c < 3; ++c)
            image.rgb[3 * n + c] =
                std::uint8_t((image.rgb[3 * n + c] + 3 * color[glm::length_t(c)]) / 4);
    }
}

/// Of the findings that mean a polyp, by its kind.
void compareHeights(const std::vector<Finding>& findings,
                    const std::vector<cad::TrueLesion>& truth) {
    std::vector<glm::dvec3> places;
    for (const Finding& finding : findings)
        places.push_back(finding.positionMm);
    const std::vector<int> meant = cad::matched(places, truth);
    for (const char* kind : {"flat", "sessile", "pedunculated"}) {
        double error = 0.0, sum = 0.0;
        int count = 0, alike = 0;
        for (std::size_t n = 0; n < findings.size(); ++n) {
            if (meant[n] < 0) continue;
            const cad::TrueLesion& lesion = truth[std::size_t(meant[n])];
            if (!lesion.neoplastic || lesion.kind != kind) continue;
            const double off = findings[n].heightMm - lesion.heightMm;
            error += std::abs(off), sum += off, ++count;
            alike += findings[n].kind == kind;
        }
        if (count > 0)
            std::printf(
                "%d found %s: heights off by %.2f mm in the mean (bias %+.2f), %d told as "
                "such\n",
                count, kind, error / count, sum / count, alike);
    }
}

void countOnPolyps(const cad::PreparedColon& colon, const cad::WallSamples& samples,
                   const std::vector<cad::TrueLesion>& truth) {
    const cad::StripRaster raster = cad::rasterStrip(colon.flat, {4000, 200}, 0);
    std::vector<double> onWall, onStrip;
    for (const cad::TrueLesion& lesion : truth) {
        if (!lesion.neoplastic || lesion.diameterMm < 5.0) continue;
        const auto isOn = [&](glm::dvec3 p) {
            return glm::distance(p, lesion.positionMm) < 0.5 * lesion.diameterMm + 0.5;
        };
        const auto held = std::count_if(samples.mesh.vertices.begin(), samples.mesh.vertices.end(),
                                        [&](const glm::dvec3& p) { return isOn(p); });
        if (held == 0) continue;  // no wall was found there
        onWall.push_back(double(held));
        onStrip.push_back(double(
            std::count_if(raster.pixels.begin(), raster.pixels.end(), [&](const auto& pixel) {
                return pixel.triangle >= 0 && isOn(raster.placeOf(pixel, colon.flat));
            })));
    }
    std::printf(
        "%zu polyps: samples of the wall on each: least %.0f, median %.0f; pixels of the "
        "4000 x 200 strip: least %.0f, median %.0f\n",
        onWall.size(), bench::quantile(onWall, 0), bench::median(onWall),
        bench::quantile(onStrip, 0), bench::median(onStrip));
}

Result<void> run(const std::string& root, const std::string& name, const std::string& truthFile,
                 const char* clusters) {
    const auto store = TRY(store::CaseStore::open(root, false));
    const auto source = TRY(store.openCase(name));
    const auto inputs =
        TRY(pipeline::readColon(source, {source.find(store::product::quality).has_value(),
                                         source.find(store::product::cleansed).has_value(),
                                         source.find(store::product::flatMap).has_value()}));
    const cad::CadModel model =
        TRY(cad::modelOfText(std::string(cad::builtInModelText()), "the built-in model"));
    const double start = milliseconds();
    const auto examined = timed("samples, shapes and rays", [&] {
        return std::make_unique<const cad::ExaminedColon>(inputs.colon(), cad::EvidenceOptions());
    });
    const cad::PreparedColon& colon = examined->colon();
    const cad::WallEvidence& evidence = examined->evidence();
    std::vector<cad::Candidate> residue;
    auto candidates = timed("candidates and their features", [&] {
        return cad::findCandidates(colon, evidence, &model.texture, {}, &model, &residue);
    });
    std::printf("fingerprint of them: %016llx\n",
                static_cast<unsigned long long>(fingerprintOf(candidates)));
    const auto before =
        std::ranges::count_if(candidates, [](const auto& c) { return c.levelOf < 0; });
    const auto levels = std::ptrdiff_t(candidates.size()) - before;
    const auto all = clusters ? candidates : std::vector<cad::Candidate>();
    const auto findings = timed("places weighed, and findings", [&] {
        cad::weigh(candidates, model);
        return cad::findingsOf(colon, evidence, candidates, model, residue);
    });
    std::printf("%zu samples, %zd candidates, %zd at other levels, %zu findings: %.2f s in all\n",
                evidence.rays.size(), before, levels, findings.findings.size(),
                (milliseconds() - start) / 1e3);
    const cad::BiopsyTable table(evidence.transferFunction);
    const cad::BiopsyScan scan{*evidence.smooth, colon.lumen, colon.tissue.airBelowHu};
    if (inputs.flat.height > 0.0) {
        timed("biopsy image, 4000 x 200, 1 ray a pixel", [&] {
            return cad::biopsyImage(scan, colon.flat, table, {4000, 200}, 1, 0);
        });
        Image image = timed("biopsy image, 4000 x 200, 4 rays a pixel", [&] {
            return cad::biopsyImage(scan, colon.flat, table, {4000, 200}, 2, 0);
        });
        if (clusters) {
            const cad::StripRaster raster = cad::rasterStrip(colon.flat, {4000, 200}, 0);
            for (const cad::Candidate& c : all)
                if (c.levelOf < 0)
                    tint(image, raster, colon.flat, evidence, c,
                         c.lesion.patch.by == cad::Generator::texture ? glm::u8vec3(255, 0, 255)
                                                                      : glm::u8vec3(255, 255, 255));
            for (const cad::Candidate& c : candidates)
                if (c.probability >= model.operatingPoint)
                    tint(image, raster, colon.flat, evidence, c, {255, 255, 0});
            const auto texture = std::count_if(all.begin(), all.end(), [](const auto& c) {
                return c.lesion.patch.by == cad::Generator::texture;
            });
            std::printf("%zd candidates by texture, %zd by shape\n", std::ptrdiff_t(texture),
                        std::ptrdiff_t(before) - std::ptrdiff_t(texture));
            TRY(pictures::writePicture(clusters, image, {}));
        }
    }
    timeWholeMucosa(evidence);
    if (truthFile.empty() || truthFile == "-") return {};
    std::ifstream in(truthFile);
    std::ostringstream text;
    text << in.rdbuf();
    const auto truth = TRY(cad::truthOfJson(text.str(), truthFile));
    compareHeights(findings.findings, truth);
    countOnPolyps(colon, evidence.samples, truth);
    return {};
}

}  // namespace

int main(int argc, char** argv) {
    haustra::useLargePages(argv);  // as haustra prepare does
    if (argc < 3) {
        std::fprintf(stderr, "usage: cad_table STORE CASE [TRUTH.json|- [CLUSTERS.png]]\n");
        return 2;
    }
    const auto done = run(argv[1], argv[2], argc > 3 ? argv[3] : "", argc > 4 ? argv[4] : nullptr);
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    return done ? 0 : 1;
}
