// Findings that may be one mass: a lobed carcinoma is told lobe by lobe, as each bulges both ways.
#pragma once

#include "core/findings.h"

#include <cstddef>
#include <span>
#include <vector>

namespace haustra::cad {

/// Findings that lie rim to rim.
struct MassOfFindings {
    std::vector<std::size_t> findings;  ///< their numbers, ascending
    double widthMm = 0.0;               ///< from rim to rim of all, at most
};

/// Of at least three findings, each within 3 mm of the rim of another, that are together at least
/// 20 mm wide; in the order of their first. C-RADS calls what is from 30 mm on a mass (Zalis et
/// al., Radiology 2005; 236: 3), but lobes at its rim are told too narrow, or not. What goes all
/// around is no lobe.
std::vector<MassOfFindings> massesOf(std::span<const Finding> findings);

}  // namespace haustra::cad
