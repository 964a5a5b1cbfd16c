# libvoussoir.a: the rooms that a foreign program needs, in one static library, with the headers of the public interface
# (docs/reference/public_interface.md) and the CMake package Voussoir. libvoussoir.so: the same rooms behind the C
# interface (c_library.cmake). A Kokkos for GPUs is the program's own affair.
if(Kokkos_ENABLE_CUDA)
  return()
endif()
include(CMakePackageConfigHelpers)

set(objects "")
foreach(part kernels io host_process host_case host_packing host_material host_library)
  list(APPEND objects $<TARGET_OBJECTS:voussoir_${part}>)
endforeach()
# The part of fem that the rooms above use: meshes and solvers stay out, and with them Gmsh and SuiteSparse.
list(APPEND objects $<FILTER:$<TARGET_OBJECTS:voussoir_fem>,INCLUDE,/material_batch>)
get_property(joined_lanes GLOBAL PROPERTY voussoir_joined_lanes)
set_source_files_properties(${joined_lanes} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
add_library(voussoir_library STATIC ${objects} ${joined_lanes})
add_dependencies(voussoir_library voussoir_kernels)
set_target_properties(voussoir_library PROPERTIES OUTPUT_NAME voussoir EXPORT_NAME voussoir LINKER_LANGUAGE CXX)
target_compile_features(voussoir_library INTERFACE cxx_std_20)
# Eigen's types cross the interface, and their alignment must be that of the library (fem/CMakeLists.txt).
target_compile_definitions(voussoir_library INTERFACE EIGEN_DONT_VECTORIZE)
target_include_directories(voussoir_library INTERFACE "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/voussoir>"
                                                      "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
# A foreign program sees the headers of Eigen alone and only links the others.
set(linked fmt::fmt hdf5::hdf5 voussoir::kokkos OpenMP::OpenMP_CXX ${CMAKE_DL_LIBS})
list(TRANSFORM linked REPLACE "(.+)" "$<LINK_ONLY:\\1>")
list(TRANSFORM linked REPLACE "(.+)" "$<INSTALL_INTERFACE:\\1>")
target_link_libraries(voussoir_library INTERFACE "$<INSTALL_INTERFACE:Eigen3::Eigen>" ${linked})

set(package_folder "${CMAKE_INSTALL_LIBDIR}/cmake/Voussoir")
include(cmake/c_library.cmake)

install(TARGETS voussoir_library EXPORT voussoir_targets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(EXPORT voussoir_targets NAMESPACE voussoir:: FILE VoussoirTargets.cmake DESTINATION "${package_folder}"
        COMPONENT development)
foreach(header host/library/rves.hpp fem/material_batch.hpp io/packing_file.hpp io/input_error.hpp)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/voussoir/${folder}" COMPONENT development)
endforeach()

# The static Kokkos that tools/setup has built is nowhere else to be had, and so it is installed beside the library. A
# user's own Kokkos is looked for where the package is used.
cmake_path(IS_PREFIX PROJECT_SOURCE_DIR "${Kokkos_DIR}" kokkos_is_ours)
if(kokkos_is_ours)
  get_target_property(kokkos_archive Kokkos::kokkoscore IMPORTED_LOCATION_RELEASE)
  cmake_path(GET kokkos_archive FILENAME kokkos_archive_name)
  set(kokkos_folder "${CMAKE_INSTALL_LIBDIR}/voussoir")
  install(FILES "${kokkos_archive}" DESTINATION "${kokkos_folder}" COMPONENT development)
endif()

configure_package_config_file(cmake/VoussoirConfig.cmake.in "${PROJECT_BINARY_DIR}/VoussoirConfig.cmake"
  INSTALL_DESTINATION "${package_folder}" PATH_VARS CMAKE_INSTALL_LIBDIR CMAKE_INSTALL_INCLUDEDIR
  NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/VoussoirConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/VoussoirConfig.cmake" "${PROJECT_BINARY_DIR}/VoussoirConfigVersion.cmake"
        DESTINATION "${package_folder}" COMPONENT development)
