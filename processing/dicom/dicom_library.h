// DCMTK's process-wide set-up.
#pragma once

#include <cstddef>

namespace haustra::dicom {

/// Registers the decoders and silences DCMTK's own log, once; every file that calls DCMTK calls
/// this first. Thread-safe.
void prepareDicomLibrary();

/// How often DCMTK has warned in this thread. It writes none of that anywhere.
std::size_t libraryWarnings();

}  // namespace haustra::dicom
