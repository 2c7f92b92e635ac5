// The optical model (core/optics.h) among the renderer's names.
#pragma once

#include "core/optics.h"
#include "core/result.h"

#include <string>
#include <vector>

namespace haustra::render {

using haustra::checkOptics;
using haustra::checkTransferFunction;
using haustra::Composition;
using haustra::firstHitBisections;
using haustra::firstHitOpacity;
using haustra::GradientRow;
using haustra::Headlight;
using haustra::headlight;
using haustra::longestPreIntegratedStep;
using haustra::Optics;
using haustra::terminationOpacity;
using haustra::TransferFunction;
using haustra::TransferFunctionPoint;

/// Names of the built-in presets (optics_presets.h), the default ("mucosa") first; and one of them.
/// Fails (badInput), naming them all.
const std::vector<std::string>& opticsPresets();
Result<Optics> opticsPreset(const std::string& name);

}  // namespace haustra::render
