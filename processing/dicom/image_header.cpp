#include "dicom/image_header.h"

#include "dicom/dicom_library.h"

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>

namespace haustra::dicom {
namespace {

constexpr int largestMatrix = 4096;
constexpr int mostFrames = 4096;

/// True where the file starts as DICOM does: "DICM" after the preamble, or, without a preamble,
/// an element of one of the first groups in either byte order.
bool startsLikeDicom(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, 132> head{};
    in.read(head.data(), head.size());
    if (in.gcount() == std::streamsize(head.size()) &&
        std::string_view(head.data() + 128, 4) == "DICM") {
        return true;
    }
    if (in.gcount() < 8) return false;
    for (char group : {0x02, 0x04, 0x08}) {
        if (head[0] == group && head[1] == 0 && head[3] == 0) return true;
        if (head[0] == 0 && head[1] == group && head[2] == 0) return true;
    }
    return false;
}

std::string text(DcmItem& item, const DcmTagKey& tag, unsigned long value = 0) {
    OFString string;
    if (item.findAndGetOFString(tag, string, value).bad()) return {};
    return std::string(string.c_str(), string.length());
}

std::string printable(std::string string) {
    for (char& c : string) {
        if (c < 0x20 || c > 0x7e) c = '?';
    }
    if (string.size() > 64) string.resize(64);
    return string;
}

/// Of a text the whole text must be a number: DCMTK reads "1,5" as 1.
std::optional<double> numberIn(std::string_view text) {
    constexpr std::string_view padding(" \t\r\n\0", 5);
    const std::size_t begin = text.find_first_not_of(padding);
    if (begin == std::string_view::npos) return std::nullopt;
    text = text.substr(begin, text.find_last_not_of(padding) + 1 - begin);
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<double> numberAt(DcmItem& item, const DcmTagKey& tag, unsigned long n) {
    DcmElement* element = nullptr;
    if (item.findAndGetElement(tag, element).bad() || !element) return std::nullopt;
    std::optional<double> value;
    Float64 stored = 0;
    if (DcmVR(element->getVR()).isaString())
        value = numberIn(text(item, tag, n));
    else if (element->getFloat64(stored, n).good())
        value = stored;
    return value && std::isfinite(*value) ? value : std::nullopt;
}

template <std::size_t Count>
bool numbers(DcmItem& item, const DcmTagKey& tag, std::array<double, Count>& values) {
    for (std::size_t n = 0; n < Count; ++n) {
        const auto value = numberAt(item, tag, static_cast<unsigned long>(n));
        if (!value) return false;
        values[n] = *value;
    }
    return true;
}

std::optional<double> number(DcmItem& item, const DcmTagKey& tag) {
    std::array<double, 1> value{};
    return numbers(item, tag, value) ? std::optional(value[0]) : std::nullopt;
}

std::optional<int> whole(DcmItem& item, const DcmTagKey& tag) {
    Uint16 value = 0;
    return item.findAndGetUint16(tag, value).good() ? std::optional<int>(value) : std::nullopt;
}

PatientPosition patientPosition(const std::string& code) {
    // Head or feet first does not matter: the axes are the patient's.
    if (code == "HFS" || code == "FFS") return PatientPosition::supine;
    if (code == "HFP" || code == "FFP") return PatientPosition::prone;
    if (code == "HFDL" || code == "FFDL") return PatientPosition::leftDecubitus;
    if (code == "HFDR" || code == "FFDR") return PatientPosition::rightDecubitus;
    return PatientPosition::unknown;
}

/// The attributes of one frame, from the groups that may hold them: the data set itself for a
/// classic image, else the frame's and the shared functional groups (PS3.3 C.7.6.16).
class FrameAttributes {
public:
    FrameAttributes(DcmItem& dataset) : dataset_(dataset) {}
    FrameAttributes(DcmItem& dataset, DcmItem* perFrame, DcmItem* shared)
        : dataset_(dataset), perFrame_(perFrame), shared_(shared), enhanced_(true) {}

    /// The item of the functional group `sequence`; null where there is none.
    DcmItem* group(const DcmTagKey& sequence) const {
        if (!enhanced_) return &dataset_;
        for (DcmItem* groups : {perFrame_, shared_}) {
            DcmItem* item = nullptr;
            if (groups && groups->findAndGetSequenceItem(sequence, item, 0).good() && item)
                return item;
        }
        return nullptr;
    }

private:
    DcmItem& dataset_;
    DcmItem* perFrame_ = nullptr;
    DcmItem* shared_ = nullptr;
    bool enhanced_ = false;
};

Result<FrameHeader> readFrame(const FrameAttributes& attributes, const std::string& place) {
    FrameHeader frame;
    auto missing = [&](const char* what) {
        return fail(ErrorKind::badInput, std::string("the CT image has no valid ") + what, place);
    };
    DcmItem* position = attributes.group(DCM_PlanePositionSequence);
    std::array<double, 3> p{};
    if (!position || !numbers(*position, DCM_ImagePositionPatient, p))
        return missing("Image Position (Patient)");
    frame.positionMm = {p[0], p[1], p[2]};
    constexpr double farthestMm = 1e6;
    if (glm::any(glm::greaterThan(glm::abs(frame.positionMm), glm::dvec3(farthestMm))))
        return missing("Image Position (Patient): it is more than a kilometre away");

    DcmItem* orientation = attributes.group(DCM_PlaneOrientationSequence);
    std::array<double, 6> o{};
    if (!orientation || !numbers(*orientation, DCM_ImageOrientationPatient, o))
        return missing("Image Orientation (Patient)");
    const glm::dvec3 row(o[0], o[1], o[2]), column(o[3], o[4], o[5]);
    const bool unit =
        std::abs(glm::length(row) - 1.0) < 0.01 && std::abs(glm::length(column) - 1.0) < 0.01;
    if (!unit || std::abs(glm::dot(row, column)) > 0.01)
        return missing("Image Orientation (Patient): its directions are not orthogonal units");
    frame.rowDirection = glm::normalize(row);
    frame.columnDirection =
        glm::normalize(column - glm::dot(column, frame.rowDirection) * frame.rowDirection);

    DcmItem* measures = attributes.group(DCM_PixelMeasuresSequence);
    std::array<double, 2> spacing{};
    if (!measures || !numbers(*measures, DCM_PixelSpacing, spacing) || !(spacing[0] > 1e-3) ||
        !(spacing[1] > 1e-3) || spacing[0] > 100.0 || spacing[1] > 100.0) {
        return missing("Pixel Spacing");
    }
    frame.pixelSpacingMm = {spacing[1], spacing[0]};  // DICOM gives the rows' spacing first
    frame.thicknessMm = number(*measures, DCM_SliceThickness).value_or(0.0);

    DcmItem* transformation = attributes.group(DCM_PixelValueTransformationSequence);
    if (!transformation) return missing("Pixel Value Transformation");
    const auto slope = number(*transformation, DCM_RescaleSlope);
    const auto intercept = number(*transformation, DCM_RescaleIntercept);
    if (!slope || !intercept || *slope == 0.0)
        return missing("Rescale Slope and Rescale Intercept");
    frame.rescale = {*slope, *intercept};
    return frame;
}

Result<StoredFormat> readFormat(DcmItem& dataset, const std::string& place) {
    auto unsupported = [&](std::string message) {
        return fail(ErrorKind::unsupported, std::move(message), place);
    };
    if (whole(dataset, DCM_SamplesPerPixel).value_or(1) != 1)
        return unsupported("the CT image is in colour");
    const std::string photometric = text(dataset, DCM_PhotometricInterpretation);
    if (photometric != "MONOCHROME2") {
        return unsupported("the CT image's pixels are " +
                           (photometric.empty() ? "of no stated kind" : printable(photometric)) +
                           ", not MONOCHROME2");
    }
    StoredFormat format;
    format.bitsAllocated = whole(dataset, DCM_BitsAllocated).value_or(0);
    format.bitsStored = whole(dataset, DCM_BitsStored).value_or(format.bitsAllocated);
    format.highBit = whole(dataset, DCM_HighBit).value_or(format.bitsStored - 1);
    const int representation = whole(dataset, DCM_PixelRepresentation).value_or(-1);
    if (representation != 0 && representation != 1) {
        return fail(ErrorKind::badInput,
                    "the CT image does not say whether its pixels have signs: it has no valid "
                    "Pixel Representation",
                    place);
    }
    format.isSigned = representation == 1;
    if (!format.valid()) {
        return unsupported("the CT image's pixels have " + std::to_string(format.bitsAllocated) +
                           " bits allocated, " + std::to_string(format.bitsStored) +
                           " stored, high bit " + std::to_string(format.highBit) +
                           "; only 8 and 16 bits allocated are read");
    }
    auto cell = [&](const DcmTagKey& tag) -> std::optional<int> {
        Uint16 bits = 0;
        Sint16 value = 0;
        if (dataset.findAndGetUint16(tag, bits).bad()) {
            if (dataset.findAndGetSint16(tag, value).bad()) return std::nullopt;
            bits = Uint16(value);
        }
        return format.isSigned ? int(Sint16(bits)) : int(bits);
    };
    if (const auto padding = cell(DCM_PixelPaddingValue)) {
        const int limit = cell(DCM_PixelPaddingRangeLimit).value_or(*padding);
        format.padding = {std::min(*padding, limit), std::max(*padding, limit)};
    }
    return format;
}

Result<std::vector<FrameHeader>> readFrames(DcmItem& dataset, bool enhanced,
                                            const std::string& place) {
    Sint32 count = 0;
    if (dataset.findAndGetSint32(DCM_NumberOfFrames, count).bad())
        count = dataset.tagExistsWithValue(DCM_NumberOfFrames) ? 0 : 1;
    if (count < 1 || count > mostFrames) {
        return fail(
            ErrorKind::badInput,
            "the CT image's number of frames is not between 1 and " + std::to_string(mostFrames),
            place);
    }
    std::vector<FrameHeader> frames;
    if (!enhanced) {
        if (count != 1) {
            return fail(ErrorKind::unsupported,
                        "the CT image has several frames, but does not say where each lies", place);
        }
        auto frame = TRY(readFrame(FrameAttributes(dataset), place));
        frames.push_back(frame);
        return frames;
    }
    DcmItem* shared = nullptr;
    dataset.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared, 0);
    DcmSequenceOfItems* perFrame = nullptr;
    dataset.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame);
    const unsigned long groups = perFrame ? perFrame->card() : 0;
    if (groups != static_cast<unsigned long>(count)) {
        return fail(ErrorKind::badInput,
                    "the enhanced CT image has " + std::to_string(groups) +
                        " functional groups of " + std::to_string(count) + " frames",
                    place);
    }
    DcmObject* item = nullptr;
    for (int n = 0; n < count; ++n) {
        item = perFrame->nextInContainer(item);  // getItem(n) would walk the list each time
        auto frame =
            readFrame(FrameAttributes(dataset, dynamic_cast<DcmItem*>(item), shared), place);
        if (!frame) {
            frame.error().message += " (frame " + std::to_string(n + 1) + ")";
            return tl::make_unexpected(frame.error());
        }
        frames.push_back(*frame);
    }
    return frames;
}

/// Fills `image`; what was found before a failure stays.
Result<void> readImage(DcmItem& dataset, bool enhanced, const std::string& place,
                       ImageHeader& image) {
    image.studyUid = printable(text(dataset, DCM_StudyInstanceUID));
    image.seriesUid = printable(text(dataset, DCM_SeriesInstanceUID));
    image.instanceUid = text(dataset, DCM_SOPInstanceUID);
    image.frameOfReferenceUid = text(dataset, DCM_FrameOfReferenceUID);
    image.studyDate = text(dataset, DCM_StudyDate);
    image.studyTime = text(dataset, DCM_StudyTime);
    image.description = printable(text(dataset, DCM_SeriesDescription));
    image.position = patientPosition(text(dataset, DCM_PatientPosition));
    image.localizer = text(dataset, DCM_ImageType, 2) == "LOCALIZER";
    image.isLossy = text(dataset, DCM_LossyImageCompression) == "01";
    if (image.seriesUid.empty())
        return fail(ErrorKind::badInput, "the CT image has no Series Instance UID", place);
    const int columns = whole(dataset, DCM_Columns).value_or(0);
    const int rows = whole(dataset, DCM_Rows).value_or(0);
    if (rows == 0 || columns == 0)
        return fail(ErrorKind::badInput, "the CT image holds no picture", place);
    if (rows > largestMatrix || columns > largestMatrix) {
        return fail(ErrorKind::unsupported,
                    "the CT image has " + std::to_string(columns) + " columns and " +
                        std::to_string(rows) + " rows; up to " + std::to_string(largestMatrix) +
                        " are read",
                    place);
    }
    image.matrix = {columns, rows};
    if (image.localizer) return {};  // never decoded: its geometry does not matter
    auto format = TRY(readFormat(dataset, place));
    image.format = format;
    auto frames = TRY(readFrames(dataset, enhanced, place));
    image.frames = std::move(frames);
    return {};
}

DicomFile withoutImage(DicomFile::Kind kind, ErrorKind error, std::string message,
                       const std::filesystem::path& file) {
    DicomFile result;
    result.kind = kind;
    result.reason = {error, std::move(message), file.string()};
    return result;
}

}  // namespace

