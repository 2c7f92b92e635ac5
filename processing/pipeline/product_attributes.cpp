#include "pipeline/product_attributes.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <span>

namespace haustra::pipeline {
namespace {

using store::Attributes;

std::string joined(std::span<const double> values) {
    std::string text;
    for (const double value : values) {
        if (!text.empty()) text += ',';
        text += exactText(value);
    }
    return text;
}

// Exactly as many finite numbers with commas between them.
bool readNumbers(const Attributes& attributes, const std::string& name, std::span<double> values) {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return false;
    const char* at = found->second.data();
    const char* const end = at + found->second.size();
    for (std::size_t n = 0; n < values.size(); ++n) {
        if (n > 0 && (at == end || *at++ != ',')) return false;
        const auto [rest, error] = std::from_chars(at, end, values[n]);
        if (error != std::errc() || !std::isfinite(values[n])) return false;
        at = rest;
    }
    return at == end;
}

}  // namespace

std::string exactText(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string exactText(glm::dvec3 v) {
    return exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z);
}

std::string exactText(const char* name, const std::vector<glm::dvec3>& points) {
    std::string text;
    for (const glm::dvec3& point : points)
        text += std::string(name) + "=" + exactText(point) + ";";
    return text;
}

void setTissueModel(Attributes& attributes, const TissueModel& tissue) {
    attributes["mean-hu"] = joined(tissue.meanHu);
    attributes["sd-hu"] = joined(tissue.sdHu);
    attributes["weight"] = joined(tissue.weight);
    attributes["air-below-hu"] = exactText(tissue.airBelowHu);
    attributes["tagged-above-hu"] = exactText(tissue.taggedAboveHu);
}

Result<TissueModel> tissueModelOf(const Attributes& attributes) {
    TissueModel tissue;
    const auto number = [&](const char* name, double& value) {
        return readNumbers(attributes, name, std::span(&value, 1));
    };
    if (!readNumbers(attributes, "mean-hu", tissue.meanHu) ||
        !readNumbers(attributes, "sd-hu", tissue.sdHu) ||
        !readNumbers(attributes, "weight", tissue.weight) ||
        !number("air-below-hu", tissue.airBelowHu) ||
        !number("tagged-above-hu", tissue.taggedAboveHu)) {
        return fail(ErrorKind::badInput, "the segmentation's tissue model is damaged");
    }
    return tissue;
}

glm::dvec3 gravityOf(const Attributes& attributes) {
    std::array<double, 3> down{};
    if (!readNumbers(attributes, "gravity", down)) return glm::dvec3(0.0);
    return {down[0], down[1], down[2]};
}

}  // namespace haustra::pipeline
