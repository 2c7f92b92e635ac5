#include "protocol/optics_message.h"

namespace haustra::protocol {
namespace {

using Points = google::protobuf::RepeatedPtrField<TransferFunctionPoint>;

void fill(Points& message, const std::vector<haustra::TransferFunctionPoint>& points) {
    for (const haustra::TransferFunctionPoint& point : points) {
        TransferFunctionPoint* out = message.Add();
        out->set_hu(point.hu);
        out->set_red(point.color.r);
        out->set_green(point.color.g);
        out->set_blue(point.color.b);
        out->set_opacity(point.opacity);
    }
}

std::vector<haustra::TransferFunctionPoint> pointsFrom(const Points& message) {
    std::vector<haustra::TransferFunctionPoint> points;
    for (const TransferFunctionPoint& point : message)
        points.push_back({point.hu(), {point.red(), point.green(), point.blue()}, point.opacity()});
    return points;
}

Composition codeOf(haustra::Composition composition) {
    switch (composition) {
        case haustra::Composition::emissionAbsorption:
            return EMISSION_ABSORPTION;
        case haustra::Composition::maximumIntensity:
            return MAXIMUM_INTENSITY;
        case haustra::Composition::firstHit:
            return FIRST_HIT;
    }
    return EMISSION_ABSORPTION;
}

Result<haustra::Composition> compositionFrom(Composition code) {
    switch (code) {
        case EMISSION_ABSORPTION:
            return haustra::Composition::emissionAbsorption;
        case MAXIMUM_INTENSITY:
            return haustra::Composition::maximumIntensity;
        case FIRST_HIT:
            return haustra::Composition::firstHit;
        default:
            return fail(ErrorKind::badInput, "there is no such composition", "transfer function");
    }
}

}  // namespace

void fill(Optics& message, const haustra::Optics& optics) {
    message.Clear();
    fill(*message.mutable_points(), optics.transferFunction.points);
    for (const haustra::GradientRow& row : optics.transferFunction.rows) {
        GradientRow* out = message.add_rows();
        out->set_gradient_hu_per_mm(row.gradientHuPerMm);
        fill(*out->mutable_points(), row.points);
    }
    message.set_composition(codeOf(optics.composition));
    message.set_pre_integrated(optics.preIntegrated);
    message.set_unlit(!optics.shading);
    if (optics.light == headlight) return;
    Headlight* light = message.mutable_light();
    light->set_half_depth_mm(optics.light.halfDepthMm);
    light->set_ambient(optics.light.ambient);
    light->set_diffuse(optics.light.diffuse);
    light->set_specular(optics.light.specular);
    light->set_shininess(optics.light.shininess);
}

void fill(OpticsPreset& message, const haustra::OpticsPreset& preset) {
    message.set_name(preset.name);
    message.set_description(preset.description);
    fill(*message.mutable_optics(), preset.optics);
}

Result<haustra::Optics> opticsFrom(const Optics& message) {
    haustra::Optics optics;
    const auto composition = TRY(compositionFrom(message.composition()));
    optics.composition = composition;
    optics.preIntegrated = message.pre_integrated();
    optics.shading = !message.unlit();
    if (message.has_light()) {
        const Headlight& light = message.light();
        optics.light = {light.half_depth_mm(), light.ambient(), light.diffuse(), light.specular(),
                        light.shininess()};
    }
    optics.transferFunction.points = pointsFrom(message.points());
    for (const GradientRow& row : message.rows())
        optics.transferFunction.rows.push_back(
            {row.gradient_hu_per_mm(), pointsFrom(row.points())});
    TRY(checkOptics(optics));
    return optics;
}

Result<haustra::OpticsPreset> presetFrom(const OpticsPreset& message) {
    if (!isPresetName(message.name()))
        return fail(ErrorKind::badInput, "its name is none", "preset");
    auto optics = TRY(opticsFrom(message.optics()));
    return haustra::OpticsPreset{message.name(), message.description(), std::move(optics)};
}

}  // namespace haustra::protocol
