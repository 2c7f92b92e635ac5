// One call of prepare as its stages see it: the case they write, the organ, and what is done of it.
#pragma once

#include "core/ct_scan.h"
#include "core/parallel.h"
#include "organs/organ_profile.h"
#include "pipeline/prepare.h"
#include "pipeline/stage_meter.h"
#include "store/case_store.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace haustra::pipeline {

/// Products by the order in which they are made, so that none comes from a later one.
namespace product {
inline constexpr char ct[] = "ct", segmentation[] = "segmentation", quality[] = "quality",
                      mixture[] = "mixture", cleansedLumen[] = "cleansed-lumen",
                      cleansed[] = "cleansed", lumen[] = "lumen", distance[] = "distance",
                      centerline[] = "centerline", branches[] = "branches", surface[] = "surface",
                      flatMap[] = "flatmap", edits[] = "edits";
}  // namespace product

/// The products that a product goes into, nearly or by way of others: what is outdated with it.
const std::vector<std::string>& madeFrom(const std::string& product);

/// One run of a stage. All its products are published under one key.
struct Stage {
    std::string name;
    store::ProductKey key;
    std::vector<std::string> products;
};

/// Stages hand products on through the store alone: each maps what it reads, page by page as it is
/// touched, and lets go of it at its end, so that no volume is held longer than it is needed. What
/// mixture measures for cleansing too is the one exception, and is measured again where it is not
/// at hand.
/// Belongs to one thread; beside it others may read the options, the organ and the case.
class Preparation {
public:
    /// `studyUid`: of the case's other scans; empty where there are none, or it is not known.
    Preparation(store::Case target, const PrepareOptions& options, organs::OrganProfile organ,
                std::string studyUid);

    store::Case& target() { return target_; }
    const PrepareOptions& options() const { return options_; }
    const organs::OrganProfile& organ() const { return organ_; }

    /// Binds the case to the scan that is prepared; `importKey`, where given, is what its product
    /// "ct" has. Fails (badInput) where prepare refuses it.
    Result<void> bind(store::ScanIdentity scan,
                      const std::optional<store::ProductKey>& importKey = {});

    /// Not past `until`.
    bool wanted(const std::string& stage) const;

    /// Runs `make`, which publishes the stage's products, unless the case holds them all, sound,
    /// under the stage's key. Either way the stage is reported, with the notes in its products'
    /// attributes.
    Result<void> run(const Stage& stage, const StageMeter& meter,
                     const std::function<Result<void>(const Progress& progress)>& make);

    /// The product `ct`, with its patient position.
    Result<CtScan> readScan() const;

    /// A line for the report, of something that no product tells.
    void note(const std::string& line) { report_.notes.push_back(line); }
    /// The centerline's bridges, for the report.
    Result<void> noteBridges();
    /// How much of the surface encloses bridges.
    Result<void> noteBridgedWall();
    PrepareReport takeReport() { return std::move(report_); }

private:
    bool reusable(const Stage& stage);

    store::Case target_;
    const PrepareOptions& options_;
    const organs::OrganProfile organ_;
    const std::string studyUid_;
    PrepareReport report_;
};

}  // namespace haustra::pipeline
