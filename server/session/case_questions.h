// Questions about an open case that take longer than a socket can wait: where on the wall, how
// long, which values of the scan.
#pragma once

#include "core/result.h"
#include "core/scan_values.h"
#include "session/open_case.h"
#include "session/pick.h"
#include "session/wall.h"
#include "session/worker.h"

#include <functional>
#include <memory>
#include <variant>

namespace haustra::session {

/// A WallQuestion is for a case that has a wall.
using CaseQuestion = std::variant<WallQuestion, ScanRegion, PickRay>;
using CaseAnswer = std::variant<WallPlace, WallMeasure, ScanStatistics>;

/// As session/wall.h's answer, and core's measureScan: at most some 100 ms, and the time in which
/// pages of the scan come from the disk.
/// A ray meets the flattened wall, or else the wall's mesh; where there is neither, or the ray goes
/// through its open end, the tissue of the scan that the endoscopic view shows. Then the place is
/// looked at from the nearest of the path, or from where the ray begins, where there is no path,
/// and `flatTriangle` is −1 (so is `sourceTriangle`, of tissue). Fails (badInput) where there is no
/// cleansed scan, or the ray meets nothing, (io) where the scan's file was cut short.
Result<CaseAnswer> answer(const OpenCase& of, const CaseQuestion& question);

struct CaseRequest {
    std::shared_ptr<const OpenCase> of;
    CaseQuestion question;
    std::function<void(Result<CaseAnswer>)> done;  ///< called on the question thread
};

/// The thread that answers. A session has one question here at a time, so that sessions take turns
/// however much one of them asks.
class QuestionThread : public Worker<CaseRequest> {
public:
    QuestionThread();
};

}  // namespace haustra::session
