// Which of the optical model's variants a shader is compiled for: what is off costs nothing.
#pragma once

#include "gpu/program.h"
#include "render/optics/optics.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace haustra::render {

/// The #defines of shaders/optics.glsl, march.glsl and picture.glsl.
struct MarchVariant {
    Composition composition = Composition::emissionAbsorption;
    bool preIntegrated = false, gradientRows = false, shading = true;
    bool gradientTexture = false;  ///< gradients are read, not computed from six values
    bool backdrop = false;
    bool operator==(const MarchVariant&) const = default;

    /// What these optics need; where they take no notice of something, it is off.
    static MarchVariant of(const Optics& optics, bool gradientTexture, bool backdrop);
    /// One line for each; the first text of a shader.
    std::string defines() const;
};

/// One entry point, compiled for each variant that is asked for, and kept. Belongs to the thread of
/// the context.
class MarchPrograms {
public:
    /// The shader is uniforms.h, srgb.glsl, lens.glsl, optics.glsl, rays.glsl, `sampler` (what
    /// march() samples), march.glsl, picture.glsl, `between` and `entry`, all names of shaders/.
    /// `defines` stands before all of it.
    explicit MarchPrograms(std::string entry,
                           const std::vector<std::string>& sampler = {"volume.glsl"},
                           const std::vector<std::string>& between = {}, std::string defines = {});

    /// Compiling takes some 0.1 s the first time on a machine. Fails (device) where the driver
    /// refuses the text. Valid while this lives.
    Result<const gpu::ComputeProgram*> program(const MarchVariant& variant);

private:
    std::string entry_, sampler_, between_, defines_;
    std::vector<std::pair<MarchVariant, std::unique_ptr<gpu::ComputeProgram>>> made_;
};

}  // namespace haustra::render
