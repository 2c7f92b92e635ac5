// A case as its sessions see it, and what its renderer is made from.
#pragma once

#include "core/centerline.h"
#include "core/ct_scan.h"
#include "store/case_store.h"

#include <cstdint>
#include <string>

namespace haustra::session {

/// What sessions on a case share. Immutable.
struct OpenCase {
    std::string name;
    std::string content;  ///< equal for equal products of the same case
    Grid grid;
    PatientPosition position = PatientPosition::unknown;
    Centerline centerline;  ///< empty where the case has none yet
    bool cleansed = false;  ///< the endoscopic view shows the cleansed scan, slices can
};

/// The case's volumes, memory-mapped, beside what is known of it.
struct CaseFiles {
    OpenCase facts;
    Volume<std::int16_t> ct;
    Volume<std::int16_t> cleansed;  ///< empty where the case has none yet
};

/// Reads product "ct" of a case and, where they are there, "cleansed" and "centerline". Fails
/// (notFound) where there is no such case. Maps the volumes, reads no voxel.
Result<CaseFiles> readCase(const store::CaseStore& store, const std::string& name);

}  // namespace haustra::session
