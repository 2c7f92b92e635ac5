// Whether a scan goes on evenly from slice to slice.
#pragma once

#include "core/volume.h"

#include <cstdint>
#include <optional>
#include <string>

namespace haustra {

/// A warning for readers of a scan (HU, slices along k) in which neighbouring slices differ far
/// more than those around them do, or not at all: the patient breathed or moved between them, or a
/// slice does not belong where it lies, is damaged, or was stored twice. It names the heights of
/// the widest step. None of a scan that goes on evenly. The same for any number of threads.
///
/// The measure is the mean |HU| difference of two slices, of HU clamped to −1024 … 600, over its
/// median among the five steps to either side. Of scans as scanners make them it stays below 1.5.
std::optional<std::string> unevenStepsOf(const Volume<std::int16_t>& hu, int threads);

}  // namespace haustra
