#include "session/open_case.h"

#include "core/bridges.h"
#include "store/case_trust.h"
#include "store/lost_pages.h"

namespace haustra::session {

Result<CaseFiles> readCase(const store::Case& source) {
    const auto products = source.products();
    if (!products) return tl::make_unexpected(products.error());

    CaseFiles files;
    files.facts.name = source.name();
    const auto scan = source.scan();
    if (!scan) return tl::make_unexpected(scan.error());
    if (*scan) files.facts.scan = (*scan)->key.hex;
    auto ct = source.readVolume<std::int16_t>("ct");
    if (!ct) return tl::make_unexpected(ct.error());
    files.ct = std::move(*ct);
    files.facts.grid = files.ct.grid();
    if (const auto attributes = source.attributes("ct")) {
        const auto position = attributes->find("position");
        if (position != attributes->end())
            files.facts.position = patientPositionFromString(position->second);
    }
    for (const store::ProductEntry& entry : *products) {
        if (entry.product == "cleansed") {
            auto cleansed = source.readVolume<std::int16_t>("cleansed");
            if (!cleansed) return tl::make_unexpected(cleansed.error());
            files.cleansed = std::move(*cleansed);
            files.facts.cleansed = true;
        } else if (entry.product == "centerline") {
            auto centerline = source.readCenterline();
            if (!centerline) return tl::make_unexpected(centerline.error());
            files.facts.centerline = std::move(*centerline);
        } else if (entry.product == "quality") {
            auto trust = store::readTrust(source);
            if (!trust) return tl::make_unexpected(trust.error());
            files.facts.trust = std::move(*trust);
        } else if (entry.product == "flatmap") {
            files.flattened = true;
        } else if (entry.product == "surface") {
            files.surface = true;
        } else if (entry.product != "ct") {
            continue;
        }
        files.facts.content += entry.product + ':' + entry.key.hex + ' ';
    }
    return files;
}

Result<std::shared_ptr<const TriMesh>> readSurface(const store::Case& source) {
    auto mesh = source.readMesh("surface");
    if (!mesh) return tl::make_unexpected(mesh.error());
    return std::make_shared<const TriMesh>(std::move(*mesh));
}

Result<std::shared_ptr<const Wall>> readWall(const store::Case& source) {
    auto map = source.readFlatMap();
    if (!map) return tl::make_unexpected(map.error());
    std::vector<std::uint8_t> bridged;
    if (source.find("lumen")) {
        const auto lumen = source.readVolume<std::uint8_t>("lumen");
        if (!lumen) return tl::make_unexpected(lumen.error());
        bridged = bridgedTriangles(map->surface, *lumen);
        if (!store::isWhole(lumen->voxels().data()))
            return fail(ErrorKind::io, "product lumen was cut short, or its disk fails",
                        source.name());
    }
    return makeWall(std::make_shared<const FlatMap>(std::move(*map)), std::move(bridged));
}

}  // namespace haustra::session
