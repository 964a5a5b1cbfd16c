# Two Debian packages, made by `cpack -G DEB` (tools/package, preset package): `voussoir` with all that a user runs, and
# `voussoir-dev` with the library. dpkg-shlibdeps finds the packages on which the program depends.
if(NOT VOUSSOIR_DEBIAN)
  return()
endif()
find_program(GZIP gzip REQUIRED)

set(contact "The Voussoir developers <voussoir@users.noreply.invalid>")
# The date of the packages is that of the revision, so that the same revision gives the same files.
execute_process(COMMAND git -C "${PROJECT_SOURCE_DIR}" log -1 --format=%cD OUTPUT_VARIABLE revision_date
                OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT revision_date)
  string(TIMESTAMP revision_date "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
set(changelog "${PROJECT_BINARY_DIR}/debian/changelog")
file(CONFIGURE OUTPUT "${changelog}" @ONLY CONTENT
"voussoir (@PROJECT_VERSION@) bookworm; urgency=medium

  * CHANGELOG.md, which the package voussoir brings, tells what is new.

 -- @contact@  @revision_date@
")
execute_process(COMMAND "${GZIP}" -9nc "${changelog}" OUTPUT_FILE "${changelog}.gz")

foreach(pair "voussoir;program" "voussoir-dev;development")
  list(POP_FRONT pair package)
  set(papers "${CMAKE_INSTALL_DATAROOTDIR}/doc/${package}")
  install(FILES "${changelog}.gz" cmake/debian/copyright DESTINATION "${papers}" COMPONENT ${pair})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "${contact}")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}")
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ
    WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME voussoir)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "python3:any, python3-h5py, python3-matplotlib, python3-numpy")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/postinst"
    "${PROJECT_SOURCE_DIR}/cmake/debian/prerm")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"ground movement around tunnels, computed from grains
Voussoir computes how the ground moves when a shallow tunnel is driven
through coarse-grained soil. A finite-element mesh describes the ground,
and at each of its Gauss points a packing of grains (discrete element
method) answers in place of a constitutive law.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME voussoir-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libeigen3-dev, libfmt-dev, libhdf5-dev, g++")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake, voussoir")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"packings of grains as a material for other programs
A static library with its headers and CMake package. A foreign
finite-element program sends displacement gradients to packings of grains
(discrete element method) and gets stresses and tangents from them.")
include(CPack)
