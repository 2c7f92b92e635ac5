# One library per folder. A folder may use only what its target links, so the dependency
# rules of the design are the link lines of the CMakeLists.txt files; tests/include_rules
# checks the #include lines against the same rules.
find_package(Threads REQUIRED)

add_library(haustra_flags INTERFACE)
target_compile_options(haustra_flags INTERFACE
    -Wall -Wextra -Wnon-virtual-dtor
    # Files that are compiled as one (CMAKE_UNITY_BUILD) shadow what others of them declare.
    $<$<NOT:$<BOOL:${CMAKE_UNITY_BUILD}>>:-Wshadow>
    # Products are byte-identical on every machine: no contraction into fused multiply-adds.
    -ffp-contract=off)
# Hardened: untrusted files and messages are parsed here. The sanitizers bring their own checks.
if(NOT HAUSTRA_SANITIZE)
    target_compile_options(haustra_flags INTERFACE
        -fstack-protector-strong $<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>)
    target_compile_definitions(haustra_flags INTERFACE _GLIBCXX_ASSERTIONS)
    target_link_options(haustra_flags INTERFACE LINKER:-z,relro LINKER:-z,now)
endif()
if(HAUSTRA_SANITIZE)
    target_compile_options(haustra_flags INTERFACE
        -fsanitize=${HAUSTRA_SANITIZE} -fno-omit-frame-pointer)
    target_link_options(haustra_flags INTERFACE -fsanitize=${HAUSTRA_SANITIZE})
endif()

# haustra_library(name ROOT dir LINK public… LINK_PRIVATE private… [EXCEPT a.cpp…] [SOURCES generated…])
# All .cpp files of the calling folder, in name's order. ROOT is what #include paths start from
# ("core/grid.h" has ROOT processing/).
function(haustra_library name)
    cmake_parse_arguments(arg "" "ROOT" "SOURCES;EXCEPT;LINK;LINK_PRIVATE" ${ARGN})
    file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
    if(arg_EXCEPT)
        list(REMOVE_ITEM sources ${arg_EXCEPT})
    endif()
    add_library(haustra_${name} STATIC ${sources} ${arg_SOURCES})
    add_library(haustra::${name} ALIAS haustra_${name})
    target_include_directories(haustra_${name} PUBLIC ${arg_ROOT})
    target_link_libraries(haustra_${name} PUBLIC haustra_flags ${arg_LINK}
        PRIVATE ${arg_LINK_PRIVATE})
endfunction()

# haustra_program(name SOURCES … LINK …)
function(haustra_program name)
    cmake_parse_arguments(arg "" "" "SOURCES;LINK" ${ARGN})
    add_executable(${name} ${arg_SOURCES})
    target_link_libraries(${name} PRIVATE haustra_flags ${arg_LINK})
endfunction()

# haustra_embed(output header namespace function NAME|NAME_WE files…): sets `output` to a source made of the
# calling folder's files, whose function(), which the header declares, gives their texts by their names, with or without endings: an
# installed program carries them.
function(haustra_embed output header namespace function key)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}.cpp)
    set(script ${PROJECT_SOURCE_DIR}/deploy/embed_texts.cmake)
    list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE files)
    add_custom_command(OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -D OUTPUT=${source} -D NAMESPACE=${namespace} -D FUNCTION=${function}
            -D KEY=${key} -D HEADER=${header} -D "FILES=${files}" -P ${script}
        DEPENDS ${files} ${script}
        VERBATIM)
    set(${output} ${source} PARENT_SCOPE)
endfunction()
