#include "dicom/frame_decoding.h"

#include "dicom/dicom_library.h"
#include "dicom/jpeg2000.h"
#include "dicom/jpeg_header.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcfcache.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dctk.h>

namespace haustra::dicom {
namespace {

/// Any process of JPEG itself, JPEG-LS and JPEG 2000 apart.
bool isJpeg(E_TransferSyntax syntax) {
    return syntax >= EXS_JPEGProcess1 && syntax <= EXS_JPEGProcess14SV1;
}
bool isJpeg2000(E_TransferSyntax syntax) {
    return syntax == EXS_JPEG2000 || syntax == EXS_JPEG2000LosslessOnly;
}

std::size_t littleEndian32(const std::uint8_t* at) {
    return std::size_t(at[0]) | std::size_t(at[1]) << 8 | std::size_t(at[2]) << 16 |
           std::size_t(at[3]) << 24;
}

/// Whether a run-length segment (PS3.5 G.3) makes so many bytes, and holds nothing behind them but
/// zeros and no-operations that fill it up.
bool rleSegmentMakes(std::span<const std::uint8_t> segment, std::size_t wanted) {
    std::size_t made = 0, at = 0;
    while (made < wanted && at < segment.size()) {
        const std::size_t control = segment[at];
        if (control < 128)
            made += control + 1, at += control + 2;
        else if (control > 128)
            made += 257 - control, at += 2;
        else
            ++at;
    }
    return made == wanted && at <= segment.size() &&
           std::ranges::all_of(segment.subspan(at),
                               [](std::uint8_t byte) { return byte == 0 || byte == 128; });
}

/// An RLE frame starts with 16 numbers: how many segments, and where each begins (PS3.5 G.5).
/// DCMTK's decoder reads out of bounds where they point beyond the frame, and fills up what is
/// missing.
bool rleFrameIsSound(std::span<const std::uint8_t> frame, std::size_t segments,
                     std::size_t pixels) {
    constexpr std::size_t headerBytes = 64;
    if (frame.size() < headerBytes) return false;
    auto number = [&](std::size_t n) { return littleEndian32(frame.data() + 4 * n); };
    if (number(0) != segments) return false;
    std::size_t least = headerBytes;
    for (std::size_t n = 1; n <= segments; ++n) {
        if (number(n) < least || number(n) > frame.size()) return false;
        least = number(n);
    }
    for (std::size_t n = 1; n <= segments; ++n) {
        const std::size_t end = n < segments ? number(n + 1) : frame.size();
        if (!rleSegmentMakes(frame.subspan(number(n), end - number(n)), pixels)) return false;
    }
    return true;
}

/// One open file.
class PixelReader {
public:
    PixelReader(const ImageHeader& image) : image_(image), place_(image.file.string()) {}

    Result<void> open() {
        const OFCondition condition = format_.loadFile(OFFilename(image_.file.c_str()));
        if (condition.bad()) return damaged(condition.text());
        dataset_ = format_.getDataset();
        DcmElement* element = nullptr;
        if (dataset_->findAndGetElement(DCM_PixelData, element).good())
            pixelData_ = dynamic_cast<DcmPixelData*>(element);
        if (!pixelData_) return fail(ErrorKind::badInput, "the CT image has no pixel data", place_);
        const DcmRepresentationParameter* parameter = nullptr;
        pixelData_->getOriginalRepresentationKey(syntax_, parameter);
        Uint16 rows = 0, columns = 0, allocated = 0;
        dataset_->findAndGetUint16(DCM_Rows, rows);
        dataset_->findAndGetUint16(DCM_Columns, columns);
        dataset_->findAndGetUint16(DCM_BitsAllocated, allocated);
        if (image_.matrix != glm::ivec2(columns, rows) || image_.format.bitsAllocated != allocated)
            return damaged("it changed while it was read");
        if (DcmXfer(syntax_).isEncapsulated()) {
            DcmPixelSequence* fragments = nullptr;
            if (pixelData_->getEncapsulatedRepresentation(syntax_, parameter, fragments).bad() ||
                !fragments) {
                return damaged("its compressed pixels cannot be found");
            }
            fragments_ = fragments;
            return {};
        }
        const std::size_t needed = pixels() * image_.frames.size() * cellBytes();
        if (pixelData_->getLength() < needed) {
            return damaged("its pixel data holds " + std::to_string(pixelData_->getLength()) +
                           " of " + std::to_string(needed) + " bytes");
        }
        if (!isPadding(needed)) {
            return damaged("its pixel data holds " + std::to_string(pixelData_->getLength()) +
                           " bytes, where its rows, columns and bits ask for " +
                           std::to_string(needed));
        }
        return {};
    }

