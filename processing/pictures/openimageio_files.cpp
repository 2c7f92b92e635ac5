#include "core/durable_file.h"
#include "pictures/image_libraries.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <new>
#include <utility>

#include <OpenImageIO/color.h>
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haustra::pictures::module {

namespace {

namespace fs = std::filesystem;
using OIIO::TypeDesc;

// ---- out

/// OpenImageIO's own file tells nobody when a full disk refuses its last bytes.
class CheckedFile final : public OIIO::Filesystem::IOProxy {
public:
    explicit CheckedFile(const DurableFile& file)
        : IOProxy(file.beside().string(), Write), descriptor_(file.descriptor()) {}

    /// Whether all that was written has been taken.
    bool isSound() const { return sound_; }

    // Not "file", which OpenImageIO takes for its own.
    const char* proxytype() const override { return "haustra"; }
    std::size_t read(void* bytes, std::size_t count) override {
        const std::size_t got = pread(bytes, count, m_pos);
        m_pos += std::int64_t(got);
        return got;
    }
    std::size_t write(const void* bytes, std::size_t count) override {
        const std::size_t put = pwrite(bytes, count, m_pos);
        m_pos += std::int64_t(put);
        return put;
    }
    std::size_t pread(void* bytes, std::size_t count, std::int64_t offset) override {
        const ssize_t got = ::pread(descriptor_, bytes, count, offset);
        return got < 0 ? 0 : std::size_t(got);
    }
    std::size_t pwrite(const void* bytes, std::size_t count, std::int64_t offset) override {
        std::size_t done = 0;
        while (done < count) {
            const ssize_t put = ::pwrite(descriptor_, static_cast<const char*>(bytes) + done,
                                         count - done, offset + std::int64_t(done));
            if (put < 0 && errno == EINTR) continue;
            if (put <= 0) break;
            done += std::size_t(put);
        }
        sound_ = done == count && sound_;
        return done;
    }
    std::size_t size() const override {
        struct stat status {};
        return ::fstat(descriptor_, &status) == 0 ? std::size_t(status.st_size) : 0;
    }

private:
    int descriptor_;
    bool sound_ = true;
};

const char* formatOf(const fs::path& file) {
    const std::string ending = file.extension().string();
    if (ending == ".png") return "png";
    if (ending == ".tif" || ending == ".tiff") return "tiff";
    if (ending == ".exr") return "openexr";
    if (ending == ".jpg" || ending == ".jpeg") return "jpeg";
    return nullptr;
}

std::string printable(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
}

OIIO::ImageSpec specOf(const std::string& format, int width, int height,
                       const Provenance& provenance) {
    const bool linear = format == "openexr";
    OIIO::ImageSpec spec(width, height, 3, linear ? TypeDesc::HALF : TypeDesc::UINT8);
    std::string facts;
    for (const auto& [name, value] : provenance.facts)
        facts += (facts.empty() ? "" : "; ") + printable(name) + "=" + printable(value);
    spec.attribute("ImageDescription", facts);
    spec.attribute("Software", printable(provenance.software));
    // Of TIFF it would go into an Exif directory, after which OpenImageIO 2.4 cannot find back to
    // the picture's own unless the file is its own, too.
    if (format != "tiff") spec.attribute("oiio:ColorSpace", linear ? "Linear" : "sRGB");
    // The same picture is the same file whenever it is written.
    spec.attribute("DateTime", "");
    if (format == "png") {
        // Every row by the filter that suits it, as libpng does by itself.
        spec.attribute("png:filter", 0xF8);
    }
    if (format == "jpeg") {
        spec.attribute("CompressionQuality", 95);
        spec.attribute("jpeg:subsampling", "4:4:4");
    }
    return spec;
}

std::vector<float> linearLight(const std::vector<std::uint8_t>& rgb) {
    static const auto table = [] {
        std::array<float, 256> linear;
        for (std::size_t byte = 0; byte < linear.size(); ++byte)
            linear[byte] = OIIO::sRGB_to_linear(float(byte) / 255.0f);
        return linear;
    }();
    std::vector<float> light(rgb.size());
    std::transform(rgb.begin(), rgb.end(), light.begin(), [](std::uint8_t b) { return table[b]; });
    return light;
}

class OpenImageIoFile final : public PictureFile {
public:
    OpenImageIoFile(fs::path file, OIIO::ImageSpec spec)
        : file_(std::move(file)), spec_(std::move(spec)), made_(file_), bytes_(made_) {}

    Result<void> open() {
        TRY(made_.isMade());
        output_ = OIIO::ImageOutput::create(formatOf(file_), &bytes_);
        if (!output_ || !output_->open(file_.string(), spec_)) return notWhole();
        return {};
    }

    Result<void> append(const Image& band) override try {
        if (band.width != spec_.width || band.height < 0 || band.height > spec_.height - rows_ ||
            band.rgb.size() != 3 * std::size_t(band.width) * std::size_t(band.height))
            return disagree();
        if (band.height == 0) return {};
        const int end = rows_ + band.height;
        const bool written =
            spec_.format == TypeDesc::HALF
                ? output_->write_scanlines(rows_, end, 0, TypeDesc::FLOAT,
                                           linearLight(band.rgb).data())
                : output_->write_scanlines(rows_, end, 0, TypeDesc::UINT8, band.rgb.data());
        if (!written) return notWhole();
        rows_ = end;
        return {};
    } catch (const std::exception&) {
        return notWhole();
    }

    Result<void> finish() override try {
        if (rows_ != spec_.height) return disagree();
        if (!output_->close() || !bytes_.isSound()) return notWhole();
        return made_.publish();
    } catch (const std::exception&) {
        return notWhole();
    }

private:
    tl::unexpected<Error> disagree() const {
        return fail(ErrorKind::badInput, "the picture's size and its pixels disagree",
                    file_.string());
    }
    tl::unexpected<Error> notWhole() const {
        if (output_) output_->geterror();  // else it is printed
        return fail(ErrorKind::io, "cannot be written whole", file_.string());
    }

    fs::path file_;
    OIIO::ImageSpec spec_;
    DurableFile made_;
    CheckedFile bytes_;
    std::unique_ptr<OIIO::ImageOutput> output_;  // last: it writes to bytes_ as it goes
    int rows_ = 0;
};

// ---- in

/// By its first bytes: OpenImageIO would try all the formats it knows on a hostile file.
const char* formatWithin(std::ifstream& in, bool lossy) {
    std::array<char, 8> first{};
    in.read(first.data(), first.size());
    const auto begins = [&](const char* with, std::size_t count) {
        return std::memcmp(first.data(), with, count) == 0;
    };
    if (begins("\x89PNG\r\n\x1a\n", 8)) return "png";
    if (begins("II*\0", 4) || begins("MM\0*", 4) || begins("II+\0", 4) || begins("MM\0+", 4))
        return "tiff";
    if (lossy && begins("\xff\xd8\xff", 3)) return "jpeg";
    return nullptr;
}

class InputFile {
public:
    /// Opened, its pixels not yet read: of at most four channels, and with sides in bounds.
    static Result<InputFile> open(const fs::path& file, int maxSide, bool lossy) {
        InputFile my(file);
        std::ifstream in(file, std::ios::binary);
        if (!in) return fail(ErrorKind::io, "the file cannot be read", file.string());
        const char* format = formatWithin(in, lossy);
        if (!format)
            return my.refuse(lossy ? "this is no PNG, TIFF or JPEG picture"
                                   : "this is no PNG or TIFF picture");
        my.input_ = OIIO::ImageInput::create(format);
        OIIO::ImageSpec wanted;
        wanted.attribute("oiio:UnassociatedAlpha", 1);  // bytes as they are
        if (!my.input_ || !my.input_->open(file.string(), my.spec_, wanted))
            return my.refuse("the picture is damaged");
        const auto& spec = my.spec_;
        if (spec.width < 1 || spec.height < 1 || spec.depth > 1)
            return my.refuse("the picture is damaged");
        if (spec.width > maxSide || spec.height > maxSide || spec.tile_width > maxSide ||
            spec.tile_height > maxSide)
            return my.refuse("the picture is too large: its sides are not within 1 to " +
                             std::to_string(maxSide) + " pixels");
        if (spec.nchannels < 1 || spec.nchannels > 4)
            return my.refuse("the picture has more than four channels");
        if (my.input_->seek_subimage(1, 0)) return my.refuse("the file holds several pictures");
        my.input_->geterror();
        if (!my.input_->seek_subimage(0, 0)) return my.refuse("the picture is damaged");
        return my;
    }

    const OIIO::ImageSpec& spec() const { return spec_; }
    tl::unexpected<Error> refuse(const std::string& why) const {
        if (input_) input_->geterror();  // else it is printed
        return fail(ErrorKind::badInput, why, file_.string());
    }
    /// All pixels as T, channel after channel.
    template <class T>
    Result<std::vector<T>> read() {
        std::vector<T> values(std::size_t(spec_.width) * std::size_t(spec_.height) *
                              std::size_t(spec_.nchannels));
        if (!input_->read_image(0, 0, 0, spec_.nchannels, OIIO::BaseTypeFromC<T>::value,
                                values.data()))
            return refuse("the picture is damaged");
        return values;
    }

private:
    explicit InputFile(fs::path file) : file_(std::move(file)) {}
    fs::path file_;
    OIIO::ImageSpec spec_;
    std::unique_ptr<OIIO::ImageInput> input_;
};

template <class T>
Result<GreyPicture> greyOf(InputFile& input) {
    const auto values = TRY(input.read<T>());
    GreyPicture grey{{input.spec().width, input.spec().height}, {}};
    grey.values.resize(values.size());
    std::transform(values.begin(), values.end(), grey.values.begin(),
                   [](T value) { return std::int16_t(std::min(int(value), INT16_MAX)); });
    return grey;
}

/// What a library throws, as an error that names the file.
tl::unexpected<Error> thrown(const fs::path& file) {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::io, "there is not enough memory for the picture", file.string());
    } catch (...) {
        return fail(ErrorKind::badInput, "the picture is damaged", file.string());
    }
}

}  // namespace

