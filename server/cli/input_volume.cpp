#include "cli/input_volume.h"

#include "dicom/import_series.h"
#include "nifti/nifti_file.h"

#include <algorithm>
#include <cctype>
#include <csetjmp>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include <png.h>

namespace haustra::cli {

namespace {

namespace fs = std::filesystem;

struct Slice {
    glm::ivec2 size{0};
    std::vector<std::int16_t> values;
};

constexpr unsigned maxSliceSide = 1 << 14;

// libpng leaves by longjmp: in the functions that call it nothing has a destructor.
struct PngReader {
    std::FILE* in = nullptr;
    png_structp png = nullptr;
    png_infop info = nullptr;
    unsigned width = 0, height = 0;
    bool grey = false, wide = false;  // of 16 bits

    ~PngReader() {
        png_destroy_read_struct(&png, &info, nullptr);
        if (in) std::fclose(in);
    }
    bool readHeader() {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr,
                                     [](png_structp, png_const_charp) {});
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info || setjmp(png_jmpbuf(png))) return false;
        png_init_io(png, in);
        png_read_info(png, info);
        width = png_get_image_width(png, info);
        height = png_get_image_height(png, info);
        grey = png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY;
        wide = png_get_bit_depth(png, info) == 16;
        return true;
    }
    std::size_t rowBytes() const { return std::size_t(width) * (wide ? 2 : 1); }
    bool read(png_bytep pixels) {
        if (setjmp(png_jmpbuf(png))) return false;
        png_set_expand_gray_1_2_4_to_8(png);
        const int passes = png_set_interlace_handling(png);
        for (int pass = 0; pass < passes; ++pass)
            for (unsigned y = 0; y < height; ++y)
                png_read_row(png, pixels + rowBytes() * y, nullptr);
        png_read_end(png, nullptr);
        return true;
    }
};

Result<Slice> readGreyPng(const fs::path& path) {
    const auto refuse = [&](const char* why) {
        return fail(ErrorKind::badInput, why, path.string());
    };
    PngReader reader;
    reader.in = std::fopen(path.c_str(), "rb");
    if (!reader.in) return fail(ErrorKind::io, "the file cannot be read", path.string());
    if (!reader.readHeader()) return refuse("this is no PNG picture");
    if (reader.width > maxSliceSide || reader.height > maxSliceSide)
        return refuse("the picture is too large");
    if (!reader.grey) return refuse("the picture is not grey");
    std::vector<std::uint8_t> bytes(reader.rowBytes() * reader.height);
    if (!reader.read(bytes.data())) return refuse("the picture is damaged");
    Slice slice{{int(reader.width), int(reader.height)},
                std::vector<std::int16_t>(std::size_t(reader.width) * reader.height)};
    for (std::size_t i = 0; i < slice.values.size(); ++i) {
        const int value = reader.wide ? bytes[2 * i] << 8 | bytes[2 * i + 1] : bytes[i];
        slice.values[i] = std::int16_t(std::min(value, INT16_MAX));
    }
    return slice;
}

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

Result<std::vector<fs::path>> slicesIn(const fs::path& folder) {
    std::vector<fs::path> slices;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        if (at->path().extension() == ".png") slices.push_back(at->path());
    if (error) return fail(ErrorKind::io, "the folder cannot be read", folder.string());
    std::sort(slices.begin(), slices.end(), [](const fs::path& a, const fs::path& b) {
        return comesBefore(a.filename().string(), b.filename().string());
    });
    return slices;
}

Result<Volume<std::int16_t>> stacked(const std::vector<fs::path>& slices, glm::dvec3 spacingMm) {
    Volume<std::int16_t> volume;
    for (std::size_t z = 0; z < slices.size(); ++z) {
        const auto slice = TRY(readGreyPng(slices[z]));
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

Result<Volume<std::int16_t>> readInputVolume(const fs::path& path, glm::dvec3 spacingMm,
                                             int threads) try {
    std::error_code error;
    if (!fs::is_directory(path, error)) return nifti::readNifti<std::int16_t>(path);
    const auto slices = TRY(slicesIn(path));
    if (!slices.empty()) return stacked(slices, spacingMm);
    dicom::ImportOptions options;
    options.threads = threads;
    auto series = TRY(dicom::importSeries(path, options));
    return std::move(series.scan.hu);
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "there is not enough memory for the volume", path.string());
}

}  // namespace haustra::cli
