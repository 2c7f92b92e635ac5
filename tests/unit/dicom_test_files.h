// DICOM files changed or made with DCMTK, for the DICOM tests.
#pragma once

#include "dicom_test_series.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpls/djencode.h>

namespace haustra::tests {

/// Changes a file's data set in place.
inline void edit(const std::filesystem::path& file,
                 const std::function<void(DcmDataset&)>& change) {
    DcmFileFormat format;
    ASSERT_TRUE(format.loadFile(OFFilename(file.c_str())).good()) << file;
    ASSERT_TRUE(format.loadAllDataIntoMemory().good());
    change(*format.getDataset());
    const E_TransferSyntax syntax = format.getDataset()->getOriginalXfer();
    ASSERT_TRUE(format.saveFile(OFFilename(file.c_str()), syntax).good()) << file;
}

inline void set(const std::filesystem::path& file, const DcmTagKey& tag, const std::string& value) {
    edit(file, [&](DcmDataset& dataset) {
        ASSERT_TRUE(dataset.putAndInsertString(tag, value.c_str()).good());
    });
}

/// Saves a file anew in `syntax`, with or without preamble and meta information.
inline void rewrite(const std::filesystem::path& file, E_TransferSyntax syntax,
                    E_FileWriteMode mode = EWM_fileformat) {
    DcmRLEEncoderRegistration::registerCodecs();
    DJEncoderRegistration::registerCodecs();
    DJLSEncoderRegistration::registerCodecs();
    DcmFileFormat format;
    ASSERT_TRUE(format.loadFile(OFFilename(file.c_str())).good()) << file;
    ASSERT_TRUE(format.loadAllDataIntoMemory().good());
    DcmDataset& dataset = *format.getDataset();
    ASSERT_TRUE(dataset.chooseRepresentation(syntax, nullptr).good());
    ASSERT_TRUE(dataset.canWriteXfer(syntax));
    ASSERT_TRUE(format
                    .saveFile(OFFilename(file.c_str()), syntax, EET_UndefinedLength, EGL_recalcGL,
                              EPD_noChange, 0, 0, mode)
                    .good());
}

inline std::vector<std::filesystem::path> filesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

/// "x\y\z" with six decimals.
inline std::string triple(glm::dvec3 v) {
    return std::to_string(v.x) + "\\" + std::to_string(v.y) + "\\" + std::to_string(v.z);
}

/// Writes `scan` as one enhanced multi-frame CT file, its frames in shuffled order; the rescale of
/// each frame is its own: stored = HU + 10 · slice.
inline void writeEnhanced(const std::filesystem::path& file, const CtScan& scan) {
    const TemporaryFolder folder;
    write(folder.path(), scan);
    DcmFileFormat format;
    ASSERT_TRUE(format.loadFile(OFFilename((folder / "0001.dcm").c_str())).good());
    DcmDataset& dataset = *format.getDataset();
    for (const DcmTagKey& tag :
         {DCM_ImagePositionPatient, DCM_ImageOrientationPatient, DCM_PixelSpacing,
          DCM_SliceThickness, DCM_RescaleIntercept, DCM_RescaleSlope, DCM_RescaleType}) {
        delete dataset.remove(tag);
    }
    const Grid& grid = scan.hu.grid();
    const glm::dvec3 spacing = grid.spacingMm();
    dataset.putAndInsertString(DCM_SOPClassUID, UID_EnhancedCTImageStorage);
    dataset.putAndInsertString(DCM_NumberOfFrames, std::to_string(grid.size.z).c_str());
    DcmItem* shared = nullptr;
    DcmItem* item = nullptr;
    dataset.findOrCreateSequenceItem(DCM_SharedFunctionalGroupsSequence, shared, -2);
    shared->findOrCreateSequenceItem(DCM_PlaneOrientationSequence, item, -2);
    const std::string orientation = triple(glm::dvec3(grid.patientFromVoxel[0]) / spacing.x) +
                                    "\\" + triple(glm::dvec3(grid.patientFromVoxel[1]) / spacing.y);
    item->putAndInsertString(DCM_ImageOrientationPatient, orientation.c_str());
    shared->findOrCreateSequenceItem(DCM_PixelMeasuresSequence, item, -2);
    item->putAndInsertString(
        DCM_PixelSpacing, (std::to_string(spacing.y) + "\\" + std::to_string(spacing.x)).c_str());

    std::vector<int> slices(std::size_t(grid.size.z));
    for (std::size_t n = 0; n < slices.size(); ++n)
        slices[n] = int(n);
    std::shuffle(slices.begin(), slices.end(), std::mt19937(7));
    const std::size_t plane = std::size_t(grid.size.x) * std::size_t(grid.size.y);
    std::vector<Uint16> pixels;
    for (int k : slices) {
        DcmItem* frame = nullptr;
        dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, frame, -2);
        frame->findOrCreateSequenceItem(DCM_PlanePositionSequence, item, -2);
        item->putAndInsertString(DCM_ImagePositionPatient,
                                 triple(grid.patientFromVoxelPoint({0, 0, k})).c_str());
        frame->findOrCreateSequenceItem(DCM_PixelValueTransformationSequence, item, -2);
        item->putAndInsertString(DCM_RescaleIntercept, std::to_string(-10 * k).c_str());
        item->putAndInsertString(DCM_RescaleSlope, "1");
        for (std::size_t n = 0; n < plane; ++n)
            pixels.push_back(Uint16(scan.hu[std::size_t(k) * plane + n] + 10 * k));
    }
    dataset.putAndInsertUint16Array(DCM_PixelData, pixels.data(),
                                    static_cast<unsigned long>(pixels.size()));
    ASSERT_TRUE(format.saveFile(OFFilename(file.c_str()), EXS_LittleEndianExplicit).good());
}

