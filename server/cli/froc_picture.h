// The free-response ROC curve as a picture and as a table.
#pragma once

#include "cad/evaluate.h"
#include "core/image.h"
#include "core/result.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::cli {

/// What must be read beside any figure of ours, in lines of printable ASCII, none too long for the
/// picture: that it is of phantoms, and what the field and the dissertation reached.
inline constexpr std::array<std::string_view, 5> frocNotes{
    "Of phantoms, unless the cases are patients'; phantoms say nothing of patients.",
    "On patients: 90 % of polyps from 6 mm and 96 % from 10 mm at 4.7 false positives a series",
    "(3,046 patients; Radiology 2010;256:791).",
    "The dissertation's table 6.1: all polyps at 2.9 and 3.5 false positives a series, 97.1 and",
    "96.1 % of the false candidates rejected."};

/// The notes, each behind "# "; a line of names,
/// false_positives_per_scan,sensitivity_from_6_mm,low,high,threshold; then a line for each point.
std::string frocCsv(const std::vector<cad::FrocPoint>& curve);

/// Sensitivity over false positives a scan, these by powers of two, with the bootstrap's band and
/// the notes; the title is printable ASCII.
Result<Image> frocPicture(const std::vector<cad::FrocPoint>& curve, const std::string& title);

}  // namespace haustra::cli
