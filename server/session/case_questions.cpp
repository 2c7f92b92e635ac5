#include "session/case_questions.h"

#include "store/lost_pages.h"

#include <cmath>
#include <utility>

namespace haustra::session {
namespace {

Result<CaseAnswer> answerTo(const OpenCase& of, const WallQuestion& question) {
    auto found = TRY(answer(*of.wall, question));
    return std::visit([](auto& any) { return CaseAnswer(std::move(any)); }, found);
}

Result<CaseAnswer> answerTo(const OpenCase& of, const ScanRegion& region) {
    const auto& scan = region.scan == Scan::cleansed ? of.cleansedScan : of.ct;
    if (!scan) return fail(ErrorKind::badInput, "the case has no cleansed scan", "scan values");
    const auto found = TRY(measureScan(*scan, region));
    if (!store::isWhole(scan->voxels().data()))
        return fail(ErrorKind::io, "the scan was cut short, or its disk fails", of.name);
    return found;
}

/// As the path has it, of a place that the strip does not.
WallPlace placeBeside(const OpenCase& of, const PickRay& ray, const MetTriangle& met) {
    WallPlace place;
    place.positionMm = met.positionMm;
    place.sourceTriangle = met.triangle;
    place.cameraMm = ray.fromMm;
    if (of.centerline.points.empty()) return place;
    place.arcMm = nearestArc(of.centerline, met.positionMm);
    place.cameraMm = poseAtArc(of.centerline, place.arcMm).point.positionMm;
    return place;
}

/// The wall beside what a ray meets as tissue well before the wall itself: the mucosa is drawn some
/// tenths of a millimetre in front of the mesh, so that a click on the rim of a head meets the wall
/// behind it. Empty where none is that near, as of residue that stands free, and where the scan is
/// damaged.
std::optional<WallPlace> rimBefore(const OpenCase& of, const PickRay& ray, double wayMm) {
    constexpr double beforeMm = 2.0, besideMm = 1.0;
    const auto& shown = of.cleansedScan ? of.cleansedScan : of.ct;
    const auto tissue = firstTissue(*shown, ray);
    if (!store::isWhole(shown->voxels().data())) return std::nullopt;
    const double tissueMm = tissue ? glm::distance(ray.fromMm, *tissue) : INFINITY;
    if (tissueMm == 0.0 || tissueMm > wayMm - beforeMm) return std::nullopt;
    const WallPlace rim = of.wall->lookup.nearest(*tissue);
    if (glm::distance(rim.positionMm, *tissue) > besideMm) return std::nullopt;
    return rim;
}

Result<CaseAnswer> answerTo(const OpenCase& of, const PickRay& ray) {
    if (of.wall) {
        if (const auto met = of.wall->painter->sight().firstMet(ray.fromMm, ray.direction)) {
            if (const auto rim = rimBefore(of, ray, glm::distance(ray.fromMm, met->positionMm)))
                return *rim;
            const auto place = of.wall->lookup.at(met->flat);
            return place ? *place : of.wall->lookup.nearest(met->positionMm);
        }
    } else if (of.surface) {
        if (const auto met = firstMet(*of.surface, ray)) return placeBeside(of, ray, *met);
    }
    const auto& shown = of.cleansedScan ? of.cleansedScan : of.ct;
    const auto tissue = firstTissue(*shown, ray);
    if (!store::isWhole(shown->voxels().data()))
        return fail(ErrorKind::io, "the scan was cut short, or its disk fails", of.name);
    if (!tissue) return fail(ErrorKind::badInput, "no wall lies in this direction", "wall");
    return placeBeside(of, ray, {-1, *tissue});
}

}  // namespace

Result<CaseAnswer> answer(const OpenCase& of, const CaseQuestion& question) {
    return std::visit([&](const auto& any) { return answerTo(of, any); }, question);
}

QuestionThread::QuestionThread() {
    start("questions", 1, [](auto& taken) {
        const CaseRequest& request = taken.front();
        request.done(guarded([&] { return answer(*request.of, request.question); }));
    });
}

}  // namespace haustra::session
