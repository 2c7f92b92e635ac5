// prepare: from a CT series to the products that a reader needs. The one place that knows the
// order of the stages.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/result.h"
#include "store/case_store.h"

namespace haustra::pipeline {

struct PrepareOptions {
    std::filesystem::path series;  ///< DICOM folder or NIfTI file
    std::string seriesUid;
    std::filesystem::path lumenMask;   ///< NIfTI; replaces the lumen stage
    std::string until;                 ///< last stage to run; empty: all
    std::vector<glm::dvec3> seedsMm, excludesMm;
    int threads = 0;
    std::function<void(const std::string& stage, double fraction)> progress;
    std::function<void(const std::string& line)> log;
};

/// What one stage cost.
struct StageReport {
    std::string stage;
    bool reused = false;  ///< its products were in the store already
    double wallSeconds = 0.0;
    double peakMemoryMb = 0.0;
};

struct PrepareReport {
    std::vector<StageReport> stages;
    std::vector<std::string> notes;
};

/// Stages in order, by the names that `until` takes.
const std::vector<std::string>& stageNames();

Result<PrepareReport> prepare(const store::CaseStore& store, const std::string& caseName,
                              const PrepareOptions& options);

}  // namespace haustra::pipeline
