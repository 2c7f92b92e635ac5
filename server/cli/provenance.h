// What a picture's file says of where the picture comes from. Never a path or a name that was
// given: those may hold a patient's.
#pragma once

#include "core/camera.h"
#include "pictures/picture_file.h"
#include "store/case_store.h"

#include <string>

#include <glm/glm.hpp>

namespace haustra::cli {

/// This program's name and version, and nothing else yet.
pictures::Provenance ownProvenance();

/// `x,y` and `x,y,z`, exact to the last digit.
std::string toText(glm::dvec2 point);
std::string toText(glm::dvec3 point);

/// "PRODUCT.key": the key of a product that the picture shows; nothing where the case has none.
void addProduct(pictures::Provenance& provenance, const store::Case& source,
                const std::string& product);

/// "camera.…": place and directions (LPS, mm), lens, and its angle or height.
void addCamera(pictures::Provenance& provenance, const Camera& camera);

}  // namespace haustra::cli
