// What either side may ask of the other: the bounds of PROTOCOL.md, each of them once. Those of the
// values that views are made of stand with the values, and have their names here too.
#pragma once

#include "core/findings.h"
#include "core/flat_map.h"
#include "core/patient_point.h"
#include "core/scan_values.h"
#include "core/seen_limits.h"
#include "core/view.h"

#include <cstddef>
#include <cstdint>

namespace haustra::protocol {

// ---- §3, frames: the greatest payloads
inline constexpr std::uint32_t maxClientControlBytes = 64 * 1024;
inline constexpr std::uint32_t maxServerControlBytes = 4 * 1024 * 1024;
inline constexpr std::uint32_t maxTileBytes = 16 * 1024 * 1024;

// ---- §4, viewports
/// Of a session: ids are 0…8, the last one only with a server that has capability::lens.
inline constexpr std::uint32_t maxViewports = 9;
inline constexpr std::uint32_t lensViewport = 8;  ///< the ninth, which this client has for its lens
inline constexpr std::uint32_t minViewportPixels = 16, maxViewportPixels = 2048;  ///< of each side

// ---- §4, what views show
using haustra::maxCoordinateMm;  ///< of each coordinate, either way
using haustra::maxMarkRadiusMm;
using haustra::maxObliqueMm;
using haustra::maxOverviewBookmarks;
using haustra::maxPanMm;
using haustra::maxSlabMm;
using haustra::maxSliceZoom;
using haustra::minMarkRadiusMm;
using haustra::minObliqueMm;
inline constexpr double maxTurns = 1e6;  ///< |x| of a place in the strip
using haustra::maxFlatHeight;            ///< |y| of a place in the strip, and the strip's height
/// Of a window onto the strip.
inline constexpr double minPixelsPerCircumference = 16.0, maxPixelsPerCircumference = 65536.0;

// ---- §4, measurements in the strip
inline constexpr int minLinePoints = 2, minOutlinePoints = 3, maxMeasuredPoints = 128;
inline constexpr double maxMeasuredTurns = 32.0;  ///< |x| of a measured point
inline constexpr double maxLineCircumferences = 256.0, maxOutlineCircumferences = 16.0;

// ---- §4, values of the scan
using haustra::maxHalfAxisMm;
using haustra::maxScanSamples;

// ---- §4, bookmarks
inline constexpr std::size_t maxNoteBytes = 2000;
inline constexpr std::size_t maxClientKeyBytes = 64;
/// What all bookmarks of a scan may take together, so that their list fits in one message: each
/// counts its note's and key's bytes and bookmarkOverheadBytes.
inline constexpr std::size_t maxScanBookmarkBytes = 4'000'000, bookmarkOverheadBytes = 256;
/// The newest ones have discs on the wall.
inline constexpr std::size_t maxMarkedBookmarks = 1024;

// ---- §4, the list of cases: a client shows so many, the first ones
inline constexpr std::size_t maxListedCases = 100'000;

// ---- §4, the trust in a colon
inline constexpr int maxWarnings = 200;
inline constexpr std::size_t maxWarningBytes = 400;

// ---- §4, findings
using haustra::maxFindings;  ///< of a list
/// Runs of voxels of all findings of a list together, so that it fits in one message.
inline constexpr std::size_t maxListedRuns = 150'000;
inline constexpr std::size_t maxFindingKindBytes = 40, maxModelNameBytes = 200,
                             maxTrainedOnBytes = 2000;

// ---- §4, what readers have seen
using haustra::leastSeenPixelsPerMm;
using haustra::mostSeenMs;  ///< of SeenLimits, and of a picture in one message
using haustra::mostSeenPixelsPerMm;
inline constexpr std::size_t maxReaderBytes = 64;
/// Of the pictures that were sent last so many can be told to have been on screen, and so many in
/// one message.
inline constexpr std::size_t maxShownPictures = 256;
inline constexpr int maxMissedPatches = 64;  ///< of a list: the largest
inline constexpr double leastListedMm2 = 1.0, mostListedMm2 = 1e6;
/// Kept of one wall, of all readers, and of each of them; of the newest a report tells so many,
/// each with its largest patches.
inline constexpr int maxWallLedgers = 256, maxReaderLedgers = 8, maxReportedLedgers = 32,
                     maxReportedPatches = 32;
/// Its flags, twice a bit each, fit in one message.
inline constexpr int maxLedgerTriangles = 1 << 23;

// ---- §7, requests without an answer: at most so much weight of them at a time
inline constexpr int maxUnanswered = 256, listWeight = 64, measurementWeight = 16;

}  // namespace haustra::protocol
