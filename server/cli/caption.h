// The words and marks that --caption draws onto a picture: what it shows, and which way and how
// large it lies in the patient.
#pragma once

#include "core/flat_map.h"
#include "core/result.h"
#include "core/slice_placement.h"
#include "pictures/drawing.h"
#include "render/scene/picture.h"

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::cli {

/// How a picture of parallel rays lies in the patient.
struct PictureFrame {
    glm::dvec3 right{1.0, 0.0, 0.0}, down{0.0, 1.0, 0.0};  ///< LPS, of length one
    double mmPerPixel = 1.0;
};
PictureFrame frameOf(const SlicePlacement& placement);
/// Of an orthographic camera's picture; none of the other lenses, which have no one scale.
std::optional<PictureFrame> frameOf(const Camera& camera, int pictureHeight);

/// A finding in a picture.
struct NumberedPlace {
    int number = 0;
    glm::dvec2 pixel{0.0};
    glm::u8vec3 color{255};
};

/// Where a direction of the patient points: one or two of L, R, A, P, H and F, the nearer first.
std::string orientation(glm::dvec3 direction);

/// `line` at the top; with a frame, the letters of the directions at the edges, which nothing
/// covers, and a bar of a round number of millimetres. A line that would reach a letter is a row
/// lower, and one that is too long is cut short; a bar without room is left out. Around each place
/// in the picture a ring, but for where words are, with its number beside it if that has room.
Result<pictures::Marks> caption(const std::string& line, const std::optional<PictureFrame>& frame,
                                glm::ivec2 size, const std::vector<NumberedPlace>& places = {});

/// The same for a comparison of three panels of `size`, each with its title, the middle one with
/// the tissues' colours if they have room.
Result<pictures::Marks> comparisonCaption(const std::string& line, const PictureFrame& frame,
                                          glm::ivec2 size);

/// Of the whole strip in a picture of `size`: its ends, and a scale of millimetres along the
/// centerline, from the rectum, where the wall's cameras stand. Where the map squeezes the colon,
/// only as many of its marks as can be read. Places are ringed as by caption.
Result<pictures::Marks> stripCaption(const FlatMap& map, glm::ivec2 size,
                                     const std::vector<NumberedPlace>& places = {});

}  // namespace haustra::cli
