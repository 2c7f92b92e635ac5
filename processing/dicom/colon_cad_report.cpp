#include "dicom/colon_cad_report.h"

#include "core/durable_file.h"
#include "core/voxel_ellipsoid.h"
#include "dicom/dicom_library.h"
#include "dicom/series_selection.h"
#include "dicom/written_values.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmsr/codes/dcm.h>
#include <dcmtk/dcmsr/codes/ucum.h>
#include <dcmtk/dcmsr/dsrdoc.h>

namespace haustra::dicom {
namespace {

using Code = DSRBasicCodedEntry;
using Type = DSRTypes;

// The codes that DCMTK has no names for.
const Code percent("%", "UCUM", "Percent");
const Code english("en", "RFC5646", "English");
const Code polypOfColon("68496003", "SCT", "Polyp of colon");
const Code associatedMorphology("116676008", "SCT", "Associated Morphology");
const Code findingSite("363698007", "SCT", "Finding Site");
const Code diameter("81827009", "SCT", "Diameter");
const Code computedTomography("CT", "DCM", "Computed Tomography");

Code siteOf(ColonSegment segment) {
    switch (segment) {
        case ColonSegment::rectum:
            return {"34402009", "SCT", "Rectum"};
        case ColonSegment::sigmoid:
            return {"60184004", "SCT", "Sigmoid colon"};
        case ColonSegment::descending:
            return {"32622004", "SCT", "Descending colon"};
        case ColonSegment::transverse:
            return {"485005", "SCT", "Transverse colon"};
        case ColonSegment::ascending:
            return {"9040008", "SCT", "Ascending colon"};
        case ColonSegment::cecum:
            break;
    }
    return {"32713005", "SCT", "Cecum"};
}

/// CID 6209; none of a kind that it has no code for.
std::optional<Code> morphologyOf(const std::string& kind) {
    if (kind == "sessile") return Code("5712003", "SCT", "Sessile");
    if (kind == "pedunculated") return Code("25126001", "SCT", "Pedunculated");
    if (kind == "flat") return Code("6041008", "SCT", "Flat");
    if (kind == annularKind) return Code("255593009", "SCT", "Circumferential");
    return std::nullopt;
}

/// CID 19 and 20; none where the position is not known.
std::optional<Code> recumbency(PatientPosition position) {
    switch (position) {
        case PatientPosition::supine:
            return Code("40199007", "SCT", "supine");
        case PatientPosition::prone:
            return Code("1240000", "SCT", "prone");
        case PatientPosition::leftDecubitus:
            return Code("102536004", "SCT", "left lateral decubitus");
        case PatientPosition::rightDecubitus:
            return Code("102535000", "SCT", "right lateral decubitus");
        case PatientPosition::unknown:
            break;
    }
    return std::nullopt;
}

/// DICOM has leap seconds, DCMTK does not.
std::string withoutLeapSecond(std::string time) {
    if (time.size() >= 6 && time.compare(4, 2, "60") == 0) time.replace(4, 2, "59");
    return time;
}

double micrometres(double mm) {
    return std::round(mm * 1e3) / 1e3;
}

bool isAnnular(const Finding& finding) {
    return finding.kind == annularKind;
}

/// What DICOM's VR LO holds: 64 characters, none of which parts values.
std::string shortText(std::string text) {
    for (char& c : text) {
        if (c < 0x20 || c > 0x7e || c == '\\') c = '?';
    }
    if (text.size() > 64) text.resize(64);
    return text;
}

/// Adds content items, each below the one whose `children` call for it. Keeps the first failure.
class ContentTree {
public:
    using Children = std::function<void()>;

    ContentTree(DSRDocumentTree& tree, std::string frameOfReferenceUid)
        : tree_(tree), frameOfReferenceUid_(std::move(frameOfReferenceUid)) {}

