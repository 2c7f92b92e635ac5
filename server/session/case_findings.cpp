#include "session/case_findings.h"

#include "core/missed_patches.h"
#include "core/parallel.h"
#include "protocol/limits.h"
#include "render/wall/review_camera.h"
#include "store/products.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haustra::session {
namespace {

namespace product = store::product;

// What can be told (PROTOCOL.md §4).
bool isSound(const Finding& finding) {
    const auto isLength = [](double mm) { return mm >= 0.0 && mm <= protocol::maxCoordinateMm; };
    return isPatientPoint(finding.positionMm) && isPatientPoint(finding.wallMm) &&
           isPatientPoint(finding.diameterEndsMm.first) &&
           isPatientPoint(finding.diameterEndsMm.second) && isLength(finding.diameterMm) &&
           std::abs(finding.heightMm) <= protocol::maxCoordinateMm &&
           std::abs(finding.arcMm) <= protocol::maxCoordinateMm && finding.score >= 0.0 &&
           finding.score <= 1.0;
}

// Of each entry the triangles that are its own, as a patch to be looked at.
std::vector<MissedPatch> patchesOf(const CaseFindings& findings, const render::WallSight& sight) {
    std::vector<MissedPatch> patches(findings.entries.size());
    const auto ofTriangle = render::findingTriangles(sight, findings.product);
    for (std::size_t t = 0; t < ofTriangle.size(); ++t) {
        if (ofTriangle[t] < 0) continue;
        MissedPatch& patch = patches[std::size_t(ofTriangle[t])];
        const render::WallSight::Facet& facet = sight.facets()[t];
        patch.triangles.push_back(std::int32_t(t));
        patch.areaMm2 += double(facet.areaMm2);
        patch.inward += double(facet.areaMm2) * glm::dvec3(facet.inward);
    }
    for (std::size_t n = 0; n < patches.size(); ++n) {
        const WallPlace& wall = findings.entries[n].wall;
        patches[n].centerMm = wall.positionMm;
        patches[n].arcMm = wall.arcMm;
        if (const double length = glm::length(patches[n].inward); length > 0.0)
            patches[n].inward /= length;
    }
    return patches;
}

}  // namespace

bool CaseFindings::isShown(int index, const DetectionChoice& choice) const {
    if (!choice.shows()) return false;
    if (!entries[std::size_t(index)].candidate) return true;
    return choice.leastProbability && finding(index).score >= *choice.leastProbability;
}

std::vector<render::FindingShade> CaseFindings::shades(const DetectionChoice& choice) const {
    std::vector<render::FindingShade> shades;
    for (int n = 0; n < int(entries.size()); ++n)
        shades.push_back(!isShown(n, choice)                 ? render::FindingShade::none
                         : entries[std::size_t(n)].candidate ? render::FindingShade::candidate
                                                             : render::FindingShade::finding);
    return shades;
}

std::shared_ptr<const CaseFindings> placeFindings(Findings findings, const Centerline& centerline,
                                                  const Wall* wall) {
    auto made = std::make_shared<CaseFindings>();
    made->product = std::move(findings);
    const auto above = int(made->product.findings.size()),
               all = above + int(made->product.candidates.size());
    for (int n = 0; n < all; ++n) {
        CaseFindings::Entry entry{n + 1, n >= above, {}};
        const Finding& finding = made->finding(n);
        entry.wall = wall ? wall->lookup.nearest(finding.wallMm)
                          : placeByCenterline(centerline, finding.wallMm);
        made->entries.push_back(entry);
    }
    made->alongColon.resize(std::size_t(all));
    std::iota(made->alongColon.begin(), made->alongColon.end(), 0);
    std::stable_sort(made->alongColon.begin(), made->alongColon.end(),
                     [&](int a, int b) { return made->finding(a).arcMm < made->finding(b).arcMm; });
    if (!wall) return made;
    made->paint = render::findingPixels(*wall->painter, made->product);
    const render::WallSight& sight = wall->painter->sight();
    const std::vector<MissedPatch> patches = patchesOf(*made, sight);
    parallelFor(patches.size(), 1, 0, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            made->entries[n].view = render::viewBesidePath(sight, patches[n], centerline);
    });
    return made;
}

Result<std::shared_ptr<const CaseFindings>> readFindings(const store::Case& source,
                                                         const Grid& grid,
                                                         const Centerline& centerline,
                                                         const Wall* wall) {
    TRY(source.verify(product::findings));
    const std::string text = TRY(source.readText(product::findings));
    auto findings = TRY(findingsOfJson(text, product::findings));
    const auto refuse = [](const char* what) {
        return fail(ErrorKind::badInput, what, product::findings);
    };
    if (findings.grid.size == glm::ivec3(0)) findings.grid = grid;  // they have no voxels
    if (!sameGrid(findings.grid, grid)) return refuse("findings are of another grid than the scan");
    if (!(findings.operatingPoint >= 0.0 && findings.operatingPoint <= 1.0))
        return refuse("the operating point is no probability");
    for (const auto* list : {&findings.findings, &findings.candidates})
        if (!std::all_of(list->begin(), list->end(), isSound))
            return refuse("a finding lies nowhere");
    return placeFindings(std::move(findings), centerline, wall);
}

}  // namespace haustra::session
