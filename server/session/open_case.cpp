#include "session/open_case.h"

#include "core/bridges.h"
#include "store/case_trust.h"
#include "store/lost_pages.h"

namespace haustra::session {

Result<CaseFiles> readCase(const store::Case& source) {
    const auto products = TRY(source.products());

    CaseFiles files;
    files.facts.name = source.name();
    const auto scan = TRY(source.scan());
    if (scan) files.facts.scan = scan->key.hex;
    auto ct = TRY(source.readVolume<std::int16_t>("ct"));
    files.ct = std::move(ct);
    files.facts.grid = files.ct.grid();
    if (const auto attributes = source.attributes("ct")) {
        const auto position = attributes->find("position");
        if (position != attributes->end())
            files.facts.position = patientPositionFromString(position->second);
    }
    for (const store::ProductEntry& entry : products) {
        if (entry.product == "cleansed") {
            auto cleansed = TRY(source.readVolume<std::int16_t>("cleansed"));
            files.cleansed = std::move(cleansed);
            files.facts.cleansed = true;
        } else if (entry.product == "centerline") {
            auto centerline = TRY(source.readCenterline());
            files.facts.centerline = std::move(centerline);
        } else if (entry.product == "quality") {
            auto trust = TRY(store::readTrust(source));
            files.facts.trust = std::move(trust);
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
    auto mesh = TRY(source.readMesh("surface"));
    return std::make_shared<const TriMesh>(std::move(mesh));
}

Result<std::shared_ptr<const Wall>> readWall(const store::Case& source) {
    auto map = TRY(source.readFlatMap());
    std::vector<std::uint8_t> bridged;
    if (source.find("lumen")) {
        const auto lumen = TRY(source.readVolume<std::uint8_t>("lumen"));
        bridged = bridgedTriangles(map.surface, lumen);
        if (!store::isWhole(lumen.voxels().data()))
            return fail(ErrorKind::io, "product lumen was cut short, or its disk fails",
                        source.name());
    }
    return makeWall(std::make_shared<const FlatMap>(std::move(map)), std::move(bridged));
}

}  // namespace haustra::session
