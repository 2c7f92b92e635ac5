# cmake -D OUTPUT=x.cpp -D FILES=a;b -P embed_profiles.cmake: writes builtInProfiles() of
# built_in_profiles.h.
set(entries "")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} NAME_WE)
    file(READ ${file} text)
    string(APPEND entries "        {\"${name}\", R\"profile(${text})profile\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by embed_profiles.cmake.
#include \"organs/built_in_profiles.h\"

namespace haustra::organs {

const std::map<std::string, std::string_view>& builtInProfiles() {
    static const std::map<std::string, std::string_view> profiles{
${entries}    };
    return profiles;
}

}  // namespace haustra::organs
")
