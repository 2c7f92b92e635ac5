#include "core/source_series.h"

#include "core/printed_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace haustra {
namespace {

using OrderedJson = nlohmann::ordered_json;

constexpr double farthestMm = 1e6;  // no scanner's bed is longer

bool isDigit(char c) {
    return c >= '0' && c <= '9';
}

bool allDigits(std::string_view text) {
    return std::ranges::all_of(text, isDigit);
}

int twoDigits(std::string_view text, std::size_t at) {
    return 10 * (text[at] - '0') + (text[at + 1] - '0');
}

void require(bool condition, const char* otherwise) {
    if (!condition) throw std::invalid_argument(otherwise);
}

double millimetresIn(const OrderedJson& json) {
    const double value = json.get<double>();
    require(std::isfinite(value) && std::abs(value) <= farthestMm, "a number is out of range");
    return value;
}

glm::dvec3 vectorIn(const OrderedJson& json) {
    require(json.is_array() && json.size() == 3, "a place has three coordinates");
    return {millimetresIn(json.at(0)), millimetresIn(json.at(1)), millimetresIn(json.at(2))};
}

std::string uidIn(const OrderedJson& json, const char* name) {
    std::string uid = json.at(name);
    require(uid.empty() || isUid(uid), "a UID is not one");
    return uid;
}

SourceImage imageOf(const OrderedJson& json) {
    SourceImage image{uidIn(json, "class"), uidIn(json, "instance"), json.value("frame", 0),
                      vectorIn(json.at("position_mm")), millimetresIn(json.at("thickness_mm"))};
    require(image.frame >= 0 && image.thicknessMm >= 0.0, "a number is out of range");
    return image;
}

OrderedJson imageJson(const SourceImage& image) {
    const glm::dvec3 p = image.positionMm;
    OrderedJson json{{"class", image.sopClassUid}, {"instance", image.sopInstanceUid}};
    if (image.frame > 0) json["frame"] = image.frame;
    json["position_mm"] = {p.x, p.y, p.z};
    json["thickness_mm"] = image.thicknessMm;
    return json;
}

}  // namespace

bool isUid(std::string_view text) {
    if (text.empty() || text.size() > 64) return false;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('.', at), text.size());
        const std::string_view number = text.substr(at, end - at);
        if (number.empty() || !allDigits(number) || (number.size() > 1 && number[0] == '0'))
            return false;
        at = end + 1;
    }
    return true;
}

bool isDicomDate(std::string_view text) {
    if (text.size() != 8 || !allDigits(text)) return false;
    const int month = twoDigits(text, 4), day = twoDigits(text, 6);
    return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

bool isDicomTime(std::string_view text) {
    const std::size_t dot = text.find('.');
    const std::string_view whole = text.substr(0, dot);
    if (!allDigits(whole) || whole.size() % 2 != 0 || whole.empty() || whole.size() > 6)
        return false;
    if (twoDigits(whole, 0) > 23) return false;
    if (whole.size() >= 4 && twoDigits(whole, 2) > 59) return false;
    if (whole.size() == 6 && twoDigits(whole, 4) > 60) return false;  // a leap second
    if (dot == std::string_view::npos) return true;
    const std::string_view fraction = text.substr(dot + 1);
    return whole.size() == 6 && !fraction.empty() && fraction.size() <= 6 && allDigits(fraction);
}

std::string sourceSeriesJson(const SourceSeries& series) {
    const glm::dvec3 row = series.rowDirection, column = series.columnDirection;
    OrderedJson json{{"study", series.studyUid},
                     {"series", series.seriesUid},
                     {"frame_of_reference", series.frameOfReferenceUid},
                     {"study_date", series.studyDate},
                     {"study_time", series.studyTime},
                     {"position", toString(series.position)},
                     {"row", {row.x, row.y, row.z}},
                     {"column", {column.x, column.y, column.z}},
                     {"pixel_spacing_mm", {series.pixelSpacingMm.x, series.pixelSpacingMm.y}}};
    std::string text = json.dump();
    text.back() = ',';
    text += "\n\"images\": [";
    for (std::size_t n = 0; n < series.images.size(); ++n)
        text += (n > 0 ? ",\n" : "\n") + imageJson(series.images[n]).dump();
    return text + "]}\n";
}

Result<SourceSeries> sourceSeriesOfJson(const std::string& text, const std::string& place) {
    try {
        const OrderedJson json = OrderedJson::parse(text);
        SourceSeries series;
        series.studyUid = uidIn(json, "study");
        series.seriesUid = uidIn(json, "series");
        series.frameOfReferenceUid = uidIn(json, "frame_of_reference");
        series.studyDate = json.at("study_date");
        series.studyTime = json.at("study_time");
        require(series.studyDate.empty() || isDicomDate(series.studyDate), "a date is not one");
        require(series.studyTime.empty() || isDicomTime(series.studyTime), "a time is not one");
        series.position = patientPositionFromString(json.at("position").get<std::string>());
        series.rowDirection = vectorIn(json.at("row"));
        series.columnDirection = vectorIn(json.at("column"));
        const auto unit = [](glm::dvec3 v) { return std::abs(glm::length(v) - 1.0) < 1e-6; };
        require(unit(series.rowDirection) && unit(series.columnDirection) &&
                    std::abs(glm::dot(series.rowDirection, series.columnDirection)) < 1e-6,
                "the image's directions are not orthogonal units");
        const OrderedJson& spacing = json.at("pixel_spacing_mm");
        require(spacing.is_array() && spacing.size() == 2, "pixels have two spacings");
        series.pixelSpacingMm = {millimetresIn(spacing.at(0)), millimetresIn(spacing.at(1))};
        require(glm::all(glm::greaterThan(series.pixelSpacingMm, glm::dvec2(0.0))),
                "a number is out of range");
        const OrderedJson& images = json.at("images");
        require(images.is_array() && images.size() <= std::size_t(maxSourceImages),
                "there are too many images");
        for (const OrderedJson& image : images)
            series.images.push_back(imageOf(image));
        return series;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this is no source series: " + reasonOf(error), place);
    }
}

}  // namespace haustra
