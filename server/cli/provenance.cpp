#include "cli/provenance.h"

#include "core/version.h"

#include <fmt/format.h>

namespace haustra::cli {

pictures::Provenance ownProvenance() {
    return {std::string("Haustra ") + softwareVersion, {}};
}

std::string toText(glm::dvec2 point) {
    return fmt::format("{},{}", point.x, point.y);
}
std::string toText(glm::dvec3 point) {
    return fmt::format("{},{},{}", point.x, point.y, point.z);
}

void addProduct(pictures::Provenance& provenance, const store::Case& source,
                const std::string& product) {
    if (const auto found = source.find(product))
        provenance.facts.emplace_back(product + ".key", found->key.hex);
}

void addCamera(pictures::Provenance& provenance, const Camera& camera) {
    const auto add = [&](const char* name, std::string value) {
        provenance.facts.emplace_back(std::string("camera.") + name, std::move(value));
    };
    add("position_mm", toText(camera.positionMm));
    add("forward", toText(camera.forward));
    add("up", toText(camera.up));
    switch (camera.lens) {
        case Lens::perspective:
            add("lens", "perspective");
            break;
        case Lens::fisheye:
            add("lens", "fisheye");
            break;
        case Lens::orthographic:
            add("lens", "orthographic");
            break;
    }
    if (camera.lens == Lens::orthographic)
        add("height_mm", fmt::format("{}", camera.heightMm));
    else
        add("fov_degrees", fmt::format("{}", camera.fovDegrees));
}

}  // namespace haustra::cli
