// The free-response ROC curve as a picture and as a table.
#pragma once

#include "cad/evaluate.h"
#include "core/image.h"
#include "core/result.h"

#include <string>
#include <vector>

namespace haustra::cli {

/// A line of names, false_positives_per_scan,sensitivity_from_6_mm,low,high,threshold, then a line
/// for each point.
std::string frocCsv(const std::vector<cad::FrocPoint>& curve);

/// Sensitivity over false positives a scan, these by powers of two, with the bootstrap's band; the
/// title is printable ASCII.
Result<Image> frocPicture(const std::vector<cad::FrocPoint>& curve, const std::string& title);

}  // namespace haustra::cli
