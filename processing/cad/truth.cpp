#include "cad/truth.h"

#include "cad/model.h"
#include "core/printed_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace haustra::cad {
namespace {

constexpr double farthestMm = 1e5, largestMm = 300.0;  // no body is longer, no colon wider

glm::dvec3 placeOfTruth(const nlohmann::json& json) {
    if (json.size() != 3) throw std::invalid_argument("a place has three coordinates");
    const glm::dvec3 place(json.at(0).get<double>(), json.at(1).get<double>(),
                           json.at(2).get<double>());
    if (!glm::all(glm::lessThan(glm::abs(place), glm::dvec3(farthestMm))))
        throw std::invalid_argument("a place lies outside any body");
    return place;
}

double diameterOfTruth(double mm) {
    if (!(mm >= 0.0 && mm <= largestMm))
        throw std::invalid_argument("a diameter is not 0 to 300 mm");
    return mm;
}

double shareOfTruth(const nlohmann::json& json, const char* name) {
    const double share = json.value(name, 0.0);
    if (!(share >= 0.0 && share <= 1.0))
        throw std::invalid_argument(std::string(name) + " is not 0 to 1");
    return share;
}

double lengthOfTruth(const nlohmann::json& json, const char* name) {
    const double mm = json.value(name, 0.0);
    if (!(mm >= 0.0 && mm <= largestMm))
        throw std::invalid_argument(std::string(name) + " is not 0 to 300");
    return mm;
}

// It is printed.
std::string kindOfTruth(const nlohmann::json& json) {
    constexpr std::size_t longest = 40;
    const std::string kind = json.value("kind", "");
    if (!isModelLine(kind, longest))
        throw std::invalid_argument("its kind is no line of 40 bytes at most");
    return kind;
}

TrueLesion lesionOfTruth(const nlohmann::json& read) {
    if (!read.is_object()) throw std::invalid_argument("it is no object");
    TrueLesion lesion;
    lesion.positionMm = placeOfTruth(read.at("position_mm"));
    lesion.wallMm = read.contains("wall_mm") ? placeOfTruth(read.at("wall_mm")) : lesion.positionMm;
    lesion.diameterMm = diameterOfTruth(read.at("diameter_mm"));
    lesion.heightMm = lengthOfTruth(read, "height_mm");
    lesion.kind = kindOfTruth(read);
    lesion.neoplastic = read.value("neoplastic", !lesion.hyperplastic());
    if (lesion.neoplastic && lesion.hyperplastic())
        throw std::invalid_argument("a hyperplastic one is called neoplastic");
    if (read.contains("core_hu")) lesion.coreHu = read.at("core_hu").get<double>();
    lesion.submergedShare = shareOfTruth(read, "submerged_share");
    lesion.untaggedShare = shareOfTruth(read, "untagged_share");
    lesion.filmMm = lengthOfTruth(read, "film_mm");
    return lesion;
}

}  // namespace

double TrueLesion::reachMm() const {
    return std::max(0.5 * diameterMm + 3.0, 5.0);
}

double TrueLesion::distanceMm(glm::dvec3 placeMm) const {
    const double center = glm::distance(placeMm, positionMm);
    return kind == "pedunculated" ? center : std::min(center, glm::distance(placeMm, wallMm));
}

Result<std::vector<TrueLesion>> truthOfJson(const std::string& text, const std::string& place) {
    try {
        const auto json = nlohmann::json::parse(text);
        std::vector<TrueLesion> lesions;
        if (!json.contains("growths") && !json.contains("findings"))
            throw std::invalid_argument("it has neither growths nor findings");
        const auto& list = json.contains("growths") ? json.at("growths") : json.at("findings");
        if (!list.is_array()) throw std::invalid_argument("its lesions are no list");
        for (const auto& read : list) {
            try {
                lesions.push_back(lesionOfTruth(read));
            } catch (const std::exception& error) {
                throw std::invalid_argument("lesion " + std::to_string(lesions.size() + 1) + ": " +
                                            reasonOf(error));
            }
        }
        return lesions;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this is no truth: " + reasonOf(error), place);
    }
}

Result<std::vector<TrueLesion>> mimicsOfJson(const std::string& text, const std::string& place) {
    constexpr double lipsMm = 20.0;
    try {
        const auto json = nlohmann::json::parse(text);
        if (!json.contains("valve") && !json.contains("rectal_tube"))
            throw std::invalid_argument("it has neither valve nor rectal_tube");
        std::vector<TrueLesion> mimics;
        const auto add = [&](const char* kind, const nlohmann::json& at, double diameterMm) {
            TrueLesion mimic;
            mimic.positionMm = mimic.wallMm = placeOfTruth(at);
            mimic.diameterMm = diameterOfTruth(diameterMm);
            mimic.kind = kind;
            mimic.neoplastic = false;
            mimics.push_back(mimic);
        };
        if (json.contains("valve") && !json.at("valve").is_null())
            add("valve", json.at("valve").at("position_mm"), lipsMm);
        if (json.contains("rectal_tube")) {
            const auto& tube = json.at("rectal_tube");
            const double shaftMm = 2.0 * tube.at("shaft_radius_mm").get<double>(),
                         balloonMm = 2.0 * tube.at("balloon_radius_mm").get<double>();
            for (const auto& point : tube.at("axis_mm"))
                add("tube", point, shaftMm);
            add("tube", tube.at("balloon_mm"), balloonMm);
        }
        return mimics;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "this is no structure: " + reasonOf(error), place);
    }
}

std::vector<int> matched(const std::vector<glm::dvec3>& places,
                         const std::vector<TrueLesion>& lesions) {
    std::vector<int> result(places.size(), -1);
    for (std::size_t n = 0; n < places.size(); ++n) {
        double least = 1e30;
        for (const bool neoplastic : {true, false}) {
            if (result[n] >= 0) break;
            for (std::size_t l = 0; l < lesions.size(); ++l) {
                if (lesions[l].neoplastic != neoplastic) continue;
                const double mm = lesions[l].distanceMm(places[n]);
                if (mm <= lesions[l].reachMm() && mm < least) least = mm, result[n] = int(l);
            }
        }
    }
    return result;
}

}  // namespace haustra::cad
