#include "render/optics.h"

#include <cmath>

namespace haustra::render {

namespace {

bool finite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

const std::vector<std::string>& opticsPresets() {
    static const std::vector<std::string> names = {"mucosa", "translucent"};
    return names;
}

Result<Optics> opticsPreset(const std::string& name) {
    // The mucosa's surface in a blurred scan lies midway between air and soft tissue; the ramp
    // ends before, so that thin folds stay closed.
    if (name == "mucosa") {
        return Optics{{{
                           {-750.0, {0.86, 0.49, 0.42}, 0.0},
                           {-550.0, {0.93, 0.59, 0.51}, 0.97},
                           {-350.0, {0.96, 0.67, 0.58}, 0.9999},
                           {50.0, {0.90, 0.50, 0.44}, 0.9999},
                           {250.0, {0.98, 0.91, 0.78}, 0.9999},
                       },
                       {}}};
    }
    // A veil at the wall, clear fat, and whatever is denser behind: what a fold hides.
    if (name == "translucent") {
        return Optics{{{
                           {-850.0, {0.75, 0.55, 0.50}, 0.0},
                           {-550.0, {0.92, 0.62, 0.52}, 0.14},
                           {-250.0, {0.95, 0.66, 0.55}, 0.14},
                           {-130.0, {0.95, 0.75, 0.50}, 0.0},
                           {-20.0, {0.85, 0.40, 0.34}, 0.0},
                           {60.0, {0.82, 0.30, 0.26}, 0.30},
                           {180.0, {0.98, 0.92, 0.80}, 0.90},
                       },
                       {}}};
    }
    return fail(ErrorKind::badInput,
                "no transfer function named '" + name + "' (mucosa, translucent)");
}

Result<void> checkTransferFunction(const TransferFunction& transferFunction) {
    const auto& points = transferFunction.points;
    const auto bad = [](std::size_t at, const char* what) {
        return fail(ErrorKind::badInput, "point " + std::to_string(at + 1) + " " + what,
                    "transfer function");
    };
    if (points.size() < 2 || points.size() > 256)
        return fail(ErrorKind::badInput,
                    std::to_string(points.size()) + " points, where 2 to 256 are needed",
                    "transfer function");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const TransferFunctionPoint& point = points[i];
        if (!(point.hu >= -32768.0 && point.hu <= 32767.0))
            return bad(i, "has HU outside -32768 to 32767");
        if (!(point.opacity >= 0.0 && point.opacity <= 1.0))
            return bad(i, "has an opacity outside 0 to 1");
        if (!finite(point.color) || glm::any(glm::lessThan(point.color, glm::dvec3(0.0))) ||
            glm::any(glm::greaterThan(point.color, glm::dvec3(1.0))))
            return bad(i, "has a colour outside 0 to 1");
        if (i > 0 && point.hu < points[i - 1].hu)
            return bad(i, "has a lower HU than the point before");
    }
    if (!(points.back().hu > points.front().hu))
        return fail(ErrorKind::badInput, "all points have the same HU", "transfer function");
    return {};
}

Result<void> checkOptics(const Optics& optics) {
    return checkTransferFunction(optics.transferFunction);
}

}  // namespace haustra::render
