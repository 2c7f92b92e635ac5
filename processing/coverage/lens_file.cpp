#include "coverage/lens_file.h"

#include "core/text_file.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <nlohmann/json.hpp>

namespace haustra::coverage {
namespace {

using nlohmann::json, nlohmann::ordered_json;

constexpr const char* projectionNames[] = {"equidistance", "stereographic", "equisolid",
                                           "orthogonal", "perspective"};
constexpr std::size_t mostBytes = std::size_t(1) << 20;

/// Takes numbers out of a lens file and remembers the first thing that is wrong.
class LensFields {
public:
    LensFields(const json& object, std::string place) : object_(object), place_(std::move(place)) {}

    bool has(const char* field) const { return object_.contains(field); }
    void numbers(const char* field, std::size_t count, double* values) {
        const auto found = object_.find(field);
        if (found == object_.end()) return wrong(field, "is missing");
        const bool list = found->is_array();
        if (list ? found->size() != count : count != 1) return wrong(field, count);
        for (std::size_t n = 0; n < count; ++n) {
            const json& value = list ? (*found)[n] : *found;
            if (!value.is_number() || !std::isfinite(value.get<double>()))
                return wrong(field, count);
            values[n] = value.get<double>();
        }
    }
    std::string text(const char* field) {
        const auto found = object_.find(field);
        if (found == object_.end() || !found->is_string()) {
            wrong(field, "is no text");
            return {};
        }
        return found->get<std::string>();
    }
    void wrong(const char* field, const std::string& what) {
        if (!error_)
            error_ = Error{ErrorKind::badInput,
                           std::string("the field ") + field + " of the lens " + what, place_};
    }
    Result<void> finish() const {
        if (error_) return tl::make_unexpected(*error_);
        return {};
    }

private:
    void wrong(const char* field, std::size_t count) {
        wrong(field, count == 1 ? "is not a finite number"
                                : "is not a list of " + std::to_string(count) + " finite numbers");
    }
    const json& object_;
    std::string place_;
    std::optional<Error> error_;
};

ordered_json reportOf(const LensModel& model, const Calibration& calibration) {
    ordered_json errors, views = ordered_json::array();
    for (std::size_t n = 0; n < lensNumbers; ++n)
        if (calibration.standardErrors[n] > 0.0)
            errors[lensNumberNames()[n]] = calibration.standardErrors[n];
    std::size_t points = 0;
    for (const ViewFit& view : calibration.views) {
        views.push_back({{"points", view.residuals.size()},
                         {"rms_pixels", view.rmsPixels},
                         {"largest_pixels", view.largestPixels}});
        points += view.residuals.size();
    }
    ordered_json report{{"model", model.name},
                        {"r", model.formula},
                        {"held", lensNumberNames()[calibration.held]},
                        {"standard_errors", errors},
                        {"focal_pixels", calibration.focalPixels},
                        {"focal_pixels_standard_error", calibration.focalError},
                        {"points", points},
                        {"rms_pixels", calibration.rmsPixels},
                        {"outermost_point_degrees", glm::degrees(calibration.largestAngle)},
                        {"pictures", views}};
    if (calibration.dotRadiusMm > 0.0) {
        report["dot_radius_mm"] = calibration.dotRadiusMm;
        report["largest_dot_bias_pixels"] = calibration.largestBiasPixels;
    }
    return report;
}

}  // namespace

std::string lensText(const Colonoscope& scope, const LensModel* model,
                     const Calibration* calibration) {
    const FisheyeLens& lens = scope.lens;
    ordered_json file{{"name", scope.name},
                      {"projection", projectionNames[int(lens.projection)]},
                      {"k", lens.k},
                      {"m_u", lens.mu},
                      {"m_v", lens.mv},
                      {"u0", lens.u0},
                      {"v0", lens.v0},
                      {"decentring", lens.decentring},
                      {"picture_size", {scope.pictureSize.x, scope.pictureSize.y}},
                      {"open_centre", {scope.openCenter.x, scope.openCenter.y}},
                      {"open_radii", {scope.openRadii.x, scope.openRadii.y}},
                      {"field_degrees", scope.fieldDegrees},
                      {"depth_of_field_mm", {scope.nearestMm, scope.farthestMm}},
                      {"tip_radius_mm", scope.tipRadiusMm}};
    if (model && calibration) file["calibration"] = reportOf(*model, *calibration);
    return file.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

Result<Colonoscope> colonoscopeOfText(std::string_view text, const std::string& place) {
    const json file = json::parse(text, nullptr, false);
    if (!file.is_object())
        return fail(ErrorKind::badInput, "the lens file is not a JSON object", place);
    LensFields fields(file, place);
    Colonoscope scope;
    scope.name = fields.text("name");
    const std::string projection = fields.text("projection");
    const auto named =
        std::find(std::begin(projectionNames), std::end(projectionNames), projection);
    if (named == std::end(projectionNames))
        fields.wrong("projection",
                     "is none of equidistance, stereographic, equisolid, orthogonal, "
                     "perspective");
    else
        scope.lens.projection = Projection(named - std::begin(projectionNames));
    fields.numbers("k", 5, scope.lens.k.data());
    fields.numbers("m_u", 1, &scope.lens.mu);
    fields.numbers("m_v", 1, &scope.lens.mv);
    fields.numbers("u0", 1, &scope.lens.u0);
    fields.numbers("v0", 1, &scope.lens.v0);
    if (fields.has("decentring")) fields.numbers("decentring", 2, scope.lens.decentring.data());
    glm::dvec2 size(1.0), depth(0.0);
    fields.numbers("picture_size", 2, &size.x);
    fields.numbers("open_centre", 2, &scope.openCenter.x);
    fields.numbers("open_radii", 2, &scope.openRadii.x);
    fields.numbers("field_degrees", 1, &scope.fieldDegrees);
    fields.numbers("depth_of_field_mm", 2, &depth.x);
    fields.numbers("tip_radius_mm", 1, &scope.tipRadiusMm);
    for (const double side : {size.x, size.y})
        if (!(side >= 1.0 && side <= mostScopePixels && side == std::floor(side)))
            fields.wrong("picture_size", "is not within 1 to " + std::to_string(mostScopePixels));
    if (!(scope.openRadii.x > 0.0 && scope.openRadii.y > 0.0))
        fields.wrong("open_radii", "is not over 0");
    if (!(scope.fieldDegrees > 0.0 && scope.fieldDegrees <= 360.0))
        fields.wrong("field_degrees", "is not within 0 to 360");
    if (!(depth.x >= 0.0 && depth.y > depth.x))
        fields.wrong("depth_of_field_mm", "does not run from 0 or more to more");
    if (!(scope.tipRadiusMm >= 0.0)) fields.wrong("tip_radius_mm", "is under 0");
    TRY(fields.finish());
    if (const auto sound = checkLens(scope.lens); !sound)
        return fail(sound.error().kind, sound.error().message, place);
    scope.pictureSize = glm::ivec2(size);
    scope.nearestMm = depth.x, scope.farthestMm = depth.y;
    return scope;
}

Result<Colonoscope> readColonoscope(const std::string& nameOrFile) {
    if (nameOrFile == "olympus-cf-q160l") return olympusCfQ160l();
    std::error_code ignored;
    if (!std::filesystem::exists(nameOrFile, ignored))
        return fail(ErrorKind::notFound,
                    "there is no such lens: neither a file nor olympus-cf-q160l", nameOrFile);
    if (!std::filesystem::is_regular_file(nameOrFile, ignored))
        return fail(ErrorKind::badInput, "this is no lens file", nameOrFile);
    const auto text = TRY(readTextFile(nameOrFile, mostBytes));
    // OpenCV's JSON has a camera_matrix, and neither its YAML nor its XML is JSON.
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool own =
        first != text.npos && text[first] == '{' && text.find("\"projection\"") != text.npos;
    return own ? colonoscopeOfText(text, nameOrFile) : lensOfOpenCvText(text, nameOrFile);
}

}  // namespace haustra::coverage
