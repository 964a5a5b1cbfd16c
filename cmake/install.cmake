# The rules of `cmake --install`. No file that is installed names a folder of the build or of the sources. The component
# `program` is what a user runs, the component `development` is what a foreign program is built with, and the component
# `library` what it needs when it runs.
include(GNUInstallDirs)
set(voussoir_share "${CMAKE_INSTALL_DATADIR}/voussoir")

install(TARGETS voussoir RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
if(NOT CMAKE_BUILD_WITH_INSTALL_RPATH AND NOT VOUSSOIR_DEBIAN)
  # A shared library that the system does not find by itself, such as a user's own Kokkos, is found after installation, too.
  # All libraries of a Debian package are the system's.
  set_target_properties(voussoir PROPERTIES INSTALL_RPATH_USE_LINK_PATH ON)
endif()

# Cases and pages keep their places to one another, so that the links between them hold.
install(DIRECTORY cases docs DESTINATION "${voussoir_share}" COMPONENT program PATTERN "__pycache__" EXCLUDE)
install(FILES README.md CHANGELOG.md CONTRIBUTING.md CITATION.cff LICENSE DESTINATION "${voussoir_share}" COMPONENT program)
# A case may name its schema by a short path.
file(GLOB schemas CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/docs/reference/*.schema.json")
if(schemas)
  install(FILES ${schemas} DESTINATION "${voussoir_share}/schema" COMPONENT program)
endif()

# The figures and reports are modules of the Python package, which are found from the place of the command.
set(voussoir_python_folder "${voussoir_share}/python")
install(DIRECTORY python/voussoir DESTINATION "${voussoir_python_folder}" COMPONENT program
        PATTERN "__pycache__" EXCLUDE)
cmake_path(RELATIVE_PATH voussoir_python_folder BASE_DIRECTORY "${CMAKE_INSTALL_BINDIR}" OUTPUT_VARIABLE from_bin_to_python)
set(VOUSSOIR_PYTHON "/usr/bin/env python3" CACHE STRING "Python of the commands voussoir-figures and voussoir-report")
foreach(pair "figures;voussoir.figures" "report;voussoir.report")
  list(POP_FRONT pair command)
  set(module ${pair})
  configure_file(cmake/voussoir_command.py.in "${PROJECT_BINARY_DIR}/voussoir-${command}" @ONLY)
  install(PROGRAMS "${PROJECT_BINARY_DIR}/voussoir-${command}" DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT program)
endforeach()

include(cmake/manual.cmake)
include(cmake/library.cmake)
include(cmake/debian_package.cmake)
