#include "render/gl/march_variant.h"

#include "shaders/shader_source.h"

namespace haustra::render {

MarchVariant MarchVariant::of(const Optics& optics, bool gradientTexture, bool backdrop) {
    MarchVariant variant;
    variant.composition = optics.composition;
    const bool absorbs = optics.composition == Composition::emissionAbsorption;
    variant.gradientRows = absorbs && !optics.transferFunction.rows.empty();
    variant.preIntegrated = absorbs && optics.preIntegrated;
    variant.shading = optics.composition != Composition::maximumIntensity && optics.shading;
    variant.gradientTexture = gradientTexture && (variant.shading || variant.gradientRows);
    variant.backdrop = backdrop;
    return variant;
}

std::string MarchVariant::defines() const {
    const auto define = [](const char* name, int value) {
        return "#define " + std::string(name) + " " + std::to_string(value) + "\n";
    };
    return define("COMPOSITION", int(composition)) + define("PRE_INTEGRATED", preIntegrated) +
           define("GRADIENT_ROWS", gradientRows) + define("SHADING", shading) +
           define("GRADIENT_TEXTURE", gradientTexture) + define("BACKDROP", backdrop);
}

MarchPrograms::MarchPrograms(std::string entry, const std::vector<std::string>& sampler,
                             const std::vector<std::string>& between, std::string defines)
    : entry_(std::move(entry)), defines_(std::move(defines)) {
    for (const std::string& file : sampler)
        sampler_ += shaders::shaderSource(file);
    for (const std::string& file : between)
        between_ += shaders::shaderSource(file);
}

Result<const gpu::ComputeProgram*> MarchPrograms::program(const MarchVariant& variant) {
    for (const auto& [known, program] : made_)
        if (known == variant) return program.get();
    using shaders::shaderSource;
    const std::string defines = variant.defines() + defines_;
    auto program = TRY(gpu::ComputeProgram::create(
        entry_.c_str(), {defines, shaderSource("uniforms.h"), shaderSource("srgb.glsl"),
                         shaderSource("lens.glsl"), shaderSource("optics.glsl"),
                         shaderSource("rays.glsl"), sampler_, shaderSource("march.glsl"),
                         shaderSource("picture.glsl"), between_, shaderSource(entry_)}));
    made_.emplace_back(variant, std::make_unique<gpu::ComputeProgram>(std::move(program)));
    return made_.back().second.get();
}

}  // namespace haustra::render