    void container(Type::E_RelationshipType relation, const Code& name, const Children& children) {
        item(relation, Type::VT_Container, name, children, [](DSRContentItem& content) {
            return content.setContinuityOfContent(Type::COC_Separate);
        });
    }
    void code(Type::E_RelationshipType relation, const Code& name, const Code& value,
              const Children& children = {}) {
        item(relation, Type::VT_Code, name, children,
             [&](DSRContentItem& content) { return content.setCodeValue(value); });
    }
    void number(Type::E_RelationshipType relation, const Code& name, double value, const Code& unit,
                const Children& children = {}) {
        item(relation, Type::VT_Num, name, children, [&](DSRContentItem& content) {
            return content.setNumericValue(
                DSRNumericMeasurementValue(decimal(value).c_str(), unit));
        });
    }
    /// TEXT, UIDREF, DATE or TIME.
    void string(Type::E_RelationshipType relation, Type::E_ValueType type, const Code& name,
                const std::string& value) {
        item(relation, type, name, {},
             [&](DSRContentItem& content) { return content.setStringValue(value.c_str()); });
    }
    void places(Type::E_RelationshipType relation, const Code& name, Type::E_GraphicType3D type,
                std::initializer_list<glm::dvec3> placesMm) {
        item(relation, Type::VT_SCoord3D, name, {}, [&](DSRContentItem& content) {
            DSRSpatialCoordinates3DValue value(type);
            value.setFrameOfReferenceUID(frameOfReferenceUid_.c_str());
            for (glm::dvec3 p : placesMm)
                value.getGraphicDataList().addItem(Float32(p.x), Float32(p.y), Float32(p.z));
            return content.setSpatialCoordinates3D(value);
        });
    }
    const OFCondition& condition() const { return condition_; }

private:
    template <class Fill>
    void item(Type::E_RelationshipType relation, Type::E_ValueType type, const Code& name,
              const Children& children, Fill fill) {
        if (condition_.bad()) return;
        const bool first = tree_.isEmpty();
        // Below the item that is open; beside its last child where it has one.
        const Type::E_AddMode where = descend_ ? Type::AM_belowCurrent : Type::AM_afterCurrent;
        if (tree_.addContentItem(relation, type, first ? Type::AM_afterCurrent : where) == 0) {
            condition_ = SR_EC_CannotAddContentItem;
            return;
        }
        keep(tree_.getCurrentContentItem().setConceptName(name));
        keep(fill(tree_.getCurrentContentItem()));
        if (children) {
            descend_ = true;
            children();
            // Nothing may have been added.
            if (!descend_ && condition_.good()) tree_.goUp();
        }
        descend_ = false;
    }
    void keep(const OFCondition& condition) {
        if (condition_.good()) condition_ = condition;
    }

    DSRDocumentTree& tree_;
    const std::string frameOfReferenceUid_;
    bool descend_ = false;  ///< the tree's current item is the parent of what comes next
    OFCondition condition_ = EC_Normal;
};

/// Equally spaced slices, one after the other.
struct SliceRun {
    double spacingMm = 0.0;  ///< 0 of a single slice
    double thicknessMm = 0.0;
    bool operator==(const SliceRun&) const = default;
};

/// One where the spacing is the same throughout, by the measure of series_geometry.h: rounded
/// positions count as equally spaced.
std::vector<SliceRun> runsOf(const SourceSeries& source) {
    const glm::dvec3 normal = glm::cross(source.rowDirection, source.columnDirection);
    std::vector<double> depth;
    for (const SourceImage& image : source.images)
        depth.push_back(glm::dot(image.positionMm, normal));
    const double thickness = micrometres(source.images.front().thicknessMm);
    if (depth.size() == 1) return {{0.0, thickness}};
    const double mean = (depth.back() - depth.front()) / double(depth.size() - 1);
    bool uniform = true;
    for (std::size_t k = 0; k < depth.size(); ++k)
        uniform &= std::abs(depth[k] - depth[0] - mean * double(k)) < 0.1 * mean;
    if (uniform) return {{micrometres(mean), thickness}};
    std::vector<SliceRun> runs;
    for (std::size_t k = 0; k + 1 < depth.size(); ++k) {
        const SliceRun run{micrometres(depth[k + 1] - depth[k]),
                           micrometres(source.images[k].thicknessMm)};
        const bool goesOn = !runs.empty() && runs.back().thicknessMm == run.thicknessMm &&
                            std::abs(runs.back().spacingMm - run.spacingMm) < 0.1 * run.spacingMm;
        if (!goesOn) runs.push_back(run);
    }
    return runs;
}

class Report {
public:
    Report(DSRDocumentTree& tree, const Findings& findings, const SourceSeries& source)
        : out_(tree, source.frameOfReferenceUid), findings_(findings), source_(source) {}

