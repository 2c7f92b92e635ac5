#include "nifti/gzip_stream.h"
#include "nifti/nifti_file.h"
#include "nifti/ras.h"

#include <bit>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>
#include <vector>

#include <nifti1_io.h>

static_assert(std::endian::native == std::endian::little);
static_assert(sizeof(nifti_1_header) == 348);

namespace haustra::nifti {
namespace {

constexpr std::size_t voxelsAtOnce = 1 << 20;

// ------------------------------------------------------------------------------------- geometry

double millimetresPerUnit(const nifti_1_header& header) {
    switch (XYZT_TO_SPACE(header.xyzt_units)) {
        case NIFTI_UNITS_METER:
            return 1000.0;
        case NIFTI_UNITS_MICRON:
            return 0.001;
        default:
            return 1.0;  // millimetres, or not said
    }
}

glm::dmat4 rasFromVoxel(const nifti_1_header& header) {
    glm::dmat4 affine(1.0);
    if (header.sform_code > 0) {
        const float* rows[] = {header.srow_x, header.srow_y, header.srow_z};
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 4; ++column)
                affine[column][row] = rows[row][column];
        }
    } else if (header.qform_code > 0) {
        const mat44 m = nifti_quatern_to_mat44(header.quatern_b, header.quatern_c, header.quatern_d,
                                               header.qoffset_x, header.qoffset_y, header.qoffset_z,
                                               header.pixdim[1], header.pixdim[2], header.pixdim[3],
                                               header.pixdim[0] < 0.0f ? -1.0f : 1.0f);
        for (int row = 0; row < 3; ++row) {
            for (int column = 0; column < 4; ++column)
                affine[column][row] = m.m[row][column];
        }
    } else {
        for (int axis = 0; axis < 3; ++axis)
            affine[axis][axis] = header.pixdim[axis + 1];
    }
    const double scale = millimetresPerUnit(header);
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 3; ++row)
            affine[column][row] *= scale;
    }
    return affine;
}

Result<Grid> gridOf(const nifti_1_header& header, const std::string& place) {
    const int axes = header.dim[0];
    if (axes < 1 || axes > 7)
        return fail(ErrorKind::badInput, "the NIfTI header has no valid number of axes", place);
    Grid grid;
    grid.size = glm::ivec3(1);
    for (int axis = 1; axis <= axes; ++axis) {
        if (axis <= 3)
            grid.size[axis - 1] = header.dim[axis];
        else if (header.dim[axis] != 1)
            return fail(ErrorKind::unsupported, "the NIfTI image has more than three axes", place);
    }
    grid.patientFromVoxel = flipped(rasFromVoxel(header));
    TRY(checkGrid(grid, place));
    return grid;
}

// ----------------------------------------------------------------------------------- the header

Result<nifti_1_header> readHeader(MaybeGzipFile& stream, bool& swapped, const std::string& place) {
    nifti_1_header header;
    auto notNifti = [&] { return fail(ErrorKind::badInput, "this is not a NIfTI-1 file", place); };
    if (auto read = stream.read(std::as_writable_bytes(std::span(&header, 1))); !read)
        return stream.compressed() ? tl::make_unexpected(read.error()) : notNifti();
    int size = header.sizeof_hdr;
    swapped = size != int(sizeof header);
    if (swapped) nifti_swap_4bytes(1, &size);
    if (size == 540 || header.sizeof_hdr == 540)
        return fail(ErrorKind::unsupported, "this is a NIfTI-2 file; NIfTI-1 is read", place);
    if (size != int(sizeof header)) return notNifti();
    if (swapped) swap_nifti_header(&header, 1);
    const std::string_view magic(header.magic, 3);
    if (magic == "ni1") {
        return fail(ErrorKind::unsupported,
                    "this is the header of a NIfTI pair; a single .nii file is read", place);
    }
    if (magic != "n+1") return notNifti();
    return header;
}

Result<void> skipToData(MaybeGzipFile& stream, const nifti_1_header& header,
                        const std::string& place) {
    constexpr float farthest = 1 << 24;
    if (!(header.vox_offset >= float(sizeof header) && header.vox_offset <= farthest))
        return fail(ErrorKind::badInput, "the NIfTI header has no valid data offset", place);
    std::vector<std::byte> extensions(std::size_t(header.vox_offset) - sizeof header);
    return stream.read(extensions);
}

// ------------------------------------------------------------------------------------ the values

template <class T>
T converted(double value, T notANumber) {
    if constexpr (std::is_floating_point_v<T>) {
        return T(value);
    } else {
        if (std::isnan(value)) return notANumber;
        constexpr double low = std::numeric_limits<T>::min(), high = std::numeric_limits<T>::max();
        return T(std::lround(std::min(std::max(value, low), high)));
    }
}

struct Scaling {
    double slope = 1.0, intercept = 0.0;
    bool none() const { return slope == 1.0 && intercept == 0.0; }
};

Scaling scalingOf(const nifti_1_header& header) {
    // A slope of zero means no scaling; so does what some writers leave there.
    if (header.scl_slope == 0.0f || !std::isfinite(header.scl_slope) ||
        !std::isfinite(header.scl_inter)) {
        return {};
    }
    return {header.scl_slope, header.scl_inter};
}

