// DCMTK's process-wide set-up.
#pragma once

#include <cstddef>

namespace haustra::dicom {

/// Registers the decoders and silences DCMTK's own log, once; every file that calls DCMTK calls
/// this first. Thread-safe.
void prepareDicomLibrary();

/// What DCMTK's JPEG decoders have warned of in this thread, in sum. They go on where they can, and
/// tell it to the log alone.
struct JpegWarnings {
    std::size_t damages = 0;         ///< pixels were made up
    std::size_t bytesBeforeEnd = 0;  ///< were left when all pixels were there: padding, or worse
};
JpegWarnings jpegWarnings();

}  // namespace haustra::dicom
