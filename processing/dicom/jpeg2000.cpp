#include "dicom/jpeg2000.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <openjpeg.h>

namespace haustra::dicom {
namespace {

struct MemoryStream {
    std::span<const std::uint8_t> bytes;
    std::size_t at = 0;
};

OPJ_SIZE_T readBytes(void* buffer, OPJ_SIZE_T count, void* user) {
    auto& stream = *static_cast<MemoryStream*>(user);
    const std::size_t take = std::min(count, stream.bytes.size() - stream.at);
    if (take == 0) return OPJ_SIZE_T(-1);
    std::memcpy(buffer, stream.bytes.data() + stream.at, take);
    stream.at += take;
    return take;
}

OPJ_OFF_T skipBytes(OPJ_OFF_T count, void* user) {
    auto& stream = *static_cast<MemoryStream*>(user);
    if (count < 0) return -1;
    const std::size_t left = stream.bytes.size() - stream.at;
    const std::size_t take = std::min(std::size_t(count), left);
    stream.at += take;
    return OPJ_OFF_T(take);
}

OPJ_BOOL seekBytes(OPJ_OFF_T to, void* user) {
    auto& stream = *static_cast<MemoryStream*>(user);
    if (to < 0 || std::size_t(to) > stream.bytes.size()) return OPJ_FALSE;
    stream.at = std::size_t(to);
    return OPJ_TRUE;
}

void sayNothing(const char*, void*) {}

template <auto Destroy>
struct Destroyer {
    template <class T>
    void operator()(T* object) const {
        Destroy(object);
    }
};
using Stream = std::unique_ptr<opj_stream_t, Destroyer<opj_stream_destroy>>;
using Codec = std::unique_ptr<opj_codec_t, Destroyer<opj_destroy_codec>>;
using Image = std::unique_ptr<opj_image_t, Destroyer<opj_image_destroy>>;

Stream openStream(MemoryStream& memory) {
    Stream stream(opj_stream_default_create(OPJ_TRUE));
    if (!stream) return stream;
    opj_stream_set_user_data(stream.get(), &memory, nullptr);
    opj_stream_set_user_data_length(stream.get(), memory.bytes.size());
    opj_stream_set_read_function(stream.get(), readBytes);
    opj_stream_set_skip_function(stream.get(), skipBytes);
    opj_stream_set_seek_function(stream.get(), seekBytes);
    return stream;
}

Codec openCodec(std::span<const std::uint8_t> bytes) {
    // A JP2 box header has no place in DICOM, but some writers leave it.
    constexpr std::uint8_t codestreamStart[] = {0xff, 0x4f, 0xff, 0x51};
    const bool raw = bytes.size() >= 4 && std::equal(std::begin(codestreamStart),
                                                     std::end(codestreamStart), bytes.begin());
    Codec codec(opj_create_decompress(raw ? OPJ_CODEC_J2K : OPJ_CODEC_JP2));
    if (!codec) return codec;
    opj_set_info_handler(codec.get(), sayNothing, nullptr);
    opj_set_warning_handler(codec.get(), sayNothing, nullptr);
    opj_set_error_handler(codec.get(), sayNothing, nullptr);
    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    if (!opj_setup_decoder(codec.get(), &parameters)) return nullptr;
    opj_decoder_set_strict_mode(codec.get(), OPJ_TRUE);  // truncated data is an error
    return codec;
}

}  // namespace

Result<Jpeg2000Image> decodeJpeg2000(std::span<const std::uint8_t> bytes, glm::ivec2 matrix,
                                     const std::string& place) {
    MemoryStream memory{bytes};
    const Stream stream = openStream(memory);
    const Codec codec = openCodec(bytes);
    if (!stream || !codec) return fail(ErrorKind::io, "no memory for a JPEG 2000 decoder", place);
    auto damaged = [&] {
        return fail(ErrorKind::badInput, "the JPEG 2000 pixel data is damaged", place);
    };
    opj_image_t* header = nullptr;
    const bool started = opj_read_header(stream.get(), codec.get(), &header);
    const Image image(header);
    if (!started || !image) return damaged();
    // Checked before decoding, which allocates what the codestream asks for.
    if (image->numcomps != 1 || !image->comps || image->comps[0].prec > 16) {
        return fail(ErrorKind::unsupported,
                    "the JPEG 2000 pixel data is not one grey channel of at most 16 bits", place);
    }
    auto sizeIsRight = [&] {
        return image->comps[0].w == OPJ_UINT32(matrix.x) &&
               image->comps[0].h == OPJ_UINT32(matrix.y);
    };
    if (!sizeIsRight()) {
        return fail(ErrorKind::badInput,
                    "the JPEG 2000 pixel data is not of the size that the file states", place);
    }
    if (!opj_decode(codec.get(), stream.get(), image.get())) return damaged();
    const opj_image_comp_t& component = image->comps[0];
    if (!sizeIsRight() || !component.data) return damaged();

    Jpeg2000Image result;
    result.precision = int(component.prec);
    result.isSigned = component.sgnd != 0;
    result.cells.resize(std::size_t(matrix.x) * std::size_t(matrix.y));
    std::transform(component.data, component.data + result.cells.size(), result.cells.begin(),
                   [](OPJ_INT32 value) { return std::uint16_t(value); });
    return result;
}

}  // namespace haustra::dicom