template <class Stored, class T>
Result<void> readValues(MaybeGzipFile& stream, bool swapped, const Scaling& scaling,
                        std::span<T> values, T notANumber) {
    std::vector<Stored> stored(std::min(voxelsAtOnce, values.size()));
    for (std::size_t at = 0; at < values.size(); at += voxelsAtOnce) {
        const std::size_t count = std::min(voxelsAtOnce, values.size() - at);
        const bool direct =
            std::is_same_v<Stored, T> && scaling.none() && (!swapped || sizeof(Stored) == 1);
        if (direct) {
            TRY(stream.read(std::as_writable_bytes(values.subspan(at, count))));
            continue;
        }
        TRY(stream.read(std::as_writable_bytes(std::span(stored).first(count))));
        if (swapped && sizeof(Stored) > 1) nifti_swap_Nbytes(count, sizeof(Stored), stored.data());
        for (std::size_t n = 0; n < count; ++n)
            values[at + n] =
                converted<T>(scaling.slope * double(stored[n]) + scaling.intercept, notANumber);
    }
    return {};
}

tl::unexpected<Error> unreadType(short datatype, const std::string& place) {
    return fail(
        ErrorKind::unsupported,
        std::string("NIfTI images of type ") + nifti_datatype_string(datatype) + " are not read",
        place);
}

template <class T>
Result<void> readValuesOf(short datatype, MaybeGzipFile& stream, bool swapped,
                          const Scaling& scaling, std::span<T> values, T notANumber,
                          const std::string& place) {
    auto as = [&]<class Stored>(Stored) {
        return readValues<Stored>(stream, swapped, scaling, values, notANumber);
    };
    switch (datatype) {
        case NIFTI_TYPE_UINT8:
            return as(std::uint8_t());
        case NIFTI_TYPE_INT8:
            return as(std::int8_t());
        case NIFTI_TYPE_UINT16:
            return as(std::uint16_t());
        case NIFTI_TYPE_INT16:
            return as(std::int16_t());
        case NIFTI_TYPE_UINT32:
            return as(std::uint32_t());
        case NIFTI_TYPE_INT32:
            return as(std::int32_t());
        case NIFTI_TYPE_UINT64:
            return as(std::uint64_t());
        case NIFTI_TYPE_INT64:
            return as(std::int64_t());
        case NIFTI_TYPE_FLOAT32:
            return as(float());
        case NIFTI_TYPE_FLOAT64:
            return as(double());
        default:
            break;
    }
    return unreadType(datatype, place);
}

/// An image whose values come next in its stream.
struct OpenImage {
    MaybeGzipFile stream;
    nifti_1_header header;
    bool swapped;
    Grid grid;
};

Result<OpenImage> openImage(const std::filesystem::path& file) {
    const std::string place = file.string();
    auto stream = TRY(MaybeGzipFile::open(file));
    bool swapped = false;
    const auto header = TRY(readHeader(stream, swapped, place));
    const auto grid = TRY(gridOf(header, place));
    TRY(skipToData(stream, header, place));
    int bytesPerVoxel = 0, swapSize = 0;
    nifti_datatype_sizes(header.datatype, &bytesPerVoxel, &swapSize);
    // Before anything is allocated: what has no size would pass for a file of any length.
    if (bytesPerVoxel == 0) return unreadType(header.datatype, place);
    if (grid.voxelCount() * std::size_t(bytesPerVoxel) > stream.mostBytes())
        return fail(ErrorKind::badInput, "the file is truncated", place);
    return OpenImage{std::move(stream), header, swapped, grid};
}

}  // namespace

template <class T>
Result<Volume<T>> readNifti(const std::filesystem::path& file, T notANumber) try {
    auto image = TRY(openImage(file));
    Volume<T> volume(image.grid);
    TRY(readValuesOf<T>(image.header.datatype, image.stream, image.swapped, scalingOf(image.header),
                        volume.writable(), notANumber, file.string()));
    TRY(image.stream.finish());
    return volume;
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "there is not enough memory for the volume", file.string());
}

Result<bool> saysHowItLies(const std::filesystem::path& file) {
    const auto image = TRY(openImage(file));
    return image.header.sform_code > 0 || image.header.qform_code > 0;
}

Result<ColorImage> readColorNifti(const std::filesystem::path& file) try {
    auto image = TRY(openImage(file));
    const short datatype = image.header.datatype;
    if (datatype != NIFTI_TYPE_RGB24 && datatype != NIFTI_TYPE_RGBA32)
        return fail(ErrorKind::unsupported,
                    std::string("a colour image is RGB24 or RGBA32, not ") +
                        nifti_datatype_string(datatype),
                    file.string());
    ColorImage color{Volume<Rgba>(image.grid), datatype == NIFTI_TYPE_RGBA32};
    const std::span<Rgba> voxels = color.voxels.writable();
    const std::size_t channels = color.hasOpacity ? 4 : 3;
    std::vector<std::uint8_t> stored(channels * std::min(voxelsAtOnce, voxels.size()));
    for (std::size_t at = 0; at < voxels.size(); at += voxelsAtOnce) {
        const std::size_t count = std::min(voxelsAtOnce, voxels.size() - at);
        const auto room = std::as_writable_bytes(std::span(stored).first(channels * count));
        TRY(image.stream.read(room));
        for (std::size_t n = 0; n < count; ++n) {
            const std::uint8_t* of = &stored[channels * n];
            voxels[at + n] = {of[0], of[1], of[2], color.hasOpacity ? of[3] : std::uint8_t(255)};
        }
    }
    TRY(image.stream.finish());
    return color;
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "there is not enough memory for the volume", file.string());
}

template Result<Volume<std::uint8_t>> readNifti(const std::filesystem::path&, std::uint8_t);
template Result<Volume<std::int16_t>> readNifti(const std::filesystem::path&, std::int16_t);
template Result<Volume<float>> readNifti(const std::filesystem::path&, float);

}  // namespace haustra::nifti
