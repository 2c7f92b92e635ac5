#include "cli/input_volume.h"

#include "dicom/import_series.h"
#include "nifti/nifti_file.h"
#include "pictures/picture_file.h"

#include <algorithm>
#include <cctype>
#include <new>
#include <string>
#include <vector>

namespace haustra::cli {

namespace {

namespace fs = std::filesystem;

/// Names in which numbers count by their values: slice9 before slice10.
bool comesBefore(const std::string& a, const std::string& b) {
    const auto isDigit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
    std::size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        if (!isDigit(a[i]) || !isDigit(b[j])) {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i, ++j;
            continue;
        }
        const auto number = [&](const std::string& text, std::size_t& at) {
            while (at < text.size() && text[at] == '0')
                ++at;
            const std::size_t begin = at;
            while (at < text.size() && isDigit(text[at]))
                ++at;
            return text.substr(begin, at - begin);
        };
        const std::string left = number(a, i), right = number(b, j);
        if (left.size() != right.size()) return left.size() < right.size();
        if (left != right) return left < right;
    }
    return a.size() - i < b.size() - j;
}

/// The folder's PNG files; or, where there is none, its TIFF files.
Result<std::vector<fs::path>> slicesIn(const fs::path& folder) {
    std::vector<fs::path> slices, tiffs;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        const std::string ending = at->path().extension().string();
        if (ending == ".png") slices.push_back(at->path());
        if (ending == ".tif" || ending == ".tiff") tiffs.push_back(at->path());
    }
    if (error) return fail(ErrorKind::io, "the folder cannot be read", folder.string());
    if (slices.empty()) slices = std::move(tiffs);
    std::sort(slices.begin(), slices.end(), [](const fs::path& a, const fs::path& b) {
        return comesBefore(a.filename().string(), b.filename().string());
    });
    return slices;
}

Result<Volume<std::int16_t>> stacked(const std::vector<fs::path>& slices, glm::dvec3 spacingMm) {
    Volume<std::int16_t> volume;
    for (std::size_t z = 0; z < slices.size(); ++z) {
        const auto slice = TRY(pictures::readGreyPicture(slices[z]));
        if (z == 0) {
            const Grid grid =
                axisAlignedGrid({slice.size, int(slices.size())}, spacingMm, glm::dvec3(0.0));
            TRY(checkGrid(grid, slices[0].parent_path().string()));
            volume = Volume<std::int16_t>(grid);
        } else if (slice.size != glm::ivec2(volume.grid().size)) {
            return fail(ErrorKind::badInput, "the slice is not as large as the first",
                        slices[z].string());
        }
        std::copy(slice.values.begin(), slice.values.end(),
                  volume.writable().begin() + std::ptrdiff_t(z * slice.values.size()));
    }
    return volume;
}

}  // namespace

Result<Volume<std::int16_t>> readInputVolume(const fs::path& path,
                                             std::optional<glm::dvec3> spacingMm, int threads) try {
    std::error_code error;
    if (!fs::is_directory(path, error)) return nifti::readNifti<std::int16_t>(path);
    const auto slices = TRY(slicesIn(path));
    if (!slices.empty()) return stacked(slices, spacingMm.value_or(glm::dvec3(1.0)));
    if (spacingMm)
        return fail(ErrorKind::badInput,
                    "--spacing is for a folder of PNG or TIFF slices, and this one has none",
                    path.string());
    dicom::ImportOptions options;
    options.threads = threads;
    auto series = TRY(dicom::importSeries(path, options));
    return std::move(series.scan.hu);
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "there is not enough memory for the volume", path.string());
}

}  // namespace haustra::cli
