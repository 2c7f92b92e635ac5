#include "shaders/shader_source.h"

#include <cstdlib>

namespace haustra::shaders {

std::string_view shaderSource(std::string_view file) {
    const auto found = shaderTexts().find(file);
    if (found == shaderTexts().end()) std::abort();
    return found->second;
}

}  // namespace haustra::shaders