    /// Whether what the pixel data holds beyond so many bytes is no picture: less than a row, or
    /// zeros.
    bool isPadding(std::size_t needed) {
        const std::size_t excess = pixelData_->getLength() - needed;
        if (excess < std::size_t(image_.matrix.x) * cellBytes()) return true;
        if (excess >= needed) return false;
        std::vector<Uint8> tail(excess);
        return pixelData_->getPartialValue(tail.data(), Uint32(needed), Uint32(excess), &cache_)
                   .good() &&
               std::ranges::all_of(tail, [](Uint8 byte) { return byte == 0; });
    }

    /// HU of one frame; the span is valid until the next call.
    Result<std::span<const std::int16_t>> read(int frame) {
        hu_.resize(pixels());
        const FrameHeader& header = image_.frames[std::size_t(frame)];
        if (fragments_ && isJpeg2000(syntax_)) {
            TRY(readJpeg2000(frame, header.rescale));
            return std::span<const std::int16_t>(hu_);
        }
        Uint32 size = 0;
        if (pixelData_->getUncompressedFrameSize(dataset_, size).bad() ||
            size < pixels() * cellBytes() || size > pixels() * cellBytes() + 1) {
            return damaged("its pixel data has no consistent size");
        }
        if (fragments_ && syntax_ == EXS_RLELossless) {
            // A run-length frame is always one fragment, so DCMTK reads what is checked here.
            const auto range = fragmentsOf(frame);
            if (!range || range->last - range->first != 1)
                return damaged("its compressed frames cannot be told apart");
            const auto bytes = TRY(frameBytes(frame));
            if (!rleFrameIsSound(bytes, cellBytes(), pixels()))
                return damaged("its run-length segments are damaged, or of another size");
            nextFragment_ = Uint32(range->first);
        }
        if (fragments_ && isJpeg(syntax_)) {
            TRY(checkJpeg(frame));
            nextFragment_ = Uint32(fragmentsOf(frame)->first);
        }
        cells_.resize(pixels() + 1);
        OFString colorModel;
        const JpegWarnings before = jpegWarnings();
        const OFCondition condition = pixelData_->getUncompressedFrame(
            dataset_, Uint32(frame), nextFragment_, cells_.data(),
            Uint32(cells_.size() * sizeof(std::uint16_t)), colorModel, &cache_);
        if (condition.bad()) return damaged(condition.text());
        const JpegWarnings after = jpegWarnings();
        // The last pixels' own bytes may be counted among those that are left.
        constexpr std::size_t ofPixels = 4;
        if (after.damages > before.damages ||
            after.bytesBeforeEnd > before.bytesBeforeEnd + jpegFilling_ + ofPixels)
            return damaged("its compressed data is damaged");
        const HuTable& hu = table(image_.format, header.rescale);
        if (cellBytes() == 1) {
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(cells_.data());
            for (std::size_t n = 0; n < hu_.size(); ++n)
                hu_[n] = hu[bytes[n]];
        } else {
            for (std::size_t n = 0; n < hu_.size(); ++n)
                hu_[n] = hu[cells_[n]];
        }
        return std::span<const std::int16_t>(hu_);
    }

private:
    std::size_t pixels() const {
        return std::size_t(image_.matrix.x) * std::size_t(image_.matrix.y);
    }
    std::size_t cellBytes() const { return std::size_t(image_.format.bitsAllocated) / 8; }

    tl::unexpected<Error> damaged(const std::string& why) const {
        return fail(ErrorKind::badInput, "the pixels cannot be read: " + why, place_);
    }

    const HuTable& table(const StoredFormat& format, const Rescale& rescale) {
        if (!table_ || !table_->isOf(format, rescale))
            table_ = std::make_unique<HuTable>(format, rescale);
        return *table_;
    }

    struct FragmentRange {
        unsigned long first = 0, last = 0;  ///< items [first, last) of the sequence
    };

    /// The fragments of one frame: all of a single frame's, one each where there are as many as
    /// frames, else from where the offset table (item 0, PS3.5 A.4) says up to the next frame's.
    std::optional<FragmentRange> fragmentsOf(int frame) {
        const unsigned long items = fragments_->card();
        const std::size_t frames = image_.frames.size();
        if (items < 2) return std::nullopt;
        if (frames == 1) return FragmentRange{1, items};
        const auto n = static_cast<unsigned long>(frame);
        if (items == frames + 1) return FragmentRange{n + 1, n + 2};
        DcmPixelItem* table = nullptr;
        Uint8* bytes = nullptr;
        if (fragments_->getItem(table, 0).bad() || !table || table->getLength() != 4 * frames ||
            table->getUint8Array(bytes).bad() || !bytes) {
            return isJpeg(syntax_) ? streamOf(n) : std::nullopt;
        }
        FragmentRange range;
        const std::uint64_t begin = littleEndian32(bytes + 4 * n);
        const std::uint64_t end =
            n + 1 < frames ? littleEndian32(bytes + 4 * (n + 1)) : ~std::uint64_t(0);
        std::uint64_t at = 0;
        for (unsigned long item = 1; item < items && at < end; ++item) {
            if (at == begin) range.first = item;
            range.last = item + 1;
            DcmPixelItem* fragment = nullptr;
            if (fragments_->getItem(fragment, item).bad() || !fragment) return std::nullopt;
            at += 8 + fragment->getLength();  // each item has eight bytes of tag and length
        }
        return range.first > 0 ? std::optional(range) : std::nullopt;
    }

