#include "phantom_polyps.h"

#include "phantom/filled_colon.h"
#include "phantom/growths.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <utility>

#include <nlohmann/json.hpp>

namespace haustra::bench {
namespace {

const std::map<std::string, phantom::Preset> presets{{"easy", phantom::Preset::easy},
                                                     {"standard", phantom::Preset::standard},
                                                     {"hard", phantom::Preset::hard}};

Result<phantom::PhantomOptions> optionsIn(const std::string& file) {
    std::ifstream in(file);
    const auto json = nlohmann::json::parse(in, nullptr, false);
    phantom::PhantomOptions options;
    try {
        if (json.at("version").get<int>() != phantom::phantomVersion)
            return fail(ErrorKind::unsupported, "is of a phantom of another version", file);
        options.seed = json.at("seed").get<std::uint64_t>();
        options.preset = presets.at(json.at("preset").get<std::string>());
        options.position = json.at("position").get<std::string>() == "prone"
                               ? PatientPosition::prone
                               : PatientPosition::supine;
        options.size = json.at("size").get<std::string>() == "small" ? phantom::Size::small
                                                                     : phantom::Size::full;
    } catch (const std::exception&) {
        return fail(ErrorKind::badInput, "is not a phantom.json", file);
    }
    return options;
}

}  // namespace

Result<std::vector<PhantomPolyp>> polypsOfPhantom(const std::string& file) {
    const auto options = TRY(optionsIn(file));
    const auto shape =
        std::make_shared<const phantom::ColonShape>(phantom::makeFilledColon(options).shape);
    const Findings findings = phantom::polypsOf(*shape);
    std::vector<PhantomPolyp> polyps;
    for (const phantom::Growth& growth : shape->growths()) {
        if (!growth.polyp()) continue;
        phantom::ColonShape::Nearby bare;
        shape->findNearby(growth.center, growth.reachMm() + 2.0, bare);
        bare.growths.clear();
        const auto border = [shape, growth, bare](glm::dvec3 p) {
            // Beyond its reach nothing is known of what is near, and nothing is the polyp's.
            const double beyond = glm::distance(p, growth.center) - growth.reachMm() - 1.0;
            if (beyond > 0.0) return 1.0 + beyond;
            return std::max(beyond, growth.distance(p) + shape->evaluate(p, bare).lumenMm);
        };
        const auto girth = [border, growth](glm::dvec3 p) {
            return std::max(border(p), glm::dot(growth.center - p, growth.inward));
        };
        polyps.push_back({findings.findings[polyps.size()], border, girth});
    }
    return polyps;
}

}  // namespace haustra::bench
