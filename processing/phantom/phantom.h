// A synthetic abdominal CT colonography with exact truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/centerline.h"
#include "core/ct_scan.h"
#include "core/findings.h"
#include "core/parallel.h"
#include "core/result.h"

namespace haustra::phantom {

enum class Preset { easy, standard, hard };
enum class Size { small, full };

struct PhantomOptions {
    std::uint64_t seed = 1;
    Preset preset = Preset::standard;
    PatientPosition position = PatientPosition::supine;  ///< supine or prone
    Size size = Size::full;
    int threads = 0;
    Progress progress;
};

struct Phantom {
    CtScan scan;
    Volume<std::int16_t> untaggedHu;  ///< the same scan and noise, with air where the tagging was
    Volume<std::uint8_t> lumen;       ///< LumenLabel
    Centerline centerline;
    Findings polyps;
};

/// Deterministic in the options, byte for byte, whatever the number of threads.
Result<Phantom> makePhantom(const PhantomOptions& options);

}  // namespace haustra::phantom
