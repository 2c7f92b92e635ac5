#include "dicom/write_series.h"

#include "core/parallel.h"
#include "dicom/dicom_library.h"
#include "dicom/written_values.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <mutex>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

namespace haustra::dicom {
namespace {

std::string decimals(std::initializer_list<double> values) {
    std::string text;
    for (double value : values) {
        if (!text.empty()) text += '\\';
        text += decimal(value);
    }
    return text;
}

std::string patientPositionCode(PatientPosition position, bool feetFirst) {
    const std::string end = feetFirst ? "FF" : "HF";
    switch (position) {
        case PatientPosition::supine:
            return end + "S";
        case PatientPosition::prone:
            return end + "P";
        case PatientPosition::leftDecubitus:
            return end + "DL";
        case PatientPosition::rightDecubitus:
            return end + "DR";
        case PatientPosition::unknown:
            break;
    }
    return "";
}

/// Slice k of the series: the patient's, or with the feet first the one from the other end, each
/// row the other way round, as the gantry sees it.
Volume<std::int16_t> sliceOf(const CtScan& scan, int k, bool feetFirst) {
    const Grid& from = scan.hu.grid();
    const std::size_t plane = std::size_t(from.size.x) * std::size_t(from.size.y);
    const glm::ivec3 corner =
        feetFirst ? glm::ivec3(from.size.x - 1, 0, from.size.z - 1 - k) : glm::ivec3(0, 0, k);
    Grid grid = from;
    grid.size.z = 1;
    grid.patientFromVoxel[3] = glm::dvec4(from.patientFromVoxelPoint(corner), 1.0);
    const auto voxels = scan.hu.voxels().subspan(std::size_t(corner.z) * plane, plane);
    if (!feetFirst) return Volume<std::int16_t>::view(grid, voxels.data(), nullptr);
    grid.patientFromVoxel[0] = -from.patientFromVoxel[0];
    grid.patientFromVoxel[2] = -from.patientFromVoxel[2];
    Volume<std::int16_t> slice(grid);
    for (std::size_t row = 0; row < plane; row += std::size_t(from.size.x))
        std::reverse_copy(voxels.data() + row, voxels.data() + row + from.size.x,
                          slice.writable().data() + row);
    return slice;
}

/// Collects the first failure of many insertions.
class Attributes {
public:
    explicit Attributes(DcmItem& item) : item_(item) {}
    void put(const DcmTagKey& tag, const std::string& value) {
        keep(item_.putAndInsertString(tag, value.c_str()));
    }
    void put(const DcmTagKey& tag, int value) {
        keep(item_.putAndInsertUint16(tag, Uint16(value)));
    }
    void putPixels(std::span<const std::int16_t> pixels) {
        keep(item_.putAndInsertUint16Array(DCM_PixelData,
                                           reinterpret_cast<const Uint16*>(pixels.data()),
                                           static_cast<unsigned long>(pixels.size())));
    }
    const OFCondition& condition() const { return condition_; }

private:
    void keep(const OFCondition& condition) {
        if (condition_.good()) condition_ = condition;
    }
    DcmItem& item_;
    OFCondition condition_ = EC_Normal;
};

void putPatientAndStudy(Attributes& out, const WriteOptions& options) {
    out.put(DCM_ImageType, "DERIVED\\PRIMARY\\AXIAL");
    out.put(DCM_Modality, "CT");
    out.put(DCM_Manufacturer, "Haustra");
    out.put(DCM_SeriesDescription, options.seriesDescription);
    out.put(DCM_PatientName, options.patientName);
    out.put(DCM_PatientID, options.patientId);
    out.put(DCM_StudyInstanceUID,
            uidOf((options.studySeed.empty() ? options.uidSeed : options.studySeed) + "/study"));
    out.put(DCM_SeriesInstanceUID, uidOf(options.uidSeed + "/series"));
    out.put(DCM_FrameOfReferenceUID, uidOf(options.uidSeed + "/frame of reference"));
    out.put(DCM_StudyID, "1");
    out.put(DCM_SeriesNumber, "1");
    // Required to be there, allowed to be empty.
    for (const DcmTagKey& tag : {DCM_StudyDate, DCM_StudyTime, DCM_AccessionNumber,
                                 DCM_ReferringPhysicianName, DCM_PatientBirthDate, DCM_PatientSex,
                                 DCM_KVP, DCM_AcquisitionNumber, DCM_PositionReferenceIndicator}) {
        out.put(tag, "");
    }
}

void putSlice(Attributes& out, const CtScan& scan, int k, const WriteOptions& options) {
    const Volume<std::int16_t> slice = sliceOf(scan, k, options.feetFirst);
    const Grid& grid = slice.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    const glm::dvec3 row = glm::dvec3(grid.patientFromVoxel[0]) / spacing.x;
    const glm::dvec3 column = glm::dvec3(grid.patientFromVoxel[1]) / spacing.y;
    const glm::dvec3 position = grid.patientFromVoxelPoint({0, 0, 0});
    out.put(DCM_SOPClassUID, UID_CTImageStorage);
    out.put(DCM_SOPInstanceUID, uidOf(options.uidSeed + "/slice " + std::to_string(k)));
    out.put(DCM_PatientPosition, patientPositionCode(scan.position, options.feetFirst));
    out.put(DCM_InstanceNumber, std::to_string(k + 1));
    out.put(DCM_ImagePositionPatient, decimals({position.x, position.y, position.z}));
    out.put(DCM_ImageOrientationPatient,
            decimals({row.x, row.y, row.z, column.x, column.y, column.z}));
    out.put(DCM_PixelSpacing, decimals({spacing.y, spacing.x}));
    out.put(DCM_SliceThickness, decimal(spacing.z));
    out.put(DCM_SamplesPerPixel, 1);
    out.put(DCM_PhotometricInterpretation, "MONOCHROME2");
    out.put(DCM_Rows, grid.size.y);
    out.put(DCM_Columns, grid.size.x);
    out.put(DCM_BitsAllocated, 16);
    out.put(DCM_BitsStored, 16);
    out.put(DCM_HighBit, 15);
    out.put(DCM_PixelRepresentation, 1);
    out.put(DCM_RescaleIntercept, "0");
    out.put(DCM_RescaleSlope, "1");
    out.put(DCM_RescaleType, "HU");
    out.putPixels(slice.voxels());
}

Result<void> writeSlice(const std::filesystem::path& file, const CtScan& scan, int k,
                        const WriteOptions& options) {
    DcmFileFormat format;
    Attributes attributes(*format.getDataset());
    putPatientAndStudy(attributes, options);
    putSlice(attributes, scan, k, options);
    OFCondition condition = attributes.condition();
    if (condition.good()) {
        condition = format.saveFile(OFFilename(file.c_str()), EXS_LittleEndianExplicit,
                                    EET_ExplicitLength, EGL_recalcGL, EPD_withoutPadding);
    }
    if (condition.bad()) {
        return fail(ErrorKind::io,
                    std::string("the DICOM file cannot be written: ") + condition.text(),
                    file.string());
    }
    return {};
}

Result<void> checkOrthogonal(const Grid& grid, const std::string& place) {
    TRY(checkGrid(grid, place));
    const glm::dvec3 spacing = grid.spacingMm();
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        const double cosine = glm::dot(glm::dvec3(grid.patientFromVoxel[a]) / spacing[a],
                                       glm::dvec3(grid.patientFromVoxel[b]) / spacing[b]);
        if (std::abs(cosine) > 1e-3) {
            return fail(ErrorKind::unsupported,
                        "a DICOM series needs a volume whose axes are orthogonal", place);
        }
    }
    return {};
}

}  // namespace

Result<void> writeSeries(const std::filesystem::path& directory, const CtScan& scan,
                         const WriteOptions& options) try {
    prepareDicomLibrary();
    const Grid& grid = scan.hu.grid();
    TRY(checkOrthogonal(grid, directory.string()));
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error) {
        return fail(ErrorKind::io, "the folder cannot be made: " + error.message(),
                    directory.string());
    }
    std::mutex mutex;
    Result<void> result;
    parallelFor(std::size_t(grid.size.z), 1, options.threads, [&](std::size_t k, std::size_t) {
        char name[16];
        std::snprintf(name, sizeof name, "%04d.dcm", int(k) + 1);
        if (auto written = writeSlice(directory / name, scan, int(k), options); !written) {
            std::lock_guard lock(mutex);
            if (result) result = written;
        }
    });
    return result;
} catch (const std::exception& error) {
    return fail(ErrorKind::io, std::string("the series cannot be written: ") + error.what(),
                directory.string());
}

}  // namespace haustra::dicom