/// The bytes of one frame, in one or more fragments.
using Fragments = std::vector<std::vector<Uint8>>;

/// Replaces a file's pixels by compressed streams, one a frame, behind an offset table or an empty
/// one.
inline void wrap(const std::filesystem::path& file, const std::vector<Fragments>& frames,
                 E_TransferSyntax syntax, bool hasTable = true) {
    DcmFileFormat format;
    ASSERT_TRUE(format.loadFile(OFFilename(file.c_str())).good()) << file;
    ASSERT_TRUE(format.loadAllDataIntoMemory().good());
    DcmDataset& dataset = *format.getDataset();
    auto* sequence = new DcmPixelSequence(DCM_PixelSequenceTag);
    auto* table = new DcmPixelItem(DCM_PixelItemTag);
    sequence->insert(table);
    std::vector<Uint8> offsets;
    Uint32 at = 0;
    for (const Fragments& fragments : frames) {
        for (int shift = 0; shift < 32; shift += 8)
            offsets.push_back(Uint8(at >> shift));
        for (const std::vector<Uint8>& fragment : fragments) {
            auto* item = new DcmPixelItem(DCM_PixelItemTag);
            item->putUint8Array(fragment.data(), static_cast<unsigned long>(fragment.size()));
            sequence->insert(item);
            at += Uint32(item->getLength()) + 8;
        }
    }
    if (hasTable) table->putUint8Array(offsets.data(), static_cast<unsigned long>(offsets.size()));
    delete dataset.remove(DCM_PixelData);
    auto* pixels = new DcmPixelData(DCM_PixelData);
    pixels->putOriginalRepresentation(syntax, nullptr, sequence);
    ASSERT_TRUE(dataset.insert(pixels, OFTrue).good());
    ASSERT_TRUE(format.saveFile(OFFilename(file.c_str()), syntax).good());
}
inline void wrapJpeg2000(const std::filesystem::path& file, const std::vector<Fragments>& frames) {
    wrap(file, frames, EXS_JPEG2000LosslessOnly);
}

/// The fragments of a compressed single-frame file.
inline Fragments fragmentsOf(const std::filesystem::path& file) {
    DcmFileFormat format;
    EXPECT_TRUE(format.loadFile(OFFilename(file.c_str())).good()) << file;
    DcmElement* element = nullptr;
    format.getDataset()->findAndGetElement(DCM_PixelData, element);
    auto* pixels = dynamic_cast<DcmPixelData*>(element);
    E_TransferSyntax syntax = EXS_Unknown;
    const DcmRepresentationParameter* parameter = nullptr;
    DcmPixelSequence* sequence = nullptr;
    if (!pixels) return {};
    pixels->getOriginalRepresentationKey(syntax, parameter);
    pixels->getEncapsulatedRepresentation(syntax, parameter, sequence);
    Fragments fragments;
    for (unsigned long n = 1; sequence && n < sequence->card(); ++n) {
        DcmPixelItem* item = nullptr;
        Uint8* bytes = nullptr;
        if (sequence->getItem(item, n).bad() || item->getUint8Array(bytes).bad()) return {};
        fragments.emplace_back(bytes, bytes + item->getLength());
    }
    return fragments;
}

inline std::vector<Uint8> joined(const Fragments& fragments) {
    std::vector<Uint8> bytes;
    for (const std::vector<Uint8>& fragment : fragments)
        bytes.insert(bytes.end(), fragment.begin(), fragment.end());
    return bytes;
}

}  // namespace haustra::tests
