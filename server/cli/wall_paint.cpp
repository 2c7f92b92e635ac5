#include "cli/wall_paint.h"

#include "core/bridges.h"
#include "core/ct_scan.h"
#include "core/findings.h"
#include "core/flat_lookup.h"
#include "pictures/picture_file.h"
#include "render/wall/finding_paint.h"
#include "render/wall/strip_painter.h"
#include "store/products.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>

namespace haustra::cli {

namespace {

/// `file` is of the strip's shape, to a hundredth or a pixel: another one would be stretched.
Result<void> checkShape(const std::filesystem::path& file, glm::ivec2 size, double height) {
    const double rows = height * size.x;
    if (std::abs(size.y - rows) <= std::max(1.0, 0.01 * rows)) return {};
    return fail(
        ErrorKind::badInput,
        fmt::format("the picture is of {}x{} pixels, and a picture of this strip, without a "
                    "seam margin, of {}x{:.0f}",
                    size.x, size.y, size.x, std::max(1.0, std::round(rows))),
        file.string());
}

}  // namespace

Result<std::shared_ptr<const render::WallPaint>> readWallPaint(const std::filesystem::path& file,
                                                               double height) {
    auto picture = TRY(pictures::readColorPicture(file, render::maxPaintSide));
    TRY(checkShape(file, picture.size, height));
    auto paint = std::make_shared<render::WallPaint>();
    paint->size = picture.size;
    paint->pixels = std::move(picture.pixels);
    paint->height = height;
    TRY(render::checkWallPaint(*paint));
    return paint;
}

Result<bool> hasBridges(const store::Case& source) {
    if (!source.find(store::product::lumen)) return false;
    return source.readVolume<std::uint8_t>(store::product::lumen)
        .map([](const Volume<std::uint8_t>& lumen) {
            const auto labels = lumen.voxels();
            return std::memchr(labels.data(), int(LumenLabel::bridge), labels.size()) != nullptr;
        });
}

Result<PaintedFindings> paintFindings(const store::Case& source, std::shared_ptr<const FlatMap> map,
                                      std::optional<double> leastProbability) {
    if (!source.find(store::product::findings))
        return fail(ErrorKind::noResult,
                    "the case has no findings: prepare looks for polyps in a colon", source.name());
    TRY(source.verify(store::product::findings));
    const std::string text = TRY(source.readText(store::product::findings));
    auto findings = TRY(findingsOfJson(text, store::product::findings));
    const auto ct = TRY(source.readVolume<std::int16_t>(store::product::ct));
    if (findings.grid.size == glm::ivec3(0)) findings.grid = ct.grid();
    if (!sameGrid(findings.grid, ct.grid()))
        return fail(ErrorKind::badInput, "findings are of another grid than the scan",
                    source.name());
    std::vector<std::uint8_t> bridged;
    if (TRY(hasBridges(source))) {
        const auto lumen = TRY(source.readVolume<std::uint8_t>(store::product::lumen));
        bridged = bridgedTriangles(map->surface, lumen);
    }
    const FlatLookup lookup(map);
    auto sight = TRY(render::WallSight::of(std::move(map), std::move(bridged)));
    const auto painter = TRY(render::StripPainter::of(std::move(sight)));
    PaintedFindings painted;
    std::vector<render::FindingShade> shades;
    const auto add = [&](const Finding& finding, render::FindingShade shade) {
        shades.push_back(shade);
        if (shade != render::FindingShade::none)
            painted.places.push_back(
                {int(shades.size()), finding.wallMm, lookup.nearest(finding.wallMm).flat,
                 shade == render::FindingShade::finding ? render::findingColor
                                                        : render::candidateColor});
    };
    for (const Finding& finding : findings.findings)
        add(finding, render::FindingShade::finding);
    for (const Finding& candidate : findings.candidates)
        add(candidate, leastProbability && candidate.score >= *leastProbability
                           ? render::FindingShade::candidate
                           : render::FindingShade::none);
    painted.paint = painter->paint(
        {}, {}, render::colorFindings(render::findingPixels(*painter, findings), shades));
    return painted;
}

Result<std::shared_ptr<const render::WallPaint>> paintBridges(
    const store::Case& source, std::shared_ptr<const FlatMap> map,
    std::shared_ptr<const render::WallPaint> below) {
    const auto has = TRY(hasBridges(source));
    if (!has) return below;
    const auto lumen = TRY(source.readVolume<std::uint8_t>(store::product::lumen));
    auto bridged = bridgedTriangles(map->surface, lumen);
    auto sight = TRY(render::WallSight::of(std::move(map), std::move(bridged)));
    if (!sight->hasBridges()) return below;
    const auto painter = TRY(render::StripPainter::of(std::move(sight)));
    return below ? painter->bridgesOver(*below) : painter->paint({}, {});
}

}  // namespace haustra::cli
