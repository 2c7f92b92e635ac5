#include "mesh/file_writing.h"

#include <algorithm>
#include <cctype>

namespace haustra::mesh {

std::string endingOf(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return ending;
}

}  // namespace haustra::mesh
