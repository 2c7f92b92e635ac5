#include "pipeline/read_inputs.h"

#include "dicom/import_series.h"
#include "dicom/stored_values.h"
#include "nifti/nifti_file.h"
#include "pipeline/axial_order.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <system_error>

namespace haustra::pipeline {
namespace {

std::string describeSize(glm::ivec3 size) {
    return std::to_string(size.x) + "×" + std::to_string(size.y) + "×" + std::to_string(size.z);
}

// Towards which side of the patient each stored axis runs: "LPS" is the order that the stages use.
std::string describeOrder(const AxisOrder& order) {
    std::string text(3, ' ');
    for (std::size_t axis = 0; axis < 3; ++axis)
        text[std::size_t(order.from[axis])] = (order.reversed[axis] ? "RAI" : "LPS")[axis];
    return text;
}

// Masks that other programs write carry a rounded copy of the scan's affine.
bool almostSameGrid(const Grid& a, const Grid& b) {
    const glm::dvec3 spacing = b.spacingMm();
    const double toleranceMm = 0.05 * std::min({spacing.x, spacing.y, spacing.z});
    if (a.size != b.size) return false;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 v =
            glm::dvec3(a.size - 1) * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
        const double apartMm =
            glm::distance(a.patientFromVoxelPoint(v), b.patientFromVoxelPoint(v));
        if (!(apartMm <= toleranceMm)) return false;
    }
    return true;
}

// Programs that reorder a scan's axes write its masks in either order.
std::optional<AxisOrder> orderOnGrid(const Grid& grid, const Grid& wanted) {
    for (const AxisOrder& order : allAxisOrders())
        if (almostSameGrid(reordered(grid, order), wanted)) return order;
    return std::nullopt;
}

ScanInput inAxialOrder(ScanInput input, int threads) {
    const AxisOrder order = axialOrder(input.scan.hu.grid());
    if (order == sameOrder) return input;
    input.scan.hu = reordered(std::move(input.scan.hu), order, threads);
    input.notes.push_back(
        "the voxels' axes were put in the order left, posterior, superior; they were stored as " +
        describeOrder(order));
    return input;
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

bool isNiftiFile(const std::filesystem::path& file) {
    std::error_code ignored;
    return isNiftiName(file) && !std::filesystem::is_directory(file, ignored);
}

Result<ScanInput> readScan(const std::filesystem::path& series, const std::string& seriesUid,
                           int threads, const Progress& progress) {
    if (!isNiftiFile(series)) {
        auto imported = TRY(dicom::importSeries(series, {seriesUid, threads, progress}));
        return inAxialOrder({std::move(imported.scan), imported.summary.images,
                             std::move(imported.notes), std::move(imported.source)},
                            threads);
    }
    if (!seriesUid.empty()) {
        return fail(ErrorKind::badInput, "a NIfTI file has no series to choose from",
                    series.string());
    }
    // What is not a number lies outside the field of view, as in DICOM what is padded.
    auto volume = TRY(nifti::readNifti<std::int16_t>(series, dicom::paddingHu));
    if (!volume.grid().hasRightAngles())
        return fail(ErrorKind::unsupported,
                    "its voxel axes are not at right angles, as of a tilted scan that was not "
                    "squared up; prepare the DICOM series, or resample it",
                    series.string());
    std::vector<std::string> notes;
    if (!TRY(nifti::saysHowItLies(series)))
        notes.push_back(
            "warning: the file does not say how its axes lie in the patient; they were taken to "
            "run to the right, the front and the head, so that left and right, and prone and "
            "supine, may be wrong");
    return inAxialOrder({{std::move(volume), PatientPosition::unknown}, 1, std::move(notes)},
                        threads);
}

Result<MaskInput> readLumenMask(const std::filesystem::path& file, const Grid* scanGrid,
                                int threads) {
    auto read = TRY(nifti::readNifti<std::uint8_t>(file));
    const AxisOrder axial = axialOrder(read.grid());
    const auto order = scanGrid ? orderOnGrid(read.grid(), *scanGrid) : axial;
    if (!order) {
        const glm::ivec3 size = reordered(read.grid(), axial).size;
        return fail(ErrorKind::badInput,
                    size == scanGrid->size
                        ? "the mask's voxels lie at other places in the patient than the scan's"
                        : "the mask has " + describeSize(size) + " voxels, the scan " +
                              describeSize(scanGrid->size),
                    file.string());
    }
    read = reordered(std::move(read), *order, threads);
    MaskInput mask{Volume<std::uint8_t>(scanGrid ? *scanGrid : read.grid()), {}};
    const auto labels = mask.labels.writable();
    std::size_t inside = 0, others = 0;
    for (std::size_t n = 0; n < labels.size(); ++n) {
        const std::uint8_t value = read[n];
        inside += value != 0;
        const bool known = value <= 2 || value == std::uint8_t(LumenLabel::untagged);
        others += !known;
        labels[n] = known ? value : std::uint8_t(LumenLabel::air);
    }
    if (inside == 0) return fail(ErrorKind::noResult, "the mask is empty", file.string());
    if (others > 0) {
        mask.notes.push_back("mask values other than 0, 1, 2 and 4 were taken as air-filled lumen");
    }
    return mask;
}

}  // namespace haustra::pipeline
