# cmake -D OUTPUT=x.cpp -D FILES=a;b -P embed_presets.cmake: writes builtInPresetTexts() of
# optics_presets.cpp.
set(rows "")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND rows "        {\"${name}\", R\"preset(${text})preset\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by embed_presets.cmake.
#include <utility>
#include <vector>

namespace haustra::render {

const std::vector<std::pair<const char*, const char*>>& builtInPresetTexts();
const std::vector<std::pair<const char*, const char*>>& builtInPresetTexts() {
    static const std::vector<std::pair<const char*, const char*>> texts = {
${rows}    };
    return texts;
}

}  // namespace haustra::render
")
