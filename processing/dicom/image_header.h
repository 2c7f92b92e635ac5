// What the import needs to know of one DICOM image file, pixels excepted.
#pragma once

#include "core/grid.h"
#include "core/result.h"
#include "dicom/stored_values.h"

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::dicom {

/// Where one frame lies and how its stored values become Hounsfield units.
struct FrameHeader {
    glm::dvec3 positionMm{0.0};        ///< centre of the first pixel, LPS (Image Position Patient)
    glm::dvec3 rowDirection{1, 0, 0};  ///< along increasing column index
    glm::dvec3 columnDirection{0, 1, 0};  ///< along increasing row index
    glm::dvec2 pixelSpacingMm{1.0};       ///< between columns (x), between rows (y)
    double thicknessMm = 0.0;             ///< 0 where the file does not say
    Rescale rescale;
};

struct ImageHeader {
    std::filesystem::path file;
    std::string studyUid;  ///< may be empty
    std::string seriesUid;
    std::string sopClassUid;
    std::string instanceUid;
    std::string frameOfReferenceUid;   ///< may be empty
    std::string studyDate, studyTime;  ///< may be empty
    std::string description;           ///< printable ASCII
    PatientPosition position = PatientPosition::unknown;
    bool localizer = false;  ///< a scout view: no part of a volume
    bool isLossy = false;    ///< its pixels have been compressed with loss
    glm::ivec2 matrix{0};    ///< columns, rows
    StoredFormat format;
    std::vector<FrameHeader> frames;  ///< one for a classic CT image
};

struct DicomFile {
    enum class Kind {
        notDicom,     ///< anything else: a picture, a text …
        otherObject,  ///< DICOM, but no CT image: a report, a directory, another modality
        ctImage,
        damaged,  ///< DICOM that cannot be parsed, or a CT image without what a volume needs
    };
    Kind kind = Kind::notDicom;
    Error reason;       ///< for any kind but ctImage, why the file gives no image; names the file
    ImageHeader image;  ///< for damaged, what was found: seriesUid may be empty
};

/// Reads everything before the pixels, in any transfer syntax, with or without preamble and file
/// meta information; single-frame CT and enhanced multi-frame CT. Thread-safe.
DicomFile readHeader(const std::filesystem::path& file);

}  // namespace haustra::dicom