    /// TID 4120.
    OFCondition write() {
        out_.container(Type::RT_isRoot, CODE_DCM_ColonCADReport, [&] {
            out_.code(Type::RT_hasConceptMod, CODE_DCM_LanguageOfContentItemAndDescendants,
                      english);
            for (const SliceRun& run : runsOf(source_))
                imageSetProperties(run);
            findingsSummary();
            summaryOfDetections();
            out_.code(Type::RT_contains, CODE_DCM_SummaryOfAnalyses, CODE_DCM_NotAttempted);
        });
        return out_.condition();
    }

private:
    // Detection has looked at a part of the wall alone.
    bool partial() const { return findings_.unexaminedMm2 > 0.0; }

    /// TID 4122.
    void imageSetProperties(const SliceRun& run) {
        const auto contains = Type::RT_contains;
        out_.container(contains, CODE_DCM_ImageSetProperties, [&] {
            out_.string(contains, Type::VT_UIDRef, CODE_DCM_FrameOfReferenceUID,
                        source_.frameOfReferenceUid);
            out_.string(contains, Type::VT_UIDRef, CODE_DCM_StudyInstanceUID, source_.studyUid);
            if (!source_.studyDate.empty())
                out_.string(contains, Type::VT_Date, CODE_DCM_StudyDate, source_.studyDate);
            if (!source_.studyTime.empty())
                out_.string(contains, Type::VT_Time, CODE_DCM_StudyTime,
                            withoutLeapSecond(source_.studyTime));
            out_.code(contains, CODE_DCM_Modality, computedTomography);
            length(contains, CODE_DCM_HorizontalPixelSpacing, source_.pixelSpacingMm.x);
            length(contains, CODE_DCM_VerticalPixelSpacing, source_.pixelSpacingMm.y);
            if (run.thicknessMm > 0.0) length(contains, CODE_DCM_SliceThickness, run.thicknessMm);
            if (run.spacingMm > 0.0) length(contains, CODE_DCM_SpacingBetweenSlices, run.spacingMm);
            if (const auto lies = recumbency(source_.position))
                out_.code(contains, CODE_DCM_RecumbentPatientPositionWithRespectToGravity, *lies);
        });
    }

    /// TID 4121. Its code says whether the tree below it is empty, of candidates too.
    void findingsSummary() {
        const bool none = findings_.findings.empty() && findings_.candidates.empty();
        const Code succeeded = none ? CODE_DCM_AllAlgorithmsSucceeded_withoutFindings
                                    : CODE_DCM_AllAlgorithmsSucceeded_withFindings;
        const Code notAll = none ? CODE_DCM_NotAllAlgorithmsSucceeded_withoutFindings
                                 : CODE_DCM_NotAllAlgorithmsSucceeded_withFindings;
        out_.code(Type::RT_contains, CODE_DCM_CADProcessingAndFindingsSummary,
                  partial() ? notAll : succeeded, [&] {
                      all(findings_.findings, "finding ", 1,
                          CODE_DCM_PresentationRequired_RenderingDeviceIsExpectedToPresent);
                      all(findings_.candidates, "candidate ", findings_.findings.size() + 1,
                          CODE_DCM_PresentationOptional_RenderingDeviceMayPresent);
                  });
    }

    // Numbered as a reading station does, the one list after the other.
    void all(const std::vector<Finding>& list, const std::string& name, std::size_t first,
             const Code& intent) {
        for (std::size_t n = 0; n < list.size(); ++n)
            feature(list[n], name + std::to_string(first + n), intent);
    }