DicomFile readHeader(const std::filesystem::path& file) try {
    prepareDicomLibrary();
    using Kind = DicomFile::Kind;
    if (!startsLikeDicom(file)) {
        return withoutImage(Kind::notDicom, ErrorKind::unsupported, "this is not a DICOM file",
                            file);
    }
    DcmFileFormat format;
    const OFCondition condition =
        format.loadFileUntilTag(OFFilename(file.c_str()), EXS_Unknown, EGL_noChange,
                                DCM_MaxReadLength, ERM_autoDetect, DCM_PixelData);
    DcmDataset* dataset = format.getDataset();
    if (condition.bad() || !dataset || dataset->isEmpty()) {
        DicomFile damaged = withoutImage(
            Kind::damaged, ErrorKind::badInput,
            "the DICOM file cannot be read: " +
                (condition.bad() ? std::string(condition.text()) : std::string("it is empty")),
            file);
        // The last element read may be cut off: a UID there would name no series.
        DcmElement* last =
            dataset && !dataset->isEmpty() ? dataset->getElement(dataset->card() - 1) : nullptr;
        if (last && last->getTag() != DCM_SeriesInstanceUID)
            damaged.image.seriesUid = printable(text(*dataset, DCM_SeriesInstanceUID));
        return damaged;
    }
    std::string sopClass = text(*dataset, DCM_SOPClassUID);
    if (sopClass.empty() && format.getMetaInfo())  // cut off early, it is still what it was
        sopClass = text(*format.getMetaInfo(), DCM_MediaStorageSOPClassUID);
    const bool enhanced = sopClass == UID_EnhancedCTImageStorage ||
                          sopClass == UID_LegacyConvertedEnhancedCTImageStorage;
    if (!enhanced && sopClass != UID_CTImageStorage) {
        const char* name = dcmFindNameOfUID(sopClass.c_str(), nullptr);
        return withoutImage(Kind::otherObject, ErrorKind::unsupported,
                            std::string("this is not a CT image, but ") +
                                (name ? name : "a DICOM object of unknown class"),
                            file);
    }
    DicomFile result;
    result.kind = Kind::ctImage;
    result.image.file = file;
    result.image.sopClassUid = sopClass;
    if (auto read = readImage(*dataset, enhanced, file.string(), result.image); !read) {
        result.kind = Kind::damaged;
        result.reason = read.error();
    }
    return result;
} catch (const std::exception& error) {
    return withoutImage(DicomFile::Kind::damaged, ErrorKind::badInput,
                        std::string("the DICOM file cannot be read: ") + error.what(), file);
}

}  // namespace haustra::dicom
