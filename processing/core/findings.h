// Places in the colon that somebody, or something, wants a physician to judge.
#pragma once

#include "core/colon_record.h"
#include "core/grid.h"
#include "core/optics.h"
#include "core/result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

/// Neighbouring voxels of one row of a grid, along i.
struct VoxelRun {
    glm::ivec3 first{0};
    std::int32_t count = 0;
    bool operator==(const VoxelRun&) const = default;
};

/// The kind of a finding that is a stretch of wall, thick all around. Its centre is the lumen's,
/// its diameter the straight way between its ends, its height the wall's thickness, its arc the
/// stretch's middle, and its score fixed, as a rule tells it.
inline constexpr char annularKind[] = "annular";

struct Finding {
    glm::dvec3 positionMm{0.0};  ///< centre; of what stands on a stalk, of its head. LPS
    double diameterMm = 0.0;     ///< largest; a stalk does not count
    double score = 1.0;          ///< probability that it is a polyp, 0…1; 1 for truth
    std::string kind;            ///< "sessile", "pedunculated", "flat", annularKind; may be empty

    // What detection adds. Of a truth these are empty.
    glm::dvec3 wallMm{0.0};  ///< the place of the wall's surface that shows it best: its top
    /// Between which the diameter was taken.
    std::pair<glm::dvec3, glm::dvec3> diameterEndsMm{};
    double heightMm = 0.0;  ///< above the wall as it would be without it, stalk included
    /// Along the centerline, from the rectum: where the flat map has wallMm, or, without a map, the
    /// nearest point.
    double arcMm = 0.0;
    std::optional<ColonSegment> segment = {};  ///< where the colon's parts are known
    std::vector<std::pair<std::string, double>> features = {};
    /// Its tissue, of Findings::grid, in memory order; of what detection found also what lies right
    /// behind the wall that it takes up.
    std::vector<VoxelRun> voxels = {};
};

/// What made findings: a program and what it had learnt.
struct DetectionModel {
    std::string software;   ///< name and version of the program
    std::string name;       ///< of the model, with its version
    std::string sha256;     ///< of the model's file
    std::string trainedOn;  ///< for a reader: what of, and what that means
};

/// How the electronic biopsy of one scan is coloured, and from what that was derived (§7.2.5).
struct ScanBiopsy {
    double wallHu = 0.0;                ///< of the wall's tissue
    double fatHu = 0.0;                 ///< of the fat around it
    double noiseHu = 0.0;               ///< standard deviation in the smoothed scan; not negative
    TransferFunction transferFunction;  ///< 1-D, passes checkTransferFunction
    bool operator==(const ScanBiopsy&) const = default;
};

struct Findings {
    /// From the rectum to the cecum; of detection, those at or above the operating point.
    std::vector<Finding> findings;
    /// What detection weighed and scored lower, in the same order; a reader may ask for them.
    std::vector<Finding> candidates = {};
    double operatingPoint = 0.0;
    DetectionModel model = {};
    Grid grid = {};                          ///< that voxels are of
    std::vector<std::string> warnings = {};  ///< what a reader must know of how they were found
    double unexaminedMm2 = 0.0;              ///< wall that detection could not look at
    std::optional<ScanBiopsy> biopsy = {};   ///< by which detection looked beneath the wall
};

/// Most findings and candidates together, and most runs of voxels of one: far more than a reader
/// could judge. What reads them refuses more.
inline constexpr int maxFindings = 4096, maxFindingRuns = 1 << 16;

/// The `findings` product, JSON:
///   {"software", "model": {"name", "sha256", "trained_on"}, "operating_point", "warnings",
///    "unexamined_mm2",
///    "grid": {"size", "patient_from_voxel"},            16 numbers, rows of the affine
///    "biopsy": {"wall_hu", "fat_hu", "noise_hu",
///               "transfer_function": [{"hu", "color": [r,g,b], "opacity"}, …]},  as of a preset
///    "findings": [{"position_mm": [x,y,z], "diameter_mm", "score", "kind", "wall_mm",
///                  "diameter_ends_mm": [[x,y,z], [x,y,z]], "height_mm", "arc_mm", "segment",
///                  "features": {…}, "voxels": [[i,j,k,count], …]}, …],
///    "candidates": […]}
/// Lengths in mm to a thousandth, places in LPS. What a truth does not have is left out. Ends with
/// a new line.
std::string findingsJson(const Findings& findings);
/// Reads what findingsJson writes; of the rest, position_mm and diameter_mm of each finding are
/// enough. Fails (badInput) where the text is none, a number is out of any body's range, voxels
/// do not lie in the grid, or the biopsy's transfer function is not sound.
Result<Findings> findingsOfJson(const std::string& text, const std::string& place = "findings");

}  // namespace haustra
