// The door to OpenImageIO and OpenCV. With them come some 240 libraries, which cost every start of
// a program 0.25 s of processor time and 110 MB: they are in a module of their own, loaded when the
// first picture is read or written.
#pragma once

#include "pictures/drawing.h"
#include "pictures/picture_file.h"

namespace haustra::pictures {

/// What picture_file.h and drawing.h say, within the module. No exception leaves it.
namespace module {
decltype(pictures::createPicture) createPicture;
decltype(pictures::readGreyPicture) readGreyPicture;
decltype(pictures::readColorPicture) readColorPicture;
decltype(pictures::sideBySide) sideBySide;
decltype(pictures::textWidth) textWidth;
decltype(pictures::draw) draw;
}  // namespace module

struct ImageLibraries {
    decltype(&module::createPicture) createPicture;
    decltype(&module::readGreyPicture) readGreyPicture;
    decltype(&module::readColorPicture) readColorPicture;
    decltype(&module::sideBySide) sideBySide;
    decltype(&module::textWidth) textWidth;
    decltype(&module::draw) draw;
};

}  // namespace haustra::pictures

/// The module's one symbol.
extern "C" const haustra::pictures::ImageLibraries haustraImageLibraries;
