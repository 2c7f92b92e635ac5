#include "core/durable_file.h"
#include "nifti/gzip_stream.h"
#include "nifti/nifti_file.h"
#include "nifti/ras.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <new>
#include <type_traits>

#include <nifti1_io.h>

static_assert(std::endian::native == std::endian::little);

namespace haustra::nifti {
namespace {

constexpr std::size_t dataOffset = 352;  // the header, and four bytes that say "no extensions"

bool orthogonal(const Grid& grid) {
    const glm::dvec3 spacing = grid.spacingMm();
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        const double cosine = glm::dot(glm::dvec3(grid.patientFromVoxel[a]) / spacing[a],
                                       glm::dvec3(grid.patientFromVoxel[b]) / spacing[b]);
        if (std::abs(cosine) > 1e-6) return false;
    }
    return true;
}

void setGeometry(const Grid& grid, nifti_1_header& header) {
    const glm::dmat4 affine = flipped(grid.patientFromVoxel);
    const glm::dvec3 spacing = grid.spacingMm();
    float* rows[] = {header.srow_x, header.srow_y, header.srow_z};
    mat44 m{};
    m.m[3][3] = 1.0f;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column)
            m.m[row][column] = rows[row][column] = float(affine[column][row]);
    }
    for (int axis = 0; axis < 3; ++axis)
        header.pixdim[axis + 1] = float(spacing[axis]);
    header.pixdim[0] = 1.0f;
    header.sform_code = NIFTI_XFORM_SCANNER_ANAT;
    if (orthogonal(grid)) {
        header.qform_code = NIFTI_XFORM_SCANNER_ANAT;
        nifti_mat44_to_quatern(m, &header.quatern_b, &header.quatern_c, &header.quatern_d,
                               &header.qoffset_x, &header.qoffset_y, &header.qoffset_z, nullptr,
                               nullptr, nullptr, &header.pixdim[0]);
    }
    header.xyzt_units = NIFTI_UNITS_MM;
}

template <class T>
constexpr short datatypeOf() {
    if constexpr (std::is_same_v<T, std::uint8_t>) return NIFTI_TYPE_UINT8;
    if constexpr (std::is_same_v<T, std::int16_t>) return NIFTI_TYPE_INT16;
    if constexpr (std::is_same_v<T, float>) return NIFTI_TYPE_FLOAT32;
}

nifti_1_header headerOf(const Grid& grid, short datatype, std::size_t valueBytes, int samples) {
    nifti_1_header header{};
    header.sizeof_hdr = sizeof header;
    header.regular = 'r';
    header.dim[0] = samples > 1 ? 4 : 3;
    for (int axis = 1; axis < 8; ++axis)
        header.dim[axis] = axis <= 3 ? short(grid.size[axis - 1]) : short(1);
    header.dim[4] = short(samples);
    header.datatype = datatype;
    header.bitpix = short(8 * valueBytes);
    header.vox_offset = float(dataOffset);
    header.scl_slope = 1.0f;
    header.pixdim[4] = samples > 1 ? 1.0f : 0.0f;
    setGeometry(grid, header);
    std::copy_n("n+1", 4, header.magic);
    return header;
}

Result<void> writeImage(const std::filesystem::path& file, const nifti_1_header& header,
                        const Grid& grid, const ByteSource& body) try {
    TRY(checkGrid(grid, file.string()));
    std::array<std::byte, dataOffset> head{};
    std::memcpy(head.data(), &header, sizeof header);
    DurableFile made(file);
    TRY(made.isMade());
    std::ofstream out(made.beside(), std::ios::binary);
    if (file.extension() == ".gz")
        writeGzip(out, head, body, 0);
    else
        writePlain(out, head, body);
    out.close();
    if (!out) return fail(ErrorKind::io, "the file cannot be written", file.string());
    return made.publish();
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "there is not enough memory to write the file", file.string());
}

template <class T>
Result<void> writeVolume(const std::filesystem::path& file, const Volume<T>& volume,
                         short datatype) {
    const auto voxels = std::as_bytes(volume.voxels());
    const ByteSource body{voxels.size(), [&](std::size_t offset, std::span<std::byte> room) {
                              return voxels.subspan(offset, room.size());
                          }};
    return writeImage(file, headerOf(volume.grid(), datatype, sizeof(T), 1), volume.grid(), body);
}

}  // namespace

Result<void> writeColorNifti(const std::filesystem::path& file, const Volume<Rgba>& volume) {
    return writeVolume(file, volume, NIFTI_TYPE_RGBA32);
}

template <class T>
Result<void> writeNifti(const std::filesystem::path& file, const Volume<T>& volume) {
    return writeVolume(file, volume, datatypeOf<T>());
}

Result<void> writeFractions(const std::filesystem::path& file,
                            const Volume<TissueFractions>& fractions) {
    const std::size_t count = fractions.grid().voxelCount();
    // One after the other: all air, all soft tissue, all tagged.
    const auto value = [&](std::size_t at) {
        const TissueFractions voxel = fractions[at % count];
        return at < count ? voxel.air : at < 2 * count ? voxel.soft() : voxel.tagged;
    };
    const ByteSource body{3 * count, [&](std::size_t offset, std::span<std::byte> room) {
                              for (std::size_t n = 0; n < room.size(); ++n)
                                  room[n] = std::byte(value(offset + n));
                              return std::span<const std::byte>(room);
                          }};
    return writeImage(file, headerOf(fractions.grid(), NIFTI_TYPE_UINT8, 1, 3), fractions.grid(),
                      body);
}

template Result<void> writeNifti(const std::filesystem::path&, const Volume<std::uint8_t>&);
template Result<void> writeNifti(const std::filesystem::path&, const Volume<std::int16_t>&);
template Result<void> writeNifti(const std::filesystem::path&, const Volume<float>&);

}  // namespace haustra::nifti
