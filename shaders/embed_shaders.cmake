# cmake -D OUTPUT=x.cpp -D FILES=a;b -P embed_shaders.cmake: writes shaderSource() of shader_source.h.
set(branches "")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME)
    file(READ ${file} text)
    string(APPEND branches "    if (file == \"${name}\") return R\"shader(${text})shader\";\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by embed_shaders.cmake.
#include \"shaders/shader_source.h\"

#include <cstdlib>

namespace haustra::shaders {

std::string_view shaderSource(std::string_view file) {
${branches}    std::abort();
}

}  // namespace haustra::shaders
")
