# cmake --install: the programs with their documents and the licence, in three parts (components)
# that may be installed alone: tools (haustra), server, client. The documents lie under the name of
# the part's program, as Debian has it. Packages that they run on: deploy/install-packages.
include(GNUInstallDirs)

# haustra_install(component program documents…)
function(haustra_install component program)
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT ${component})
    set(documents ${CMAKE_INSTALL_DATAROOTDIR}/doc/${program})
    install(FILES LICENSE DESTINATION ${documents} COMPONENT ${component})
    foreach(document IN LISTS ARGN)
        # Documents name each other by their places in the tree.
        get_filename_component(folder ${document} DIRECTORY)
        install(FILES ${document} DESTINATION ${documents}/${folder} COMPONENT ${component})
    endforeach()
endfunction()

# haustra loads them with its first picture and its first board; it looks beside its own folder.
install(TARGETS haustra-pictures haustra-calibration LIBRARY DESTINATION lib/haustra COMPONENT tools)
haustra_install(tools haustra README.md processing/METHODS.md processing/organs/README.md)
haustra_install(server haustra-server deploy/OPERATIONS.md protocol/PROTOCOL.md protocol/ADDING.md
    server/THREADS.md)
if(HAUSTRA_BUILD_CLIENT)
    haustra_install(client haustra-client client/SCRIPT.md)
endif()
