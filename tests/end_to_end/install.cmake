# cmake -DBUILD=… -DVERSION=… -DPROGRAMS=… -P install.cmake: cmake --install gives programs that run from
# where they were put, of the project's version, with their documents, and nothing else; each
# component gives its part alone, and the parts are the whole.
cmake_minimum_required(VERSION 3.25)
set(ENV{DESTDIR} "")
string(RANDOM LENGTH 12 unique)
set(folder ${BUILD}/install-test-${unique})

function(fail message)
    file(REMOVE_RECURSE ${folder})
    message(FATAL_ERROR "${message}")
endfunction()

# Installs under folder/name; files: the regular files, programs run, that it then holds.
function(install_into name files)
    execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${folder}/${name} ${ARGN}
        OUTPUT_QUIET RESULT_VARIABLE result)
    if(result)
        fail("cmake --install ${ARGN} ended with ${result}")
    endif()
    file(GLOB_RECURSE found RELATIVE ${folder}/${name} ${folder}/${name}/*)
    foreach(program IN LISTS found)
        if(NOT program MATCHES "^bin/")
            continue()
        endif()
        execute_process(COMMAND ${CMAKE_COMMAND} -E chdir / ${folder}/${name}/${program} --version
            OUTPUT_VARIABLE said ERROR_VARIABLE failure RESULT_VARIABLE result)
        if(result OR NOT said MATCHES "(^|[^0-9.])${VERSION}\n$")
            fail("${program} --version ended with ${result}: ${said}${failure}")
        endif()
    endforeach()
    list(SORT found)
    set(${files} ${found} PARENT_SCOPE)
endfunction()

set(expected)
foreach(program IN LISTS PROGRAMS)
    list(APPEND expected bin/${program} share/doc/${program}/LICENSE)
endforeach()
list(APPEND expected
    lib/haustra/haustra-calibration.so lib/haustra/haustra-pictures.so share/doc/haustra/README.md share/doc/haustra/processing/METHODS.md
    share/doc/haustra/processing/organs/README.md
    share/doc/haustra-server/deploy/OPERATIONS.md share/doc/haustra-server/protocol/ADDING.md
    share/doc/haustra-server/protocol/PROTOCOL.md
    share/doc/haustra-server/server/THREADS.md)
if(haustra-client IN_LIST PROGRAMS)
    list(APPEND expected share/doc/haustra-client/client/SCRIPT.md)
endif()
list(SORT expected)

install_into(whole whole)
if(NOT whole STREQUAL expected)
    fail("installed: ${whole}\nexpected: ${expected}")
endif()

set(parts)
foreach(program IN LISTS PROGRAMS)
    string(REGEX REPLACE "^haustra-?" "" component ${program})
    if(NOT component)
        set(component tools)
    endif()
    install_into(${component} part --component ${component})
    foreach(file IN LISTS part)
        # haustra has a module beside it.
        if(NOT file MATCHES "^(bin/${program}$|share/doc/${program}/|lib/${program}/)")
            fail("component ${component} installs ${file}")
        endif()
    endforeach()
    list(APPEND parts ${part})
endforeach()
list(SORT parts)
if(NOT parts STREQUAL expected)
    fail("the components install: ${parts}\nexpected: ${expected}")
endif()
file(REMOVE_RECURSE ${folder})