    /// TID 4125.
    void feature(const Finding& finding, const std::string& name, const Code& intent) {
        const auto properties = Type::RT_hasProperties;
        out_.code(Type::RT_inferredFrom, CODE_DCM_CompositeFeature, polypOfColon, [&] {
            out_.code(Type::RT_hasConceptMod, CODE_DCM_RenderingIntent, intent);
            out_.string(Type::RT_hasObsContext, Type::VT_Text, CODE_DCM_TrackingIdentifier, name);
            // No code that we know for sure names what it may be; this says how it was found.
            algorithm(Type::RT_hasObsContext,
                      isAnnular(finding)
                          ? std::vector<std::string>{"a rule that has not learnt: the wall is " +
                                                     decimal(std::round(finding.heightMm)) +
                                                     " mm thick all around"}
                          : std::vector<std::string>());
            // TID 4126.
            out_.code(properties, CODE_DCM_CompositeType,
                      CODE_DCM_TargetContentItemsAreRelatedSpatially);
            out_.code(properties, CODE_DCM_ScopeOfFeature,
                      CODE_DCM_FeatureDetectedonMultipleImages);
            out_.number(properties, CODE_DCM_CertaintyOfFeature,
                        std::round(finding.score * 1e8) / 1e6, percent);
            geometry(finding);
            descriptors(finding);
        });
    }

    /// TID 4129.
    void geometry(const Finding& finding) {
        out_.places(Type::RT_hasProperties, CODE_DCM_Center, Type::GT3_Point, {finding.positionMm});
        if (finding.voxels.empty()) return;
        const Ellipsoid e = ellipsoidOf(finding.voxels, findings_.grid);
        const auto& [a, b, c] = e.halfAxesMm;
        out_.places(Type::RT_hasProperties, CODE_DCM_Outline, Type::GT3_Ellipsoid,
                    {e.centerMm - a, e.centerMm + a, e.centerMm - b, e.centerMm + b, e.centerMm - c,
                     e.centerMm + c});
    }

    /// TID 4128, whose order is significant: morphology, site, distance from the anus, height,
    /// diameter. Of a truth there is no more than a kind and a diameter, without its ends.
    void descriptors(const Finding& finding) {
        const auto properties = Type::RT_hasProperties;
        const bool detected = !finding.voxels.empty();
        if (const auto morphology = morphologyOf(finding.kind))
            out_.code(properties, associatedMorphology, *morphology);
        if (finding.segment) out_.code(properties, findingSite, siteOf(*finding.segment));
        if (detected) {
            length(properties, CODE_DCM_DistanceFromAnus, finding.arcMm);
            if (!isAnnular(finding)) length(properties, CODE_DCM_Height, finding.heightMm);
        }
        const auto& ends = finding.diameterEndsMm;
        const bool haveEnds = detected && ends.first != ends.second;
        length(properties, diameter, finding.diameterMm, [&] {
            if (haveEnds)
                out_.places(Type::RT_inferredFrom, CODE_DCM_Path, Type::GT3_Polyline,
                            {ends.first, ends.second});
        });
    }

    void length(Type::E_RelationshipType relation, const Code& name, double mm,
                const ContentTree::Children& children = {}) {
        out_.number(relation, name, micrometres(mm), CODE_UCUM_Millimeter, children);
    }

    /// TID 4019.
    void algorithm(Type::E_RelationshipType relation, const std::vector<std::string>& parameters) {
        const DetectionModel& model = findings_.model;
        out_.string(relation, Type::VT_Text, CODE_DCM_AlgorithmName,
                    model.name.empty() ? model.software : model.name);
        out_.string(
            relation, Type::VT_Text, CODE_DCM_AlgorithmVersion,
            model.software + (model.sha256.empty() ? "" : "; model's SHA-256 " + model.sha256));
        for (const std::string& parameter : parameters)
            out_.string(relation, Type::VT_Text, CODE_DCM_AlgorithmParameters, parameter);
    }

    void summaryOfDetections() {
        out_.code(Type::RT_contains, CODE_DCM_SummaryOfDetections,
                  partial() ? CODE_DCM_PartiallySucceeded : CODE_DCM_Succeeded, [&] {
                      // TID 4015.
                      std::vector<std::string> how{"operating point: " +
                                                   decimal(findings_.operatingPoint)};
                      if (!findings_.model.trainedOn.empty())
                          how.push_back("trained on: " + findings_.model.trainedOn);
                      for (const std::string& warning : findings_.warnings)
                          how.push_back("warning: " + warning);
                      detections(CODE_DCM_SuccessfulDetections, {how});
                      if (!partial()) return;
                      const std::vector<std::string> why{"wall that was not examined: " +
                                                         decimal(findings_.unexaminedMm2) + " mm2"};
                      detections(CODE_DCM_FailedDetections, {why});
                  });
    }

