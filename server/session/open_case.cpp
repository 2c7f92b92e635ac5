#include "session/open_case.h"

#include "core/bridges.h"
#include "store/case_trust.h"
#include "store/lost_pages.h"
#include "store/products.h"

#include <set>

namespace haustra::session {

namespace product = store::product;

Result<CaseFiles> readCase(const store::Case& source) {
    const auto products = TRY(source.products());

    CaseFiles files;
    files.facts.name = source.name();
    const auto scan = TRY(source.scan());
    if (scan) files.facts.scan = scan->key.hex;
    std::set<std::string> held;
    for (const store::ProductEntry& entry : products) {
        held.insert(entry.product);
        const store::Product* const known = store::catalogue().find(entry.product);
        if (known && known->shown) files.facts.content += entry.product + ':' + entry.key.hex + ' ';
    }
    files.ct = TRY(source.readVolume<std::int16_t>(product::ct));
    files.facts.ct = std::make_shared<const Volume<std::int16_t>>(files.ct.share());
    files.facts.grid = files.ct.grid();
    if (const auto attributes = source.attributes(product::ct)) {
        const auto position = attributes->find("position");
        if (position != attributes->end())
            files.facts.position = patientPositionFromString(position->second);
    }
    files.facts.cleansed = held.contains(product::cleansed);
    if (files.facts.cleansed) {
        files.cleansed = TRY(source.readVolume<std::int16_t>(product::cleansed));
        files.facts.cleansedScan =
            std::make_shared<const Volume<std::int16_t>>(files.cleansed.share());
    }
    if (held.contains(product::centerline)) files.facts.centerline = TRY(source.readCenterline());
    if (held.contains(product::quality)) files.facts.trust = TRY(store::readTrust(source));
    files.flattened = held.contains(product::flatMap);
    files.surface = held.contains(product::surface);
    files.findings = held.contains(product::findings);
    return files;
}

Result<std::shared_ptr<const TriMesh>> readSurface(const store::Case& source) {
    auto mesh = TRY(source.readMesh(product::surface));
    return std::make_shared<const TriMesh>(std::move(mesh));
}

Result<std::shared_ptr<const Wall>> readWall(const store::Case& source) {
    auto map = TRY(source.readFlatMap());
    std::vector<std::uint8_t> bridged;
    if (source.find(product::lumen)) {
        const auto lumen = TRY(source.readVolume<std::uint8_t>(product::lumen));
        bridged = bridgedTriangles(map.surface, lumen);
        if (!store::isWhole(lumen.voxels().data()))
            return fail(ErrorKind::io, "product lumen was cut short, or its disk fails",
                        source.name());
    }
    return makeWall(std::make_shared<const FlatMap>(std::move(map)), std::move(bridged));
}

}  // namespace haustra::session
