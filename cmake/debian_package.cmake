# Three Debian packages, made by `cpack -G DEB` (tools/package, preset package): `voussoir` with all that a user runs,
# `voussoir-dev` with what foreign programs are built with, and the shared library, whose name has its version.
# dpkg-shlibdeps finds the packages on which program and library depend.
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

set(library_package "libvoussoir${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
foreach(pair "voussoir;program" "${library_package};library" "voussoir-dev;development")
  list(POP_FRONT pair package)
  set(papers "${CMAKE_INSTALL_DATAROOTDIR}/doc/${package}")
  install(FILES "${changelog}.gz" cmake/debian/copyright DESTINATION "${papers}" COMPONENT ${pair})
endforeach()
install(FILES cmake/debian/libvoussoir.lintian-overrides DESTINATION "${CMAKE_INSTALL_DATAROOTDIR}/lintian/overrides"
        COMPONENT library RENAME ${library_package})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "${contact}")
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}")
set(CPACK_COMPONENTS_ALL program library development)
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
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/cmake/debian/triggers")
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION
"packings of grains as a material for other programs, shared library
The C interface of Voussoir as a shared library, which programs in C or
Fortran are linked with and other languages load. A program sends
displacement gradients to packings of grains (discrete element method) and
gets stresses and tangents from them.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME voussoir-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library_package} (= ${PROJECT_VERSION}), libeigen3-dev, libfmt-dev, libhdf5-dev, g++")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake, voussoir")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
"packings of grains as a material for other programs
A static library for C++, with its headers and CMake package, and what is
needed to build programs with the shared library for C and Fortran. A
finite-element program sends displacement gradients to packings of grains
(discrete element method) and gets stresses and tangents from them.")
include(CPack)