    /// The fragments of one JPEG stream, where no table says where frames begin: by its first
    /// bytes.
    std::optional<FragmentRange> streamOf(unsigned long frame) {
        FragmentRange range;
        unsigned long streams = 0;
        for (unsigned long item = 1; item < fragments_->card(); ++item) {
            DcmPixelItem* fragment = nullptr;
            Uint8* bytes = nullptr;
            if (fragments_->getItem(fragment, item).bad() || !fragment) return std::nullopt;
            const bool begins = fragment->getLength() >= 2 &&
                                fragment->getUint8Array(bytes).good() && bytes &&
                                bytes[0] == 0xff && bytes[1] == 0xd8;
            streams += begins;
            if (begins && streams == frame + 1) range.first = item;
            if (streams == frame + 1) range.last = item + 1;
        }
        return streams == image_.frames.size() ? std::optional(range) : std::nullopt;
    }

    /// The compressed bytes of one frame, its fragments joined.
    Result<std::vector<std::uint8_t>> frameBytes(int frame) {
        const auto range = fragmentsOf(frame);
        if (!range) return damaged("its compressed frames cannot be told apart");
        std::vector<std::uint8_t> bytes;
        for (unsigned long n = range->first; n < range->last; ++n) {
            DcmPixelItem* item = nullptr;
            Uint8* data = nullptr;
            if (fragments_->getItem(item, n).good() && item && item->getLength() == 0) continue;
            if (!item || item->getUint8Array(data).bad() || !data)
                return damaged("a compressed fragment is missing or truncated");
            bytes.insert(bytes.end(), data, data + item->getLength());
        }
        return bytes;
    }

    /// DCMTK decodes a stream of another size or depth than the file states into cells of those.
    Result<void> checkJpeg(int frame) {
        const auto bytes = TRY(frameBytes(frame));
        const auto header = jpegHeader(bytes);
        jpegFilling_ = fillingOfJpeg(bytes);
        if (!header) return damaged("its JPEG stream has no frame header");
        const StoredFormat& format = image_.format;
        const bool isWideEnough = (header->precision > 8) == (format.bitsAllocated == 16) &&
                                  (!format.isSigned || header->precision >= format.bitsStored);
        if (header->components == 1 && header->size == image_.matrix && isWideEnough) return {};
        return damaged("its JPEG stream is of " + std::to_string(header->size.x) + " columns, " +
                       std::to_string(header->size.y) + " rows and " +
                       std::to_string(header->precision) + " bits, the file of " +
                       std::to_string(image_.matrix.x) + ", " + std::to_string(image_.matrix.y) +
                       " and " + std::to_string(format.bitsStored));
    }

    Result<void> readJpeg2000(int frame, const Rescale& rescale) {
        const auto bytes = TRY(frameBytes(frame));
        const auto decoded = TRY(decodeJpeg2000(bytes, image_.matrix, place_));
        // The codestream's own precision rules: some writers' Bits Stored disagrees with it. Where
        // the signs disagree, the values are the data set's, written as if of the other kind: whole
        // cells where these are wider.
        StoredFormat format = image_.format;
        const bool areCells = format.isSigned && !decoded.isSigned && format.bitsAllocated == 16 &&
                              decoded.precision > format.bitsStored;
        if (!areCells) {
            format.bitsAllocated = 16;
            format.bitsStored = decoded.precision;
            format.highBit = decoded.precision - 1;
        }
        const HuTable& hu = table(format, rescale);
        for (std::size_t n = 0; n < hu_.size(); ++n)
            hu_[n] = hu[decoded.cells[n]];
        return {};
    }

    const ImageHeader& image_;
    std::string place_;
    DcmFileFormat format_;
    DcmFileCache cache_;
    DcmDataset* dataset_ = nullptr;
    DcmPixelData* pixelData_ = nullptr;
    DcmPixelSequence* fragments_ = nullptr;
    E_TransferSyntax syntax_ = EXS_Unknown;
    Uint32 nextFragment_ = 0;
    std::unique_ptr<HuTable> table_;
    std::size_t jpegFilling_ = 0;
    std::vector<std::uint16_t> cells_;
    std::vector<std::int16_t> hu_;
};

}  // namespace

Result<void> decodeFrames(const ImageHeader& image, int first, int last,
                          const FrameSink& sink) try {
    prepareDicomLibrary();
    PixelReader reader(image);
    TRY(reader.open());
    for (int frame = first; frame < last; ++frame) {
        const auto hu = TRY(reader.read(frame));
        sink(frame, hu);
    }
    return {};
} catch (const std::exception& error) {
    return fail(ErrorKind::badInput, std::string("the pixels cannot be read: ") + error.what(),
                image.file.string());
}

}  // namespace haustra::dicom
