#include "session/case_questions.h"

#include "store/lost_pages.h"

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
