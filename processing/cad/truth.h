// What is truly there: lesions that somebody, or a generator, has marked.
#pragma once

#include "core/result.h"

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cad {

struct TrueLesion {
    glm::dvec3 positionMm{0.0};  ///< centre; of a pedunculated one, of its head
    glm::dvec3 wallMm{0.0};      ///< its foot
    double diameterMm = 0.0;
    double heightMm = 0.0;
    std::string kind;  ///< "sessile", "pedunculated", "flat"; or "untagged_stool", "film" …
    /// Else hyperplastic, which is neither praised nor blamed, or no growth at all: stool, a film,
    /// the valve, a tube.
    bool neoplastic = true;
    /// How much denser than the wall its inside is, HU; empty: nobody has told.
    std::optional<double> coreHu = {};
    double submergedShare = 0.0;  ///< of its height, under fluid
    double untaggedShare = 0.0;   ///< of its height, in fluid or stool without tagging
    double filmMm = 0.0;          ///< thickness of the residue that coats it

    /// From how far a finding is taken to mean it: half its diameter and 3 mm, at least 5 mm.
    double reachMm() const;
    /// From a place to its centre, or to its foot where that is nearer and it has no stalk.
    double distanceMm(glm::dvec3 placeMm) const;
    /// A small benign growth of mucosa, which looks like a polyp and is one to a reader.
    bool hyperplastic() const { return kind == "hyperplastic"; }
    /// Whether who tells it is right; empty: neither praised nor blamed.
    std::optional<bool> isPolyp() const {
        return hyperplastic() ? std::nullopt : std::optional(neoplastic);
    }
    /// Mostly in fluid or stool without tagging, whose HU are near its own: most scans do not show
    /// it.
    bool hidden() const { return untaggedShare > 0.5; }
    /// Mostly under fluid, and not hidden by it.
    bool submerged() const { return submergedShare > 0.5 && !hidden(); }
};

/// A list of lesions: {"growths": [{"kind", "neoplastic", "position_mm", "wall_mm", "diameter_mm",
/// "height_mm", "core_hu", "submerged_share", "untagged_share", "film_mm"}, …]}, other
/// members not being read; or
/// {"findings": [{"position_mm", "diameter_mm", "kind"}, …]}, the same with less told. Of one that
/// does not tell, all but hyperplastic ones are neoplastic. Fails (badInput) where it is neither,
/// or a lesion lies outside any body (±100 m), is wider than 300 mm, or is hyperplastic and
/// neoplastic.
Result<std::vector<TrueLesion>> truthOfJson(const std::string& text, const std::string& place);

/// Of a phantom's structure.json what may be taken for polyps and is no lesion: the ileocecal valve
/// ({"valve": {"position_mm"}}, or null) and the tube in the rectum ({"rectal_tube": {"axis_mm",
/// "shaft_radius_mm", "balloon_mm", "balloon_radius_mm"}}, or missing), as balls along its shaft
/// and one for the balloon, of kinds "valve" and "tube". Fails (badInput) where it is neither.
Result<std::vector<TrueLesion>> mimicsOfJson(const std::string& text, const std::string& place);

/// Of each place the lesion that it means: the nearest of those that it reaches, neoplastic ones
/// before others; −1: none.
std::vector<int> matched(const std::vector<glm::dvec3>& places,
                         const std::vector<TrueLesion>& lesions);

}  // namespace haustra::cad
