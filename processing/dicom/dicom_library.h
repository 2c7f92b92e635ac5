// DCMTK's process-wide set-up.
#pragma once

namespace haustra::dicom {

/// Registers the decoders and silences DCMTK's own log, once; every file that calls DCMTK calls
/// this first. Thread-safe.
void prepareDicomLibrary();

}  // namespace haustra::dicom