Result<std::unique_ptr<PictureFile>> createPicture(const fs::path& file, int width, int height,
                                                   const Provenance& provenance) try {
    const char* format = formatOf(file);
    if (!format)
        return fail(ErrorKind::badInput, "pictures are written as .png, .tif, .exr or .jpg",
                    file.string());
    if (width <= 0 || height <= 0)
        return fail(ErrorKind::badInput, "a picture has no pixels", file.string());
    auto picture =
        std::make_unique<OpenImageIoFile>(file, specOf(format, width, height, provenance));
    TRY(picture->open());
    return picture;
} catch (const std::exception&) {
    return fail(ErrorKind::io, "cannot be written whole", file.string());
}

Result<GreyPicture> readGreyPicture(const fs::path& file) try {
    auto input = TRY(InputFile::open(file, maxGreySide, false));
    const OIIO::ImageSpec& spec = input.spec();
    if (spec.nchannels != 1) return input.refuse("the picture is not grey");
    const int bits = spec.get_int_attribute("oiio:BitsPerSample", 8 * int(spec.format.size()));
    if (bits <= 8 && spec.format == TypeDesc::UINT8) return greyOf<std::uint8_t>(input);
    if (bits == 16 && spec.format == TypeDesc::UINT16) return greyOf<std::uint16_t>(input);
    if (bits == 16 && spec.format == TypeDesc::INT16) return greyOf<std::int16_t>(input);
    return input.refuse("the picture's values are neither of 8 nor of 16 bits");
} catch (...) {
    return thrown(file);
}

