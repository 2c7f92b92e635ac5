// Places in the colon that somebody, or something, wants a physician to judge.
#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra {

struct Finding {
    glm::dvec3 positionMm{0.0};  ///< centre, LPS
    double diameterMm = 0.0;     ///< largest
    double score = 1.0;          ///< 0…1; 1 for truth
    std::string kind;            ///< "sessile", "pedunculated", "flat" …; may be empty
};

struct Findings {
    std::vector<Finding> findings;
};

}  // namespace haustra
