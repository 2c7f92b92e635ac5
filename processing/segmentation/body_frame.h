// Coordinates in the trunk that can be compared between patients.
#pragma once

#include "segmentation/bowel_contents.h"

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::segmentation {

/// The trunk as a box. place(p): x from −1 (the patient's right side) to 1 (left), y from −1
/// (anterior) to 1 (posterior), z from 0 (the lowest bowel) to 1 (the highest).
struct BodyFrame {
    glm::dvec3 middleMm{0.0};
    glm::dvec2 halfMm{150.0, 100.0};  ///< half width and half depth
    double lowMm = 0.0, highMm = 400.0;

    glm::dvec3 place(glm::dvec3 patientMm) const {
        return {(patientMm.x - middleMm.x) / halfMm.x, (patientMm.y - middleMm.y) / halfMm.y,
                (patientMm.z - lowMm) / (highMm - lowMm)};
    }
};

/// Places of soft tissue (LPS, mm): of every fourth voxel along each axis.
std::vector<glm::vec3> softTissueSamples(const Volume<std::int16_t>& hu,
                                         const Volume<std::uint8_t>& content);

/// Width and depth from the soft tissue between `lowMm` and `highMm` (the 2nd and 98th percentiles
/// of its samples), so that table and arms count little.
BodyFrame findBodyFrame(std::span<const glm::vec3> softTissueMm, double lowMm, double highMm);

}  // namespace haustra::segmentation
