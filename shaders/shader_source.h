// The shaders' text, built into the program so that it needs no files beside it.
#pragma once

#include <map>
#include <string_view>

namespace haustra::shaders {

/// The texts of this folder's files by their names. Any thread.
const std::map<std::string_view, std::string_view>& shaderTexts();

/// Text of a file of this folder ("march.glsl"), whole. A name that is not there is a
/// programming error and aborts. Any thread.
std::string_view shaderSource(std::string_view file);

}  // namespace haustra::shaders
