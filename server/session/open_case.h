// A case as its sessions see it, and what its renderer is made from.
#pragma once

#include "core/centerline.h"
#include "core/colon_record.h"
#include "core/ct_scan.h"
#include "core/histogram.h"
#include "core/optics_preset.h"
#include "core/tri_mesh.h"
#include "core/volume.h"
#include "render/raycaster_choice.h"
#include "session/case_findings.h"
#include "session/wall.h"
#include "store/case_store.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haustra::session {

/// What sessions on a case share. Immutable.
struct OpenCase {
    std::string name;
    std::string scan;     ///< key of the scan that it is of: what bookmarks belong to
    std::string content;  ///< equal for equal products of the case, of those that are shown
    Grid grid;
    PatientPosition position = PatientPosition::unknown;
    std::optional<ColonTrust> trust;  ///< where a colon was searched for
    Centerline centerline;            ///< empty where the case has none yet
    /// Colours of the electronic biopsy that were derived from its scan, where they were.
    std::optional<OpticsPreset> scanBiopsy;
    Histogram histogram;    ///< of the scan that the endoscopic view shows
    bool cleansed = false;  ///< the endoscopic view shows the cleansed scan, slices can
    /// Memory-mapped, for questions about single values; the renderer has its own.
    std::shared_ptr<const Volume<std::int16_t>> ct;
    std::shared_ptr<const Volume<std::int16_t>> cleansedScan;  ///< empty where there is none
    std::shared_ptr<const TriMesh> surface;        ///< the wall's mesh, where the case has it
    std::shared_ptr<const Wall> wall;              ///< empty where the case has not been flattened
    std::shared_ptr<const CaseFindings> findings;  ///< empty where detection found nothing to read
    bool findingsDamaged = false;                  ///< there are some, which cannot be read
    /// What draws it, and what was measured to choose it (nothing where it was not).
    RaycasterKind raycaster = RaycasterKind::singlePass;
    std::vector<render::RaycasterTrial> trials;
};

/// The case's volumes, memory-mapped, beside what is known of it. Its wall has not been read.
struct CaseFiles {
    OpenCase facts;
    Volume<std::int16_t> ct;
    Volume<std::int16_t> cleansed;  ///< empty where the case has none yet
    bool flattened = false;         ///< there is a flat map
    bool surface = false;           ///< there is the wall's mesh
    bool findings = false;          ///< there is what detection found
};

/// Reads product "ct" of a case and, where they are there, "cleansed", "centerline" and "quality".
/// Maps the volumes, reads no voxel.
Result<CaseFiles> readCase(const store::Case& source);

/// Reads product "surface", the wall's mesh.
Result<std::shared_ptr<const TriMesh>> readSurface(const store::Case& source);

/// Reads product "flatmap", and which of it "lumen" knows for a bridge, and makes it ready for
/// questions: about a second for a million triangles, and some hundred bytes for each.
Result<std::shared_ptr<const Wall>> readWall(const store::Case& source);

}  // namespace haustra::session
