// Optics as messages: both ends of the link speak of them.
#pragma once

#include "core/optics_preset.h"
#include "core/result.h"
#include "protocol/haustra.pb.h"

namespace haustra::protocol {

/// Replaces all that `message` holds.
void fill(Optics& message, const haustra::Optics& optics);
void fill(OpticsPreset& message, const haustra::OpticsPreset& preset);

/// Fail (badInput) where the composition is unknown, or the optics do not pass checkOptics; a
/// preset's also where its name is none.
Result<haustra::Optics> opticsFrom(const Optics& message);
Result<haustra::OpticsPreset> presetFrom(const OpticsPreset& message);

}  // namespace haustra::protocol
