// The presets that a case has beside the server's: colours derived from its own scan.
#pragma once

#include "core/findings.h"
#include "core/result.h"
#include "render/optics/optics_presets.h"

#include <optional>

namespace haustra::session {

/// scanBiopsyPreset: biopsyPreset with the transfer function by which detection looked beneath this
/// case's wall; none where its findings do not tell. Fails where the server lacks biopsyPreset.
Result<std::optional<OpticsPreset>> scanBiopsyOf(const Findings& findings);

/// What the server offers, and the case's own; in the place of one of that name, or of the last
/// where there are mostPresets.
render::PresetLibrary withPresetOfCase(render::PresetLibrary offered,
                                       const std::optional<OpticsPreset>& own);

}  // namespace haustra::session
