#include "cad/examined_colon.h"

#include <utility>

namespace haustra::cad {

ExaminedColon::ExaminedColon(const PreparedColon& colon, const EvidenceOptions& options)
    : colon_(colon), evidence_(gatherEvidence(colon, options)) {
    const auto edges = wallEdges(colon, evidence_);
    if (!edges) return;
    std::optional<WallEdges> ofSoftened;
    if (auto soft = softened(colon, evidence_, *edges, options.threads)) {
        softened_ = std::make_unique<const SoftenedScan>(*std::move(soft));
        colon_.emplace(PreparedColon{softened_->ct, softened_->cleansed, colon.lumen, colon.surface,
                                     colon.flat, colon.centerline, colon.tissue, colon.pieces,
                                     colon.rebuilt});
        EvidenceOptions again = options;
        again.progress = {};
        evidence_ = gatherEvidence(*colon_, again, std::move(evidence_));
        ofSoftened = wallEdges(*colon_, evidence_);
    }
    edgeWarning_ = warningOfEdges(*edges, ofSoftened);
}

}  // namespace haustra::cad
