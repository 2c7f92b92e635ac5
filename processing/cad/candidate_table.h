// Candidates of a case as a small text, so that learning and judging go on without the scan.
#pragma once

#include "cad/detect.h"

#include <string>
#include <string_view>
#include <vector>

namespace haustra::cad {

/// What weighing, learning and judging use of candidates: centre, diameter, area, which generator
/// found it, of which it is another level, and features; JSON, a line each, numbers so that they
/// read back the same.
std::string candidateTable(const std::vector<Candidate>& candidates);
/// Reads it back; what else a candidate has (samples, body, voxels, probability) is empty. Fails
/// (badInput) where the text is none, (unsupported) where it has other features than this program.
Result<std::vector<Candidate>> candidatesOfTable(std::string_view text, const std::string& place);

}  // namespace haustra::cad
