// One patient's colon with its contents, all drawn from the seed.
#pragma once

#include "phantom/colon_field.h"
#include "phantom/film.h"
#include "phantom/fluid.h"
#include "phantom/ileum.h"
#include "phantom/phantom.h"

namespace haustra::phantom {

/// The grid of a phantom's volumes. A field of view of 0 stands for the one that the size has.
Grid gridOf(Size size, double fieldOfViewMm = 0.0);

/// The body that the seed and the position of the options give.
BodyPlan bodyOf(const PhantomOptions& options);

struct FilledColon {
    ColonShape shape;  ///< with its growths
    ColonField field;  ///< of `shape`, on gridOf(options.size)
    Fluid fluid;
    std::optional<Ileum> ileum;
    std::vector<Film> films;
};

/// The colon of the options' patient: the path, what grows on its wall, the fluid that gravity
/// levels, the polyps that the fluid covers, films of residue, the ileum with its valve, and
/// diverticula. Deterministic in seed, preset, position and size, whatever the number of threads;
/// seconds at full size.
FilledColon makeFilledColon(const PhantomOptions& options);

}  // namespace haustra::phantom
