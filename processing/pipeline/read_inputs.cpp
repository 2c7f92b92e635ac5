#include "pipeline/read_inputs.h"

#include "dicom/import_series.h"
#include "nifti/nifti_file.h"

#include <algorithm>
#include <cctype>
#include <system_error>

namespace haustra::pipeline {
namespace {

std::string describeSize(glm::ivec3 size) {
    return std::to_string(size.x) + "×" + std::to_string(size.y) + "×" + std::to_string(size.z);
}

// Masks that other programs write carry a rounded copy of the scan's affine.
bool almostSameGrid(const Grid& a, const Grid& b) {
    const glm::dvec3 spacing = b.spacingMm();
    const double toleranceMm = 0.05 * std::min({spacing.x, spacing.y, spacing.z});
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 v =
            glm::dvec3(a.size - 1) * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const double apartMm =
            glm::distance(a.patientFromVoxelPoint(v), b.patientFromVoxelPoint(v));
        if (!(apartMm <= toleranceMm)) return false;
    }
    return true;
}

}  // namespace

bool isNiftiName(const std::filesystem::path& file) {
    std::string name = file.filename().string();
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    const auto endsIn = [&](const std::string& ending) {
        return name.size() > ending.size() &&
               name.compare(name.size() - ending.size(), ending.size(), ending) == 0;
    };
    return endsIn(".nii") || endsIn(".nii.gz");
}

Result<ScanInput> readScan(const std::filesystem::path& series, const std::string& seriesUid,
                           int threads, const Progress& progress) {
    std::error_code ignored;
    if (!isNiftiName(series) || std::filesystem::is_directory(series, ignored)) {
        auto imported = dicom::importSeries(series, {seriesUid, threads, progress});
        if (!imported) return tl::make_unexpected(imported.error());
        return ScanInput{std::move(imported->scan), imported->summary.images,
                         std::move(imported->notes)};
    }
    if (!seriesUid.empty()) {
        return fail(ErrorKind::badInput, "a NIfTI file has no series to choose from",
                    series.string());
    }
    auto volume = nifti::readNifti<std::int16_t>(series);
    if (!volume) return tl::make_unexpected(volume.error());
    return ScanInput{{std::move(*volume), PatientPosition::unknown}, 1, {}};
}

Result<MaskInput> readLumenMask(const std::filesystem::path& file, const Grid* scanGrid) {
    auto read = nifti::readNifti<std::uint8_t>(file);
    if (!read) return tl::make_unexpected(read.error());
    if (scanGrid && read->grid().size != scanGrid->size) {
        return fail(ErrorKind::badInput,
                    "the mask has " + describeSize(read->grid().size) + " voxels, the scan " +
                        describeSize(scanGrid->size),
                    file.string());
    }
    if (scanGrid && !almostSameGrid(read->grid(), *scanGrid)) {
        return fail(ErrorKind::badInput,
                    "the mask's voxels lie at other places in the patient than the scan's",
                    file.string());
    }
    MaskInput mask{Volume<std::uint8_t>(scanGrid ? *scanGrid : read->grid()), {}};
    const auto labels = mask.labels.writable();
    std::size_t inside = 0, others = 0;
    for (std::size_t n = 0; n < labels.size(); ++n) {
        const std::uint8_t value = (*read)[n];
        inside += value != 0;
        others += value > 2;
        labels[n] = value > 2 ? std::uint8_t(LumenLabel::air) : value;
    }
    if (inside == 0) return fail(ErrorKind::noResult, "the mask is empty", file.string());
    if (others > 0) {
        mask.notes.push_back("mask values other than 0, 1 and 2 were taken as air-filled lumen");
    }
    return mask;
}

}  // namespace haustra::pipeline
