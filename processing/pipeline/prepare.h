// prepare: from a CT series to the products that a reader needs. The one place that knows the
// order of the stages.
#pragma once

#include "core/bridges.h"
#include "core/colon_edits.h"
#include "core/result.h"
#include "store/case_store.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace haustra::pipeline {

struct PrepareOptions {
    /// DICOM folder or file, or a NIfTI file (whose patient position is unknown). May be empty
    /// where `lumenMask` is not: the mask is then of the scan that the case holds already, or of
    /// none.
    std::filesystem::path series;
    std::string seriesUid;            ///< which series of the folder; empty: its only one
    std::filesystem::path lumenMask;  ///< NIfTI; replaces the segmentation stage (readLumenMask)
    std::string organ = "colon";      ///< a built-in profile or a profile's file (organs/README.md)
    std::string until;  ///< last stage to run; empty: all. Not import without a series
    /// One of several scans of a case ("supine", "prone"): it is kept as the case "CASE.SCAN".
    std::string scan;
    bool replace = false;  ///< another scan may take the place of the one that the case is of
    /// Overrule the segmentation (patient, LPS); not with `lumenMask`.
    std::vector<glm::dvec3> seedsMm, excludesMm;
    std::vector<CutBall> cuts;  ///< of a colon: core/colon_edits.h
    std::vector<std::pair<glm::dvec3, glm::dvec3>> joins;
    /// Forget what earlier calls said of a colon; else that stands where this call says nothing.
    bool forgetEdits = false;
    /// How far the surface may be from the contoured one, at the samples that
    /// simplification/simplification.h names; between them it is not bounded. 0.001 to 10.
    double surfaceErrorMm = 0.1;
    /// Of the flat map, from 0 (angles are kept) to 1 (areas nearly are):
    /// flatten/tube/flattening.h.
    double areaWeight = 0.0;
    /// What detection has learnt, a file of `haustra cad train` or `calibrate`; empty: the built-in
    /// model.
    std::filesystem::path cadModel;
    int threads = 0;  ///< ≤ 0: all cores
    /// How far a stage is, 0…1. Called from the thread that called prepare.
    std::function<void(const std::string& stage, double fraction)> progress;
    /// One line for the log; nothing of the patient.
    std::function<void(const std::string& line)> log;
};

/// What one stage cost.
struct StageReport {
    std::string stage;
    bool reused = false;            ///< its products were in the store already
    std::vector<std::string> read;  ///< the products that it read; none where it was reused
    double wallSeconds = 0.0;
    double besideSeconds = 0.0;  ///< of them, those that passed beside the stages before it
    /// The most memory that the process held resident during the stage, MiB (mapped files count).
    double peakMemoryMib = 0.0;
};

struct PrepareReport {
    std::string caseName;  ///< as the store has it
    std::vector<StageReport> stages;
    /// Of the centerline: where it crosses from one segment of the lumen to the next, and the colon
    /// is collapsed or filled. Nothing there is mucosa that a reader could see.
    std::vector<Bridge> bridges;
    /// Of the surface: what encloses bridges, those too that the path does not take.
    double bridgedMm2 = 0.0;
    std::vector<std::string> notes;  ///< what the stages found worth telling, reused ones too
};

/// Stages in order, by the names that `until` takes: those of the catalogue (store/products.h).
const std::vector<std::string>& stageNames();

/// Makes a case's products, stage by stage: which, and from which others, the catalogue tells.
/// `quality` is made of a colon, `branches` where the organ's profile keeps them.
///
/// What seeds, excludes, cuts and joins say of a colon is kept as the product `edits` (JSON).
///
/// Mixture and cleansing run where there is a scan and the organ's profile says so; `lumen` comes
/// from the segmentation otherwise. Flattening and detection run where the profile says so. A stage
/// that fails leaves the products before it published. A colon that cannot be flattened is searched
/// for polyps before that is told. Stages whose products the store holds under
/// the same key (stage version, options, input keys; the first input is the content of the source
/// files), with sound bytes, are skipped. Killed at any moment it continues with the next call.
/// Holds the case's lock while it runs. The products are the same bytes for any number of threads.
///
/// The case is bound to the scan (pipeline/scan_identity.h), or to the mask where there is no scan.
/// Refused (badInput), with the case as it was: another scan than the case's without `replace`, and
/// a `scan` of another study than the case's other scans. With `replace` the former scan's products
/// go as the new scan's first is published; readers' bookmarks stay with the former scan, and are
/// there again when it is.
Result<PrepareReport> prepare(const store::CaseStore& store, const std::string& caseName,
                              const PrepareOptions& options);

}  // namespace haustra::pipeline
