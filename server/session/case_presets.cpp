#include "session/case_presets.h"

#include "core/printed_text.h"

#include <algorithm>

namespace haustra::session {

Result<std::optional<OpticsPreset>> scanBiopsyOf(const Findings& findings) {
    if (!findings.biopsy) return std::optional<OpticsPreset>();
    const ScanBiopsy& biopsy = *findings.biopsy;
    OpticsPreset preset{
        scanBiopsyPreset,
        printed("Electronic biopsy with colours derived from this scan: its wall has %.0f HU, its "
                "fat %.0f, noise %.0f. Tissue beneath the wall by its density, red the highest, "
                "green the middle, blue the lowest.",
                biopsy.wallHu, biopsy.fatHu, biopsy.noiseHu),
        TRY(render::opticsPreset(biopsyPreset))};
    preset.optics.transferFunction = biopsy.transferFunction;
    return std::optional<OpticsPreset>(std::move(preset));
}

render::PresetLibrary withPresetOfCase(render::PresetLibrary offered,
                                       const std::optional<OpticsPreset>& own) {
    if (!own) return offered;
    auto& presets = offered.presets;
    const auto same = std::find_if(presets.begin(), presets.end(),
                                   [&](const OpticsPreset& p) { return p.name == own->name; });
    if (same != presets.end())
        *same = *own;
    else if (presets.size() < render::mostPresets)
        presets.push_back(*own);
    else
        presets.back() = *own;
    return offered;
}

}  // namespace haustra::session
