// The door to OpenCV's image work and Ceres, with what they bring: in a module of their own, loaded
// when the first picture is calibrated with (core/program_module.h).
#pragma once

#include "coverage/board.h"
#include "coverage/calibrate.h"
#include "coverage/lens_file.h"

namespace haustra::coverage {

/// What board.h, calibrate.h and lens_file.h say, within the module. No exception leaves it.
namespace module {
decltype(coverage::findBoard) findBoard;
decltype(coverage::findField) findField;
decltype(coverage::calibrate) calibrate;
decltype(coverage::lensOfOpenCvText) lensOfOpenCvText;
decltype(coverage::openCvText) openCvText;
}  // namespace module

struct CalibrationLibraries {
    decltype(&module::findBoard) findBoard;
    decltype(&module::findField) findField;
    decltype(&module::calibrate) calibrate;
    decltype(&module::lensOfOpenCvText) lensOfOpenCvText;
    decltype(&module::openCvText) openCvText;
};

}  // namespace haustra::coverage

/// The module's one symbol.
extern "C" const haustra::coverage::CalibrationLibraries haustraCalibrationLibraries;