    void detections(const Code& name, const std::vector<std::vector<std::string>>& parameters) {
        out_.container(Type::RT_inferredFrom, name, [&] {
            for (const std::vector<std::string>& of : parameters) {
                // TID 4017.
                out_.code(Type::RT_contains, CODE_DCM_DetectionPerformed, polypOfColon, [&] {
                    algorithm(Type::RT_hasProperties, of);
                    out_.string(Type::RT_hasProperties, Type::VT_UIDRef, CODE_DCM_SeriesInstanceUID,
                                source_.seriesUid);
                });
            }
        });
    }

    ContentTree out_;
    const Findings& findings_;
    const SourceSeries& source_;
};

/// What a report takes over of its patient and study.
const DcmTagKey identityTags[] = {
    DCM_PatientName, DCM_PatientID,        DCM_IssuerOfPatientID,     DCM_PatientBirthDate,
    DCM_PatientSex,  DCM_StudyID,          DCM_AccessionNumber,       DCM_StudyDate,
    DCM_StudyTime,   DCM_StudyDescription, DCM_ReferringPhysicianName};

Result<void> sameImages(const Series& series, const SourceSeries& source,
                        const std::string& place) {
    std::set<std::string> found, wanted;
    bool sameStudy = true;
    for (const ImageHeader& image : series.images) {
        if (!image.frames.empty()) found.insert(image.instanceUid);
        sameStudy &= image.studyUid == source.studyUid;
    }
    for (const SourceImage& image : source.images)
        wanted.insert(image.sopInstanceUid);
    if (sameStudy && found == wanted) return {};
    return fail(ErrorKind::badInput, "these are not the very images that the case was made from",
                place);
}

OFString textOf(DcmItem& item, const DcmTagKey& tag) {
    OFString text;
    item.findAndGetOFStringArray(tag, text);
    return text;
}

/// The identity's attributes and their character set, as one image has them.
Result<void> readIdentityOf(const std::filesystem::path& file, DcmItem& identity) {
    DcmFileFormat format;
    OFCondition condition =
        format.loadFileUntilTag(OFFilename(file.c_str()), EXS_Unknown, EGL_noChange,
                                DCM_MaxReadLength, ERM_autoDetect, DCM_PixelData);
    if (condition.good()) {
        DcmItem& dataset = *format.getDataset();
        const OFString characters = textOf(dataset, DCM_SpecificCharacterSet);
        if (!characters.empty())
            condition = identity.putAndInsertOFStringArray(DCM_SpecificCharacterSet, characters);
        for (const DcmTagKey& tag : identityTags) {
            if (condition.good() && dataset.tagExists(tag))
                condition = dataset.findAndInsertCopyOfElement(tag, &identity);
        }
    }
    if (condition.good()) return {};
    return fail(ErrorKind::badInput,
                std::string("whose series it is cannot be read: ") + condition.text(),
                file.string());
}

/// Images of one series may name two patients all the same, where an archive has mixed them.
Result<void> sameIdentity(const Series& series, DcmItem& identity) {
    std::set<std::filesystem::path> read{series.images.front().file};
    for (const ImageHeader& image : series.images) {
        if (!read.insert(image.file).second) continue;
        DcmItem other;
        TRY(readIdentityOf(image.file, other));
        for (const DcmTagKey& tag : identityTags) {
            if (textOf(other, tag) == textOf(identity, tag)) continue;
            return fail(ErrorKind::badInput,
                        std::string("the series' images differ in ") + DcmTag(tag).getTagName() +
                            ", so that it is not known whose they are: this one is not as " +
                            series.images.front().file.filename().string(),
                        image.file.string());
        }
    }
    return {};
}

/// The identity's attributes, of which all images must say the same: in UTF-8, or in their own
/// character set where that is none that can be converted.
Result<void> readIdentity(const ColonCadReportOptions& options, const SourceSeries& source,
                          DcmItem& identity) {
    const std::string place = options.series.string();
    auto found = TRY(findSeries(options.series, options.threads, {}));
    const auto series = TRY(chooseSeries(std::move(found), source.seriesUid, options.series));
    TRY(sameImages(series, source, place));
    const std::filesystem::path& file = series.images.front().file;
    TRY(readIdentityOf(file, identity));
    TRY(sameIdentity(series, identity));
    if (identity.convertToUTF8().good()) return {};
    identity.clear();
    TRY(readIdentityOf(file, identity));
    if (textOf(identity, DCM_SpecificCharacterSet).empty()) {
        return fail(ErrorKind::badInput,
                    "the patient's name or another of its texts has characters beyond ASCII, and "
                    "no character set is named (SpecificCharacterSet)",
                    file.string());
    }
    return {};
}

constexpr char utf8[] = "ISO_IR 192";

/// Of an identity that could not be converted: its own, empty else.
OFString ownCharacterSet(DcmItem& identity) {
    const OFString characters = textOf(identity, DCM_SpecificCharacterSet);
    return characters == utf8 ? OFString() : characters;
}

Result<void> checkSource(const SourceSeries& source, const std::string& place) {
    const auto refuse = [&](const char* why) { return fail(ErrorKind::badInput, why, place); };
    if (source.images.empty() || source.seriesUid.empty())
        return refuse("a DICOM report needs the DICOM series that the scan came from");
    if (source.studyUid.empty()) return refuse("the scan's series is of no one DICOM study");
    if (source.frameOfReferenceUid.empty())
        return refuse("the scan's images do not name one DICOM frame of reference");
    for (const SourceImage& image : source.images) {
        if (image.sopClassUid.empty() || image.sopInstanceUid.empty())
            return refuse("an image of the scan's series has no valid DICOM UID");
    }
    return {};
}

bool isAscii(std::string_view text) {
    return std::ranges::all_of(text, [](unsigned char c) { return c < 0x80; });
}

/// Readers that know ASCII only are served where that is all there is.
bool needsUtf8(const Findings& findings) {
    const DetectionModel& model = findings.model;
    return !(isAscii(model.software) && isAscii(model.name) && isAscii(model.trainedOn) &&
             std::ranges::all_of(findings.warnings, isAscii));
}
bool needsUtf8(DcmItem& identity) {
    return !std::ranges::all_of(identityTags, [&](const DcmTagKey& tag) {
        const OFString text = textOf(identity, tag);
        return isAscii({text.c_str(), text.length()});
    });
}

/// The data set's bytes, for hashing.
Result<std::string> bytesOf(DcmDataset& dataset) {
    const Uint32 length = dataset.calcElementLength(EXS_LittleEndianExplicit, EET_ExplicitLength);
    std::string bytes(std::size_t(length) + 1024, '\0');
    DcmOutputBufferStream stream(bytes.data(), offile_off_t(bytes.size()));
    dataset.transferInit();
    const OFCondition written = dataset.write(stream, EXS_LittleEndianExplicit, EET_ExplicitLength,
                                              nullptr, EGL_recalcGL, EPD_withoutPadding);
    dataset.transferEnd();
    if (written.bad()) return fail(ErrorKind::io, "the report cannot be written");
    void* buffer = nullptr;
    offile_off_t filled = 0;
    stream.flushBuffer(buffer, filled);
    return std::string(static_cast<const char*>(buffer), std::size_t(filled));
}

OFCondition fillHeader(DSRDocument& document, const Findings& findings,
                       const SourceSeries& source) {
    const DetectionModel& model = findings.model;
    OFCondition condition = EC_Normal;
    const auto keep = [&](const OFCondition& next) {
        if (condition.good()) condition = next;
    };
    keep(document.createNewSeriesInStudy(source.studyUid.c_str()));
    keep(document.setStudyDate(source.studyDate.c_str()));
    const std::string studyTime = withoutLeapSecond(source.studyTime);
    keep(document.setStudyTime(studyTime.c_str()));
    // Of the study, so that the same findings give the same file.
    keep(document.setContentDate(source.studyDate.empty() ? "19000101" : source.studyDate.c_str()));
    keep(document.setContentTime(studyTime.empty() ? "000000" : studyTime.c_str()));
    keep(document.setSeriesDescription("Haustra colon CAD"));
    keep(document.setManufacturer("Haustra"));
    keep(document.setManufacturerModelName("Haustra colon CAD"));
    keep(document.setDeviceSerialNumber(model.sha256.empty() ? "0"
                                                             : shortText(model.sha256).c_str()));
    keep(document.setSoftwareVersions(shortText(model.software).c_str()));
    std::set<std::string> listed;
    for (const SourceImage& image : source.images) {
        if (!listed.insert(image.sopInstanceUid).second) continue;  // another frame of it
        keep(document.getCurrentRequestedProcedureEvidence().addItem(
            source.studyUid.c_str(), source.seriesUid.c_str(), image.sopClassUid.c_str(),
            image.sopInstanceUid.c_str()));
    }
    keep(document.completeDocument());
    return condition;
}

/// Puts what tells this document from every other in the place of what DCMTK makes up: random UIDs
/// and the hour.
Result<void> nameDocument(DcmDataset& dataset, const Findings& findings,
                          const SourceSeries& source) {
    for (const DcmTagKey& tag : {DCM_InstanceCreationDate, DCM_InstanceCreationTime,
                                 DCM_InstanceCreatorUID, DCM_TimezoneOffsetFromUTC})
        dataset.findAndDeleteElement(tag);
    const DetectionModel& model = findings.model;
    const std::string series = uidOf(source.seriesUid + "/colon CAD/" + model.software + "/" +
                                     model.name + "/" + model.sha256);
    dataset.putAndInsertString(DCM_SeriesInstanceUID, series.c_str());
    dataset.putAndInsertString(DCM_SOPInstanceUID, "2.25.0");
    const auto bytes = TRY(bytesOf(dataset));
    dataset.putAndInsertString(DCM_SOPInstanceUID, uidOf(bytes).c_str());
    return {};
}

Result<void> save(DcmFileFormat& format, const std::filesystem::path& file) {
    DurableFile made(file);
    TRY(made.isMade());
    const OFCondition saved =
        format.saveFile(OFFilename(made.beside().c_str()), EXS_LittleEndianExplicit,
                        EET_ExplicitLength, EGL_recalcGL, EPD_withoutPadding);
    if (saved.bad()) {
        return fail(ErrorKind::io, std::string("the report cannot be written: ") + saved.text(),
                    file.string());
    }
    return made.publish();
}

}  // namespace

Result<void> writeColonCadReport(const std::filesystem::path& file, const Findings& findings,
                                 const SourceSeries& source,
                                 const ColonCadReportOptions& options) try {
    prepareDicomLibrary();
    const std::string place = file.string();
    TRY(checkSource(source, place));
    if (findings.model.software.empty())
        return fail(ErrorKind::badInput, "the findings do not say what program found them", place);
    DcmDataset identity;
    if (!options.series.empty()) TRY(readIdentity(options, source, identity));

    DSRDocument document(Type::DT_ColonCadSR);
    DcmFileFormat format;
    DcmDataset& dataset = *format.getDataset();
    const OFString characters = ownCharacterSet(identity);
    if (!characters.empty() && needsUtf8(findings)) {
        return fail(ErrorKind::unsupported,
                    std::string("the patient's name is in the character set ") +
                        characters.c_str() + ", in which the findings' own text cannot be written",
                    options.series.string());
    }
    if (characters.empty() && (needsUtf8(findings) || needsUtf8(identity)))
        document.setSpecificCharacterSetType(Type::CS_UTF8);
    OFCondition condition = fillHeader(document, findings, source);
    if (condition.good()) condition = Report(document.getTree(), findings, source).write();
    if (condition.good()) condition = document.getTree().setTemplateIdentification("4120", "DCMR");
    if (condition.good()) condition = document.write(dataset);
    for (const DcmTagKey& tag : identityTags) {
        if (condition.good() && identity.tagExists(tag))
            condition = identity.findAndInsertCopyOfElement(tag, &dataset);
    }
    if (condition.good() && !characters.empty())
        condition = dataset.putAndInsertOFStringArray(DCM_SpecificCharacterSet, characters);
    if (condition.bad()) {
        return fail(ErrorKind::badInput,
                    std::string("the findings make no DICOM report: ") + condition.text(), place);
    }
    TRY(nameDocument(dataset, findings, source));
    return save(format, file);
} catch (const std::exception& error) {
    return fail(ErrorKind::io, std::string("the report cannot be written: ") + error.what(),
                file.string());
}

}  // namespace haustra::dicom