Result<ColorPicture> readColorPicture(const fs::path& file, int maxSide) try {
    auto input = TRY(InputFile::open(file, maxSide, true));
    const auto values = TRY(input.read<std::uint8_t>());
    const std::size_t channels = std::size_t(input.spec().nchannels);
    ColorPicture picture{{input.spec().width, input.spec().height}, {}};
    picture.pixels.resize(values.size() / channels);
    // One or two channels are grey; the second and the fourth is how much it covers.
    const std::size_t green = channels < 3 ? 0 : 1, blue = channels < 3 ? 0 : 2;
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const std::uint8_t* from = &values[channels * i];
        picture.pixels[i] = {from[0], from[green], from[blue],
                             channels % 2 == 0 ? from[channels - 1] : 255};
    }
    return picture;
} catch (...) {
    return thrown(file);
}

}  // namespace haustra::pictures::module

extern "C" const haustra::pictures::ImageLibraries haustraImageLibraries = [] {
    using namespace haustra::pictures;
    OIIO::attribute("threads", 1);  // no threads of its own
    OIIO::attribute("exr_threads", -1);
    return ImageLibraries{&module::createPicture,    &module::readGreyPicture,
                          &module::readColorPicture, &module::sideBySide,
                          &module::textWidth,        &module::draw};
}();
