// What a calibration leaves, drawn on its pictures.
#pragma once

#include "core/image.h"
#include "core/result.h"
#include "coverage/board.h"
#include "coverage/calibrate.h"

#include <string>
#include <vector>

namespace haustra::cli {

/// A picture in which a board was found, and its part of a calibration.
struct CalibratedPicture {
    std::string name;  ///< printable ASCII
    const Image* image;
    const coverage::BoardView* view;
    const coverage::ViewFit* fit;
};

/// The pictures darkened, up to four in a row, with a cross at each point and a line from there to
/// where the lens has it, drawn longer by one factor for all, so that the longest is 30 pixels; the
/// factor, names and RMS are written beside them.
Result<Image> residualPicture(const std::vector<CalibratedPicture>& pictures, double rmsPixels);

}  // namespace haustra::cli
