// What prepare knows of an organ: a profile, read from JSON (README.md in this folder has the
// format).
#pragma once

#include "core/result.h"
#include "core/tissue.h"

#include <string>
#include <string_view>

namespace haustra::organs {

enum class LumenFinder {
    gasAndTagged,  ///< bowel gas, and tagged fluid and stool: topology/lumen.h
    huRange,       ///< connected voxels of a range of HU: segmentation/hu_range_lumen.h
};
enum class ExpectedTopology {
    ball,  ///< handles are leaks and are cut
    any,   ///< handles are the organ's own
};
enum class EndPoints {
    rectumCecum,  ///< by the anatomy of the colon
    farthest,     ///< the two points of the lumen that are farthest apart along it
};

struct OrganProfile {
    std::string organ;
    LumenFinder finder = LumenFinder::gasAndTagged;
    TissuePriors tissues;      ///< of gasAndTagged
    HuRange contentHu;         ///< of huRange
    double smoothingMm = 0.0;  ///< of huRange: against noise; 0: none
    double openingMm = 0.0;    ///< of huRange: narrower necks are cut off; 0: none
    bool cleanse = false;
    ExpectedTopology topology = ExpectedTopology::ball;
    EndPoints endPoints = EndPoints::farthest;
    bool branches = false;  ///< the centerline keeps them
    bool flatten = false;   ///< a tube between the centerline's ends: its surface is mapped flat
    bool detectPolyps = false;  ///< of a colon: places that may be polyps are sought
};

/// A profile from its text. Fails (badInput), naming `place` and the field, where the text is not
/// JSON, a field is missing, unknown, of the wrong type or out of range, or contradicts another.
Result<OrganProfile> parseProfile(std::string_view json, const std::string& place);

/// The built-in profile of that name ("colon", "bladder", "vessel"), else the file of that path.
/// Fails (notFound) where there is neither.
Result<OrganProfile> readProfile(const std::string& nameOrFile);

/// What finding the lumen depends on, as text that is equal for equal profiles alone.
std::string segmentationOptions(const OrganProfile& profile);

const char* toString(ExpectedTopology topology);
const char* toString(EndPoints endPoints);

}  // namespace haustra::organs
