// One call of prepare as its stages see it: the case they write, the organ, and what is done of it.
#pragma once

#include "core/parallel.h"
#include "organs/organ_profile.h"
#include "pipeline/prepare.h"
#include "pipeline/stage_case.h"
#include "pipeline/stage_meter.h"
#include "store/case_store.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace haustra::pipeline {

/// What mixture measures for cleansing too goes from the one to the other beside the store, and is
/// measured again where it is not at hand.
/// Belongs to one thread; beside it others may read the options, the organ and the case.
class Preparation {
public:
    /// `studyUid`: of the case's other scans; empty where there are none, or it is not known.
    Preparation(store::Case target, const PrepareOptions& options, organs::OrganProfile organ,
                std::string studyUid);

    const PrepareOptions& options() const { return options_; }
    const organs::OrganProfile& organ() const { return organ_; }

    /// Binds the case to the scan that is prepared; `importKey`, where given, is what its product
    /// "ct" has. Fails (badInput) where prepare refuses it.
    Result<void> bind(store::ScanIdentity scan,
                      const std::optional<store::ProductKey>& importKey = {});

    /// What this call says of the colon, which the case keeps as `edits`; or what an earlier one
    /// said.
    Result<ColonEdits> takeEdits();

    /// Not past `until`.
    bool wanted(const std::string& stage) const;

    /// The key that the case has the product under; none where it has none.
    std::optional<store::ProductKey> keyOf(const std::string& product) const;

    /// The case as a stage sees it. `without`: products that it does not make of this organ.
    StageCase open(const std::string& stage, const store::ProductKey& key,
                   const std::vector<std::string>& without = {}) {
        return {target_, stage, key, without};
    }

    /// Runs `make`, which publishes the stage's products, unless the case holds them all, sound,
    /// under the stage's key, which it returns. Either way the stage is reported, with the notes in
    /// its products' attributes.
    Result<store::ProductKey> run(
        const StageCase& stage, const StageMeter& meter,
        const std::function<Result<void>(const Progress& progress)>& make);

    /// A line for the report, of something that no product tells.
    void note(const std::string& line) { report_.notes.push_back(line); }
    /// The centerline's bridges, for the report.
    Result<void> noteBridges();
    /// How much of the surface encloses bridges.
    Result<void> noteBridgedWall();
    PrepareReport takeReport() { return std::move(report_); }

private:
    bool reusable(const StageCase& stage);

    store::Case target_;
    const PrepareOptions& options_;
    const organs::OrganProfile organ_;
    const std::string studyUid_;
    PrepareReport report_;
};

}  // namespace haustra::pipeline
