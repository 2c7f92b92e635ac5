// The models of models/, built into the program so that it needs no files beside it.
#pragma once

#include <map>
#include <string_view>

namespace haustra::cad {

/// The text of each by its file's name without ending. Any thread.
const std::map<std::string_view, std::string_view>& builtInModels();

}  // namespace haustra::cad
