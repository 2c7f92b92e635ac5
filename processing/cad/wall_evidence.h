// What is known of the wall at each of its samples, before anything is made of it.
#pragma once

#include "cad/along_colon.h"
#include "cad/biopsy.h"
#include "cad/former_fluid.h"
#include "cad/wall_samples.h"
#include "cad/wall_shape.h"
#include "core/centerline.h"
#include "core/colon_record.h"
#include "core/flat_map.h"
#include "core/parallel.h"
#include "core/tissue.h"
#include "core/volume.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace haustra::cad {

/// A prepared colon. What it points at outlives what is made of it; all volumes are on one grid.
struct PreparedColon {
    const Volume<std::int16_t>& ct;        ///< as it was scanned
    const Volume<std::int16_t>& cleansed;  ///< the same volume where nothing was cleansed
    const Volume<std::uint8_t>& lumen;     ///< LumenLabel
    const TriMesh& surface;
    const FlatMap& flat;
    const Centerline& centerline;
    TissueModel tissue;
    std::vector<ColonPiece> pieces;          ///< empty where nobody knows the colon's parts
    std::vector<RebuiltWallRecord> rebuilt;  ///< walls that the segmentation set up again
};

/// HU of what the electronic biopsy shows, measured on the scan itself.
struct WallStatistics {
    double wallHu = 0.0;  ///< of the wall's tissue
    double fatHu = 0.0;   ///< of fat around it
    /// Standard deviation in the smoothed scan. Too low by a tenth at 30 HU and two fifths at 60,
    /// as only places within 60 HU of soft tissue are counted; 0 where those are a hundred at most.
    double noiseHu = 0.0;
};

/// What an empty scanner measures.
inline constexpr double emptyHu = -1000.0;

/// At most this far apart lie neighbouring samples.
inline constexpr double sampleSpacingMm = 0.5;
/// Scale at which the wall's shape is measured. A polyp of 6 mm has twelve of it around; of a
/// standard scan's noise it leaves a tenth.
inline constexpr double shapeSigmaMm = 1.0;
/// A second scale for what is low and wide: a flat lesion is 2 mm high and 10 mm wide.
inline constexpr double broadSigmaMm = 2.2;

struct EvidenceOptions {
    /// The biopsy's colours; empty: derived from the scan (§7.2.5).
    std::optional<TransferFunction> transferFunction = {};
    int threads = 0;
    Progress progress = {};
};

struct WallEvidence {
    WallSamples samples;
    std::unique_ptr<const SmoothScan> smooth;  ///< the cleansed scan at shapeSigmaMm
    std::vector<WallShape> shapes;             ///< of each sample
    std::vector<WallShape> broadShapes;        ///< the same at broadSigmaMm
    std::vector<BiopsyRay> rays;
    /// Nobody has seen the wall there: it encloses a bridge, or was set up again after a leak.
    std::vector<std::uint8_t> unseen;
    /// Fluid without tagging stood before it, or something stands in the lumen there: water's
    /// contrast to tissue is less than most scans' noise, so that the wall's place is known to
    /// millimetres only, and its shape not at all.
    std::vector<std::uint8_t> untagged;
    std::vector<std::uint8_t> wet;                 ///< tagging stood before it, which was taken out
    FormerFluid formerFluid;                       ///< where that was
    std::unique_ptr<const AlongColon> alongColon;  ///< of the same colon
    WallStatistics statistics;
    TransferFunction transferFunction;  ///< that the rays were cast by
};

/// How deep the wall is looked into where it is thick all around (annular_wall.h).
inline constexpr double deepestWallMm = 30.0;
/// How far from the wall biopsy rays look.
inline constexpr double biopsyReachMm = biopsyStepMm * biopsySteps + 2.0;

/// The cleansed scan at a scale, in the box that reaches so far beyond the wall to each side.
SmoothScan smoothedAround(const PreparedColon& colon, double sigmaMm, int threads,
                          double reachMm = biopsyReachMm);

/// Wall and fat as the scan's tissue model has them, and the noise of `smooth` (at shapeSigmaMm),
/// by second differences along lines into the tissue beneath 40,000 to 80,000 of the surface's
/// vertices, where it has as many.
WallStatistics wallStatistics(const PreparedColon& colon, const SmoothScan& smooth);

/// `ofSurface`: evidence of the same surface and centerline in another scan, whole. It gives its
/// samples and its axis, which are the same, and is spent; empty: they are made.
WallEvidence gatherEvidence(const PreparedColon& colon, const EvidenceOptions& options,
                            WallEvidence ofSurface = {});

}  // namespace haustra::cad
