# libvoussoir.so: the objects of libvoussoir.a, of which only the functions of voussoir.h can be seen. Fortran, Julia and
# ctypes load it, and a C program needs no C++ compiler to link it.

# The names come from the header. Kokkos, the engine and the templates of the C++ library stay inside, so that they meet
# no other copy of themselves in the process.
set(c_header "${PROJECT_SOURCE_DIR}/host/library/voussoir.h")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${c_header}")
file(STRINGS "${c_header}" declarations REGEX "^[a-z].* voussoir_[a-z_]+\\(")
set(exported "")
foreach(declaration IN LISTS declarations)
  string(REGEX MATCH "voussoir_[a-z_]+" name "${declaration}")
  string(APPEND exported "    ${name};\n")
endforeach()
set(exported_names "${PROJECT_BINARY_DIR}/exported_names.map")
file(CONFIGURE OUTPUT "${exported_names}" CONTENT "{\n  global:\n@exported@  local: *;\n};\n" @ONLY)

find_package(HDF5 REQUIRED COMPONENTS C)
find_package(fmt REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
add_library(voussoir_c SHARED ${objects} ${joined_lanes})
add_dependencies(voussoir_c voussoir_kernels)
# Below version 1 a new minor version may change the interface, so that the name of the library has the minor version.
set_target_properties(voussoir_c PROPERTIES OUTPUT_NAME voussoir EXPORT_NAME c LINKER_LANGUAGE CXX
  VERSION "${PROJECT_VERSION}" SOVERSION "${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}"
  LINK_DEPENDS "${exported_names}")
get_target_property(rpath_of_links voussoir INSTALL_RPATH_USE_LINK_PATH)
set_target_properties(voussoir_c PROPERTIES INSTALL_RPATH_USE_LINK_PATH "${rpath_of_links}")
target_link_libraries(voussoir_c PRIVATE fmt::fmt hdf5::hdf5 voussoir_kokkos OpenMP::OpenMP_CXX ${CMAKE_DL_LIBS})
# nodelete: threads of OpenMP may run yet when a program closes the library.
target_link_options(voussoir_c PRIVATE "-Wl,--version-script=${exported_names}" "-Wl,-z,nodelete")
if(VOUSSOIR_SANITIZE)
  target_link_options(voussoir_c PRIVATE -fsanitize=address,undefined)
else()
  target_link_options(voussoir_c PRIVATE "-Wl,-z,defs")
endif()
target_include_directories(voussoir_c INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/host/library>"
                                                "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")

install(TARGETS voussoir_c EXPORT voussoir_c_targets LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT library
        NAMELINK_COMPONENT development)
install(EXPORT voussoir_c_targets NAMESPACE voussoir:: FILE VoussoirCTargets.cmake DESTINATION "${package_folder}"
        COMPONENT development)
install(FILES "${c_header}" host/library/voussoir.f90 DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
set(pc_folder "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
cmake_path(RELATIVE_PATH CMAKE_INSTALL_PREFIX BASE_DIRECTORY "${CMAKE_INSTALL_PREFIX}/${pc_folder}"
           OUTPUT_VARIABLE voussoir_prefix_from_pc)
configure_file(cmake/voussoir.pc.in "${PROJECT_BINARY_DIR}/voussoir.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/voussoir.pc" DESTINATION "${pc_folder}" COMPONENT development)
