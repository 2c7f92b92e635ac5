// Flat targets that a camera is calibrated with, and what of one a picture shows.
#pragma once

#include "core/image.h"
#include "core/result.h"
#include "coverage/lens_field.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::coverage {

enum class BoardPattern {
    checkerboard,    ///< black and white squares; the points are where four of them meet
    dots,            ///< discs in rows and columns
    asymmetricDots,  ///< every second row of discs moved by half a step, as OpenCV prints them
};

struct Board {
    BoardPattern pattern = BoardPattern::checkerboard;
    /// Columns and rows: of squares of a checkerboard (as it is printed, and as MATLAB counts;
    /// OpenCV counts the points, one less each way); of dots otherwise.
    glm::ivec2 count{0};
    /// Side of a square; distance of neighbouring dots; of asymmetric dots the distance of rows,
    /// half of that of neighbours in a row (OpenCV's).
    double spacingMm = 1.0;
};

/// "checkerboard:8x7", "dots:7x5", "asymmetric-dots:3x11"; none where the text is not of that kind,
/// or where a side has less than 3 points or more than 200.
std::optional<Board> boardOfText(std::string_view text);
std::string textOf(const Board& board);
int pointCount(const Board& board);

/// One picture's points.
struct BoardView {
    std::vector<glm::dvec2> placesMm;  ///< on the board, from an unknown corner of it
    std::vector<glm::dvec2> pixels;
    /// Of dots: how many pixels each covers.
    std::vector<double> areas;
};

/// The points of a board in a picture, to a fraction of a pixel; no lens is known yet, and straight
/// lines may be as bent as a fisheye bends them. Saddles of brightness with four alternating
/// quarters (checkerboards) or dark or light clusters with the moments of a filled ellipse (dots),
/// at several scales, from which a square lattice grows from neighbour to neighbour: each step is
/// foretold by those before it. Dots are asymmetric where the lattice lies at 45° to the rows. A
/// point of a checkerboard is the saddle of the quadric that fits the brightness around it (Placht
/// et al., ECCV 2014); one of a dot is the cluster's centre, weighted by contrast: the centre of
/// the disc's picture, not the picture of the disc's centre (calibrate corrects for it). A part of
/// the board, from half of its points, is a view too: the pose takes up where on the board it is.
/// Mirrored pictures likewise are views of the board from behind. Fails (noResult), saying what was
/// seen instead, or (badInput) where it is no board. A second for a large picture; any thread.
Result<BoardView> findBoard(const Image& picture, const Board& board);

/// The ellipse around what is not black in any of the pictures, which are of one size, by least
/// squares on the outline where the picture's border does not cut it, leaving out what lies off it.
/// Fails (noResult) where the pictures have no dark surround. Any thread.
Result<FieldEllipse> findField(const std::vector<Image>& pictures);

}  // namespace haustra::coverage
