#include "shaders/shader_source.h"

#include <cstdlib>
#include <map>

namespace haustra::shaders {

// Made of this folder's files by haustra_embed.
const std::map<std::string_view, std::string_view>& shaderTexts();

std::string_view shaderSource(std::string_view file) {
    const auto found = shaderTexts().find(file);
    if (found == shaderTexts().end()) std::abort();
    return found->second;
}

}  // namespace haustra::shaders
