#include "contouring/dual_contouring.h"
#include "contouring/wall_field.h"
#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"
#include "simplification/simplification.h"

#include <algorithm>
#include <chrono>

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using organs::ExpectedTopology;
using organs::LumenFinder;
using store::Attributes;

// Raise it whenever the surface changes for the same input and options.
constexpr int surfaceVersion = 5;

// Which HU the wall stands at, and in which field.
enum class WallRule { air, content, mask };

WallRule wallRule(const Preparation& preparation, const WallSource& source) {
    if (source.hu.empty()) return WallRule::mask;
    return preparation.organ().finder == LumenFinder::huRange ? WallRule::content : WallRule::air;
}

const char* toString(WallRule rule) {
    switch (rule) {
        case WallRule::air:
            return "air";
        case WallRule::content:
            return "content";
        case WallRule::mask:
            return "mask";
    }
    return "";
}

Result<contouring::WallField> readWall(const Preparation& preparation, StageCase& stage,
                                       const WallSource& source,
                                       const Volume<std::uint8_t>& lumen) {
    const int threads = preparation.options().threads;
    const WallRule rule = wallRule(preparation, source);
    if (rule == WallRule::mask) return contouring::smoothedMask(lumen, threads);
    auto hu = TRY(stage.readVolume<std::int16_t>(source.hu));
    if (rule == WallRule::content) return contouring::contentField(hu, lumen, threads);
    const auto attributes = TRY(stage.attributes(product::segmentation));
    const auto tissue = TRY(tissueModelOf(attributes));
    return contouring::WallField{std::move(hu), tissue.airBelowHu, false};
}

// What every later stage relies on; that it holds is the contouring's and the simplification's
// promise, so a breach is told, not stored.
Result<void> checkSurface(const MeshTopology& topology, ExpectedTopology expected) {
    if (!topology.closed()) {
        return fail(
            ErrorKind::noResult,
            "the surface is not closed and manifold: " + std::to_string(topology.boundaryEdges) +
                " open edges, " + std::to_string(topology.nonManifoldEdges) + " of no manifold");
    }
    if (expected == ExpectedTopology::ball &&
        (topology.components != 1 || topology.eulerCharacteristic != 2)) {
        return fail(ErrorKind::noResult, "the surface is not a ball's: it has " +
                                             std::to_string(topology.components) +
                                             " parts and Euler characteristic " +
                                             std::to_string(topology.eulerCharacteristic));
    }
    return {};
}

ProductKey surfaceKey(const Preparation& preparation, const WallSource& source,
                      const ProductKey& lumen) {
    std::vector<ProductKey> inputs{lumen};
    if (!source.hu.empty()) inputs.push_back(source.huKey);
    return store::makeKey("surface", surfaceVersion,
                          "error-mm=" + exactText(preparation.options().surfaceErrorMm) +
                              ";wall=" + toString(wallRule(preparation, source)),
                          inputs);
}

Result<WallSurface> surfaceOf(const Preparation& preparation, StageCase& stage,
                              const WallSource& source, const Progress& progress) {
    const auto start = std::chrono::steady_clock::now();
    const PrepareOptions& options = preparation.options();
    Attributes attributes;
    TriMesh fine;
    {
        const auto lumen = TRY(stage.readVolume<std::uint8_t>(product::lumen));
        const auto wall = TRY(readWall(preparation, stage, source, lumen));
        auto contoured =
            TRY(contouring::contourLumen(wall.hu, lumen, wall.isoHu, {options.threads}));
        fine = std::move(contoured);
        if (!source.hu.empty())
            attributes["iso-hu"] = exactText(wall.negated ? -wall.isoHu : wall.isoHu);
    }
    progress(0.3);
    simplification::SimplificationOptions simplification;
    simplification.errorMm = options.surfaceErrorMm;
    simplification.threads = options.threads;
    simplification.progress = [&](double fraction) { progress(0.3 + 0.7 * fraction); };
    auto simple = TRY(simplification::simplify(fine, simplification));
    const MeshTopology topology = meshTopology(simple);
    TRY(checkSurface(topology, preparation.organ().topology));
    attributes["euler-characteristic"] = std::to_string(topology.eulerCharacteristic);
    attributes["vertices"] = std::to_string(simple.vertices.size());
    attributes["triangles"] = std::to_string(simple.triangles.size());
    attributes["contoured-triangles"] = std::to_string(fine.triangles.size());
    attributes["error-mm"] = exactText(options.surfaceErrorMm);
    setNotes(attributes,
             {attributes["triangles"] + " triangles of " + attributes["contoured-triangles"] +
              " contoured, Euler characteristic " + attributes["euler-characteristic"]});
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    return WallSurface{std::move(simple), std::move(attributes), stage.read(), took.count()};
}

}  // namespace

std::future<Result<WallSurface>> beginSurface(Preparation& preparation, const WallSource& source,
                                              const ProductKey& lumen) {
    const ProductKey key = surfaceKey(preparation, source, lumen);
    if (threadCount(preparation.options().threads) == 1 ||
        preparation.keyOf(product::surface) == key)
        return {};
    return std::async(std::launch::async,
                      [&preparation, source, stage = preparation.open("surface", key)]() mutable {
                          return surfaceOf(preparation, stage, source, [](double) {});
                      });
}

Result<ProductKey> makeSurface(Preparation& preparation, const WallSource& source,
                               const ProductKey& lumen, std::future<Result<WallSurface>> begun) {
    StageMeter meter;
    StageCase stage = preparation.open("surface", surfaceKey(preparation, source, lumen));
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const bool beside = begun.valid();
        const auto made =
            TRY(beside ? begun.get() : surfaceOf(preparation, stage, source, progress));
        if (beside) meter.addBeside(std::max(0.0, made.seconds - meter.wallSeconds()));
        stage.addRead(made.read);
        return stage.publish(product::surface, made.mesh, made.attributes);
    });
}

}  // namespace haustra::pipeline
