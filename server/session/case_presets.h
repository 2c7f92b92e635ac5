// The presets that a case has beside the server's: colours derived from its own scan.
#pragma once

#include "core/result.h"
#include "render/optics/optics_presets.h"
#include "store/case_store.h"

#include <optional>

namespace haustra::session {

/// scanBiopsyPreset: biopsyPreset with the transfer function by which detection looked beneath this
/// case's wall: of its product "findings"; none where that has none. Fails as reading it does.
Result<std::optional<OpticsPreset>> readScanBiopsy(const store::Case& source);

/// What the server offers, and the case's own; in the place of one of that name, or of the last
/// where there are mostPresets.
render::PresetLibrary withPresetOfCase(render::PresetLibrary offered,
                                       const std::optional<OpticsPreset>& own);

}  // namespace haustra::session
