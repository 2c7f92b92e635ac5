// A synthetic abdominal CT colonography with exact truth: an implicit model of the colon (axis,
// sacculations between three taeniae, semilunar folds, growths, fluid levelled by gravity) in a
// simple abdomen, sampled on a grid, then blurred and made noisy as a scanner does.
#pragma once

#include "core/centerline.h"
#include "core/ct_scan.h"
#include "core/findings.h"
#include "core/parallel.h"
#include "core/result.h"
#include "phantom/bowel_options.h"
#include "phantom/growth_options.h"
#include "phantom/structure.h"

#include <cstdint>
#include <string>
#include <vector>

namespace haustra::phantom {

/// Counts up when equal options make another phantom than before.
inline constexpr int phantomVersion = 3;

/// easy: little, even fluid; nothing opacified but the colon; other bowel keeps its distance.
/// standard: more fluid, unevenly tagged, stool balls, opacified and gas-filled small bowel against
/// the colon. hard: weak (200…400 HU), patchy tagging, untagged stool on the wall, twice the
/// noise, and a collapsed stretch of colon.
enum class Preset { easy, standard, hard };
/// small: 256×256×200 voxels of 1.5×1.5×2.1 mm; full: 512×512×400 of 0.75×0.75×1.05 mm;
/// photonCounting: 1024×1024×1000 of 0.35×0.35×0.4 mm, which takes some 10 GiB to make.
enum class Size { small, full, photonCounting };

/// How a phantom is scanned. A member that keeps its default leaves to the preset what it draws.
struct ScanOptions {
    /// Width of the reconstructed field, mm, 250…500, in place of the size's 384: small fields cut
    /// the arms and sides off, large ones have large pixels.
    double fieldOfViewMm = 0.0;
    /// Full widths at half maximum of the point spread along x, y and z, mm; z is the slice's
    /// thickness. In place of 0.85…1.15 mm in the plane and 1.2 mm across it.
    glm::dvec3 blurMm{0.0};
    /// Edge enhancement of a sharp kernel, 0…0.6: the spread is (1 + o) G(w) − o G(2.2 w) in the
    /// plane, which at an edge overshoots by about a tenth of the step for o = 0.5.
    double overshoot = 0.0;
    double noiseSdHu = 0.0;  ///< 0…100, in place of the preset's
    double grainMm = 1.1;    ///< full width of the noise's grain in the plane, 0.5…4
    /// Pseudo-enhancement: how much brighter (HU, 0…100) beam hardening and scatter make tissue at
    /// the flat edge of a large pool 1500 HU above gas. It falls off over about a centimetre within
    /// the slice, in which the rays lie (Näppi & Yoshida, Med. Image Anal. 2008; 12: 413).
    double pseudoEnhancementHu = 0.0;
    /// Streak noise where few photons pass, as between the hips, HU, 0…100: Streaks::noiseHu. In a
    /// pelvis as wide as 400 mm of water it comes in addition to noiseSdHu.
    double streakHu = 0.0;
    /// A total hip prosthesis, on a side and with a head (28, 32 or 36 mm, the usual ones of hip
    /// registries) that the seed draws: titanium cup and stem, head of cobalt-chrome, with the
    /// streaks of hardened beams.
    bool metalHip = false;
    /// The patient enters the scanner with the feet first: rows of the series run from left to
    /// right and its slices from head to feet (DICOM PS3.3 C.7.3.1.1.2). Of the series that is
    /// written alone: the phantom's volumes are the same.
    bool feetFirst = false;
};

struct PhantomOptions {
    std::uint64_t seed = 1;
    Preset preset = Preset::standard;
    PatientPosition position = PatientPosition::supine;  ///< any but unknown
    Size size = Size::full;
    BowelOptions bowel;
    GrowthOptions growths;
    ScanOptions scan;
    int threads = 0;
    Progress progress;
};

/// The options of the `wild` preset, a patient who has a bit of everything: of standard or hard,
/// and of all that BowelOptions and ScanOptions can add, what the seed draws. Position, size and
/// threads are the default ones; the draw does not depend on them, so a seed is one patient in
/// every position.
PhantomOptions wildOptions(std::uint64_t seed);

/// What a voxel holds beside the lumen's labels, to tell what was taken for colon by mistake.
enum class Site : std::uint8_t {
    elsewhere = 0,   ///< the body, and the colon's lumen
    ileum = 1,       ///< contents of the ileum that joins the cecum
    otherBowel = 2,  ///< contents of stomach and other small bowel
    lung = 3,
    outsideBody = 4,    ///< air, table
    colonWall = 5,      ///< wall, folds, growths, a closed stretch's muscle
    device = 6,         ///< rectal tube and balloon, within the colon's lumen and outside it
    untaggedFluid = 7,  ///< in the colon's lumen: water or stool that took no tagging
};

/// One thing that grows from the wall or lies on it.
struct GrowthTruth {
    std::string kind;            ///< "sessile", "pedunculated", "flat"; "hyperplastic"; "film" …
    bool neoplastic = false;     ///< a polyp that must be found
    glm::dvec3 positionMm{0.0};  ///< centre of the head
    glm::dvec3 wallMm{0.0};      ///< its foot
    double diameterMm = 0.0;     ///< largest; a stalk does not count
    double heightMm = 0.0;       ///< above the wall, stalk included
    double coreHu = 0.0;         ///< how much denser than its outside its middle is, about
    double densityHu = 0.0;      ///< how much denser than the wall its outside is
    bool onFold = false;
    double submergedShare = 0.0;  ///< of the head's height, under the fluid's level, 0…1
    double untaggedShare = 0.0;   ///< of the same height, in fluid that took no tagging
    double filmMm = 0.0;          ///< thickness of the tagged film over its top
};

struct Phantom {
    CtScan scan;
    /// The same scan and noise, with air where the colon's tagged fluid, stool and films were (what
    /// is opacified in other bowel stays).
    Volume<std::int16_t> untaggedHu;
    /// LumenLabel from the implicit geometry at each voxel's centre; `tagged` is all that is fluid,
    /// be it tagged or not, tagged stool and films. Diverticula are lumen; folds, polyps and
    /// untagged stool are not, nor is what lies beyond the orifice of the ileocecal valve. Loops
    /// with a septum thinner than a voxel still share no two neighbouring voxels.
    Volume<std::uint8_t> lumen;
    /// Site of each voxel.
    Volume<std::uint8_t> sites;
    /// The tube's axis; gaps where it is collapsed.
    Centerline centerline;
    /// Polyps of 4…15 mm. Hyperplastic bumps (smaller, not denser inside) are not among them.
    Findings polyps;
    /// Of each polyp in turn: the indices of the voxels whose centres lie in its tissue and would
    /// lie in the lumen without it, ascending.
    std::vector<std::vector<std::uint32_t>> polypVoxels;
    /// Everything that grows on the wall or lies on it; the neoplastic ones are `polyps`, in order.
    std::vector<GrowthTruth> growths;
    double noiseSdHu = 0.0;  ///< of both scans
    Structure structure;
};

/// Fails only for an unknown position and for options out of their range. Deterministic in the
/// options, byte for byte, whatever the number of threads.
Result<Phantom> makePhantom(const PhantomOptions& options);

}  // namespace haustra::phantom
