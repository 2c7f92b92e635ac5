#include "core/printed_text.h"
#include "flatten/tube/camera_registration.h"
#include "flatten/tube/end_holes.h"
#include "flatten/tube/flattening.h"
#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"

#include <algorithm>
#include <cmath>

namespace haustra::pipeline {
namespace {

namespace product = store::product;
using store::Attributes;

// Raise it whenever the flat map changes for the same input and options.
constexpr int flatteningVersion = 6;
// The chord at the centerline's ends that tells where it looks.
constexpr double endWindowMm = 6.0;
// Fingers that a conformal map has no room for are 0.5 % of a colon's wall or less.
constexpr double largePouchShare = 0.02;

std::string spreadText(const flatten::Spread& spread) {
    return exactText(spread.mean) + "," + exactText(spread.p95) + "," + exactText(spread.p999) +
           "," + exactText(spread.max);
}

Result<flatten::PunchedTube> punch(const TriMesh& surface, const Centerline& centerline) {
    if (centerline.points.empty())
        return fail(ErrorKind::badInput, "the centerline has no ends to open the surface at");
    const CenterlinePose first = poseAtArc(centerline, 0.0, endWindowMm),
                         last = poseAtArc(centerline, centerline.lengthMm(), endWindowMm);
    const glm::dvec3 ends[2] = {first.point.positionMm, last.point.positionMm},
                     outwards[2] = {-first.tangent, last.tangent};
    return flatten::punchEnds(surface, ends, outwards);
}

// Of the camera that looks at the wall there.
double arcAtRowMm(const FlatMap& map, double y) {
    const auto nearest = std::ranges::min_element(
        map.flat, {}, [&](const glm::dvec2& at) { return std::abs(at.y - y); });
    const auto vertex = std::size_t(nearest - map.flat.begin());
    return map.cameras[std::size_t(map.camera[vertex])].arcMm;
}

// Of each spread: mean, 95 %, 99.9 %, largest.
void setDistortion(Attributes& attributes, const std::string& prefix,
                   const flatten::Distortion& distortion) {
    attributes[prefix + "angle-error-degrees"] = spreadText(distortion.angleErrorDegrees);
    attributes[prefix + "angle-floor-degrees"] = exactText(distortion.angleFloorDegrees);
    attributes[prefix + "dilatation"] = spreadText(distortion.dilatation);
    attributes[prefix + "log-area-deviation"] = exactText(distortion.logAreaDeviation);
    attributes[prefix + "area-range"] = exactText(distortion.areaRange);
}

std::string distortionNote(const flatten::Distortion& distortion) {
    return printed(
        "angles off by %.2f° in the mean (no map: below %.2f°), areas by a factor of %.2f",
        distortion.angleErrorDegrees.mean, distortion.angleFloorDegrees,
        std::exp(distortion.logAreaDeviation));
}

Attributes attributesOf(const flatten::Flattening& flat, const flatten::PunchedTube& punched,
                        double askedWeight) {
    Attributes attributes{
        {"modulus", exactText(flat.modulus)},
        {"certificate", exactText(flat.certificate)},
        {"area-weight", exactText(flat.areaWeight)},
        {"flips", "0"},  // flattenTube gives no map with any
        {"seam", exactText(flat.seam)},
        {"seam-mismatch", exactText(flat.seamMismatch)},
        {"cap-area-mm2", exactText(punched.capAreaMm2[0]) + "," + exactText(punched.capAreaMm2[1])},
        {"rim-length-mm",
         exactText(punched.rimLengthMm[0]) + "," + exactText(punched.rimLengthMm[1])},
        {"vertices", std::to_string(flat.map.surface.vertices.size())},
        {"triangles", std::to_string(flat.map.surface.triangles.size())},
        {"cameras", std::to_string(flat.map.cameras.size())}};
    setDistortion(attributes, "", flat.distortion);
    std::vector<std::string> notes{
        printed("modulus %.3f (certificate %.1e), ", flat.modulus, flat.certificate) +
        distortionNote(flat.distortion)};
    if (flat.pouches > 0) {
        setDistortion(attributes, "outside-", flat.outside);
        attributes["pouches"] = std::to_string(flat.pouches);
        attributes["pouch-area-mm2"] = exactText(flat.pouchAreaMm2);
        notes.push_back(
            printed("%zu blind pouches of %.0f mm² in all are mapped apart; outside them ",
                    flat.pouches, flat.pouchAreaMm2) +
            distortionNote(flat.outside));
        if (flat.largestPouchMm2 > largePouchShare * flat.wallAreaMm2) {
            notes.push_back(printed(
                "warning: %.0f %% of the wall lies in blind pouches, which the strip shows as "
                "dots: the largest, of %.0f mm², begins at %.0f mm of the centerline. Look at it "
                "from within; the course may pass by a part of the colon",
                100.0 * flat.pouchAreaMm2 / flat.wallAreaMm2, flat.largestPouchMm2,
                arcAtRowMm(flat.map, flat.largestPouchY)));
        }
    }
    if (flat.areaWeight > 0.0) {
        setDistortion(attributes, "conformal-", flat.conformal);
        notes.push_back("before areas were weighted: " + distortionNote(flat.conformal));
    } else if (askedWeight > 0.0) {
        notes.push_back(
            "warning: areas are not weighted, as the strip would fold, or has a large blind pouch: "
            "it is the conformal one");
    }
    setNotes(attributes, notes);
    return attributes;
}

}  // namespace

Result<ProductKey> flattenSurface(Preparation& preparation, const ProductKey& surfaceKey,
                                  const ProductKey& centerlineKey) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const ProductKey key =
        store::makeKey("flattening", flatteningVersion,
                       "area-weight=" + exactText(options.areaWeight), {surfaceKey, centerlineKey});
    StageCase stage = preparation.open("flattening", key);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        const auto surface = TRY(stage.readMesh(product::surface));
        const auto centerline = TRY(stage.readCenterline(product::centerline));
        const auto punched = TRY(punch(surface, centerline));
        progress(0.1);
        flatten::FlatteningOptions flattening;
        flattening.areaWeight = options.areaWeight;
        flattening.threads = options.threads;
        flattening.progress = [&](double fraction) { progress(0.1 + 0.8 * fraction); };
        flattening.placeName = [&](const glm::dvec3& placeMm) {
            return std::to_string(std::lround(nearestArc(centerline, placeMm))) +
                   " mm of the centerline";
        };
        auto flat = TRY(flatten::flattenTube(punched.tube, punched.firstLoop, flattening));
        for (std::int32_t& source : flat.map.sourceTriangle)
            source = punched.sourceTriangle[std::size_t(source)];
        flatten::CameraRegistrationOptions registration;
        registration.threads = options.threads;
        registration.isPouch = flat.isPouch;
        TRY(flatten::registerCameras(flat.map, centerline, registration));
        return stage.publish(product::flatMap, flat.map,
                             attributesOf(flat, punched, options.areaWeight));
    });
}

}  // namespace haustra::pipeline
