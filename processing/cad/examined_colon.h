// A colon as detection looks at it.
#pragma once

#include "cad/edge_softening.h"
#include "cad/wall_evidence.h"

#include <memory>
#include <optional>
#include <string>

namespace haustra::cad {

/// The colon and what is known of its wall; where its scan's kernel enhances edges, of a copy
/// without that (edge_softening.h). What the given colon points at outlives it. Immutable.
class ExaminedColon {
public:
    ExaminedColon(const PreparedColon& colon, const EvidenceOptions& options);

    const PreparedColon& colon() const { return *colon_; }
    const WallEvidence& evidence() const { return evidence_; }
    /// A warning for readers where edges are unlike those that detection has learnt from.
    const std::optional<std::string>& edgeWarning() const { return edgeWarning_; }

private:
    std::unique_ptr<const SoftenedScan> softened_;  // which *colon_ points at
    std::optional<PreparedColon> colon_;
    WallEvidence evidence_;
    std::optional<std::string> edgeWarning_;
};

}  // namespace haustra::cad
