// DCMTK's process-wide set-up.
#pragma once

#include <cstddef>

namespace haustra::dicom {

/// Registers the decoders and silences DCMTK's own log, once; every file that calls DCMTK calls
/// this first. Thread-safe.
void prepareDicomLibrary();

/// How often DCMTK's JPEG decoders have made pixels up in this thread, as data is damaged. They go
/// on where they can, and tell it to the log alone.
std::size_t jpegDamages();

}  // namespace haustra::dicom
