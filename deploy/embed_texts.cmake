# cmake -D OUTPUT=x.cpp -D NAMESPACE=a::b -D FUNCTION=f -D KEY=NAME -D HEADER=h -D "FILES=a;b" -P embed_texts.cmake:
# writes f(), which header h declares: the files' texts by their names, with endings (KEY NAME_WE: without). haustra_embed of build.cmake calls it.
set(entries "")
foreach(file IN LISTS FILES)
    get_filename_component(name ${file} ${KEY})
    file(READ ${file} text)
    string(APPEND entries "        {\"${name}\", R\"file(${text})file\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// Made by embed_texts.cmake.
#include \"${HEADER}\"

namespace ${NAMESPACE} {

const std::map<std::string_view, std::string_view>& ${FUNCTION}() {
    static const std::map<std::string_view, std::string_view> texts{
${entries}    };
    return texts;
}

}  // namespace ${NAMESPACE}
")
